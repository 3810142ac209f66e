"""Where to put things: free spots on the floor, near a thing, in a corner, on furniture."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence

import numpy as np

from adamo_vh.geometry import Array, Vec3
from adamo_vh.inference.baseline.language.plan import Goal, Relation
from adamo_vh.inference.baseline.mind.memory import Job, Memory, Thing
from adamo_vh.inference.baseline.prompt.reading import Prompt, Room

_GAP_M = 0.02
_LEVEL_M = 0.12
"""Things whose bottoms differ by less are taken to stand on the same surface."""
_FURNITURE_HEIGHTS_M = {
    "coffee": (0.25, 0.56),
    "sideboard": (0.45, 0.95),
    "cabinet": (0.45, 1.0),
    "cupboard": (0.45, 1.0),
    "shelf": (0.9, 2.1),
    "bookshelf": (0.9, 2.1),
    "sofa": (0.25, 0.6),
    "couch": (0.25, 0.6),
    "chair": (0.35, 0.6),
    "table": (0.6, 0.95),
}
"""Usual heights of the surfaces of furniture, by the word that names it."""


def same_level(one: Thing, other: Thing) -> bool:
    """Whether two things seem to stand equally high."""
    return abs(one.bottom_z - other.bottom_z) < _LEVEL_M


def place_reached(
    relation: Relation, thing: Thing, anchor: Thing | None, room: Room, on_floor: bool
) -> bool:
    """Whether a thing rests where it should, judged by where it is said to rest."""
    p = thing.position
    match relation:
        case Relation.FLOOR:
            return on_floor
        case Relation.CORNER:
            half = room.corner_m / 2
            return on_floor and any(
                abs(p.x - c.x) <= half and abs(p.y - c.y) <= half for c in room.corners()
            )
        case Relation.NEAR:
            return (
                anchor is not None
                and p.horizontal_distance(anchor.position) <= room.near_m
                and on_floor == (anchor.bottom_z < _LEVEL_M)
                and same_level(thing, anchor)
            )
        case Relation.SURFACE:
            return not on_floor
        case Relation.HOLD:
            return False


def floor_spot(prompt: Prompt, memory: Memory, thing: Thing, near: Vec3 | None, turn: int) -> Vec3:
    """A free spot on the floor at arm's length, away from furniture and from what lies there.

    Args:
        prompt: For the body, the room and the reference points.
        memory: For the things known.
        thing: What is to be put down.
        near: Preferred place, if any.
        turn: How often it was tried before; each time another spot is named.
    """
    body, room = prompt.body.position, prompt.room
    others = [t for t in memory.things.values() if t.tag != thing.tag]
    raised = [t.position for t in others if t.bottom_z >= _LEVEL_M]
    raised += [p for p in prompt.points if 0.1 < p.z < 1.2 and _inside(room, p, 0.15)]
    lying = [t for t in others if t.bottom_z < _LEVEL_M]
    high, low = _flat(raised), _flat([t.position for t in lying])
    radii_m = np.array([_radius(t) for t in lying])
    middle = near or body
    radii = (0.3, 0.45, 0.6, 0.75) if near else (0.55, 0.65, 0.75, 0.85)
    around = [
        (radius, _around(middle, radius, turn_rad, 0.0))
        for radius in radii
        for turn_rad in np.arange(0.0, 2 * math.pi, math.pi / 12)
    ]
    spots = [(r, s) for r, s in around if _inside(room, s, 0.25 + thing.width_m / 2)]
    if not spots:
        return room.clamp(Vec3(body.x, body.y, 0.0), 0.5)
    flat = _flat([spot for _, spot in spots])
    free = (_apart(flat, low) - radii_m).min(axis=1, initial=9.0) - _radius(thing)
    clear = _apart(flat, high).min(axis=1, initial=9.0)
    # A hand's breadth between things; far enough from furniture, then close to hand.
    scores = (
        4 * np.minimum(free, 0.08) + np.minimum(clear, 0.7) - 0.1 * np.array([r for r, _ in spots])
    )
    scored = [(float(score), spot) for score, (_, spot) in zip(scores, spots, strict=True)]
    return _pick_apart(scored, turn, 0.4)


def _flat(points: Sequence[Vec3]) -> Array:
    """Where points are on the floor plan, (N, 2)."""
    return np.array([(p.x, p.y) for p in points]).reshape(-1, 2)


def _apart(spots: Array, places: Array) -> Array:
    """Distances from each spot to each place on the floor plan, (spots, places)."""
    off = spots[:, None] - places
    return np.asarray(np.hypot(off[..., 0], off[..., 1]))


def corner_spot(prompt: Prompt, memory: Memory, thing: Thing, turn: int) -> Vec3:
    """A spot in the corner area that is nearest to the body; then in the next one."""
    body = prompt.body.position
    corners = sorted(prompt.room.corners(), key=body.horizontal_distance)
    corner = corners[turn % len(corners)]
    lying = [t for t in memory.things.values() if t.tag != thing.tag and t.bottom_z < _LEVEL_M]
    reach = prompt.room.corner_m / 2 - 0.1
    spots = [corner] + [_around(corner, reach * 0.7, k * math.pi / 4, 0.0) for k in range(8)]
    scored = [
        (min(min((_between(s, t) - _radius(thing) for t in lying), default=1.0), 0.1), s)
        for s in spots
    ]
    return _pick_apart(scored, 0, 0.0)


def near_spot(prompt: Prompt, memory: Memory, thing: Thing, anchor: Thing, turn: int) -> Vec3:
    """A free spot beside a thing, on the same surface, so that the centres end near."""
    others = [
        t
        for t in memory.things.values()
        if t.tag not in (thing.tag, anchor.tag) and same_level(t, anchor)
    ]
    hull = _surface_hull(prompt, [*others, anchor], anchor.bottom_z)
    limit = prompt.room.near_m - 0.02
    least = min(_radius(anchor) + _radius(thing) + _GAP_M, limit)
    level = surface_level(prompt, anchor)
    scored = []
    for distance in np.linspace(least, limit, 4):
        for angle in np.arange(0.0, 2 * math.pi, math.pi / 18):
            spot = _around(anchor.position, float(distance), float(angle), level)
            if not _inside(prompt.room, spot, 0.05):
                continue
            free = min((_between(spot, t) - _radius(thing) for t in others), default=1.0)
            outside = _outside(hull, spot, _radius(thing))
            closeness = prompt.body.position.horizontal_distance(spot)
            score = 4 * min(free - _GAP_M, 0.03) - 3 * outside - 0.1 * float(distance)
            scored.append((score - 0.02 * closeness, spot))
    return _pick_apart(scored, turn, 0.12) if scored else anchor.position


def surface_spot(
    prompt: Prompt, memory: Memory, thing: Thing, furniture: str, turn: int
) -> Vec3 | None:
    """A free spot on a piece of furniture, known by the things and points on it; else None."""
    low, high = next(
        (span for word, span in _FURNITURE_HEIGHTS_M.items() if word in furniture), (0.3, 1.2)
    )
    others = [t for t in memory.things.values() if t.tag != thing.tag]
    standing = [t for t in others if low <= t.bottom_z <= high]
    known = [t.position for t in standing] + [p for p in prompt.points if low <= p.z <= high]
    known = [p for p in known if _inside(prompt.room, p, 0.1)]
    if not known:
        return None
    level = float(np.median([t.bottom_z for t in standing] or [p.z for p in known]))
    hull = _hull(known)
    scored = []
    for seed in known:
        for radius in (0.0, 0.15, 0.25):
            for angle in np.arange(0.0, 2 * math.pi, math.pi / 6):
                spot = _around(seed, radius, float(angle), level)
                free = min((_between(spot, t) - _radius(thing) for t in standing), default=1.0)
                outside = _outside(hull, spot, _radius(thing))
                scored.append((4 * min(free - _GAP_M, 0.05) - 3 * outside, spot))
    return _pick_apart(scored, turn, 0.3)


def surface_level(prompt: Prompt, thing: Thing) -> float:
    """Height of the surface below a thing: its estimate, made exact by points on the surface."""
    here = [
        p.z
        for p in prompt.points
        if p.horizontal_distance(thing.position) < 1.2 and abs(p.z - thing.bottom_z) < 0.06
    ]
    levels = sorted(here, key=lambda z: (-sum(abs(z - o) < 0.008 for o in here), z))
    if levels and sum(abs(levels[0] - o) < 0.008 for o in here) >= 2:
        return levels[0]
    return thing.bottom_z


def _radius(thing: Thing) -> float:
    """Radius of a circle as large as the footprint: long things count less than they reach."""
    area = thing.volume_cm3 * 1e-6 / max(thing.height_m, 0.002)
    return min(math.sqrt(area) * 0.6, thing.width_m * 0.75)


def _between(spot: Vec3, thing: Thing) -> float:
    return spot.horizontal_distance(thing.position) - _radius(thing)


def _around(center: Vec3, radius: float, angle: float, z: float) -> Vec3:
    return Vec3(center.x + radius * math.cos(angle), center.y + radius * math.sin(angle), z)


def _inside(room: Room, p: Vec3, margin: float) -> bool:
    return (
        room.x_min + margin <= p.x <= room.x_max - margin
        and room.y_min + margin <= p.y <= room.y_max - margin
    )


def _surface_hull(
    prompt: Prompt, things: Iterable[Thing], level: float
) -> list[tuple[float, float]]:
    known = [t.position for t in things]
    here = known[-1]
    known += [
        p for p in prompt.points if abs(p.z - level) < 0.03 and p.horizontal_distance(here) < 1.5
    ]
    return _hull(known)


def _hull(points: Sequence[Vec3]) -> list[tuple[float, float]]:
    """Convex hull in the floor plane, counter-clockwise (Andrew's monotone chain)."""
    ordered = sorted({(p.x, p.y) for p in points})
    if len(ordered) < 3:
        return ordered

    def half(sequence: Iterable[tuple[float, float]]) -> list[tuple[float, float]]:
        chain: list[tuple[float, float]] = []
        for p in sequence:
            while len(chain) >= 2 and _turn(chain[-2], chain[-1], p) <= 0:
                chain.pop()
            chain.append(p)
        return chain[:-1]

    return half(ordered) + half(reversed(ordered))


def _turn(a: tuple[float, float], b: tuple[float, float], c: tuple[float, float]) -> float:
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])


def _outside(hull: list[tuple[float, float]], spot: Vec3, radius: float) -> float:
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


def _pick_apart(scored: list[tuple[float, Vec3]], turn: int, apart_m: float) -> Vec3:
    """The best spot; for later turns the best one apart from those named before."""
    ordered = sorted(scored, key=lambda item: -item[0])
    named: list[Vec3] = []
    for _, spot in ordered:
        if all(spot.horizontal_distance(n) >= apart_m for n in named):
            named.append(spot)
            if len(named) > turn:
                return spot
    return named[-1]


def spot(
    prompt: Prompt, memory: Memory, goal: Goal, job: Job, thing: Thing, anchor: Thing | None
) -> Vec3 | None:
    """Where to put a thing so that its job is done; None if no such place is known."""
    match goal.relation:
        case Relation.NEAR if anchor:
            return near_spot(prompt, memory, thing, anchor, job.tries)
        case Relation.CORNER:
            return corner_spot(prompt, memory, thing, job.tries)
        case Relation.FLOOR:
            near = anchor.position if anchor else None
            return floor_spot(prompt, memory, thing, near, job.tries)
        case Relation.SURFACE:
            return surface_spot(prompt, memory, thing, goal.furniture, job.tries)
        case _:
            return None


def place_words(point: Vec3) -> str:
    """What feedback would say about a thing put down there."""
    return "on the floor" if point.z < _LEVEL_M else "on the furniture"
