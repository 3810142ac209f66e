"""Paths keep clear of furniture and are about as short as can be."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from adamo_vh.engine import SceneInfo
from adamo_vh.geometry import Solid, Vec3
from adamo_vh.runtime.navigation import BODY_RADIUS_M, FloorMap
from adamo_vh.runtime.solids import Solids

ROOM = SceneInfo("room", -3, -5, 3, 3, 3.2, ())
TABLE = Solid(-0.05, -1.0, 0.525, 0.83, 0.0, 0.0, 0.78)
SOFA = Solid(-1.3, 1.1, 0.46, 1.32, math.radians(45), 0.0, 0.8)
FLOOR = FloorMap(ROOM, [TABLE, SOFA])
inside = st.builds(Vec3, st.floats(-2.7, 2.7), st.floats(-4.7, 2.7), st.just(0.0))


@given(inside, inside)
def test_paths_never_touch_anything(start: Vec3, target: Vec3) -> None:
    if not FLOOR.can_stand(start):
        return
    path = FLOOR.ways_from(start).to_nearest(target)
    assert path.points[0] == start
    for a, b in zip(path.points, path.points[1:], strict=False):
        line = np.linspace(a.array()[:2], b.array()[:2], 50)
        assert FLOOR.clearance(line).min() >= BODY_RADIUS_M - 0.03
    assert FLOOR.can_stand(path.end) or path.end == start
    if FLOOR.can_stand(target):
        assert path.end.horizontal_distance(target) < 0.08
    assert path.length_m >= start.horizontal_distance(path.end) - 1e-9


@given(inside, inside)
def test_a_free_line_is_walked_straight(start: Vec3, target: Vec3) -> None:
    straight = FLOOR.can_stand(start) and FLOOR.can_stand(target)
    if straight and FLOOR.line_is_free(start.array()[:2], target.array()[:2]):
        path = FLOOR.ways_from(start).to_nearest(target)
        assert path.length_m <= start.horizontal_distance(target) * 1.10 + 0.10


def test_the_way_around_the_table_is_short() -> None:
    path = FLOOR.ways_from(Vec3(-2, -1, 0)).to_nearest(Vec3(2, -1, 0))
    assert path.end.horizontal_distance(Vec3(2, -1, 0)) < 0.01
    assert 4.0 < path.length_m < 5.0


@given(inside, inside, st.floats(0.0, 1.0))
def test_what_was_walked_to_a_place_is_measured_along_the_way(
    start: Vec3, target: Vec3, part: float
) -> None:
    path = FLOOR.ways_from(start).to_nearest(target)
    left_m = path.length_m * part
    place = path.end
    for a, b in zip(path.points, path.points[1:], strict=False):
        if left_m <= a.distance(b):
            place = a + (b - a) * (left_m / a.distance(b))
            break
        left_m -= a.distance(b)
    assert path.walked_to(place) == pytest.approx(path.length_m * part, abs=1e-6)


def test_a_target_inside_furniture_ends_beside_it() -> None:
    path = FLOOR.ways_from(Vec3(-2, -1, 0)).to_nearest(Vec3(-0.05, -1.0, 0))
    gap = float(TABLE.distance(path.end.array()[None, :2])[0])
    assert BODY_RADIUS_M <= gap < BODY_RADIUS_M + 0.06


def test_standing_places_are_within_reach_but_not_on_the_target() -> None:
    target = Vec3(1.5, -3.0, 0.0)
    path = FLOOR.ways_from(Vec3(-2, -1, 0)).to_standing_place(target, 0.88, 0.4, lambda _: True)
    assert path is not None
    assert 0.4 <= path.end.horizontal_distance(target) <= 0.88


def test_there_may_be_no_standing_place() -> None:
    ways = FLOOR.ways_from(Vec3(-2, -1, 0))
    assert ways.to_standing_place(Vec3(1, 1, 0), 0.88, 0.4, lambda _: False) is None


def test_what_hangs_high_does_not_block() -> None:
    lamp = Solid(2.0, -3.0, 0.5, 0.5, 0.0, 2.0, 2.5)
    assert FloorMap(ROOM, [lamp]).can_stand(Vec3(2.0, -3.0, 0))


@pytest.mark.parametrize("yaw", [0.0, 0.5, math.pi / 4])
def test_solids_block_lines_through_them_only(yaw: float) -> None:
    solids = Solids.of([Solid(0, 0, 0.5, 0.3, yaw, 0.0, 0.8), Solid(0, 3, 0.1, 0.1, yaw, 0.0, 2.0)])
    assert solids.block(Vec3(-2, 0, 0.4), Vec3(2, 0, 0.4))
    assert not solids.block(Vec3(-2, 0, 0.9), Vec3(2, 0, 0.9))
    assert not solids.block(Vec3(-2, 0, 1.4), Vec3(0, 0, 0.81))
    assert not Solids.of([]).block(Vec3(-2, 0, 0.4), Vec3(2, 0, 0.4))
