"""Whether a scene can be lived in: what no schema can say.

Overlaps, things that do not stay where they were put, places that nobody can walk to, objects that
cannot be seen or taken. Every finding names the field and the fix. Bounded in time: a few small
pictures for each object that is not in the first view.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from enum import StrEnum
from itertools import combinations

import numpy as np

from adamo.geometry import Array, Camera, Vec3
from adamo.runtime.assets.bake import load_asset
from adamo.runtime.builtin import BuiltinEngine
from adamo.runtime.embodiment import EYE_HEIGHT_M, FOV_Y_RAD
from adamo.runtime.scenes.scene import PlacedObject, Scene
from adamo.runtime.solids import Solid, gaps
from adamo.runtime.world import furniture_solids

_OVERLAP_M = 0.02
_STAYED_M = 0.02
_UPRIGHT = 0.98
_PICTURE = (640, 360)
_PIXELS = 4
"""Least pixels of a visible object in such a small picture."""
_VANTAGES = 12
_TOP_FOV_RAD = math.radians(120)


class Severity(StrEnum):
    """How bad it is."""

    ERROR = "error"
    WARNING = "warning"


@dataclass(frozen=True, slots=True)
class SceneFinding:
    """One thing that is wrong."""

    severity: Severity
    where: str
    """Field of the scene file."""
    problem: str
    fix: str


def inspect_scene(scene: Scene, engine: BuiltinEngine) -> tuple[SceneFinding, ...]:
    """Look a scene over.

    Args:
        scene: What the file says.
        engine: The same scene, loaded; is reset.
    """
    engine.reset(0)
    return (
        *_lights(scene),
        *_furniture(scene),
        *_objects(scene, engine),
        *_floor(scene, engine),
        *_reach(scene, engine),
    )


def _error(where: str, problem: str, fix: str) -> SceneFinding:
    return SceneFinding(Severity.ERROR, where, problem, fix)


def _lights(scene: Scene) -> Iterator[SceneFinding]:
    shadows = sum(light.shadow for light in scene.lights)
    if shadows > 1:
        yield SceneFinding(
            Severity.WARNING,
            "lights",
            f"{shadows} lights cast shadows, and each draws the whole scene again",
            "leave shadow = true on one light",
        )


def _furniture(scene: Scene) -> Iterator[SceneFinding]:
    solids = [furniture_solids(piece, load_asset(piece.asset)) for piece in scene.furniture]
    for (i, first), (k, second) in combinations(enumerate(solids), 2):
        if any(_overlap(a, b) for a in first for b in second):
            names = f"{scene.furniture[i].name!r} and {scene.furniture[k].name!r}"
            yield _error(f"furniture[{k}].position", f"{names} overlap", "move one of them")


def _overlap(a: Solid, b: Solid) -> bool:
    apart = gaps(np.array([[a.x, a.y]]), a, [b])[0]
    return a.overlaps_height(b.z_min, b.z_max) and bool(apart < -_OVERLAP_M)


def _objects(scene: Scene, engine: BuiltinEngine) -> Iterator[SceneFinding]:
    """Objects that are in each other, or do not stay where they were put."""
    state = engine.state()
    solids = [_as_placed(item) for item in scene.objects]
    for (i, a), (k, b) in combinations(enumerate(solids), 2):
        if scene.objects[i].on == scene.objects[k].on and _overlap(a, b):
            ids = f"{scene.objects[i].id} and {scene.objects[k].id}"
            yield _error(f"objects[{k}].position", f"objects {ids} overlap", "move one of them")
    for i, item in enumerate(scene.objects):
        now = state.object(item.id)
        moved = now.box.center.horizontal_distance(Vec3(*item.position, 0.0))
        upright = now.box.orientation.matrix()[2, 2]
        if now.support != item.on or moved > _STAYED_M or upright < _UPRIGHT:
            yield _error(
                f"objects[{i}].position",
                f"object {item.id} does not stay on {item.on!r}: it ends on {now.support!r}, "
                f"{moved:.2f} m away{'' if upright >= _UPRIGHT else ', tipped over'}",
                "put it on the surface, clear of its edge and of its neighbours",
            )


def _as_placed(item: PlacedObject) -> Solid:
    x, y, z = load_asset(item.asset).size
    return Solid(*item.position, x / 2, y / 2, math.radians(item.yaw_deg), 0.0, z)


def _floor(scene: Scene, engine: BuiltinEngine) -> Iterator[SceneFinding]:
    """Where the agent starts, and whether every area can be walked to."""
    start = Vec3(*scene.agent.position, 0.0)
    floor = engine.floor()
    if not floor.can_stand(start):
        yield _error("agent.position", "the body does not fit there", "move it 0.3 m off furniture")
        return
    places = floor.ways_from(start).places()
    for i, area in enumerate(scene.areas):
        inside = (places >= area.min).all(axis=1) & (places <= area.max).all(axis=1)
        if not inside.any():
            yield _error(f"areas[{i}]", f"{area.name!r} cannot be walked to", "clear a way to it")


def _reach(scene: Scene, engine: BuiltinEngine) -> Iterator[SceneFinding]:
    """Whether every object can be seen from somewhere, and taken."""
    start = engine.body().position
    if not engine.floor().can_stand(start):
        return
    places = engine.floor().ways_from(start).places()
    first_view = engine.capture(1920, 1080)
    for i, item in enumerate(scene.objects):
        target = engine.world.box(item.id).center
        if engine.way_to(target, 0.25) is None:
            yield _error(
                f"objects[{i}].position",
                f"object {item.id} cannot be reached from any place to stand",
                "put it within 0.9 m of open floor and below 2.07 m",
            )
        if item.id not in first_view.objects and not _is_visible(engine, item.id, target, places):
            yield _error(
                f"objects[{i}].position",
                f"object {item.id} cannot be seen from the places tried",
                "move it out from behind other things",
            )


def _is_visible(engine: BuiltinEngine, object_id: int, target: Vec3, places: Array) -> bool:
    offset = places - np.array([target.x, target.y])
    distance = np.hypot(offset[:, 0], offset[:, 1])
    good = places[(distance > 0.45) & (distance < 2.2)]
    step = max(1, len(good) // _VANTAGES)
    for x, y in good[::step][: 2 * _VANTAGES]:
        eyes = Vec3(float(x), float(y), EYE_HEIGHT_M)
        camera = _looking(eyes, target)
        layers = engine.stage.renderer.layers(engine.data, camera)
        if any((layer.ids == object_id).sum() >= _PIXELS for layer in layers):
            return True
    return False


def _looking(eyes: Vec3, target: Vec3) -> Camera:
    line = target - eyes
    pitch = math.atan2(line.z, math.hypot(line.x, line.y))
    return Camera(eyes, math.atan2(line.y, line.x), pitch, FOV_Y_RAD, *_PICTURE)


def cameras(scene: Scene, engine: BuiltinEngine) -> dict[str, Camera]:
    """Views that show a scene: from above, from the start, and from each corner."""
    room = scene.room
    middle = Vec3((room.x_min + room.x_max) / 2, (room.y_min + room.y_max) / 2, 0.0)
    above = Vec3(middle.x, middle.y, room.height_m - 0.15)
    size = (1600, 1200)
    found = {"top": Camera(above, math.pi / 2, -math.pi / 2 + 1e-4, _TOP_FOV_RAD, *size)}
    corners = [(x, y) for x in (room.x_min, room.x_max) for y in (room.y_min, room.y_max)]
    for number, (x, y) in enumerate(corners, start=1):
        inward = Vec3(x, y, 0.0) + (middle - Vec3(x, y, 0.0)) * 0.06
        eyes = Vec3(inward.x, inward.y, min(1.8, room.height_m - 0.3))
        line = middle - eyes
        yaw = math.atan2(line.y, line.x)
        found[f"corner{number}"] = Camera(eyes, yaw, -0.25, math.radians(70), 1600, 900)
    return found
