"""Whether a scene can be lived in: what no schema can say.

Overlaps, things that do not stay where they were put, places that nobody can walk to, objects that
cannot be seen or taken. Every finding names the field and the fix. Bounded in time: a few small
pictures for each object that is not in the first view.
"""

from __future__ import annotations

import math
import time
from collections.abc import Iterator

import numpy as np

from adamo_vh.geometry import Array, Camera, Vec3
from adamo_vh.runtime.builtin import BuiltinEngine
from adamo_vh.runtime.embodiment import EYE_HEIGHT_M, FOV_Y_RAD
from adamo_vh.runtime.inspection.arrangement import inspect_arrangement
from adamo_vh.runtime.inspection.finding import SceneFinding, error, warning
from adamo_vh.runtime.scenes.scene import Scene

_STAYED_M = 0.02
_UPRIGHT = 0.98
_PICTURE = (640, 360)
_PIXELS = 4
"""Least pixels of a visible object in such a small picture."""
_VANTAGES = 12
_ABOVE_M = 12.0
_FARTHEST_M = 19.0
"""What is farther from the camera is not drawn."""
_LONGEST_PX, _SHORTEST_PX = 1600, 200
_MARGIN = 1.08


def inspect_scene(
    scene: Scene, engine: BuiltinEngine, time_limit_s: float = 60.0
) -> tuple[SceneFinding, ...]:
    """Look a scene over.

    Args:
        scene: What the file says; nothing in it blocks the simulation.
        engine: The same scene, loaded; is reset.
        time_limit_s: When the time is over, the other objects are left out, with a warning.
    """
    until = time.monotonic() + time_limit_s
    engine.reset(0)
    return (
        *inspect_arrangement(scene),
        *_rest(scene, engine),
        *_floor(scene, engine),
        *_reach(scene, engine, until),
    )


def _rest(scene: Scene, engine: BuiltinEngine) -> Iterator[SceneFinding]:
    """Objects that do not stay where they were put."""
    state = engine.state()
    for i, item in enumerate(scene.objects):
        now = state.object(item.id)
        moved = now.box.center.horizontal_distance(Vec3(*item.position, 0.0))
        upright = now.box.orientation.matrix()[2, 2]
        if now.support != item.on or moved > _STAYED_M or upright < _UPRIGHT:
            yield error(
                f"objects[{i}].position",
                f"object {item.id} does not stay on {item.on!r}: it ends on {now.support!r}, "
                f"{moved:.2f} m away{'' if upright >= _UPRIGHT else ', tipped over'}",
                "put it on the surface, clear of its edge and of its neighbours",
            )


def _floor(scene: Scene, engine: BuiltinEngine) -> Iterator[SceneFinding]:
    """Where the agent starts, and whether every area can be walked to."""
    start = Vec3(*scene.agent.position, 0.0)
    floor = engine.body.floor()
    if not floor.can_stand(start):
        yield error("agent.position", "the body does not fit there", "move it 0.3 m off furniture")
        return
    places = floor.ways_from(start).places()
    for i, area in enumerate(scene.areas):
        inside = (places >= area.min).all(axis=1) & (places <= area.max).all(axis=1)
        if not inside.any():
            yield error(f"areas[{i}]", f"{area.name!r} cannot be walked to", "clear a way to it")


def _reach(scene: Scene, engine: BuiltinEngine, until: float) -> Iterator[SceneFinding]:
    """Whether every object can be seen from somewhere, and taken."""
    start = engine.body.state().position
    if not engine.body.floor().can_stand(start):
        return
    places = engine.body.floor().ways_from(start).places()
    first_view, body = engine.capture(1920, 1080), engine.body.info
    for i, item in enumerate(scene.objects):
        if time.monotonic() > until:
            yield warning(
                f"objects[{i}]",
                "reach and sight of this and the following objects are not checked: out of time",
                "make the scene smaller",
            )
            return
        target = engine.world.box(item.id).center
        if engine.body.way_to(target) is None:
            yield error(
                f"objects[{i}].position",
                f"object {item.id} cannot be reached from any place to stand",
                f"put it within {body.reach_m:g} m of open floor and below {body.reach_top_m:g} m",
            )
        if item.id not in first_view.objects and not _is_visible(engine, item.id, target, places):
            yield error(
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
        camera = Camera.towards(eyes, target, FOV_Y_RAD, _PICTURE)
        layers = engine.stage.renderer.layers(engine.data, camera)
        if any((layer.ids == object_id).sum() >= _PIXELS for layer in layers):
            return True
    return False


def cameras(scene: Scene, engine: BuiltinEngine) -> dict[str, Camera]:
    """Views that show a scene: from above, from the start, and from each corner."""
    room = scene.room
    middle = Vec3((room.x_min + room.x_max) / 2, (room.y_min + room.y_max) / 2, 0.0)
    found = {"top": _top(scene, middle)}
    corners = [(x, y) for x in (room.x_min, room.x_max) for y in (room.y_min, room.y_max)]
    for number, (x, y) in enumerate(corners, start=1):
        inward = Vec3(x, y, 0.0) + (middle - Vec3(x, y, 0.0)) * 0.06
        eyes = Vec3(inward.x, inward.y, min(1.8, room.height_m - 0.3))
        line = middle - eyes
        yaw = math.atan2(line.y, line.x)
        found[f"corner{number}"] = Camera(eyes, yaw, -0.25, math.radians(70), 1600, 900)
    return found


def _top(scene: Scene, middle: Vec3) -> Camera:
    """From far above: the ceiling is drawn from below only, so that one looks into the room."""
    room = scene.room
    height = _ABOVE_M if room.height_m < _ABOVE_M - 1.0 else min(room.height_m, _FARTHEST_M) - 0.15
    sides = room.x_max - room.x_min, room.y_max - room.y_min
    width, depth = (max(_SHORTEST_PX, round(_LONGEST_PX * side / max(sides))) for side in sides)
    half = max(sides) / 2 * depth / _LONGEST_PX * _MARGIN
    eyes = Vec3(middle.x, middle.y, height)
    straight_down = -math.pi / 2 + 1e-4
    return Camera(eyes, math.pi / 2, straight_down, 2 * math.atan2(half, height), width, depth)
