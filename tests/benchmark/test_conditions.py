"""What joins conditions, how they count, and the conditions that need the start or the history."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st
from tests.tabletop import TABLE, changed, held, resting, tabletop

from adamo_vh.benchmark.checkers import score
from adamo_vh.benchmark.conditions import (
    And,
    Beside,
    Condition,
    Holds,
    InArea,
    Near,
    Not,
    NothingElseMoved,
    On,
    Once,
    OnFloor,
    Or,
    Ordered,
    Stays,
    holds,
    needs_history,
    verdicts,
)
from adamo_vh.benchmark.tasks import task
from adamo_vh.benchmark.tasks.task import Task
from adamo_vh.engine import WorldState, object_support

START = tabletop()


def asking(*conditions: Condition) -> Task:
    return replace(task("T4"), id="OWN", conditions=conditions)


def floored(state: WorldState, *objects: int) -> WorldState:
    for number in objects:
        state = resting(state, number, -1.5, number * 0.05 - 2.0)
    return state


def fraction(final: WorldState, *conditions: Condition, between: list[WorldState] = []) -> float:  # noqa: B006
    return score(START, final, asking(*conditions), between).completion


# --- furniture and sides ----------------------------------------------------------------------


@pytest.mark.parametrize(
    ("support", "surface", "so"),
    [
        ("tall shelf/top", "tall shelf", True),
        ("tall shelf/top", "tall shelf/top", True),
        ("tall shelf/lower", "tall shelf/top", False),
        ("tall shelf 2/top", "tall shelf", False),
        ("table", "table", True),
        ("floor", "table", False),
        (object_support(50), "table", False),
        (None, "table", False),
    ],
)
def test_on_means_a_piece_or_a_level(support: str | None, surface: str, so: bool) -> None:
    state = changed(START, replace(START.object(57), support=support))
    assert On(57, surface).satisfied(state) is so
    assert not On(57, surface).satisfied(changed(state, replace(state.object(57), held=True)))


def beside_tape(aside_m: float, ahead_m: float) -> WorldState:
    """The cup beside the tape, as seen from the start of the body."""
    tape, body = START.object(4).box.center, START.body.position
    angle = math.atan2(tape.y - body.y, tape.x - body.x)
    x = tape.x + ahead_m * math.cos(angle) - aside_m * math.sin(angle)
    y = tape.y + ahead_m * math.sin(angle) + aside_m * math.cos(angle)
    return resting(START, 45, x, y, TABLE)


@given(st.floats(-0.7, 0.7), st.floats(-0.7, 0.7))
def test_left_and_right_are_seen_from_the_start(aside: float, ahead: float) -> None:
    state = beside_tape(aside, ahead)
    is_beside = abs(aside) > abs(ahead) and abs(aside) >= 0.03 and math.hypot(aside, ahead) <= 0.6
    margin = min(abs(abs(aside) - abs(ahead)), abs(abs(aside) - 0.03))
    if min(margin, abs(math.hypot(aside, ahead) - 0.6)) < 1e-6:
        return
    assert Beside(45, 4, "left").satisfied(state, (START,)) is (is_beside and aside > 0)
    assert Beside(45, 4, "right").satisfied(state, (START,)) is (is_beside and aside < 0)


def test_sides_stay_as_they_were_seen_when_the_body_walks_round() -> None:
    state = beside_tape(0.2, 0.0)
    behind = replace(state, body=replace(state.body, position=START.body.position * -1.0))
    assert Beside(45, 4, "left").satisfied(behind, (START,))
    assert not Beside(45, 4, "left").satisfied(behind)  # From there, it would be the other side.


def test_sides_need_the_same_surface_and_both_released() -> None:
    state = beside_tape(0.2, 0.0)
    assert not Beside(45, 4, "left").satisfied(held(state, 4), (START,))
    on_floor = changed(state, replace(state.object(45), support="floor"))
    assert not Beside(45, 4, "left").satisfied(on_floor, (START,))


# --- limits -----------------------------------------------------------------------------------


def test_what_stays_counts_only_with_the_rest() -> None:
    conditions = (OnFloor(57), OnFloor(45), NothingElseMoved((45, 57)))
    assert fraction(START, *conditions) == 0.0
    assert fraction(floored(START, 57), *conditions) == pytest.approx(1 / 3)
    assert fraction(floored(START, 57, 45), *conditions) == 1.0
    assert fraction(floored(START, 57, 45, 34), *conditions) == pytest.approx(2 / 3)


def test_a_limit_that_is_broken_is_not_strict_and_not_complete() -> None:
    own = asking(OnFloor(57), Not(InArea(57)))
    inside = score(START, resting(START, 57, 2.5, 2.5), own)
    assert (inside.completion, inside.strict) == (0.5, 0.0)
    assert score(START, resting(START, 57, -1.5, 0.0), own).strict == 1.0
    assert score(START, START, own).completion == 0.0


def test_a_not_that_is_open_at_the_start_is_a_goal_like_any_other() -> None:
    conditions = (Not(On(57, TABLE)), OnFloor(45))
    assert fraction(floored(START, 57), *conditions) == 0.5
    assert fraction(held(START, 57), *conditions) == 0.5
    assert fraction(START, *conditions) == 0.0


@pytest.mark.parametrize(
    ("final", "so"),
    [
        (START, True),
        (resting(START, 34, -0.174, -1.59, TABLE), True),
        (resting(START, 34, -0.174, -1.50, TABLE), False),
        (held(START, 34), False),
        (floored(START, 34), False),
    ],
)
def test_stays_means_the_same_place(final: WorldState, so: bool) -> None:
    assert Stays(34).satisfied(final, (START,)) is so
    assert NothingElseMoved((57,)).satisfied(final, (START,)) is so
    assert NothingElseMoved((34,)).satisfied(final, (START,))


# --- and, or ----------------------------------------------------------------------------------


def test_an_or_counts_as_one_and_an_and_as_its_parts() -> None:
    either = Or((OnFloor(57), Near(57, 50)))
    assert fraction(START, either) == 0.0
    assert fraction(floored(START, 57), either) == 1.0
    both = And((OnFloor(57), And((OnFloor(45), OnFloor(37)))))
    assert fraction(floored(START, 57), both) == pytest.approx(1 / 3)
    texts = [text for text, _ in verdicts((both, either), START)]
    assert texts == ["57 on floor", "45 on floor", "37 on floor", "57 on floor or 57 near 50"]


def test_an_and_in_an_or_is_met_as_a_whole() -> None:
    either = Or((And((OnFloor(57), OnFloor(45))), Holds(34)))
    assert fraction(floored(START, 57), either) == 0.0
    assert fraction(floored(START, 57, 45), either) == 1.0
    assert str(either) == "(57 on floor and 45 on floor) or holds 34"


def test_what_was_taken_out_of_the_room_meets_nothing() -> None:
    final = floored(START, 57)
    final = replace(final, objects=tuple(o for o in final.objects if o.id != 57))
    assert fraction(final, OnFloor(57)) == 0.0
    assert fraction(final, Or((OnFloor(57), OnFloor(45)))) == 0.0
    assert fraction(floored(final, 45), Or((OnFloor(57), OnFloor(45)))) == 1.0
    assert holds(Not(OnFloor(57)), final, (START,))


# --- order ------------------------------------------------------------------------------------


def test_steps_in_order_all_count() -> None:
    first, last = floored(START, 57), floored(START, 57, 45)
    steps = Ordered((OnFloor(57), OnFloor(45)))
    assert fraction(last, steps, between=[first, last]) == 1.0
    assert fraction(first, steps, between=[first]) == 0.5


def test_a_step_that_came_too_early_does_not_count_until_it_is_done_again() -> None:
    steps = Ordered((OnFloor(57), OnFloor(45)))
    early, both = floored(START, 45), floored(START, 45, 57)
    assert fraction(both, steps, between=[early, both]) == 0.5
    lifted = held(both, 45)
    assert fraction(both, steps, between=[early, both, lifted, both]) == 1.0


def test_a_step_that_was_undone_takes_those_after_it_along() -> None:
    steps = Ordered((OnFloor(57), OnFloor(45)))
    first, both = floored(START, 57), floored(START, 57, 45)
    undone = held(both, 57)
    assert fraction(undone, steps, between=[first, both, undone]) == 0.0


def test_once_needs_not_last() -> None:
    steps = Ordered((Once(Holds(45)), OnFloor(57)))
    lifted, back = held(START, 45), floored(START, 57)
    assert fraction(back, steps, between=[lifted, START, back]) == 1.0
    assert fraction(back, steps, between=[back]) == 0.0
    assert not Once(On(57, TABLE)).satisfied(START)  # The start itself is no achievement.


def test_steps_are_told_one_by_one() -> None:
    found = verdicts((Ordered((OnFloor(57), Or((OnFloor(45), Holds(45))))),), START)
    assert [text for text, _ in found] == ["first 57 on floor", "then (45 on floor or holds 45)"]


@pytest.mark.parametrize(
    ("condition", "needs"),
    [
        (OnFloor(57), False),
        (Beside(45, 4, "left"), False),
        (Not(And((OnFloor(57), Once(Holds(57))))), True),
        (Or((Ordered((Holds(57), OnFloor(57))), OnFloor(45))), True),
        (And((Stays(57), NothingElseMoved(()))), False),
    ],
)
def test_only_order_needs_the_history(condition: Condition, needs: bool) -> None:
    assert needs_history(condition) is needs
    assert asking(condition).needs_history is needs


# --- what a task is about ---------------------------------------------------------------------


def test_a_task_knows_what_it_is_about() -> None:
    own = asking(
        Ordered((Beside(45, 4, "left"), Or((On(8, "table"), InArea(8, "rug"))))),
        Not(Near(45, 57)),
        NothingElseMoved((8, 45)),
        Stays(34),
    )
    assert own.targets == {45, 8}
    assert own.objects == {45, 4, 8, 57, 34}
    assert own.areas == {"rug"}
    assert own.surfaces == {"table"}
