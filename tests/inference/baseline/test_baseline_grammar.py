"""The grammar understands the benchmark's prompts and everyday ways to say the same."""

from __future__ import annotations

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.inference.baseline.rewordings import REWORDINGS

from adamo_vh.benchmark.tasks import TASKS
from adamo_vh.inference.baseline.language.plan import Description, Goal, Relation, Size
from adamo_vh.inference.baseline.language.requests import understand
from adamo_vh.inference.baseline.language.words import class_words, tokenize
from adamo_vh.inference.baseline.sight.prototypes import prototypes


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
    ("Pick up the biggest thing you can see", ["largest hold"]),
    ("Put the smaller battery next to the larger one",
     ["Battery smallest near Battery largest"]),
    ("Put two batteries on the floor", ["all Battery floor"]),
    ("Put every bottle in a corner", ["all WineBottle corner"]),
    ("Put everything on the floor", ["all  floor"]),
    ("Move the wine to the coffee table", ["WineBottle surface"]),
    ("Put any object with a label on the floor", ["all label floor"]),
    ("Pick any object with a label", ["label hold"]),
    ("Put the glass in a corner, then the plate", ["Glass corner", "Plate corner"]),
    ("The plate and the cup: put them near the plant",
     ["Plate near IndoorPlant", "Cup near IndoorPlant"]),
    ("Find the plate and the cup, then pick the cup", ["Cup hold"]),
]  # fmt: skip

NOT_UNDERSTOOD: list[tuple[str, str]] = [
    ("Pick the plate and dance", "dance"),
    ("Stack the cups", "stack"),
    ("Put the glass on the plate", "plate"),
    ("Pick the plate unless you are tired", "tired"),
    ("Pick the object nearest to the window", "window"),
    ("Put the plate", "where"),
    ("Put it on the floor", "it"),
    ("Bring the cup there", "there"),
    ("Pick an object", "any object"),
    ("Pick the heaviest object", "heaviest"),
    ("Swap the glass and the cup", "swap"),
    ("What is the capital of France?", "capital"),
    ("", "no wish"),
]


@pytest.mark.parametrize("task", TASKS, ids=lambda task: task.id)
def test_benchmark_prompts_are_understood(task):
    assert read(task.prompt) == MEANINGS[task.id]


@pytest.mark.parametrize(
    ("task", "text"), [(task, text) for task, texts in REWORDINGS.items() for text in texts]
)
def test_rewordings_mean_the_same(task, text):
    assert sorted(read(text)) == sorted(MEANINGS[task])


def test_each_task_has_many_rewordings():
    assert set(REWORDINGS) == set(MEANINGS)
    assert all(len(set(texts)) >= 8 for texts in REWORDINGS.values())


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


def test_every_class_that_may_be_meant_has_a_word():
    meant = {name for name, prototype in prototypes().items() if prototype.weight == 1.0}
    assert {name for value in class_words().values() for name in value.split()} == meant


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
    assert plan.empty is False
    assert not (plan.goals and plan.problem)


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
    assert plan.empty is False
    assert not (plan.goals and plan.problem)


def test_symbols_keep_the_words():
    tokens = tokenize("Pick up the potted plant!")
    assert [token.text for token in tokens] == ["pick up", "the", "potted plant", "!"]
