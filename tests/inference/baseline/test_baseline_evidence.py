"""What the baseline may claim about a place: the true and the false side of every wish."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from adamo_vh.geometry import Vec3
from adamo_vh.inference.baseline.language.plan import SIDES, Description, Goal, Relation
from adamo_vh.inference.baseline.mind.choosing import thing_of
from adamo_vh.inference.baseline.mind.evidence import (
    axes,
    claim,
    named,
    same_surface,
    shifted,
    side_of,
)
from adamo_vh.inference.baseline.mind.memory import Job, Memory, Stand
from adamo_vh.inference.baseline.prompt.reading import Room

ROOM = Room(-3.0, 3.0, -5.0, 3.0)
CUP, PLATE = Description("the cup", classes=("Cup",)), Description("the plate", classes=("Plate",))
VIEWER = Stand(Vec3(-2.0, 0.0, 0.0), 0.0)
"""Looks along +X: farther is +X, the right hand side is -Y."""


@pytest.mark.parametrize(
    ("furniture", "support"),
    [
        ("table", "on the table"),
        ("table", "on the coffee table"),
        ("coffee table", "on the coffee table"),
        ("couch", "on the sofa"),
        ("shelf", "on the tall shelf (lower)"),
        ("top shelf", "on the tall shelf (top)"),
        ("upper shelf", "on the tall shelf (top)"),
        ("top of the shelf", "on the tall shelf (top)"),
        ("bottom shelf", "on the tall shelf (lower)"),
        ("middle shelf", "on the tall shelf (middle)"),
        ("bookcase", "on the tall shelf (middle)"),
        ("chair", "on the chair 2"),
        ("surface", "on the sideboard"),
        ("carpet", "on the rug"),
    ],
)
def test_what_feedback_names_is_what_was_asked_for(furniture: str, support: str) -> None:
    assert named(furniture, support)


@pytest.mark.parametrize(
    ("furniture", "support"),
    [
        ("table", "on the floor"),
        ("surface", "on the floor"),
        ("table", "on the sideboard"),
        ("dining table", "on the coffee table"),
        ("coffee table", "on the table"),
        ("top shelf", "on the tall shelf (lower)"),
        ("middle shelf", "on the tall shelf (top)"),
        ("bottom shelf", "on the tall shelf"),
        ("sofa", "on the chair 1"),
        ("table", "on Plate_57"),
    ],
)
def test_what_feedback_names_is_something_else(furniture: str, support: str) -> None:
    assert not named(furniture, support)


def known(
    cup: Vec3, rests: str = "on the table", plate: Vec3 = Vec3(0.0, 0.0, 0.8), hand: str = ""
) -> Memory:
    """The cup was put somewhere by the plate; the glass stands a metre to the left of the plate."""
    glass = Vec3(0.0, 1.0, 0.85)
    return Memory(
        hand=hand,
        began=VIEWER,
        jobs=[Job(0, "Cup_45")],
        fits={("place", 0): {"Plate_57": 1.0}, ("second", 0): {"Glass_37": 1.0}},
        things={
            "Cup_45": thing_of("Cup_45", cup, 2050.0),
            "Plate_57": thing_of("Plate_57", plate, 1875.0),
            "Glass_37": thing_of("Glass_37", glass, 1430.0),
        },
        rests={"Cup_45": rests, "Plate_57": "on the table", "Glass_37": "on the table"},
        came_from={"Cup_45": Vec3(0.5, 0.5, 0.85)},
    )


def said(goal: Goal, memory: Memory) -> str | None:
    return claim(goal, 0, "Cup_45", memory, ROOM)


def goal(relation: Relation, **more: object) -> Goal:
    anchored = replace(Goal(CUP, relation), anchor=PLATE, second=PLATE)
    return replace(anchored, **more)  # type: ignore[arg-type]


FLOOR = "on the floor"
CLAIMS = [
    (goal(Relation.NEAR), known(Vec3(0.2, 0.0, 0.85)),
     "Cup_45 rests on the table, 0.20 m from Plate_57"),
    (goal(Relation.FAR), known(Vec3(1.5, 0.0, 0.85)),
     "Cup_45 rests on the table, 1.50 m from Plate_57"),
    (goal(Relation.FAR, distance_m=0.3), known(Vec3(0.4, 0.0, 0.85)),
     "Cup_45 rests on the table, 0.40 m from Plate_57"),
    (goal(Relation.BETWEEN), known(Vec3(0.0, 0.5, 0.85)),
     "Cup_45 rests on the table, between Plate_57 and Glass_37"),
    (goal(Relation.LEFT), known(Vec3(0.0, 0.3, 0.85)),
     "Cup_45 rests on the table, to the left of Plate_57 as seen from where I was told, "
     "0.30 m from it"),
    (goal(Relation.RIGHT), known(Vec3(0.0, -0.3, 0.85)),
     "Cup_45 rests on the table, to the right of Plate_57 as seen from where I was told, "
     "0.30 m from it"),
    (goal(Relation.FRONT), known(Vec3(-0.3, 0.0, 0.85)),
     "Cup_45 rests on the table, in front of Plate_57 as seen from where I was told, "
     "0.30 m from it"),
    (goal(Relation.BEHIND), known(Vec3(0.3, 0.0, 0.85)),
     "Cup_45 rests on the table, behind Plate_57 as seen from where I was told, 0.30 m from it"),
    (Goal(CUP, Relation.FLOOR), known(Vec3(1, 1, 0.07), FLOOR), "Cup_45 rests on the floor"),
    (Goal(CUP, Relation.CORNER), known(Vec3(2.5, 2.5, 0.07), FLOOR),
     "Cup_45 rests on the floor, in a corner of the room"),
    (Goal(CUP, Relation.UNDER, furniture="table"), known(Vec3(0.05, 0.0, 0.07), FLOOR),
     "Cup_45 rests on the floor, below Plate_57, under what these stand on"),
    (Goal(CUP, Relation.SURFACE, furniture="table"), known(Vec3(0.2, 0.0, 0.85)),
     "Cup_45 rests on the table"),
    (Goal(CUP, Relation.HOME), known(Vec3(0.51, 0.5, 0.85)),
     "Cup_45 rests on the table, 1 cm from where it was before"),
    (Goal(CUP, Relation.SHIFT, distance_m=0.2, direction="left"), known(Vec3(0.45, 0.7, 0.85)),
     "Cup_45 rests on the table, 21 cm to the left as seen from where I was told"),
    (Goal(CUP, Relation.HOLD), known(Vec3(0, 0, 1), hand="Cup_45"), "I hold Cup_45"),
]  # fmt: skip

NO_CLAIMS = {
    "not near enough": (goal(Relation.NEAR), known(Vec3(0.31, 0.0, 0.85))),
    "at the very limit, as places are rounded": (goal(Relation.NEAR), known(Vec3(0.3, 0.0, 0.85))),
    "near, but on the floor": (goal(Relation.NEAR), known(Vec3(0.2, 0.0, 0.07), FLOOR)),
    "not far": (goal(Relation.FAR), known(Vec3(0.9, 0.0, 0.85))),
    "beyond the second": (goal(Relation.BETWEEN), known(Vec3(0.0, 1.2, 0.85))),
    "aside of the line": (goal(Relation.BETWEEN), known(Vec3(0.4, 0.5, 0.85))),
    "on the other side": (goal(Relation.LEFT), known(Vec3(0.0, -0.3, 0.85))),
    "too far to the left": (goal(Relation.LEFT), known(Vec3(0.0, 0.8, 0.85))),
    "on the table, not the floor": (Goal(CUP, Relation.FLOOR), known(Vec3(1, 1, 0.85))),
    "outside the corner": (Goal(CUP, Relation.CORNER), known(Vec3(1.9, 2.5, 0.07), FLOOR)),
    "in the corner, not on the floor": (Goal(CUP, Relation.CORNER), known(Vec3(2.5, 2.5, 0.8))),
    "under nothing": (
        Goal(CUP, Relation.UNDER, furniture="table"), known(Vec3(2.0, 0.0, 0.07), FLOOR)),
    "other furniture": (
        Goal(CUP, Relation.SURFACE, furniture="table"), known(Vec3(0, 0, 1), "on the sideboard")),
    "not quite back": (Goal(CUP, Relation.HOME), known(Vec3(0.56, 0.5, 0.85))),
    "back, but on the floor": (Goal(CUP, Relation.HOME), known(Vec3(0.5, 0.5, 0.07), FLOOR)),
    "shifted the wrong way": (
        Goal(CUP, Relation.SHIFT, distance_m=0.2, direction="right"), known(Vec3(0.45, 0.7, 0.85))),
    "no edge was found": (Goal(CUP, Relation.EDGE), known(Vec3(0.2, 0.0, 0.85))),
    "another thing is held": (Goal(CUP, Relation.HOLD), known(Vec3(0, 0, 1), hand="Plate_57")),
    "still in the hand": (goal(Relation.NEAR), known(Vec3(0.2, 0.0, 0.85), hand="Cup_45")),
}  # fmt: skip


@pytest.mark.parametrize(
    ("wish", "memory", "words"), CLAIMS, ids=lambda v: str(getattr(v, "relation", ""))
)
def test_what_holds_is_claimed_with_what_was_measured(
    wish: Goal, memory: Memory, words: str
) -> None:
    assert said(wish, memory) == words


@pytest.mark.parametrize("why", NO_CLAIMS)
def test_what_does_not_hold_is_not_claimed(why: str) -> None:
    assert said(*NO_CLAIMS[why]) is None


@pytest.mark.parametrize("wish", [wish for wish, _, _ in CLAIMS], ids=lambda w: str(w.relation))
def test_without_feedback_nothing_is_claimed(wish: Goal) -> None:
    memory = known(Vec3(0.2, 0.0, 0.85))
    memory.rests.clear()
    memory.hand = ""
    assert said(wish, memory) is None


@pytest.mark.parametrize("relation", [Relation.NEAR, Relation.FAR, Relation.BETWEEN, *SIDES])
def test_without_the_other_thing_nothing_is_claimed(relation: Relation) -> None:
    memory = known(Vec3(0.2, 0.0, 0.85))
    memory.fits.clear()
    assert said(goal(relation), memory) is None


def test_things_rest_on_the_same_surface_as_feedback_names_it() -> None:
    memory = known(Vec3(0.2, 0.0, 0.85), "on the sideboard")
    cup, plate = memory.things["Cup_45"], memory.things["Plate_57"]
    assert not same_surface(cup, plate, memory)
    memory.rests["Plate_57"] = "on the sideboard"
    assert same_surface(cup, plate, memory)
    memory.rests.pop("Plate_57")
    assert same_surface(cup, plate, memory)


# --- sides, as the viewer sees them ---------------------------------------------------------

metres = st.floats(-4, 4)
angles = st.floats(-math.pi, math.pi)
distances = st.floats(0.05, 0.5)
DIRECTION = {"left": Relation.LEFT, "right": Relation.RIGHT, "back": Relation.FRONT,
             "front": Relation.BEHIND}  # fmt: skip


@given(metres, metres, metres, metres, angles)
def test_away_and_right_are_square_and_of_length_one(
    x: float, y: float, vx: float, vy: float, heading: float
) -> None:
    away, right = axes(Vec3(x, y, 0.8), Stand(Vec3(vx, vy, 0.0), heading))
    assert math.hypot(*away) == pytest.approx(1.0)
    assert away[0] * right[0] + away[1] * right[1] == pytest.approx(0.0, abs=1e-9)
    # To the right is clockwise as seen from above.
    assert away[0] * right[1] - away[1] * right[0] == pytest.approx(-1.0)


@pytest.mark.parametrize("direction", DIRECTION)
@given(x=metres, y=metres, vx=metres, vy=metres, heading=angles, distance_m=distances)
def test_what_is_shifted_is_on_that_side(
    direction: str, x: float, y: float, vx: float, vy: float, heading: float, distance_m: float
) -> None:
    viewer, place = Stand(Vec3(vx, vy, 0.0), heading), Vec3(x, y, 0.8)
    there = shifted(place, direction, distance_m, viewer)
    assert there.distance(place) == pytest.approx(distance_m)
    memory = Memory(began=viewer)
    one, other = thing_of("Cup_45", there, 2050.0), thing_of("Plate_57", place, 1875.0)
    assert side_of(one, other, memory) is DIRECTION[direction]
