"""What is wrong with the way a scene is arranged, found before anything is simulated.

Scene files are untrusted: what the physics could not take (piles of things in each other, lights
without a direction) is told apart here, and never reaches it.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from itertools import combinations

import numpy as np

from adamo_vh.engine import FLOOR, WorldSurface
from adamo_vh.geometry import Solid, Vec3, gaps
from adamo_vh.runtime.assets.asset import Asset
from adamo_vh.runtime.inspection.finding import SceneFinding, bounded, error, warning
from adamo_vh.runtime.scenes.scene import PlacedObject, Scene
from adamo_vh.runtime.world import furniture_solids, furniture_surfaces, scene_assets

_FURNITURE_OVERLAP_M = 0.02
_OBJECT_OVERLAP_M = 0.005
_LEAST_HEIGHT_M = 0.01
_OVERHANG_M = 0.02
"""Round things reach less far than the box around them."""
_MAX_OVERLAPS = 40
"""More are not simulated: their contacts could fill the memory."""


Assets = Mapping[str, Asset]
"""Assets by name."""


def inspect_arrangement(scene: Scene, assets: Assets | None = None) -> tuple[SceneFinding, ...]:
    """Look over what can be told from the file alone.

    Args:
        scene: What the file says.
        assets: Every asset that the scene names; are loaded if not given.

    Returns:
        The findings; one that `blocks` means that the scene cannot be simulated.
    """
    if assets is None:
        assets = scene_assets(scene)
    surfaces = _surfaces(scene, assets)
    return (
        *_lights(scene),
        *_furniture(scene, assets),
        *_supports(scene, assets, surfaces),
        *_objects(scene, assets, surfaces),
    )


def _surfaces(scene: Scene, assets: Assets) -> dict[str, WorldSurface]:
    """Everything that carries things, by support name."""
    room = scene.room
    middle = Vec3((room.x_min + room.x_max) / 2, (room.y_min + room.y_max) / 2, 0.0)
    half_x, half_y = (room.x_max - room.x_min) / 2, (room.y_max - room.y_min) / 2
    found = [WorldSurface(FLOOR, middle, half_x, half_y, 0.0)]
    for piece in scene.furniture:
        found += furniture_surfaces(piece, assets[piece.asset])
    return {surface.support: surface for surface in found}


def _lights(scene: Scene) -> Iterator[SceneFinding]:
    for i, light in enumerate(scene.lights):
        if Vec3(*light.position).distance(Vec3(*light.target)) < 0.01:
            yield error(
                f"lights[{i}].target",
                "the light is aimed at itself",
                "aim it at another point than its position",
                blocks=True,
            )
    if not any(light.diffuse > 0 for light in scene.lights):
        yield error("lights", "no light shines", "set diffuse of at least one light above 0")
    shadows = sum(light.shadow for light in scene.lights)
    if shadows > 1:
        yield warning(
            "lights",
            f"{shadows} lights cast shadows, and each draws the whole scene again",
            "leave shadow = true on one light",
        )


def _furniture(scene: Scene, assets: Assets) -> Iterator[SceneFinding]:
    solids = [furniture_solids(piece, assets[piece.asset]) for piece in scene.furniture]
    pairs = [
        (i, k)
        for (i, first), (k, second) in combinations(enumerate(solids), 2)
        if any(_overlap(a, b, _FURNITURE_OVERLAP_M) for a in first for b in second)
    ]
    yield from bounded(
        error(
            f"furniture[{k}].position",
            f"{scene.furniture[i].name!r} and {scene.furniture[k].name!r} overlap",
            "move one of them",
            blocks=len(pairs) > _MAX_OVERLAPS,
        )
        for i, k in pairs
    )


def _overlap(a: Solid, b: Solid, more_than_m: float) -> bool:
    if math.hypot(a.x - b.x, a.y - b.y) > a.radius_m + b.radius_m:
        return False
    if not a.overlaps_height(b.z_min, b.z_max):
        return False
    return bool(gaps(np.array([[a.x, a.y]]), a, [b])[0] < -more_than_m)


def _supports(
    scene: Scene, assets: Assets, surfaces: Mapping[str, WorldSurface]
) -> Iterator[SceneFinding]:
    """Objects on levels that do not exist, or beyond the edge of those that do."""
    for i, item in enumerate(scene.objects):
        surface = surfaces.get(item.on)
        if surface is None:
            offer = ", ".join(sorted(surfaces))
            problem = f"nothing can lie on {item.on!r}"
            yield error(f"objects[{i}].on", problem, f"one of {offer}", blocks=True)
            continue
        past = _overhang_m(item, assets[item.asset], surface)
        if past > _OVERHANG_M:
            yield warning(
                f"objects[{i}].position",
                f"object {item.id} reaches {100 * past:.1f} cm past the edge of {item.on!r}",
                f"move it {100 * past:.1f} cm back",
            )


def _overhang_m(item: PlacedObject, asset: Asset, surface: WorldSurface) -> float:
    """How far the footprint of an object reaches past the edge of a surface; negative inside."""
    length, width, _ = asset.size
    cos, sin = math.cos(surface.yaw_rad), math.sin(surface.yaw_rad)
    dx, dy = item.position[0] - surface.center.x, item.position[1] - surface.center.y
    turn = math.radians(item.yaw_deg) - surface.yaw_rad
    c, s = abs(math.cos(turn)), abs(math.sin(turn))
    along = abs(cos * dx + sin * dy) + (c * length + s * width) / 2
    across = abs(-sin * dx + cos * dy) + (s * length + c * width) / 2
    return max(along - surface.half_x, across - surface.half_y)


def _objects(
    scene: Scene, assets: Assets, surfaces: Mapping[str, WorldSurface]
) -> Iterator[SceneFinding]:
    """Objects whose boxes are in each other."""
    solids = [
        (i, _as_placed(item, assets[item.asset], surfaces[item.on].center.z))
        for i, item in enumerate(scene.objects)
        if item.on in surfaces
    ]
    pairs = [
        (i, k) for (i, a), (k, b) in combinations(solids, 2) if _overlap(a, b, _OBJECT_OVERLAP_M)
    ]
    yield from bounded(
        error(
            f"objects[{k}].position",
            f"objects {scene.objects[i].id} and {scene.objects[k].id} overlap",
            "move one of them",
            blocks=len(pairs) > _MAX_OVERLAPS,
        )
        for i, k in pairs
    )


def _as_placed(item: PlacedObject, asset: Asset, z: float) -> Solid:
    length, width, height = asset.size
    yaw = math.radians(item.yaw_deg)
    # Flat things lie on each other just as badly as high ones stand in each other.
    return Solid(*item.position, length / 2, width / 2, yaw, z, z + max(height, _LEAST_HEIGHT_M))
