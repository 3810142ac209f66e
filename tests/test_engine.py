"""Facts of a world as plain data: what its hash notices, supports by name, the room's extent."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from adamo_vh.engine import (
    ObjectState,
    SceneInfo,
    WorldState,
    object_support,
    supporting_object,
)
from adamo_vh.geometry import Array, Box, Quaternion, Solid, Vec3, gaps
from adamo_vh.observation import BodyState

SCENE = SceneInfo("s", -3.0, -5.0, 3.0, 3.0, 3.2, ())
BODY = BodyState(Vec3(-2, -1, 0), 0.0, Vec3(0, -1, 0.8), Vec3(-2, -1, 1.6))
CUP = ObjectState(
    45, "Cup", Box(Vec3(0, 0, 0.8), Vec3(0.1, 0.1, 0.1), Quaternion()), "table", False
)
KEY = ObjectState(
    34, "Key", Box(Vec3(1, 0, 0.8), Vec3(0.1, 0.1, 0.1), Quaternion()), "table", False
)
STATE = WorldState(SCENE, (KEY, CUP), BODY)

metres = st.floats(-9, 9)
points = st.builds(Vec3, metres, metres, metres)
angles = st.floats(-math.pi, math.pi)


def with_cup(cup: ObjectState) -> WorldState:
    return replace(STATE, objects=(KEY, cup))


def with_box(
    center: Vec3 = CUP.box.center, orientation: Quaternion = CUP.box.orientation
) -> WorldState:
    return with_cup(replace(CUP, box=replace(CUP.box, center=center, orientation=orientation)))


OTHERWISE = {
    "an object moved": with_box(center=Vec3(0.001, 0, 0.8)),
    "an object turned": with_box(orientation=Quaternion.from_yaw(0.01)),
    "it rests on something else": with_cup(replace(CUP, support="floor")),
    "it is held": with_cup(replace(CUP, held=True)),
    "it is gone": replace(STATE, objects=(KEY,)),
    "the body moved": replace(STATE, body=replace(BODY, position=Vec3(-2, -1.001, 0))),
    "the body turned": replace(STATE, body=replace(BODY, heading_rad=0.01)),
    "the gaze moved": replace(STATE, body=replace(BODY, gaze=Vec3(0, -1, 0.9))),
    "the hand holds something": replace(STATE, body=replace(BODY, held=45)),
    "another scene": replace(STATE, scene=replace(SCENE, name="t")),
}


@pytest.mark.parametrize("what", OTHERWISE)
def test_the_hash_notices(what: str) -> None:
    assert OTHERWISE[what].hash() != STATE.hash()
    assert len({state.hash() for state in OTHERWISE.values()}) == len(OTHERWISE)


def test_the_hash_does_not_notice_what_is_no_state() -> None:
    noise = with_box(center=Vec3(0.00001, -0.00001, 0.80001))
    turned_fully = with_box(orientation=Quaternion(-1.0, -0.0, -0.0, -0.0))
    zero = with_box(center=Vec3(-0.0, -0.0, 0.8))
    assert {noise.hash(), turned_fully.hash(), zero.hash()} == {STATE.hash()}


def test_objects_are_found_by_id() -> None:
    assert STATE.object(45) is CUP
    with pytest.raises(KeyError):
        STATE.object(57)


@given(st.integers(0, 10**6))
def test_an_object_as_a_support_is_read_back(number: int) -> None:
    assert supporting_object(object_support(number)) == number


@pytest.mark.parametrize(
    "support", ["floor", "table", "shelf/top", "object", "object x", "objects 3"]
)
def test_furniture_is_no_object(support: str) -> None:
    assert supporting_object(support) is None


@given(points)
def test_the_nearest_point_of_the_room_is_in_it_and_none_is_nearer(point: Vec3) -> None:
    near = SCENE.nearest(point)
    assert SCENE.is_within_walls(near, 0.0)
    assert 0.0 <= near.z <= SCENE.height_m
    assert SCENE.nearest(near) == near
    for x in (SCENE.x_min, 0.0, SCENE.x_max):
        for y in (SCENE.y_min, 0.0, SCENE.y_max):
            for z in (0.0, 1.0, SCENE.height_m):
                assert near.distance(point) <= Vec3(x, y, z).distance(point) + 1e-9


@given(points, st.floats(-1, 1), st.floats(0, 1))
def test_a_larger_margin_lets_more_in(point: Vec3, margin_m: float, more_m: float) -> None:
    if SCENE.is_within_walls(point, margin_m):
        assert SCENE.is_within_walls(point, margin_m + more_m)


# --- boxes from above -----------------------------------------------------------------------

sizes = st.floats(0.01, 2.0)
solids = st.builds(Solid, metres, metres, sizes, sizes, angles, st.just(0.0), st.just(1.0))


def outline(solid: Solid) -> Array:
    """Points along the edges of a rectangle."""
    t = np.linspace(-1, 1, 21)
    one = np.ones_like(t)
    local = np.concatenate(
        [np.stack(side, 1) for side in ((t, one), (t, -one), (one, t), (-one, t))]
    )
    local = local * (solid.half_x, solid.half_y)
    cos, sin = math.cos(solid.yaw_rad), math.sin(solid.yaw_rad)
    return np.asarray(local @ np.array([[cos, sin], [-sin, cos]]) + (solid.x, solid.y))


@given(solids)
def test_its_own_edge_and_middle_are_at_no_distance(solid: Solid) -> None:
    inside = np.vstack([outline(solid), (solid.x, solid.y)])
    np.testing.assert_allclose(solid.distance(inside), 0.0, atol=1e-9)
    assert np.hypot(*(outline(solid) - (solid.x, solid.y)).T).max() <= solid.radius_m + 1e-9


@given(solids, metres, metres)
def test_the_distance_of_a_point_is_that_of_the_nearest_edge(s: Solid, x: float, y: float) -> None:
    told = s.distance(np.array([[x, y]]))[0]
    nearest = np.hypot(*(outline(s) - (x, y)).T).min()
    assert told <= nearest + 1e-9
    spacing = max(s.half_x, s.half_y) / 10
    assert told == 0.0 or told >= nearest - spacing


@given(solids, solids)
def test_a_gap_is_never_told_wider_than_it_is(one: Solid, other: Solid) -> None:
    (gap,) = gaps(np.array([[one.x, one.y]]), one, [other])
    (back,) = gaps(np.array([[other.x, other.y]]), other, [one])
    assert gap == pytest.approx(back, abs=1e-9)
    apart = min(other.distance(outline(one)).min(), one.distance(outline(other)).min())
    assert gap <= apart + 1e-9


def test_without_obstacles_there_is_room_everywhere() -> None:
    assert np.isinf(gaps(np.zeros((2, 2)), Solid(0, 0, 1, 1, 0, 0, 1), [])).all()


@given(points, sizes, sizes, sizes, angles)
def test_the_prism_around_an_upright_box_is_the_box(
    at: Vec3, x: float, y: float, z: float, yaw: float
) -> None:
    solid = Solid.around(Box(at, Vec3(x, y, z), Quaternion.from_yaw(yaw)))
    assert (solid.half_x, solid.half_y) == pytest.approx((x / 2, y / 2), abs=1e-9)
    assert (solid.z_min, solid.z_max) == pytest.approx((at.z - z / 2, at.z + z / 2), abs=1e-9)


@pytest.mark.parametrize(
    ("low", "high", "meets"),
    [(0.5, 2.0, True), (1.0, 2.0, False), (0.999, 2.0, False), (0.99, 2.0, True), (-1, 0.0, False)],
)
def test_things_on_top_of_each_other_do_not_meet(low: float, high: float, meets: bool) -> None:
    assert Solid(0, 0, 1, 1, 0, 0.0, 1.0).overlaps_height(low, high) is meets
