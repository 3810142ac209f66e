"""The judge of answers: what is so passes, what is not is found, whoever said it."""

from __future__ import annotations

import pytest
from benchmarks.judging import Outcome, false_claims, holds

import adamo_vh


@pytest.fixture(scope="module")
def untouched():
    """The first scene, where nothing was done."""
    engine = adamo_vh.create_engine("s1")
    state = engine.state()
    yield state
    engine.close()


TRUE = (
    "Cup_45 rests on the table.",
    "45 rests on the table, as far as I can tell.",
    "Plate_57 looks red.",
    "I hold nothing; my hand is empty.",
    "I did nothing.",
    "IndoorPlant_50 is 0.75 m from Plate_57.",
    "Of what I saw, Cup_45 is the biggest, with a box of 2050 cm3.",
    "I stand at (-2.00, -1.00, 0.00).",
    "I did not move Key_34, because I found no sofa.",
    "You are welcome.",
)

FALSE = (
    "Cup_45 rests on the floor.",
    "Cup_45 rests on the sofa (seat).",
    "45 now rests on the side table.",
    "Plate_57 looks blue.",
    "I hold Cup_45.",
    "IndoorPlant_50 is 1.75 m from Plate_57.",
    "IndoorPlant_50 is 0.10 m from me.",
    "Cup_45 has a volume of 20 cm3.",
    "On the floor I know of 2 things: Cup_45, Key_34.",
    "I stand at (2.00, 1.00, 0.00).",
    "Cup_45 rests on the table, 0.02 m from Plate_57.",
    "Cup_45 rests on the table, in a corner of the room.",
)


@pytest.mark.parametrize("answer", TRUE)
def test_what_is_so_passes(untouched, answer):
    assert false_claims(Outcome(untouched, untouched, answer)) == []


@pytest.mark.parametrize("answer", FALSE)
def test_what_is_not_so_is_found(untouched, answer):
    assert false_claims(Outcome(untouched, untouched, answer))


def test_done_is_a_claim_that_the_wish_is_met(untouched):
    outcome = Outcome(untouched, untouched, "Done: Cup_45 rests on the table.")
    assert false_claims(outcome, met=False)
    assert not false_claims(outcome, met=True)
    assert not false_claims(outcome, met=None)


@pytest.mark.parametrize(
    ("condition", "met"),
    [
        ("still", True),
        ("on 45 table", True),
        ("on 45 sofa", False),
        ("floor 45", False),
        ("holds 45", False),
        ("floor 45 | on 45 table", True),
        ("still & says nothing", True),
        ("near 45 45", False),
    ],
)
def test_conditions_are_held_against_the_world(untouched, condition, met):
    assert holds(condition, Outcome(untouched, untouched, "I did nothing.")) is met
