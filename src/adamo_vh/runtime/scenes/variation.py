"""Variations of a scene: the same room, other places for the objects, further things, other light.

A variation follows from the scene and two numbers alone: its own, and that of the attempt, because
not every drawing is fair to every task; `adamo_vh.session.variations` knows the first one that is.
The draws are our own, so that no library can change them.
"""

from __future__ import annotations

import hashlib
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cache
from itertools import accumulate
from types import MappingProxyType
from typing import TypeVar

import numpy as np

from adamo_vh.engine import FLOOR, WorldSurface
from adamo_vh.errors import SceneError
from adamo_vh.geometry import Array, Solid, gaps
from adamo_vh.runtime.assets.asset import Asset, Collider
from adamo_vh.runtime.assets.bake import load_asset
from adamo_vh.runtime.embodiment import EYE_HEIGHT_M
from adamo_vh.runtime.scenes.scene import Light, PlacedObject, Scene
from adamo_vh.runtime.world import furniture_solids, furniture_surfaces

_T = TypeVar("_T")

GENERATION = 1
"""Of the drawing: another one gives every number another scene."""

DISTRACTORS: Mapping[int, str] = MappingProxyType(
    {
        60: "banana",
        61: "hammer",
        62: "rubber_duck",
        63: "teapot",
        64: "scissors",
        65: "toy_car",
        66: "apple",
        67: "remote_control",
        68: "wooden_spoon",
        69: "pumpkin",
    }
)
"""Things that no task means, by the id that they get: none is blue, none has white parts or a
printed label, none is as small as a key, and none goes by the name of another object."""

_FEWEST, _MOST = 2, 4
"""Distractors of one variation."""
_GAP_M = 0.035
"""Free room around each object."""
_EDGE_M = 0.02
_HEADROOM_M = 0.06
"""Free height above an object, so that it can be seen and taken."""
_TALL_M = 0.04
"""Least height of what lies higher than the eyes: what is flat would never be seen there."""
_LEAST_HEIGHT_M = 0.01
"""Flat things may not lie under others either."""
_SUPPORTS, _POINTS = 24, 24
"""How often another piece of furniture is drawn for an object, and how many places on each."""


@dataclass(frozen=True, slots=True)
class LightPreset:
    """How bright a scene is."""

    name: str
    lamps: float
    """Factor on every lamp."""
    ambient: float
    """Factor on the light that comes from everywhere."""


LIGHT_PRESETS = (
    LightPreset("normal", 1.0, 1.0),
    LightPreset("low", 0.62, 0.66),
    LightPreset("high", 1.14, 1.09),
)
"""The one of a variation is that at its number, round and round; the scene itself is normal."""


def light_preset(number: int) -> LightPreset:
    """How bright the variation with a number is."""
    return LIGHT_PRESETS[number % len(LIGHT_PRESETS)]


def varied(scene: Scene, number: int, attempt: int = 0) -> Scene:
    """A variation of a scene, drawn and not proven.

    Furniture, room and start stay. Every object gets another place on a piece of furniture that
    carries something or is open above, and is turned; two to four distractors come in between.

    Args:
        scene: Variation 0.
        number: From 1.
        attempt: From 0.

    Raises:
        SceneError: The scene is a variation itself, or there is no room for its objects.
    """
    if scene.variation:
        raise SceneError(
            f"{scene.name}: this is variation {scene.variation} already; leave the variation out, "
            "or vary the scene that it was made of."
        )
    draws = Draws(f"{GENERATION} {scene.name} {number} {attempt}")
    taken = {item.id for item in scene.objects} | {item.asset for item in scene.objects}
    further = [(i, name) for i, name in DISTRACTORS.items() if not {i, name} & taken]
    chosen = draws.some(further, _FEWEST + draws.below(_MOST - _FEWEST + 1))
    added = tuple(PlacedObject(i, name, FLOOR, (0.0, 0.0)) for i, name in sorted(chosen))
    full = replace(scene, objects=(*scene.objects, *added))
    placing = _Placing(scene, draws)
    # The large ones first: they find a place only while there is room.
    order = sorted(full.objects, key=lambda item: (-_footprint(_shape(item.asset)), item.id))
    placed = {item.id: placing.place(item) for item in order}
    preset = light_preset(number)
    return replace(
        full,
        variation=number,
        objects=tuple(placed[item.id] for item in full.objects),
        ambient=min(1.0, round(scene.ambient * preset.ambient, 3)),
        lights=tuple(_dimmed(light, preset.lamps) for light in scene.lights),
    )


class Draws:
    """Random numbers that are the same everywhere: digests of a text and a counter."""

    def __init__(self, seed: str) -> None:
        """Begin."""
        self._seed = seed
        self._count = 0

    def below(self, end: int) -> int:
        """A whole number from 0, below `end`."""
        digest = hashlib.sha256(f"{self._seed} {self._count}".encode()).digest()
        self._count += 1
        # 128 bits: no number that is asked for here makes the rest of the division uneven.
        return int.from_bytes(digest[:16], "big") % end

    def some(self, among: Sequence[_T], count: int) -> list[_T]:
        """So many of them, each at most once."""
        left = list(among)
        return [left.pop(self.below(len(left))) for _ in range(min(count, len(left)))]

    def heavy(self, weights: Sequence[int]) -> int:
        """An index, each as likely as its weight."""
        mark = self.below(sum(weights))
        return next(i for i, sum_to in enumerate(accumulate(weights)) if mark < sum_to)


class _Placing:
    """Finds places for the objects of a scene, one after another."""

    def __init__(self, scene: Scene, draws: Draws) -> None:
        self._draws = draws
        self._solids = [
            solid for p in scene.furniture for solid in furniture_solids(p, _shape(p.asset))
        ]
        carries = {item.on for item in scene.objects}
        self._surfaces = [
            (surface, surface.support in carries)
            for piece in scene.furniture
            for surface in furniture_surfaces(piece, _shape(piece.asset))
        ]
        if not self._surfaces:
            raise SceneError(f"{scene.name}: no furniture carries anything; add a table.")
        areas = [4 * s.half_x * s.half_y for s, _ in self._surfaces]
        # Between even odds and odds by area: a side table is not for ever bare.
        self._weights = [round(1000 * math.sqrt(area)) for area in areas]
        self._name = scene.name

    def place(self, item: PlacedObject) -> PlacedObject:
        """The object at a free place, turned; it is in the way of those that follow."""
        length, width, height = _shape(item.asset).size
        height = max(height, _LEAST_HEIGHT_M)
        for _ in range(_SUPPORTS):
            surface, carries = self._surfaces[self._draws.heavy(self._weights)]
            if surface.center.z > EYE_HEIGHT_M and height < _TALL_M:
                continue
            yaw_deg = self._draws.below(360) - 180
            yaw, bottom = math.radians(yaw_deg), surface.center.z
            shape = Solid(0, 0, length / 2, width / 2, yaw, bottom, bottom + height)
            points = self._points(surface, shape)
            if not len(points):
                continue
            above = math.inf if not carries else shape.z_max + _HEADROOM_M
            beside = [s for s in self._solids if s.overlaps_height(bottom, above)]
            free = np.flatnonzero(gaps(points, shape, beside) >= _GAP_M)
            if len(free):
                x, y = (round(float(v), 3) for v in points[free[0]])
                self._solids.append(replace(shape, x=x, y=y))
                return replace(item, on=surface.support, position=(x, y), yaw_deg=float(yaw_deg))
        raise SceneError(
            f"{self._name}: its furniture has no room for object {item.id} in a variation; leave "
            "an object out, or add a table."
        )

    def _points(self, surface: WorldSurface, shape: Solid) -> Array:
        """(N, 2) drawn centres with the whole shape on the surface; none if it is too small."""
        turn = shape.yaw_rad - surface.yaw_rad
        c, s = abs(math.cos(turn)), abs(math.sin(turn))
        reach_x = math.floor(
            1000 * (surface.half_x - _EDGE_M - c * shape.half_x - s * shape.half_y)
        )
        reach_y = math.floor(
            1000 * (surface.half_y - _EDGE_M - s * shape.half_x - c * shape.half_y)
        )
        if min(reach_x, reach_y) < 0:
            return np.empty((0, 2))
        below = self._draws.below
        local = [
            (below(2 * reach_x + 1) - reach_x, below(2 * reach_y + 1) - reach_y)
            for _ in range(_POINTS)
        ]
        cos, sin = math.cos(surface.yaw_rad), math.sin(surface.yaw_rad)
        return np.array(
            [
                (
                    surface.center.x + (cos * u - sin * v) / 1000,
                    surface.center.y + (sin * u + cos * v) / 1000,
                )
                for u, v in local
            ]
        )


@cache
def _shape(name: str) -> Asset:
    """An asset without what is drawn; what has no colliders, a curtain, gets the box around it."""
    asset = load_asset(name)
    if asset.colliders:
        return replace(asset, parts=())
    vertices = np.concatenate([part.vertices for part in asset.parts]).astype(np.float64)
    low, high = vertices.min(axis=0), vertices.max(axis=0)
    seen = Collider("box", _three((high - low) / 2), _three((high + low) / 2))
    return replace(asset, parts=(), colliders=(seen,))


def _three(values: Array) -> tuple[float, float, float]:
    x, y, z = (float(value) for value in values)
    return x, y, z


def _footprint(asset: Asset) -> float:
    return asset.size[0] * asset.size[1]


def _dimmed(light: Light, factor: float) -> Light:
    return replace(light, diffuse=min(1.0, round(light.diffuse * factor, 3)))
