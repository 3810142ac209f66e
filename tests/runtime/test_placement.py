"""Free spots are free, carried, and the nearest ones come first."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from adamo_vh.engine import WorldSurface
from adamo_vh.geometry import Solid, Vec3, gaps
from adamo_vh.runtime.placement import CLEARANCE_M, MAX_CORRECTION_M, free_spots, spread

TABLE = WorldSurface("table", Vec3(0, 0, 0.78), 0.5, 0.8, 0.0)
FLOOR = WorldSurface("floor", Vec3(0, 0, 0.0), 3.0, 3.0, 0.0)
TOP = Solid(0, 0, 0.5, 0.8, 0.0, 0.74, 0.78)
angles = st.floats(-math.pi, math.pi)


def cup(x: float, y: float, yaw: float, z: float = 0.78) -> Solid:
    return Solid(x, y, 0.07, 0.05, yaw, z, z + 0.13)


neighbours = st.lists(
    st.builds(cup, st.floats(-0.4, 0.4), st.floats(-0.7, 0.7), angles), max_size=12
)


@given(st.floats(-0.6, 0.6), st.floats(-0.9, 0.9), angles, neighbours)
def test_spots_are_clear_of_everything(x: float, y: float, yaw: float, beside: list[Solid]) -> None:
    shape = cup(0, 0, yaw)
    spots = free_spots(Vec3(x, y, 0.78), shape, [TABLE, FLOOR], [TOP, *beside])
    distances = [spot.distance_m for spot in spots]
    assert distances == sorted(distances)
    assert all(d <= MAX_CORRECTION_M for d in distances)
    for spot in list(spread(spots))[:10]:
        put = replace(
            shape,
            x=spot.center.x,
            y=spot.center.y,
            z_min=spot.center.z - 0.065,
            z_max=spot.center.z - 0.065 + shape.z_max - shape.z_min,
        )
        near = [s for s in beside if s.overlaps_height(put.z_min, put.z_max)]
        at = np.array([[put.x, put.y]])
        assert gaps(at, put, near)[0] >= CLEARANCE_M - 1e-9
        if spot.support == "table":
            assert abs(put.x) <= 0.5
            assert abs(put.y) <= 0.8


def test_a_free_point_is_its_own_spot() -> None:
    first = free_spots(Vec3(0.1, 0.2, 0.78), cup(0, 0, 0), [TABLE], [TOP])[0]
    assert first.support == "table"
    assert first.distance_m == 0
    assert first.center.distance(Vec3(0.1, 0.2, 0.78 + 0.065)) < 1e-9


def test_a_point_on_another_thing_goes_beside_it() -> None:
    spots = free_spots(Vec3(0, 0, 0.78), cup(0, 0, 0), [TABLE], [TOP, cup(0, 0, 0)])
    assert 0.1 < spots[0].distance_m < 0.2


@pytest.mark.parametrize("sunk_m", [0.0, 0.0003, 0.0008])
def test_the_thinnest_thing_is_in_the_way_too(sunk_m: float) -> None:
    key = Solid(0, 0, 0.0275, 0.012, 0, 0.78 - sunk_m, 0.782 - sunk_m)
    spots = free_spots(Vec3(0, 0, 0.78), cup(0, 0, 0), [TABLE], [TOP, key])
    at = np.array([[spots[0].center.x, spots[0].center.y]])
    assert gaps(at, cup(0, 0, 0), [key])[0] >= CLEARANCE_M - 1e-9


def test_a_point_high_in_the_air_has_no_spot() -> None:
    assert free_spots(Vec3(0, 0, 2.0), cup(0, 0, 0), [TABLE, FLOOR], [TOP]) == []


def test_below_the_table_there_is_floor() -> None:
    spots = free_spots(Vec3(0, 0, 0.0), cup(0, 0, 0), [TABLE, FLOOR], [TOP])
    assert spots[0].support == "floor"


def test_what_is_too_tall_does_not_fit_below() -> None:
    tall = Solid(0, 0, 0.05, 0.05, 0, 0, 0.9)
    spots = free_spots(Vec3(0, 0, 0.0), tall, [FLOOR], [TOP])
    assert all(abs(s.center.x) > 0.5 or abs(s.center.y) > 0.8 for s in spots)


@given(st.floats(-1, 1), st.floats(-1, 1), angles, angles)
def test_gaps_are_lower_bounds_of_the_distance(x: float, y: float, a: float, b: float) -> None:
    one, other = cup(0, 0, a), cup(x, y, b)
    gap = gaps(np.array([[0.0, 0.0]]), one, [other])[0]
    cos, sin = math.cos(b), math.sin(b)
    grid = np.stack(np.meshgrid(np.linspace(-0.07, 0.07, 15), np.linspace(-0.05, 0.05, 15)), -1)
    inside = grid.reshape(-1, 2) @ np.array([[cos, sin], [-sin, cos]]) + [x, y]
    assert one.distance(inside).min() >= gap - 1e-9
