"""How much room things take, and which spots are free of them."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence

import numpy as np

from adamo_vh.geometry import Array, Vec3, hull
from adamo_vh.inference.baseline.mind.memory import Thing
from adamo_vh.inference.baseline.prompt.reading import Prompt, Room


def flat(points: Sequence[Vec3]) -> Array:
    """Where points are on the floor plan, (N, 2)."""
    return np.array([(p.x, p.y) for p in points]).reshape(-1, 2)


def apart(spots: Array, places: Array) -> Array:
    """Distances from each spot to each place on the floor plan, (spots, places)."""
    off = spots[:, None] - places
    return np.asarray(np.hypot(off[..., 0], off[..., 1]))


def radius_of(thing: Thing) -> float:
    """Radius of a circle as large as the footprint: long things count less than they reach."""
    area = thing.volume_cm3 * 1e-6 / max(thing.height_m, 0.002)
    return min(math.sqrt(area) * 0.6, thing.width_m * 0.75)


def gap(spot: Vec3, thing: Thing) -> float:
    """From a spot to the edge of a thing, metres."""
    return spot.horizontal_distance(thing.position) - radius_of(thing)


def around(center: Vec3, radius: float, angle: float, z: float) -> Vec3:
    """The point in a direction from another one."""
    return Vec3(center.x + radius * math.cos(angle), center.y + radius * math.sin(angle), z)


def inside(room: Room, p: Vec3, margin: float) -> bool:
    """Whether a point is in the room, so far from the walls."""
    return (
        room.x_min + margin <= p.x <= room.x_max - margin
        and room.y_min + margin <= p.y <= room.y_max - margin
    )


def surface_hull(
    prompt: Prompt, things: Iterable[Thing], level: float
) -> list[tuple[float, float]]:
    """What is known of a surface: the outline of things and points on it."""
    known = [t.position for t in things]
    here = known[-1]
    known += [
        p for p in prompt.points if abs(p.z - level) < 0.03 and p.horizontal_distance(here) < 1.5
    ]
    return hull_of(known)


def hull_of(points: Sequence[Vec3]) -> list[tuple[float, float]]:
    """Convex hull in the floor plane, counter-clockwise."""
    return hull((p.x, p.y) for p in points)


def _turn(a: tuple[float, float], b: tuple[float, float], c: tuple[float, float]) -> float:
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])


def outside(hull: list[tuple[float, float]], spot: Vec3, radius: float) -> float:
    """How far a disc reaches beyond what is known of a surface, metres."""
    if len(hull) < 3:
        return 0.0
    worst = 0.0
    for a, b in zip(hull, hull[1:] + hull[:1], strict=True):
        edge = math.hypot(b[0] - a[0], b[1] - a[1])
        if edge > 1e-6:
            inside = _turn(a, b, (spot.x, spot.y)) / edge
            worst = max(worst, radius - inside)
    # Things stand a little in from the edge, so the surface is larger than their centres tell.
    return max(0.0, worst - 0.1)


def pick_apart(scored: list[tuple[float, Vec3]], turn: int, apart_m: float) -> Vec3:
    """The best spot; for later turns the best one apart from those named before."""
    ordered = sorted(scored, key=lambda item: -item[0])
    named: list[Vec3] = []
    for _, spot in ordered:
        if all(spot.horizontal_distance(n) >= apart_m for n in named):
            named.append(spot)
            if len(named) > turn:
                return spot
    return named[-1]
