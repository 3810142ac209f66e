"""Answers that contradict the feedback are flagged; honest and doubtful ones are not."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import pytest
from tests.report.test_floor_plan import furnished
from tests.report.test_whereabouts import acted, dropped, picked

from adamo_vh.action import Feedback, Outcome
from adamo_vh.engine import FurnitureOutline
from adamo_vh.perception import Labeling
from adamo_vh.record.trajectory import Acted
from adamo_vh.report.contradictions import contradictions
from adamo_vh.report.whereabouts import followed

NAMES = ("sofa", "coffee table", "dining table", "side table", "sideboard", "chair 1", "tall shelf")
WORLD = replace(
    furnished(), furniture=tuple(FurnitureOutline(name, (), 0.0, 1.0) for name in NAMES)
)
REFUSED = Feedback(Outcome.REFUSED, "unreachable", "Refused: no way leads there.")


def flags(answer: str, acts: Sequence[Acted], labeling: Labeling = Labeling.SEM) -> tuple[str, ...]:
    return contradictions(answer, WORLD, labeling, followed(acts), acts)


def put(tag: str, support: str) -> list[Acted]:
    return [picked(1, tag), dropped(2, tag, support)]


@pytest.mark.parametrize(
    ("answer", "support"),
    [
        ("Done: the tape (Tape_4) is on the sofa.", "on the sideboard"),
        ("Tape_4 on the sofa, as the feedback says.", "on the sideboard"),
        ("I put the tape on the chair", "on the sideboard"),
        ("The tape now rests on the coffee table (top).", "on the dining table"),
        ("I looked around.\nI placed the tape in the box.", "on the floor"),
        ("The tape is on the plate.", "on the floor"),
        ("the object tagged as 4 is on top of the shelf", "on the sideboard"),
        ("Done: I hold the tape.", "on the sideboard"),
        ("The tape (Tape_4) is in my hand.", "on the sideboard"),
    ],
)
def test_a_place_that_the_feedback_denies_is_flagged(answer: str, support: str) -> None:
    (flag,) = flags(answer, put("Tape_4", support))
    assert "step 2" in flag and support in flag


@pytest.mark.parametrize(
    ("answer", "support"),
    [
        ("Done: the tape is on the sideboard.", "on the sideboard"),
        ("Done: the tape is on the table.", "on the coffee table (top)"),
        ("Done: the tape is on the cabinet.", "on the sideboard"),
        ("Done: the tape is on the second chair.", "on the chair 1"),
        ("Done: the tape is on the ground.", "on the floor"),
        ("The tape is next to the plate on the sofa.", "on the sideboard"),
        ("The tape is not on the sofa; it rests on the sideboard.", "on the sideboard"),
        ("I wanted to put the tape on the sofa.", "on the sideboard"),
        ("The tape was on the sofa.", "on the sideboard"),
        ("The tape could not be put on the sofa.", "on the sideboard"),
        ("The tape is on the left of the sideboard.", "on the sideboard"),
        ("The tape is on the gizmo.", "on the sideboard"),
        ("The tape is on the table.", "on Plate_57"),
        ("The battery is on the sofa.", "on the sideboard"),
        ("La cinta está en el sofá.", "on the sideboard"),
        ("I hold nothing. The tape is on the sideboard.", "on the sideboard"),
        ("The screwdriver is on the sofa.", "on the sideboard"),
        ("", "on the sideboard"),
    ],
)
def test_what_may_be_true_is_not_flagged(answer: str, support: str) -> None:
    assert flags(answer, put("Tape_4", support)) == ()


def test_a_thing_that_is_still_in_the_hand_was_not_put_anywhere() -> None:
    acts = [picked(1, "Tape_4")]
    (flag,) = flags("Done: the tape is next to the plate.", acts)
    assert "in the hand" in flag
    assert flags("I hold the tape.", acts) == ()
    assert flags("I picked the tape.", acts) == ()


def test_opaque_tags_are_understood() -> None:
    acts = put("4", "on the sideboard")
    assert flags("Object 4 is on the sofa.", acts, Labeling.OPAQ)
    assert flags("The tape (4) is on the sofa.", acts, Labeling.OPAQ)
    assert not flags("4 of 5 are on the sofa.", acts, Labeling.OPAQ)


def test_done_after_a_refusal_is_flagged() -> None:
    acts = [picked(1, "Tape_4"), acted(2, "Drop", "Tape_4", REFUSED)]
    (flag,) = flags("Done.", acts)
    assert flag == "The answer says that it is done; Drop, step 2, was refused."
    assert flags("I could not put it down: no way leads there.", acts) == ()
    assert flags("Done, but the tape is still in my hand.", acts) == ()


def test_a_look_that_was_refused_says_nothing_about_the_deed() -> None:
    acts = [*put("Tape_4", "on the sofa"), acted(3, "Look", None, REFUSED)]
    assert flags("Done: the tape is on the sofa.", acts) == ()


def test_each_thing_is_flagged_once() -> None:
    said = "The tape is on the sofa.\nverified: Tape_4 on the sofa"
    assert len(flags(said, put("Tape_4", "on the sideboard"))) == 1
