"""Where to put things: free spots on the floor, near a thing, in a corner, on furniture."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from adamo_vh.geometry import Vec3
from adamo_vh.inference.baseline.language.plan import SIDES, Goal, Relation
from adamo_vh.inference.baseline.mind.evidence import (
    FAR_FROM_M,
    LEVEL_M,
    axes,
    same_level,
    second_of,
    shifted,
)
from adamo_vh.inference.baseline.mind.footprints import (
    apart,
    around,
    flat,
    gap,
    hull_of,
    inside,
    outside,
    pick_apart,
    radius_of,
    surface_hull,
)
from adamo_vh.inference.baseline.mind.furniture import candidates, heights, surface_level
from adamo_vh.inference.baseline.mind.memory import Job, Memory, Stand, Thing
from adamo_vh.inference.baseline.prompt.reading import Prompt

_GAP_M = 0.02


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
    raised = [t.position for t in others if t.bottom_z >= LEVEL_M]
    raised += [p for p in prompt.points if 0.1 < p.z < 1.2 and inside(room, p, 0.15)]
    lying = [t for t in others if t.bottom_z < LEVEL_M]
    high, low = flat(raised), flat([t.position for t in lying])
    radii_m = np.array([radius_of(t) for t in lying])
    middle = near or body
    radii = (0.3, 0.45, 0.6, 0.75) if near else (0.55, 0.65, 0.75, 0.85)
    ring = [
        (radius, around(middle, radius, turn_rad, 0.0))
        for radius in radii
        for turn_rad in np.arange(0.0, 2 * math.pi, math.pi / 12)
    ]
    spots = [(r, s) for r, s in ring if inside(room, s, 0.25 + thing.width_m / 2)]
    if not spots:
        return room.clamp(Vec3(body.x, body.y, 0.0), 0.5)
    spots_flat = flat([spot for _, spot in spots])
    free = (apart(spots_flat, low) - radii_m).min(axis=1, initial=9.0) - radius_of(thing)
    clear = apart(spots_flat, high).min(axis=1, initial=9.0)
    # A hand's breadth between things; far enough from furniture, then close to hand.
    scores = (
        4 * np.minimum(free, 0.08) + np.minimum(clear, 0.7) - 0.1 * np.array([r for r, _ in spots])
    )
    scored = [(float(score), spot) for score, (_, spot) in zip(scores, spots, strict=True)]
    return pick_apart(scored, turn, 0.4)


def corner_spot(prompt: Prompt, memory: Memory, thing: Thing, turn: int) -> Vec3:
    """A spot in the corner area that is nearest to the body; then in the next one."""
    body = prompt.body.position
    corners = sorted(prompt.room.corners(), key=body.horizontal_distance)
    corner = corners[turn % len(corners)]
    lying = [t for t in memory.things.values() if t.tag != thing.tag and t.bottom_z < LEVEL_M]
    reach = prompt.room.corner_m / 2 - 0.1
    spots = [corner] + [around(corner, reach * 0.7, k * math.pi / 4, 0.0) for k in range(8)]
    scored = [
        (min(min((gap(s, t) - radius_of(thing) for t in lying), default=1.0), 0.1), s)
        for s in spots
    ]
    return pick_apart(scored, 0, 0.0)


def near_spot(prompt: Prompt, memory: Memory, thing: Thing, anchor: Thing, turn: int) -> Vec3:
    """A free spot beside a thing, on the same surface, so that the centres end near."""
    others = [
        t
        for t in memory.things.values()
        if t.tag not in (thing.tag, anchor.tag) and same_level(t, anchor)
    ]
    hull = surface_hull(prompt, [*others, anchor], anchor.bottom_z)
    limit = prompt.room.near_m - 0.02
    least = min(radius_of(anchor) + radius_of(thing) + _GAP_M, limit)
    level = surface_level(prompt, anchor)
    scored = []
    for distance in np.linspace(least, limit, 4):
        for angle in np.arange(0.0, 2 * math.pi, math.pi / 18):
            spot = around(anchor.position, float(distance), float(angle), level)
            if not inside(prompt.room, spot, 0.05):
                continue
            free = min((gap(spot, t) - radius_of(thing) for t in others), default=1.0)
            beyond = outside(hull, spot, radius_of(thing))
            closeness = prompt.body.position.horizontal_distance(spot)
            score = 4 * min(free - _GAP_M, 0.03) - 3 * beyond - 0.1 * float(distance)
            scored.append((score - 0.02 * closeness, spot))
    return pick_apart(scored, turn, 0.12) if scored else anchor.position


def beside_spot(prompt: Prompt, memory: Memory, goal: Goal, thing: Thing, anchor: Thing) -> Vec3:
    """A free spot left of, right of, in front of or behind a thing, as the viewer sees it."""
    far = goal.distance_m or max(radius_of(anchor) + radius_of(thing) + 2 * _GAP_M, 0.18)
    way = {"front": "back", "behind": "front"}.get(goal.relation.value, goal.relation.value)
    level = surface_level(prompt, anchor)
    scored = []
    for distance in (far, far + 0.05, far + 0.1) if goal.distance_m is None else (far,):
        middle = shifted(anchor.position, way, distance, memory.began)
        heading = math.atan2(middle.y - anchor.position.y, middle.x - anchor.position.x)
        for turn in np.linspace(-0.6, 0.6, 7):
            spot = around(anchor.position, distance, heading + float(turn), level)
            scored.append((_freedom(prompt, memory, thing, anchor, spot) - 0.02 * abs(turn), spot))
    return pick_apart(scored, _tries(memory, thing.tag), 0.08)


def between_spot(prompt: Prompt, memory: Memory, thing: Thing, one: Thing, other: Thing) -> Vec3:
    """A free spot about half way between two things."""
    a, b, level = one.position, other.position, surface_level(prompt, one)
    across = axes(a, Stand(b, 0.0))[1]
    scored = []
    for share in (0.5, 0.4, 0.6, 0.3, 0.7):
        for aside in (0.0, 0.04, -0.04):
            spot = Vec3(
                a.x + share * (b.x - a.x) + aside * across[0],
                a.y + share * (b.y - a.y) + aside * across[1],
                level,
            )
            freedom = _freedom(prompt, memory, thing, None, spot)
            scored.append((freedom - 0.1 * abs(share - 0.5), spot))
    return pick_apart(scored, _tries(memory, thing.tag), 0.05)


def far_spot(prompt: Prompt, memory: Memory, goal: Goal, thing: Thing, anchor: Thing) -> Vec3:
    """A free spot on the floor at some distance from a thing."""
    least = (goal.distance_m or FAR_FROM_M) + 0.25
    body, room = prompt.body.position, prompt.room
    ring = [
        around(anchor.position, least + more, float(angle), 0.0)
        for more in (0.0, 0.4, 0.8)
        for angle in np.arange(0.0, 2 * math.pi, math.pi / 12)
    ]
    free = [spot for spot in ring if inside(room, spot, 0.35)]
    scored = [
        (_clearance(prompt, memory, thing, spot) - 0.1 * spot.horizontal_distance(body), spot)
        for spot in free
    ]
    return pick_apart(scored, _tries(memory, thing.tag), 0.4) if scored else body


def under_spot(memory: Memory, thing: Thing, prompt: Prompt, furniture: str) -> Vec3 | None:
    """A place on the floor below what stands on furniture of such a height."""
    low, high = heights(furniture)
    standing = [
        t
        for t in memory.things.values()
        if t.tag not in (thing.tag, memory.hand) and low <= t.bottom_z <= high
    ]
    here = prompt.body.position
    standing.sort(key=lambda t: t.position.horizontal_distance(here))
    scored = [(-float(i), Vec3(t.position.x, t.position.y, 0.0)) for i, t in enumerate(standing)]
    return pick_apart(scored, _tries(memory, thing.tag), 0.15) if scored else None


def edge_spot(prompt: Prompt, memory: Memory, thing: Thing) -> Vec3 | None:
    """A point beyond the edge of what a thing came from: it will rest as near to it as it can."""
    origin = memory.came_from.get(thing.tag)
    if origin is None:
        return None
    stood = Thing(thing.tag, origin, thing.volume_cm3, thing.width_m, thing.height_m)
    level = surface_level(prompt, stood)
    here, tries = prompt.body.position, _tries(memory, thing.tag)
    others = [t.position for t in memory.things.values() if same_level(t, stood)]
    points = [p for p in prompt.points if abs(p.z - level) < 0.03]
    known = [p for p in [*others, *points, origin] if p.horizontal_distance(origin) < 1.5]
    away, _ = axes(origin, Stand(here, 0.0))
    outermost = min((p.x - origin.x) * away[0] + (p.y - origin.y) * away[1] for p in known)
    reach = -min(outermost, 0.0) + 0.1 + 0.12 * tries
    return Vec3(origin.x - away[0] * reach, origin.y - away[1] * reach, level)


def _tries(memory: Memory, tag: str) -> int:
    return max((job.tries for job in memory.jobs if job.tag == tag), default=0)


def _freedom(
    prompt: Prompt, memory: Memory, thing: Thing, anchor: Thing | None, spot: Vec3
) -> float:
    """How free a spot on a surface is, for a comparison."""
    others = [
        t
        for t in memory.things.values()
        if t.tag != thing.tag and abs(t.bottom_z - spot.z) < LEVEL_M
    ]
    free = min((gap(spot, t) - radius_of(thing) for t in others), default=1.0)
    hull = surface_hull(prompt, [*others, *([anchor] if anchor else [])], spot.z) if others else []
    beyond = outside(hull, spot, radius_of(thing)) if len(hull) > 2 else 0.0
    wall = 0.0 if inside(prompt.room, spot, 0.05) else 1.0
    return 4 * min(free - _GAP_M, 0.03) - beyond - wall


def _clearance(prompt: Prompt, memory: Memory, thing: Thing, spot: Vec3) -> float:
    """How far a spot on the floor is from furniture and from what lies there, up to a point."""
    raised = [t.position for t in memory.things.values() if t.bottom_z >= LEVEL_M]
    raised += [p for p in prompt.points if 0.1 < p.z < 1.2 and inside(prompt.room, p, 0.15)]
    clear = min((spot.horizontal_distance(p) for p in raised), default=9.0)
    lying = [t for t in memory.things.values() if t.bottom_z < LEVEL_M and t.tag != thing.tag]
    free = min((gap(spot, t) - radius_of(thing) for t in lying), default=1.0)
    return min(clear, 0.7) + 4 * min(free, 0.08)


def surface_spot(
    prompt: Prompt, memory: Memory, thing: Thing, furniture: str, turn: int
) -> Vec3 | None:
    """A free spot on what may be such a piece of furniture and was not found to be another.

    Args:
        prompt: For the points in view.
        memory: For the things known, and for what feedback named.
        thing: What is to be put down.
        furniture: The user's word.
        turn: How often it was tried before.
    """
    found = candidates(prompt, memory, thing.tag, furniture)
    if not found:
        return None
    surface = found[0]
    standing = [
        t
        for t in memory.things.values()
        if t.tag != thing.tag and abs(t.bottom_z - surface.level) < 0.06
    ]
    hull = hull_of(surface.places)
    scored = []
    for seed in surface.places:
        for radius in (0.0, 0.15, 0.25):
            for angle in np.arange(0.0, 2 * math.pi, math.pi / 6):
                spot = around(seed, radius, float(angle), surface.level)
                free = min((gap(spot, t) - radius_of(thing) for t in standing), default=1.0)
                beyond = outside(hull, spot, radius_of(thing))
                # The fewer places of a surface are known, the nearer to one of them.
                scored.append((4 * min(free - _GAP_M, 0.05) - 3 * beyond - 0.2 * radius, spot))
    return pick_apart(scored, turn if surface.sure else 0, 0.3)


def spot(
    prompt: Prompt, memory: Memory, goal: Goal, job: Job, thing: Thing, anchor: Thing | None
) -> Vec3 | None:
    """Where to put a thing so that its job is done; None if no such place is known."""
    ways: dict[Relation, Callable[[], Vec3 | None]] = {
        Relation.CORNER: lambda: corner_spot(prompt, memory, thing, job.tries),
        Relation.SURFACE: lambda: surface_spot(prompt, memory, thing, goal.furniture, job.tries),
        Relation.UNDER: lambda: under_spot(memory, thing, prompt, goal.furniture),
        Relation.EDGE: lambda: edge_spot(prompt, memory, thing),
        Relation.HOME: lambda: _origin_spot(memory, goal, thing, job.tries),
        Relation.SHIFT: lambda: _origin_spot(memory, goal, thing, job.tries),
    }
    if goal.relation in ways:
        return ways[goal.relation]()
    match goal.relation:
        case Relation.NEAR if anchor:
            return near_spot(prompt, memory, thing, anchor, job.tries)
        case Relation.FLOOR:
            near = anchor.position if anchor else None
            return floor_spot(prompt, memory, thing, near, job.tries)
        case Relation.FAR if anchor:
            return far_spot(prompt, memory, goal, thing, anchor)
        case Relation.BETWEEN if anchor and (other := second_of(job.goal, memory)):
            return between_spot(prompt, memory, thing, anchor, other)
        case _ if goal.relation in SIDES and anchor:
            return beside_spot(prompt, memory, goal, thing, anchor)
        case _:
            return None


def _origin_spot(memory: Memory, goal: Goal, thing: Thing, tries: int) -> Vec3 | None:
    """Where a thing was, or some way from there."""
    origin = memory.came_from.get(thing.tag)
    if origin is None:
        return None
    foot = Vec3(origin.x, origin.y, max(0.0, origin.z - thing.height_m / 2))
    if goal.relation is Relation.HOME:
        return foot
    if tries:  # what it stood on may not reach so far
        foot = Vec3(foot.x, foot.y, 0.0)
    return shifted(foot, goal.direction, goal.distance_m or 0.25, memory.began)


def place_words(point: Vec3) -> str:
    """What feedback would say about a thing put down there."""
    return "on the floor" if point.z < LEVEL_M else "on the furniture"
