"""Tables of what is left out, refused, or misspelt; and that no inner symbol is ever shown."""

from __future__ import annotations

import random
import re

import pytest
from tests.inference.baseline.meaning import read

from adamo_vh.inference.baseline.language.requests import understand
from adamo_vh.inference.baseline.language.words import phrase_table

LEFT_OUT = {
    "Put everything but the plate and the cup on the floor": "all but(Plate) but(Cup) floor",
    "Put everything on the floor except the plate and the cup": "all but(Plate) but(Cup) floor",
    "Put everything on the floor but the plate and the cup": "all but(Plate) but(Cup) floor",
    "Put all objects on the floor except for the plate": "all but(Plate) floor",
    "Put all objects on the floor other than the plate, the cup, and the glass": (
        "all but(Plate) but(Cup) but(Glass) floor"
    ),
    "Put all but 34 on the floor": "all but(34) floor",
    "Put all but lock 18 in a corner": "all but(18 Lock) corner",
    "Put everything but plate and cup on the floor": "all but(Plate) but(Cup) floor",
    "Put everything but the red one on the floor": "all but(red) floor",
    "Put all things on the floor, but not the cup": "all but(Cup) floor",
    "Put everything on the floor but don't touch the cup": "all but(Cup) floor",
    "Put everything on the floor, but do not put the cup on the floor": "all but(Cup) floor",
    "Pick all but the cup": "all but(Cup) hold",
    "Put everything on the floor save the plate": "all but(Plate) floor",
    "Put everything on the floor that is not food": "all but(all PeanutButter) floor",
    "Put nothing but the cup on the floor": "Cup floor",
    "Leave the cup alone and pick up the plate": "Plate hold",
    "Pick the plate but leave the cup where it is": "Plate hold",
    "Without touching the glass, put the plate on the floor": "Plate floor",
    "Don't put the cup on the floor, put it next to the plant": "Cup near(IndoorPlant)",
}

SPARED = {
    "Put all but one lock on the floor": 1,
    "Put all but one of the locks on the floor": 1,
    "Put all locks but one on the floor": 1,
    "Put all but two objects on the floor": 2,
    "Put all but 2 locks on the floor": 2,
    "Put all except one battery on the floor": 1,
    "Put all of the locks except for two in a corner": 2,
}

A_NUMBER_LEFT_OUT = (
    "Put every lock but one on the floor",
    "Put everything on the floor except one",
    "Put the locks on the floor, all but one",
    "Put all the locks on the floor but leave one on the table",
    "Put all except some of the batteries on the floor",
)

CANNOT = (
    "Turn on the flashlight",
    "Turn off the flashlight",
    "Turn the flashlight on",
    "Switch on the torch",
    "Switch the flashlight off",
    "Light the lighter",
    "Shine the flashlight at the plate",
    "Point the flashlight at the plate",
    "Turn the plate around",
    "Turn over the plate",
    "Flip the cup",
    "Pick the flashlight and turn it on",
    "Take the torch, then switch it on",
)

STILL_TURNS = {
    "Turn to the flashlight": "! look Flashlight",
    "Turn towards the plate": "! look Plate",
    "Turn around": "! look back",
    "Turn left": "! look left",
    "Look at the flashlight": "! look Flashlight",
    "Watch the plate": "! look Plate",
}

SHIFTED = {
    "Move the cup to the right by half a metre": "Cup shift(right 50)",
    "Move the cup by 30 cm to the right": "Cup shift(right 30)",
    "Move the cup right by 30 cm": "Cup shift(right 30)",
    "Move the cup 30 cm left": "Cup shift(left 30)",
    "Move the cup forward by 20 cm": "Cup shift(front 20)",
    "Move the cup half a metre to the left": "Cup shift(left 50)",
    "Put the cup by the plate": "Cup near(Plate)",
}

SLIPS = {
    "Pick teh screwdiver": "Screwdriver hold",
    "Pick the gass lighter": "Lighter hold",
    "Pick the peanut buter": "PeanutButter hold",
    "Pick the glass lighter": "Lighter hold",
    "Put the gass on the floor": "Glass floor",
}


@pytest.mark.parametrize(("text", "meaning"), (LEFT_OUT | SHIFTED | STILL_TURNS | SLIPS).items())
def test_the_words_mean_this_and_no_more(text, meaning):
    assert read(text) == [meaning]


@pytest.mark.parametrize("text", A_NUMBER_LEFT_OUT)
def test_a_number_left_out_is_refused_and_named(text):
    plan = understand(text)
    assert "say which" in plan.problem
    assert not plan.goals


@pytest.mark.parametrize(("text", "number"), SPARED.items())
def test_a_number_of_all_is_spared(text, number):
    (goal,) = understand(text).goals
    assert goal.target.every
    assert goal.target.spared == number


@pytest.mark.parametrize("text", CANNOT)
def test_switching_and_turning_things_is_refused(text):
    plan = understand(text)
    assert "I cannot switch" in plan.problem
    assert not plan.goals
    assert not plan.acts


@pytest.mark.parametrize(
    ("text", "remark"),
    [
        ("Put the plate on the floor, but not the cup", "As you asked, I heed 'not the cup'."),
        ("Pick the plate, do not touch the cup", "As you asked, I do not touch the cup."),
        (
            "Pick the plate, avoid touching the cup",
            "As you asked, I heed 'avoid touching the cup'.",
        ),
    ],
)
def test_what_is_not_done_is_said_in_a_sentence(text, remark):
    assert understand(text).remarks == (remark,)


@pytest.mark.parametrize("text", ["Move the cup by half a metre", "Move the cup 50 cm"])
def test_a_distance_without_a_way_is_asked_for(text):
    assert understand(text).problem == "'50 cm' (which way, or from what?)"


def test_another_language_is_named_only_if_most_words_are_strange():
    assert "English only" in understand("Wo ist der Teller bitte").problem
    assert "English only" not in understand("Pick the quux").problem
    assert "English only" not in understand("Pick teh sqrewdiver noww").problem


def test_no_inner_symbol_is_shown():
    draw = random.Random(7)
    phrases = [*sorted(phrase_table()), "50 cm", "by half a metre", "@", "to the left", "@right30"]
    starts = ("Put", "Move the cup", "Pick", "Put everything", "Turn", "Is", "If the cup", "Where")
    for _ in range(600):
        words = draw.choices(phrases, k=draw.randint(1, 6))
        plan = understand(f"{draw.choice(starts)} {' '.join(words)}")
        shown = " ".join([plan.problem, *plan.remarks, *(goal.wish() for goal in plan.goals)])
        assert not re.search(r"@|_|\bNone\b|<|Kind|\bshift\d", shown), (words, shown)
