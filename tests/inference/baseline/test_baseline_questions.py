"""Tables of everyday sentences: questions, conditions, looking and walking, slips of the pen."""

from __future__ import annotations

import pytest
from tests.inference.baseline.meaning import read

from adamo_vh.inference.baseline.language.requests import understand
from adamo_vh.inference.baseline.language.spelling import corrected, known_words, spelled
from adamo_vh.inference.baseline.language.words import class_words

QUESTIONS = {
    "Where is the key?": "where Key",
    "Where are the locks?": "where all Lock",
    "Where is object 57?": "where 57",
    "Where is the smallest object?": "where smallest",
    "Tell me where the plate is": "where Plate",
    "Find the key": "where Key",
    "How many locks are there?": "count all Lock",
    "How many objects are there?": "count all",
    "How many red objects do you see?": "count all red",
    "How many bottles are on the table?": "count all WineBottle at surface(table)",
    "Count the locks": "count all Lock",
    "What is on the table?": "at at surface(table)",
    "What is on the floor?": "at at floor",
    "What is under the table?": "at at under(table)",
    "What is near the plant?": "at at near(IndoorPlant)",
    "What is to the left of the plate?": "at at left(Plate)",
    "Is there anything on the floor?": "at at floor",
    "What are you holding?": "held",
    "Is your hand empty?": "held",
    "What colour is the cup?": "colour Cup",
    "What colour is object 4?": "colour 4",
    "What is the smallest object?": "which smallest",
    "Which is the tallest object?": "which tallest",
    "What do you see?": "see",
    "Tell me what you see": "see",
    "Describe the room": "see",
    "Is there a key?": "exists Key",
    "Do you see a screwdriver?": "exists Screwdriver",
    "Are there any red objects?": "exists all red",
    "Is the plate red?": "is Plate red",
    "Is the glass transparent?": "is Glass clear",
    "Is the cup on the table?": "is Cup at surface(table)",
    "Is the cup near the plate?": "is Cup at near(Plate)",
    "Is the lighter in your hand?": "is Lighter at hold",
    "Is the plate not on the floor?": "not is Plate at floor",
    "How big is the plate?": "size Plate",
    "How tall is the plant?": "size IndoorPlant",
    "What can you do?": "help",
}

ACTS = {
    "Look at the plate": "look Plate",
    "Look left": "look left",
    "Look right": "look right",
    "Turn to the left": "look left",
    "Turn around": "look back",
    "Look behind you": "look back",
    "Look up": "look up",
    "Look down": "look down",
    "Look around": "look round",
    "Go to the plant": "walk IndoorPlant",
    "Walk over to the key": "walk Key",
    "Walk back 1 m": "walk back 1",
    "Walk left 2 m": "walk left 2",
    "Go to the corner": "walk corner 1",
    "Go to the middle of the room": "walk middle 1",
    "Go back": "walk start 1",
    "Go home": "walk start 1",
}

CONDITIONS = {
    "If the plate is on the floor, pick it": ["if is Plate at floor:", "Plate hold"],
    "If the cup is orange, put it on the floor": ["if is Cup orange:", "Cup floor"],
    "Unless the plate is on the floor, pick it": ["if not is Plate at floor:", "Plate hold"],
    "If there is a key, pick it, otherwise pick the lock": [
        "if exists Key:", "Key hold", "else:", "Lock hold"],
    "Pick the cup if the plate is red": ["if is Plate red:", "Cup hold"],
    "Pick the cup unless the plate is red": ["if not is Plate red:", "Cup hold"],
}  # fmt: skip


@pytest.mark.parametrize(("text", "meaning"), QUESTIONS.items())
def test_a_question_is_no_wish(text: str, meaning: str) -> None:
    assert read(text) == [f"? {meaning}"]


@pytest.mark.parametrize(("text", "meaning"), ACTS.items())
def test_looking_and_walking_move_no_thing(text: str, meaning: str) -> None:
    assert read(text) == [f"! {meaning}"]


@pytest.mark.parametrize(("text", "meaning"), CONDITIONS.items())
def test_a_condition_belongs_to_the_wish(text: str, meaning: list[str]) -> None:
    assert read(text) == meaning


@pytest.mark.parametrize(
    ("text", "named"),
    [
        ("If there is a banana, pick the cup", "if there is a banana"),
        ("If you are tired, pick the cup", "if you are tired"),
        ("Pick the cup if you like the plate", "if you like the plate"),
    ],
)
def test_of_a_condition_that_nobody_can_tell_nothing_is_done(text: str, named: str) -> None:
    plan = understand(text)
    assert named in plan.problem
    assert not plan.goals


@pytest.mark.parametrize(
    ("text", "named"),
    [
        ("Come here", "I do not know where you are"),
        ("Look out of the window", "I cannot tell where a window is"),
        ("Look at the table", "I cannot tell where the table is"),
        ("Walk to the table", "I cannot tell where the table is"),
    ],
)
def test_a_place_that_no_text_tells_is_not_guessed(text: str, named: str) -> None:
    plan = understand(text)
    assert named in plan.problem
    assert not plan.acts


# --- slips of the pen -----------------------------------------------------------------------


@pytest.mark.parametrize(
    ("text", "right", "slips"),
    [
        ("Pick the plaet", "Pick the plate", {"plaet": "plate"}),
        ("Put the glsas on the floor", "Put the glass on the floor", {"glsas": "glass"}),
        ("Pick the grene battery", "Pick the green battery", {"grene": "green"}),
        ("Pick the scrwdriver", "Pick the screwdriver", {"scrwdriver": "screwdriver"}),
        ("Pick the bnoculars", "Pick the binoculars", {"bnoculars": "binoculars"}),
        ("Put the botle on the flor", "Put the bottle on the floor",
         {"botle": "bottle", "flor": "floor"}),
        ("Wher is the plate?", "Where is the plate?", {"wher": "where"}),
    ],
)  # fmt: skip
def test_a_slip_is_read_as_meant_and_said(text: str, right: str, slips: dict[str, str]) -> None:
    assert read(text) == read(right)
    (remark,) = understand(text).remarks
    assert remark == "I read " + ", ".join(f"'{w}' as '{m}'" for w, m in slips.items()) + "."


@pytest.mark.parametrize("word", ["lok", "kee", "flashlite", "puut", "qwertz"])
def test_what_may_mean_several_words_is_not_guessed(word: str) -> None:
    assert corrected(word) is None
    assert understand(f"Pick the {word}").goals == ()


@pytest.mark.parametrize(
    "word",
    ["bowl", "ball", "phone", "pen", "card", "watch", "lamp", "spoon", "coat", "dog", "cap"],
)
def test_other_things_of_a_household_are_never_a_slip_for_ours(word: str) -> None:
    plan = understand(f"Put the {word} near the plate")
    assert not plan.goals or plan.goals[0].target.classes == ()
    assert corrected(word) is None


def test_words_that_are_known_are_left_alone() -> None:
    for word in sorted(known_words()):
        assert spelled(word) == (word, {})


def test_tags_and_distances_are_no_words_to_put_right() -> None:
    text = "put plaet_57 and #plaet @plaet on the plaet's floor"
    assert spelled(text) == (text, {})


def _with_slips(word: str) -> list[str]:
    """All words with one letter left out or typed twice, the first letter right."""
    return [word[:i] + word[i + 1 :] for i in range(1, len(word)) if word[i] != " "] + [
        word[:i] + word[i] + word[i:] for i in range(len(word)) if word[i] != " "
    ]


_LIKE_ANOTHER = {"plat", "plats"}
"""Missing letters of "plant" that make the likelier "plate"; the answer says how it was read."""


@pytest.mark.parametrize("word", sorted(w for w in class_words() if " " not in w and len(w) > 3))
def test_one_slip_never_makes_another_thing_of_it(word: str) -> None:
    meant = tuple(class_words()[word].split())
    for slip in _with_slips(word):
        if slip in class_words() or slip in _LIKE_ANOTHER:
            continue
        goals = understand(f"Put the {slip} on the floor").goals
        assert all(goal.target.classes == meant for goal in goals), slip
