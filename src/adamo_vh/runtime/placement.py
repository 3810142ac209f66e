"""Free spots: where an object can be put down, nearest to a wished point."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cache

import numpy as np
from numpy.typing import NDArray

from adamo_vh.engine import WorldSurface
from adamo_vh.geometry import Array, Solid, Vec3, gaps

CLEARANCE_M = 0.010
"""Gap kept from everything that stands beside the spot."""
MAX_CORRECTION_M = 0.5
"""A wished point farther than this from every free spot is refused."""
_EDGE_M = 0.005
_STEP_M = 0.02


@dataclass(frozen=True, slots=True)
class Spot:
    """A place for an object."""

    support: str
    center: Vec3
    """Where the centre of the object's box goes."""
    distance_m: float
    """From the wished point; 0 if the point lies within the object put there."""


def free_spots(
    wish: Vec3,
    shape: Solid,
    surfaces: Sequence[WorldSurface],
    obstacles: Sequence[Solid],
) -> list[Spot]:
    """All candidate spots for an object, nearest to the wished point first.

    Args:
        wish: Where the agent asked for, metres.
        shape: The object as it is held; only its extent and heading matter.
        surfaces: What can carry it.
        obstacles: Everything else, static and movable.
    """
    height = shape.z_max - shape.z_min
    centres = np.array([wish.x, wish.y]) + _offsets()
    flat = np.hypot(*_offsets().T)
    within_m = MAX_CORRECTION_M + shape.radius_m + CLEARANCE_M
    near = [s for s in obstacles if math.hypot(s.x - wish.x, s.y - wish.y) < within_m + s.radius_m]
    spots: list[Spot] = []
    for surface in surfaces:
        top = surface.center.z
        lift = wish.z - top
        # A wish anywhere between the surface and the top of the placed object means this surface.
        miss = max(-lift, lift - height, 0.0)
        if miss > MAX_CORRECTION_M:
            continue
        distance = np.hypot(flat, miss)
        fits = (distance <= MAX_CORRECTION_M) & _carried(centres, shape, surface)
        # The costly test comes last, for the few places that are left.
        places, distance = centres[fits], distance[fits]
        beside = [s for s in near if s.overlaps_height(top, top + height)]
        for i in np.flatnonzero(gaps(places, shape, beside) >= CLEARANCE_M):
            center = Vec3(float(places[i, 0]), float(places[i, 1]), top + height / 2)
            spots.append(Spot(surface.support, center, float(distance[i])))
    return sorted(spots, key=lambda s: s.distance_m)


def spread(spots: Sequence[Spot], apart_m: float = 0.06) -> Iterator[Spot]:
    """Spots in order, leaving out those close to one already given: for costly further checks."""
    given: list[Spot] = []
    for spot in spots:
        if all(
            s.support != spot.support or s.center.horizontal_distance(spot.center) >= apart_m
            for s in given
        ):
            given.append(spot)
            yield spot


@cache
def _offsets() -> Array:
    """(N, 2) offsets from the wished point, on a fine grid, nearest first."""
    steps = np.arange(-MAX_CORRECTION_M, MAX_CORRECTION_M + _STEP_M / 2, _STEP_M)
    grid = np.stack(np.meshgrid(steps, steps, indexing="ij"), axis=-1).reshape(-1, 2)
    distance = np.hypot(*grid.T)
    order = np.argsort(distance, kind="stable")
    return np.asarray(np.round(grid[order][distance[order] <= MAX_CORRECTION_M], 9))


def _carried(centres: Array, shape: Solid, surface: WorldSurface) -> NDArray[np.bool_]:
    """Whether the whole footprint lies on the surface."""
    cos, sin = math.cos(surface.yaw_rad), math.sin(surface.yaw_rad)
    turn = shape.yaw_rad - surface.yaw_rad
    along = abs(math.cos(turn)) * shape.half_x + abs(math.sin(turn)) * shape.half_y
    across = abs(math.sin(turn)) * shape.half_x + abs(math.cos(turn)) * shape.half_y
    offset = centres - np.array([surface.center.x, surface.center.y])
    u, v = np.abs(offset @ [cos, sin]), np.abs(offset @ [-sin, cos])
    return np.asarray(
        (u + along <= surface.half_x - _EDGE_M) & (v + across <= surface.half_y - _EDGE_M)
    )
