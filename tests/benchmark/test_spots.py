"""The oracle's spots: free, on the surface, inside the room."""

from __future__ import annotations

import itertools
from dataclasses import replace

import numpy as np
import pytest

from adamo_vh.benchmark.conditions import NEAR_M
from adamo_vh.benchmark.spots import floor_spots, near_spots, surface_spots
from adamo_vh.engine import WorldState, WorldSurface
from adamo_vh.geometry import Solid, Vec3, gaps
from adamo_vh.runtime.builtin import BuiltinEngine

SCENES = ("s1", "s2")


@pytest.fixture(scope="module")
def states() -> dict[str, WorldState]:
    found = {}
    for scene in SCENES:
        engine = BuiltinEngine(scene)
        found[scene] = engine.state()
        engine.close()
    return found


def surface_of(state: WorldState, support: str | None) -> WorldSurface | None:
    known = (s for piece in state.furniture for s in piece.surfaces if s.support == support)
    return next(known, None)


def is_on(surface: WorldSurface, point: Vec3) -> bool:
    """Whether a point is above a surface, in plan."""
    offset = np.array([point.x - surface.center.x, point.y - surface.center.y])
    cos, sin = np.cos(surface.yaw_rad), np.sin(surface.yaw_rad)
    along = np.abs(np.array([[cos, sin], [-sin, cos]]) @ offset)
    return bool((along <= [surface.half_x, surface.half_y]).all())


@pytest.mark.parametrize("scene", SCENES)
def test_the_first_spot_near_an_anchor_is_on_its_surface(
    scene: str, states: dict[str, WorldState]
) -> None:
    state, tried = states[scene], 0
    for item, anchor in itertools.islice(itertools.permutations(state.objects, 2), None, None, 3):
        surface = surface_of(state, anchor.support)
        spots = near_spots(state, item, anchor)
        if surface is None or not spots:
            continue
        margin = item.box.radius_m
        inner = replace(surface, half_x=surface.half_x - margin, half_y=surface.half_y - margin)
        if not any(is_on(inner, spot) for spot in spots):
            continue  # It cannot lie there without standing out beyond the edge.
        assert is_on(surface, spots[0]), (item.class_name, anchor.class_name)
        assert spots[0].horizontal_distance(anchor.box.center) < NEAR_M
        tried += 1
    assert tried > 30


def test_without_furniture_in_the_state_there_are_spots_all_the_same(
    states: dict[str, WorldState],
) -> None:
    state = replace(states["s1"], furniture=())
    assert near_spots(state, state.object(21), state.object(5))


@pytest.mark.parametrize("scene", SCENES)
def test_spots_on_furniture_and_floor_are_free(scene: str, states: dict[str, WorldState]) -> None:
    state = states[scene]
    engine = BuiltinEngine(scene)
    item = state.object(34)
    others = [Solid.around(o.box) for o in state.objects if o.id != item.id]
    surfaces = [s for piece in state.furniture for s in piece.surfaces]
    assert surfaces
    for surface in surfaces:
        for spot in surface_spots(state, item, surface)[:5]:
            assert is_on(surface, spot)
            level = [s for s in others if s.overlaps_height(spot.z - 0.01, spot.z + 0.02)]
            at = np.array([[spot.x, spot.y]])
            assert not level or gaps(at, Solid.around(item.box), level)[0] > 0
    for spot in floor_spots(state, item, (), engine.body.info)[:5]:
        assert spot.z == 0.0
        assert state.scene.is_within_walls(spot, -0.05)
    engine.close()
