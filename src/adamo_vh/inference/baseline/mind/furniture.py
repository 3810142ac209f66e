"""Surfaces that may be furniture: told by what stands on them, by points, and by feedback."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from adamo_vh.geometry import Vec3
from adamo_vh.inference.baseline.mind.evidence import (
    LEVEL_M,
    LOW,
    TOP,
    named,
)
from adamo_vh.inference.baseline.mind.footprints import inside
from adamo_vh.inference.baseline.mind.memory import Memory, Thing
from adamo_vh.inference.baseline.prompt.reading import Prompt

_LINKED_M = 0.8

_TRIED_M = 0.3

_STOREY_M = 0.5

_SAME_HEIGHT_M = 0.05

_FURNITURE_HEIGHTS_M = {
    "coffee": (0.25, 0.56),
    "low table": (0.25, 0.56),
    "side table": (0.4, 0.7),
    "end table": (0.4, 0.7),
    "sideboard": (0.45, 0.95),
    "cabinet": (0.45, 1.0),
    "cupboard": (0.45, 1.0),
    "console": (0.65, 0.95),
    "shel": (0.85, 2.2),
    "bookcase": (0.85, 2.2),
    "sofa": (0.25, 0.6),
    "couch": (0.25, 0.6),
    "settee": (0.25, 0.6),
    "chair": (0.35, 0.6),
    "surface": (0.25, 1.2),
    "table": (0.4, 0.95),
}
"""Usual heights of the surfaces of furniture, by the word that names it."""

_BY_HEIGHT = (
    "table|tables|dining table|kitchen table|big table|tabletop|table top|coffee table|low table|"
    "side table|end table|shelf|tall shelf|shelves|bookshelf|bookcase|middle shelf|sideboard|"
    "console|console table|sofa|couch|settee|chair|chairs|surface|top of the shelf|"
    "top of the tall shelf|top shelf|upper shelf|highest shelf|lower shelf|bottom shelf|"
    "lowest shelf"
)

_TOLD_BY_HEIGHT = frozenset(_BY_HEIGHT.split("|"))
"""Furniture whose height is usual enough to look for it by that."""


@dataclass(frozen=True, slots=True)
class Surface:
    """Places at one height, close to each other: perhaps the top of a piece of furniture."""

    level: float
    places: tuple[Vec3, ...]
    sure: bool
    """Whether feedback named it."""
    firm: bool = True
    """Whether things stand on it, or several points lie on it; else it may be no surface."""


def candidates(prompt: Prompt, memory: Memory, but: str, furniture: str) -> list[Surface]:
    """Surfaces that may be a piece of furniture, the likeliest first.

    Those that feedback named otherwise are left out, and so is what a thing was aimed at in vain.
    """
    low, high = heights(furniture)
    ranked = []
    for level, places, things in _groups(prompt, memory, but):
        names = [
            support
            for place, support in memory.supports
            if "floor" not in support and _belongs(place, level, places)
        ]
        sure = any(named(furniture, support) for support in names)
        if sure:
            ranked.append((0.0, Surface(level, places, True, True)))
        elif not names and may_be_found(furniture) and low <= level <= high:
            if any(_tried(level, places, aim) for aim in memory.aims):
                continue
            firm = things > 0 or len(places) > 2
            rank = 1.0 + _off(level, furniture) + 0.5 * (not firm) - 0.01 * min(len(places), 10)
            ranked.append((rank, Surface(level, places, False, firm)))
    ranked += [(0.5, surface) for surface in _storeys(memory, furniture)]
    ranked.sort(key=lambda item: item[0])
    return [surface for _, surface in ranked]


def _storeys(memory: Memory, furniture: str) -> list[Surface]:
    """Where the top or bottom board must be of a shelf of which feedback named another board."""
    step = (
        _STOREY_M if furniture.startswith(TOP) else -_STOREY_M if furniture.startswith(LOW) else 0
    )
    found = []
    for place, support in memory.supports if step else ():
        above = Vec3(place.x, place.y, max(place.z + step, 0.2))
        tried = any(_tried(above.z, [above], aim) for aim in memory.aims)
        if named(furniture.rsplit(maxsplit=1)[-1], support) and not tried:
            found.append(Surface(above.z, (above,), False))
    return found


def _tried(level: float, places: Sequence[Vec3], aim: Vec3) -> bool:
    """Whether a thing was to be put there before."""
    near = min(place.horizontal_distance(aim) for place in places) < _TRIED_M
    return near and abs(aim.z - level) < 0.06


def _off(level: float, furniture: str) -> float:
    """How unusual a height is for such furniture."""
    if furniture.startswith(TOP):
        return 2.2 - level
    if furniture.startswith(LOW):
        return level - 0.5
    if "shel" in furniture or furniture == "bookcase":
        return 0.0
    low, high = heights(furniture)
    return abs(level - (low + high) / 2)


def may_be_found(furniture: str) -> bool:
    """Whether such furniture can be looked for by its height."""
    return furniture in _TOLD_BY_HEIGHT


def _belongs(place: Vec3, level: float, places: Sequence[Vec3]) -> bool:
    """Whether the centre of a thing that rests at a place may be above a surface."""
    if not -0.03 < place.z - level < 0.25:
        return False
    return min(place.horizontal_distance(p) for p in places) < 0.6


def _groups(prompt: Prompt, memory: Memory, but: str) -> list[tuple[float, tuple[Vec3, ...], int]]:
    """Places by height and closeness: points in view, and the feet of things, with their count."""
    feet = [
        Vec3(t.position.x, t.position.y, t.bottom_z)
        for t in memory.things.values()
        if t.tag not in (but, memory.hand) and t.bottom_z > LEVEL_M
    ]
    points = [p for p in prompt.points if p.z > LEVEL_M and inside(prompt.room, p, 0.1)]
    groups: list[list[Vec3]] = []
    for place in [*points, *feet]:
        near = [
            group
            for group in groups
            if any(
                abs(p.z - place.z) < _SAME_HEIGHT_M and p.horizontal_distance(place) < _LINKED_M
                for p in group
            )
        ]
        groups = [group for group in groups if group not in near]
        groups.append([p for group in near for p in group] + [place])
    told = {(p.x, p.y, p.z) for p in points}
    levels: list[tuple[float, tuple[Vec3, ...], int]] = []
    for group in groups:
        exact = [p.z for p in group if (p.x, p.y, p.z) in told] or [p.z for p in group]
        standing = sum((p.x, p.y, p.z) not in told for p in group)
        levels.append((float(np.median(exact)), tuple(group), standing))
    return levels


def heights(furniture: str) -> tuple[float, float]:
    """Usual heights of the surface of such furniture, metres."""
    return next(
        (span for word, span in _FURNITURE_HEIGHTS_M.items() if word in furniture), (0.3, 1.2)
    )


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
