"""Tables of everyday sentences: which things are meant, and where they shall go."""

from __future__ import annotations

import pytest
from tests.inference.baseline.meaning import read

from adamo_vh.inference.baseline.language.requests import understand

THINGS = {
    "the lock": "Lock",
    "the padlock": "Lock",
    "the torch": "Flashlight",
    "the roll of tape": "Tape",
    "the jar of peanut butter": "PeanutButter",
    "the can of soup": "TomatoSoup",
    "the pair of binoculars": "Binoculars",
    "the coffee mug": "Cup",
    "the tumbler": "Glass",
    "the house key": "Key",
    "the flower pot": "IndoorPlant",
    "the wine": "WineBottle",
    "the bottle": "WineBottle",
    "something to drink from": "Cup",
    "something to eat": "PeanutButter",
    "the tool": "Screwdriver",
    # By tag or number.
    "#57": "57",
    "tag 57": "57",
    "object 999": "999",
    "Plate 57": "57 Plate",
    "the plate (57)": "57 Plate",
    # By looks.
    "the green thing": "green",
    "the grey object": "grey",
    "the gray object": "grey",
    "the golden object": "yellow",
    "the silver object": "grey",
    "the pink object": "pink",
    "the amber bottle": "WineBottle brown",
    "the white bottle": "WineBottle white",
    "the white and red can": "TomatoSoup white red",
    "the yellow and black object": "yellow black",
    "the object with white parts": "white-part",
    "the object with a blue handle": "blue-part",
    "the red object with a white rim": "red white-part",
    "the transparent object": "clear",
    "the long object": "long",
    "the flat round object": "flat round",
    "the square object": "box",
    "the cylindrical object": "cylinder",
    # By comparing.
    "the shortest object": "shortest",
    "the biggest red object": "red largest",
    "the second largest object": "largest2",
    "the third smallest object": "smallest3",
    "the second smallest battery": "Battery smallest2",
    "the tallest bottle": "WineBottle tallest",
    "the smaller of the two locks": "Lock smallest",
    "the largest object on the floor": "largest from-floor",
    # By what it is not.
    "the lock that is not brass": "Lock but(brown)",
    "the battery that isn't green": "Battery but(green)",
}

GROUPS = {
    "both batteries": "all Battery x2",
    "two bottles": "all WineBottle x2",
    "the three bottles": "all WineBottle x3",
    "2 locks": "all Lock x2",
    "any two locks": "all Lock x2",
    "all of the keys": "all Key",
    "each battery": "all Battery",
    "every cylinder": "all cylinder",
    "all red objects": "all red",
    "all objects with cream parts": "all white-part",
    "the labelled objects": "all label",
    "20 and 23": "all 20 23",
    "objects 2, 3 and 4": "all 2 3 4",
    "one of the bottles": "WineBottle",
    "everything but the plate": "all but(Plate)",
    "all objects except the locks": "all but(all Lock)",
    "all bottles except the wine": "all WineBottle but(WineBottle)",
    "all batteries but the green one": "all Battery but(green)",
    "the things that are not red": "all but(red)",
}

PLACES = {
    "on the floor": "floor",
    "down on the ground": "floor",
    "in a corner": "corner",
    "on the sofa": "surface(sofa)",
    "on the coffee table": "surface(coffee table)",
    "on the top shelf": "surface(top shelf)",
    "on the middle shelf": "surface(middle shelf)",
    "on top of the shelf": "surface(shelf)",
    "on the chair": "surface(chair)",
    "on the rug": "surface(rug)",
    "under the table": "under(table)",
    "underneath the chair": "under(chair)",
    "near the plant": "near(IndoorPlant)",
    "by the plant": "near(IndoorPlant)",
    "next to object 50": "near(50)",
    "near the red plate": "near(Plate red)",
    "next to the larger lock": "near(Lock largest)",
    "between the plate and the glass": "between(Plate Glass)",
    "to the left of the plate": "left(Plate)",
    "to the right of the plate": "right(Plate)",
    "in front of the glass": "front(Glass)",
    "behind the plant": "behind(IndoorPlant)",
    "far from the plate": "far(Plate)",
    "away from the plate": "far(Plate)",
    "30 cm from the plate": "far(Plate 30)",
    "1 m away from the plate": "far(Plate 100)",
    "at the edge of the coffee table": "edge",
    "back": "home",
    "back where it was": "home",
}

SENTENCES = {
    # Several wishes, and what the small words refer to.
    "Pick the cup. Put it near the plate.": ["Cup near(Plate)"],
    "Take the glass and the cup and put them on the floor": ["Glass floor", "Cup floor"],
    "Take the plate, the cup and the glass and put them on the floor": [
        "Plate floor", "Cup floor", "Glass floor"],
    "Put the plate on the floor. Then pick the key.": ["Plate floor", "Key hold"],
    "First put the cup on the floor, then the glass near it": ["Cup floor", "Glass near(Cup)"],
    "Put the glass on the floor and the cup next to the glass": ["Glass floor", "Cup near(Glass)"],
    "Put the plate on the floor, then pick it again": ["Plate floor", "Plate hold"],
    "Put the cup on the coffee table and the plate on the dining table": [
        "Cup surface(coffee table)", "Plate surface(dining table)"],
    "Pick the cup and put everything else on the floor": ["all but(Cup) floor", "Cup hold"],
    "Take the plate. Put it on the floor. Then take the cup and put it next to it.": [
        "Plate floor", "Cup near(Plate)"],
    "Put one battery on the floor and the other one in the corner": [
        "Battery floor", "Battery other corner"],
    "Walk to the plant and pick it up": ["IndoorPlant hold", "! walk IndoorPlant"],
    "I dropped my key. Can you find it and give it to me?": ["Key hold"],
    "Which object is blue?": ["? exists all blue"],
    "Can you see the plant?": ["? exists IndoorPlant"],
    "Put the pills where the lighter is": ["Pills near(Lighter)"],
    "I need the binoculars": ["Binoculars hold"],
    "The key. On the floor. Now.": ["Key floor"],
    "Pick up the battery and put it near the other battery": [
        "Battery near(Battery other)"],
    "Put the plate and the cup together": ["Cup near(Plate)"],
    "Put 2 locks near the plant": ["all Lock x2 near(IndoorPlant)"],
    "Put objects 2, 3 and 4 near object 57": ["all 2 3 4 near(57)"],
    # Moves by a distance, as the viewer sees it.
    "Move the cup 20 cm to the left": ["Cup shift(left 20)"],
    "Move the cup a bit to the left": ["Cup shift(left 25)"],
    "Move the cup forward": ["Cup shift(front 25)"],
    # However it is typed.
    "PUT THE PLATE ON THE FLOOR!!!": ["Plate floor"],
    "  please   put  the plate \n   on the floor ": ["Plate floor"],
    "Put Plate_57 next to IndoorPlant_50": ["plate_57 near(indoorplant_50)"],
    # What shall be left alone is no wish.
    "Do not touch the cup, put the plate on the floor": ["Plate floor"],
    "Put the plate on the floor, but not the cup": ["Plate floor"],
    "Pick the glass, not the cup": ["Glass hold"],
    "Pick the cup and do not put it down": ["Cup hold"],
    "Don't look at the plate, look at the cup": ["! look Cup"],
}  # fmt: skip

POLITE = ["Please {}", "{}, please.", "Could you {} for me?", "Adamo, {}!", "I want you to {}"]


@pytest.mark.parametrize(("words", "meaning"), THINGS.items())
def test_one_thing_is_meant(words: str, meaning: str) -> None:
    assert read(f"Pick {words}") == [f"{meaning} hold"]
    assert read(f"Take {words} and put it in a corner") == [f"{meaning} corner"]


@pytest.mark.parametrize(("words", "meaning"), GROUPS.items())
def test_several_things_are_meant(words: str, meaning: str) -> None:
    assert read(f"Put {words} on the floor") == [f"{meaning} floor"]


@pytest.mark.parametrize(("words", "meaning"), PLACES.items())
def test_a_place_is_meant(words: str, meaning: str) -> None:
    assert read(f"Put the cup {words}") == [f"Cup {meaning}"]
    assert read(f"Take the cup and put it {words}") == [f"Cup {meaning}"]


@pytest.mark.parametrize("polite", POLITE)
@pytest.mark.parametrize("plain", ["put the cup near the plate", "pick the smaller lock"])
def test_politeness_changes_nothing(polite: str, plain: str) -> None:
    assert read(polite.format(plain)) == read(plain)


@pytest.mark.parametrize(("text", "meaning"), SENTENCES.items())
def test_whole_sentences(text: str, meaning: list[str]) -> None:
    assert read(text) == meaning


# Never a part of a sentence only: what cannot be read stops all of it, and is named.
PROBLEMS = {
    # Deeds that a hand which picks and puts cannot do.
    "Eat the soup": "eat",
    "Open the bottle": "open",
    "Water the plant": "water",
    "Throw the cup": "throw",
    "Break the glass": "break",
    "Cut the tape": "cut",
    "Hide the key": "hide",
    "Push the cup to the right": "push",
    "Fill the glass with water": "fill",
    "Clean the table": "clean",
    "Sort the objects by size": "sort",
    "Line up the bottles": "line",
    "Unlock the lock with the key": "unlock",
    "Light the lighter": "light",
    "Sing a song": "sing",
    "Put the cup upside down on the floor": "upside",
    "Put the plate on the floor twice": "twice",
    "Pick the cup and dance": "dance",
    "Put the plate on the floor and juggle": "juggle",
    # Things that nobody knows of here, or that no text describes.
    "Pick a banana": "banana",
    "Pick the dog": "dog",
    "Pick the lightest object": "lightest",
    "Pick the object without a label": "without",
    "Put the last object on the floor": "last",
    # Places that no text tells.
    "Put the cup near the window": "window",
    "Put the plate near the door": "door",
    "Put the plate on the ceiling": "ceiling",
    "Put the cup next to the sofa": "sofa",
    "Put the plate beside the table": "table",
    # A thing is nothing to put things into.
    "Put the key in the lock": "lock",
    "Put the flashlight inside the mug": "mug",
    # Nothing was named that the small word could mean.
    "Put the cup near it": "it",
    "Put them on the floor": "them",
    "Put the plate there": "there",
    # Half a sentence.
    "Put the key": "where to put it",
    "Put the tape around the bottle": "where to put it",
    "Pick": "a thing",
    "the plate": "verb",
    "on the floor": "verb",
    "42": "verb",
    "?": "no wish",
    "asdf qwer": "asdf",
}


@pytest.mark.parametrize(("text", "named"), PROBLEMS.items())
def test_what_cannot_be_done_is_named_and_nothing_is_done(text: str, named: str) -> None:
    plan = understand(text)
    assert (plan.goals, plan.acts, plan.questions) == ((), (), ())
    assert named in plan.problem


@pytest.mark.parametrize(
    "text",
    [
        "Nimm den Teller und stell ihn auf den Boden",
        "Ramasse la tasse et pose-la par terre",
        "Coge el vaso y ponlo en el suelo",
    ],
)
def test_other_languages_are_told_that_english_is_needed(text: str) -> None:
    plan = understand(text)
    assert plan.problem.endswith("(I read English only)")
    assert not plan.goals


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("Don't pick the plate", "As you asked, I do not pick the plate."),
        ("Never touch the key", "As you asked, I do not touch the key."),
        ("You must not pick the plate", "As you asked, I do not pick the plate."),
        ("Do not move", "I do nothing and wait."),
        ("Wait", "I do nothing and wait."),
        ("Stop!", "I do nothing and wait."),
        ("Never mind", "I do nothing and wait."),
    ],
)
def test_what_must_not_be_done_is_said_and_not_done(text: str, said: str) -> None:
    plan = understand(text)
    assert plan.remarks == (said,)
    assert (plan.goals, plan.acts, plan.questions, plan.problem) == ((), (), (), "")


@pytest.mark.parametrize("text", ["Hello", "Thank you", "Good job!", "Hi there"])
def test_small_talk_is_answered_with_what_it_can_do(text: str) -> None:
    plan = understand(text)
    assert not plan.goals
    assert "I can pick things up" in plan.remarks[0]
