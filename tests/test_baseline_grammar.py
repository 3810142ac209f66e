"""The grammar understands the benchmark's prompts and everyday ways to say the same."""

from __future__ import annotations

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from adamo.benchmark.tasks import TASKS
from adamo.inference.baseline.goals import Description, Goal, Relation, Size
from adamo.inference.baseline.grammar import understand
from adamo.inference.baseline.lexicon import class_words, tokenize
from adamo.inference.baseline.prototypes import prototypes


def _thing(description: Description) -> str:
    """A description in short: ids, classes, and what else is said."""
    words = [*description.ids, *description.classes[:1], *description.colours]
    words += [f"{colour}-part" for colour in description.part_colours]
    words += description.shapes
    words += ["clear"] * description.transparent + ["label"] * description.label
    words += [str(description.size)] if description.size else []
    return ("all " if description.every else "") + " ".join(words)


def _goal(goal: Goal) -> str:
    anchor = f" {_thing(goal.anchor)}" if goal.anchor else ""
    return f"{_thing(goal.target)} {goal.relation}{anchor}"


def read(text: str) -> list[str]:
    """All goals of an instruction in short."""
    plan = understand(text)
    assert not plan.problem, plan.problem
    return [_goal(goal) for goal in plan.goals]


MEANINGS: dict[str, list[str]] = {
    "T1": ["34 hold"],
    "T2": ["Plate hold"],
    "T3": ["blue round hold"],
    "T4": ["Plate floor"],
    "T5": ["4 near IndoorPlant"],
    "T6": ["smallest floor"],
    "T7": ["Flashlight corner"],
    "T8": ["Glass floor", "Plate floor"],
    "T9": ["37 near Plate", "30 near 3"],
    "T10": ["Glass near Plate", "Binoculars near Screwdriver"],
    "T11": ["4 near IndoorPlant", "Glass near Plate"],
    "T12": ["Cup floor", "PeanutButter floor", "Pills floor"],
    "T13": ["TomatoSoup cylinder near IndoorPlant", "Binoculars near Screwdriver"],
    "T14": ["all white-part floor"],
    "T15": ["all label floor"],
}

REWORDINGS: list[tuple[str, str]] = [
    ("T1", "Please grab object 34."),
    ("T1", "Could you take the thing with tag 34 for me?"),
    ("T1", "Pick up #34"),
    ("T1", "Get me the item numbered 34, please"),
    ("T1", "I want you to hold the object that has the tag 34"),
    ("T2", "Take the dish."),
    ("T2", "I would like you to pick up the plate, please"),
    ("T2", "Bring me the dinner plate"),
    ("T2", "Go and fetch the plate"),
    ("T2", "Lift up the plate"),
    ("T3", "Get the round blue thing"),
    ("T3", "Grab the blue object that is circular"),
    ("T3", "Lift the object which is blue and round"),
    ("T3", "Pick up the blue, round item"),
    ("T4", "Put the plate on the ground."),
    ("T4", "Bring the plate to the floor"),
    ("T4", "Take the plate, then set it down on the floor"),
    ("T4", "The plate should be on the floor"),
    ("T4", "On the floor, put the plate"),
    ("T4", "Grab the dish; afterwards lay it on the floor"),
    ("T4", "Take the plate to the floor"),
    ("T5", "Move object 4 next to the houseplant"),
    ("T5", "Bring number 4 close to the plant"),
    ("T5", "Fetch item 4 and leave it beside the potted plant"),
    ("T5", "Carry the object with the id 4 over to the indoor plant"),
    ("T6", "Put the smallest item on the floor"),
    ("T6", "Find and pick up the tiniest object and leave it on the ground"),
    ("T6", "Take the object with the smallest volume and put it on the floor"),
    ("T6", "Pick the smallest of all objects, then drop it on the floor"),
    ("T7", "Carry the torch to a corner of the room"),
    ("T7", "Put the flashlight in one of the corners of the room, on the floor"),
    ("T7", "Drop the torch in any corner of the room"),
    ("T7", "Take the flashlight and put it on the ground in the nearest corner"),
    ("T8", "Put the glass and the plate on the floor"),
    ("T8", "Take both the tumbler and the dish and lay them down on the floor"),
    ("T8", "Pick the glass, pick the plate, and put both on the floor"),
    ("T8", "Put the glass on the floor and do the same with the plate"),
    ("T8", "Place the glass on the floor, then bring the plate there"),
    ("T9", "Move 37 near the plate; after that move 30 near 3"),
    (
        "T9",
        "First, take object 37 and put it beside the plate. Next, take object 30 and put it "
        "beside object 3.",
    ),
    ("T9", "Place object 37 by the plate and object 30 by object 3"),
    ("T10", "Place the glass alongside the plate and the binoculars alongside the screwdriver"),
    ("T10", "Bring the drinking glass to the plate. Then bring the binoculars to the screwdriver."),
    ("T10", "Next to the plate, place the glass; next to the screwdriver, place the binoculars"),
    ("T11", "Set object 4 near the plant and then set the glass close to the plate"),
    ("T11", "Take number 4, put it near the houseplant; take the tumbler, put it near the dish"),
    ("T12", "Put the mug, the jar of peanut butter and the pill bottle on the ground"),
    ("T12", "Collect the cup, the peanut butter and the pills, and put all of them on the floor"),
    ("T12", "Take the cup, peanut butter and pills and put all three on the floor"),
    ("T12", "Put on the floor the cup, the peanut butter and the pills"),
    (
        "T13",
        "Move the cylindrical can near the plant, and the binoculars by the screwdriver",
    ),
    (
        "T13",
        "Take the cylindrical tin and place it beside the potted plant. After that, take the "
        "field glasses and place them beside the screwdriver.",
    ),
    ("T14", "Put everything that has white parts on the floor"),
    ("T14", "Put every object with parts that are white on the floor"),
    ("T14", "Take all things which have some white on them and put them on the floor"),
    ("T14", "Gather all the items with white areas and place them on the ground"),
    ("T14", "Each object with a white part goes on the floor"),
    ("T15", "All objects with a label should be on the floor"),
    ("T15", "Put on the floor all the items that carry a printed label"),
    ("T15", "Place each product with printed text on the floor"),
    ("T15", "Collect every thing that has writing on it and drop them on the floor"),
    ("T15", "Everything with a product label goes on the floor"),
]

FURTHER: list[tuple[str, list[str]]] = [
    ("Pick the black object and place it near the spherical object", ["black near sphere"]),
    ("Pick the smaller lock", ["Lock smallest hold"]),
    ("Take the green battery and put it near the larger battery",
     ["Battery green near Battery largest"]),
    ("Put both locks on the floor", ["all Lock floor"]),
    ("Put one of the locks on the floor", ["Lock floor"]),
    ("Pick the bottle of wine", ["WineBottle hold"]),
    ("Hold the transparent object", ["clear hold"]),
    ("Pick the screwdriver with the red handle", ["Screwdriver red-part hold"]),
    ("Pick the object labelled TOMATO SOUP", ["TomatoSoup label hold"]),
    ("Pick up Key_34", ["key_34 hold"]),
    ("Pick objects 8, 19 and 20 and put them on the floor", ["all 8 19 20 floor"]),
    ("Put the plate on the table", ["Plate surface"]),
    ("Pick the plate, put it down on the floor, and pick the cup.",
     ["Plate floor", "Cup hold"]),
    ("Pick the ring-shaped blue item and put it by the plant",
     ["blue ring near IndoorPlant"]),
    ("Take the red object from the table and lay it on the floor near the plant",
     ["red floor IndoorPlant"]),
    ("I want the glass next to the plate", ["Glass near Plate"]),
    ("Pick up the tallest object", ["tallest hold"]),
]  # fmt: skip

NOT_UNDERSTOOD: list[tuple[str, str]] = [
    ("Don't pick the plate", "don't"),
    ("Pick the plate and dance", "dance"),
    ("Stack the cups", "stack"),
    ("Put the glass on the plate", "plate"),
    ("Pick the plate unless it is red", "unless"),
    ("Pick the object nearest to the window", "window"),
    ("Put the plate", "where"),
    ("Put it on the floor", "it"),
    ("Bring the cup there", "there"),
    ("Pick an object", "any object"),
    ("What is the capital of France?", "capital"),
    ("hello", "no wish"),
    ("", "no wish"),
]


@pytest.mark.parametrize("task", TASKS, ids=lambda task: task.id)
def test_benchmark_prompts_are_understood(task):
    assert read(task.prompt) == MEANINGS[task.id]


@pytest.mark.parametrize(("task", "text"), REWORDINGS)
def test_rewordings_mean_the_same(task, text):
    assert sorted(read(text)) == sorted(MEANINGS[task])


@pytest.mark.parametrize(("text", "meaning"), FURTHER)
def test_further_instructions(text, meaning):
    assert read(text) == meaning


@pytest.mark.parametrize(("text", "named"), NOT_UNDERSTOOD)
def test_what_is_not_understood_is_named(text, named):
    plan = understand(text)
    assert plan.goals == ()
    assert named in plan.problem


@pytest.mark.parametrize("word", sorted(class_words()))
def test_every_word_for_a_thing_can_be_used(word):
    (goal,) = understand(f"Put the {word} on the floor").goals
    assert goal.relation is Relation.FLOOR
    assert set(goal.target.classes) <= set(prototypes())


def test_every_class_has_a_word():
    assert {name for value in class_words().values() for name in value.split()} == set(prototypes())


def test_superlatives_and_groups_need_comparing():
    smallest, group, single = (
        understand(f"Pick {words}").goals[0].target
        for words in ("the smallest object", "all locks", "the lock")
    )
    assert smallest.size is Size.SMALLEST
    assert (smallest.compares, group.compares, single.compares) == (True, True, False)


@settings(max_examples=300, deadline=None)
@given(st.text(max_size=200))
def test_any_text_gives_goals_or_a_problem(text):
    plan = understand(text)
    assert bool(plan.goals) != bool(plan.problem)


_SOME_WORDS = (
    "pick put place move bring the a all both it them there cup plate locks object objects 34 "
    "on in near next to of floor corner room table with white parts label smallest blue that is "
    "and , . then do the same with one should be tagged as from"
)
_WORDS = st.sampled_from(_SOME_WORDS.split())


@settings(max_examples=600, deadline=None)
@given(st.lists(_WORDS, max_size=14).map(" ".join))
def test_any_mix_of_known_words_gives_goals_or_a_problem(text):
    plan = understand(text)
    assert bool(plan.goals) != bool(plan.problem)


def test_symbols_keep_the_words():
    tokens = tokenize("Pick up the potted plant!")
    assert [token.text for token in tokens] == ["pick up", "the", "potted plant", "!"]
