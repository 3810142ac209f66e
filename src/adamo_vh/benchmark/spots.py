"""Free spots for the oracle to put things: candidates from the world's state, best first.

The state knows little of the furniture, so a candidate is a good guess that the engine may still
correct. Each function takes the object to be put down, which keeps the turn that it has now.
"""

from __future__ import annotations

import math
from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray

from adamo_vh.engine import BodyInfo, ObjectState, WorldState, WorldSurface
from adamo_vh.geometry import Array, Solid, Vec3, gaps

_WITHIN_REACH_M = 0.05
"""So much less than the arm's reach, so that the body need not walk."""
FREE_M = 0.015
"""A gap to the neighbours beyond which more is no better."""
NEAR_MAX_M = 0.26
"""Centre distance to aim at for "near": some room below its limit of 0.30 for corrections."""
_INWARD_WEIGHT = 0.8
"""Straight out to the other side weighs a little less than straight over the edge."""
_FLOOR_GAP_M = 0.05
_WALL_GAP_M = 0.10
_NO_DIRECTION_M = 0.02
_EDGE_M = 0.02
_STEP_M = 0.06


def near_spots(
    state: WorldState, item: ObjectState, anchor: ObjectState, most_m: float = NEAR_MAX_M
) -> list[Vec3]:
    """Spots on the anchor's surface, close to it.

    Free ones come first; among these, spots beside the anchor as the body sees it, which are as
    far from the edge and from the body as the anchor is, and spots towards the other objects of
    the surface, which are surely not beyond its edge; then the closest.

    Args:
        state: The world now.
        item: The object to be put down.
        anchor: What it is to be put near.
        most_m: Greatest distance between their centres.
    """
    angles, distances = _polar(np.arange(0.0, 360.0, 5.0), np.linspace(0.04, most_m, 12))
    center, surface_z = _plan(anchor.box.center), anchor.box.bottom_z
    directions = np.stack([np.cos(angles), np.sin(angles)], axis=1)
    points = center + directions * distances[:, None]
    apart = _gaps(points, state, item, surface_z)
    others = [_plan(o.box.center) for o in state.objects if o.support == anchor.support]
    facing = np.abs(directions @ _unit(_plan(state.body.position) - center))
    inward = directions @ _unit(np.mean(others, axis=0) - center)
    risk = np.round(4 * (facing - _INWARD_WEIGHT * inward))
    carried = _carried(points, state, item, anchor.support)
    order = np.lexsort((distances, risk, -np.minimum(apart, FREE_M), ~carried))
    return [_point(points[i], surface_z) for i in order if apart[i] > 0]


def _carried(
    points: Array, state: WorldState, item: ObjectState, support: str | None
) -> NDArray[np.bool_]:
    """Which points (N, 2) have all of the item on a surface; (N,) bool.

    All have, if the state does not tell the surface.
    """
    surfaces = (s for piece in state.furniture for s in piece.surfaces if s.support == support)
    if (surface := next(surfaces, None)) is None:
        return np.ones(len(points), np.bool_)
    corners = item.box.corners()[:, :2] - _plan(item.box.center)
    cos, sin = math.cos(surface.yaw_rad), math.sin(surface.yaw_rad)
    local = points[:, None, :] + corners - _plan(surface.center)
    local = local @ np.array([[cos, -sin], [sin, cos]])
    halves = np.array([surface.half_x, surface.half_y])
    return np.asarray((np.abs(local) <= halves).all(axis=(1, 2)))


def floor_spots(
    state: WorldState, item: ObjectState, visited: Iterable[Vec3], body: BodyInfo
) -> list[Vec3]:
    """Spots on open floor within reach: behind the body, away from the furniture that it faces.

    Args:
        state: The world now.
        item: The object to be put down.
        visited: Places where the body has stood, so surely open floor; they come last, because
            the body may have to walk to them.
        body: How large the body is and how far it reaches.
    """
    clear_m = body.radius_m + item.box.radius_m + _WALL_GAP_M
    turns, distances = _polar(
        np.arange(0.0, 121.0, 15.0), np.arange(clear_m, body.reach_m - _WITHIN_REACH_M, 0.08)
    )
    turns, distances = np.concatenate([turns, -turns]), np.tile(distances, 2)
    angles = state.body.heading_rad + math.pi + turns
    here = _plan(state.body.position)
    behind = here + np.stack([np.cos(angles), np.sin(angles)], axis=1) * distances[:, None]
    behind = behind[np.lexsort((distances, np.abs(turns)))]
    places = [_plan(p) for p in visited if p.horizontal_distance(state.body.position) > clear_m]
    points = np.concatenate([behind, np.reshape(places, (-1, 2))])
    free = _gaps(points, state, item, 0.0) > _FLOOR_GAP_M
    return [_point(p, 0.0) for p in points[free & _inside(points, state, item)]]


def area_spots(state: WorldState, item: ObjectState, kind: str) -> list[Vec3]:
    """Spots in the floor areas of a kind: the nearest area first, from its centre outwards."""
    here, spots = _plan(state.body.position), []
    middles = {
        a: np.array([(a.x_min + a.x_max) / 2, (a.y_min + a.y_max) / 2])
        for a in state.scene.areas
        if a.kind == kind
    }
    for area, middle in sorted(
        middles.items(), key=lambda pair: float(np.hypot(*(pair[1] - here)))
    ):
        steps = np.linspace(-0.4, 0.4, 5)
        half = np.array([area.x_max - area.x_min, area.y_max - area.y_min])
        grid = np.array([(x, y) for x in steps for y in steps])
        points = middle + grid[np.argsort(np.hypot(*grid.T), kind="stable")] * half
        free = _gaps(points, state, item, 0.0) > _FLOOR_GAP_M
        spots += [_point(p, 0.0) for p in points[free & _inside(points, state, item)]]
    return spots


def surface_spots(state: WorldState, item: ObjectState, surface: WorldSurface) -> list[Vec3]:
    """Spots on a piece of furniture: free ones first, then those nearest to the body."""
    margin = item.box.radius_m + _EDGE_M
    sides = (max(half - margin, 0.0) for half in (surface.half_x, surface.half_y))
    steps = [np.linspace(-side, side, 2 + int(side / _STEP_M)) for side in sides]
    grid = np.stack(np.meshgrid(*steps, indexing="ij"), axis=-1).reshape(-1, 2)
    cos, sin = math.cos(surface.yaw_rad), math.sin(surface.yaw_rad)
    points = _plan(surface.center) + grid @ np.array([[cos, sin], [-sin, cos]])
    apart = _gaps(points, state, item, surface.center.z)
    distances = np.hypot(*(points - _plan(state.body.position)).T)
    order = np.lexsort((distances, -np.minimum(apart, FREE_M)))
    return [_point(points[i], surface.center.z) for i in order if apart[i] > 0]


def _gaps(points: Array, state: WorldState, item: ObjectState, surface_z: float) -> Array:
    """Free distance (N,) in metres around the item with its centre at each point (N, 2).

    Separating axes of both headings: positive values are lower bounds, negative ones overlap.
    """
    top_z = surface_z + item.box.top_z - item.box.bottom_z
    beside = [
        Solid.around(other.box)
        for other in state.objects
        if other.id != item.id
        and not other.held
        and other.box.bottom_z <= top_z
        and other.box.top_z >= surface_z
    ]
    return gaps(points, Solid.around(item.box), beside)


def _inside(points: Array, state: WorldState, item: ObjectState) -> NDArray[np.bool_]:
    """Which points (N, 2) keep the item off the walls; (N,) bool."""
    scene, margin = state.scene, item.box.radius_m + _WALL_GAP_M
    low = np.array([scene.x_min, scene.y_min]) + margin
    high = np.array([scene.x_max, scene.y_max]) - margin
    return np.asarray(((points >= low) & (points <= high)).all(axis=1))


def _polar(degrees: Array, distances_m: Array) -> tuple[Array, Array]:
    """All pairs of angle (radians) and distance, each (N,)."""
    angles, distances = np.meshgrid(np.radians(degrees), distances_m, indexing="ij")
    return angles.ravel(), distances.ravel()


def _unit(vector: Array) -> Array:
    """The vector (2,) at length 1; zero if it is too short to have a direction."""
    length = float(np.hypot(*vector))
    return vector / length if length > _NO_DIRECTION_M else np.zeros(2)


def _plan(point: Vec3) -> Array:
    return point.array()[:2]


def _point(plan: Array, z: float) -> Vec3:
    return Vec3(float(plan[0]), float(plan[1]), z).rounded(3)
