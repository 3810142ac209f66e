"""The least number of calls to done, planned on states alone."""

from __future__ import annotations

import pytest
from tests.tabletop import carried_out, tabletop

from adamo_vh.action import Drop, Pick
from adamo_vh.benchmark.conditions import Holds, Near, OnFloor
from adamo_vh.benchmark.distance import calls_left
from adamo_vh.benchmark.tasks import TASKS

WORLD = tabletop()
ALL = frozenset(item.id for item in WORLD.objects)


@pytest.mark.parametrize("task", TASKS, ids=lambda task: task.id)
def test_each_condition_takes_a_pick_and_a_drop(task) -> None:
    least = sum(1 if isinstance(c, Holds) else 2 for c in task.conditions)
    assert calls_left(task.conditions, WORLD, ALL) == least


def test_what_was_not_seen_takes_a_look() -> None:
    assert calls_left([OnFloor(57)], WORLD, ALL - {57}) == 3


def test_each_call_on_the_way_brings_it_one_closer() -> None:
    goals, world, curve = [OnFloor(37), OnFloor(57)], WORLD, []
    for action in (Pick("37"), Drop("37", 1.5, -1.0, 0.0), Pick("57"), Drop("57", 1.5, 0.0, 0.0)):
        curve.append(calls_left(goals, world, ALL))
        world = carried_out(world, action)
    assert [*curve, calls_left(goals, world, ALL)] == [4, 3, 2, 1, 0]


def test_what_else_is_in_the_hand_is_put_down_first() -> None:
    world = carried_out(WORLD, Pick("36"))
    assert calls_left([OnFloor(57)], world, ALL) == 3
    assert calls_left([Near(4, 50)], carried_out(WORLD, Pick("50")), ALL) == 3


def test_what_is_to_stay_in_the_hand_is_taken_again() -> None:
    world = carried_out(WORLD, Pick("34"))
    assert calls_left([Holds(34)], world, ALL) == 0
    assert calls_left([Holds(34), OnFloor(57)], world, ALL) == 4
