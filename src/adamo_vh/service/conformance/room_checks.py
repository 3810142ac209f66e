"""Checks of what an engine says of its scene, of its state, and of a reset."""

from __future__ import annotations

import math
from collections.abc import Iterator

from adamo_vh.action_server.soundness import state_faults
from adamo_vh.engine import FLOOR, supporting_object
from adamo_vh.service.conformance.check import TOUCH_M, CheckFunction, Probe, unchanged


def _extent(probe: Probe) -> Iterator[str]:
    room = probe.world.scene
    if not (room.x_min < room.x_max and room.y_min < room.y_max and room.height_m > 1.0):
        yield f"x {room.x_min} to {room.x_max}, y {room.y_min} to {room.y_max}, {room.height_m} m"
    if not room.name:
        yield "the scene has no name"


def _areas(probe: Probe) -> Iterator[str]:
    room = probe.world.scene
    for area in room.areas:
        inside = room.x_min - 0.01 <= area.x_min < area.x_max <= room.x_max + 0.01
        if not (inside and room.y_min - 0.01 <= area.y_min < area.y_max <= room.y_max + 0.01):
            yield f"area {area.name!r} is not inside the room"


def _names(probe: Probe) -> Iterator[str]:
    names = probe.world.object_names
    if unnamed := sorted({item.id for item in probe.state().objects} - set(names)):
        yield f"object_names lacks {unnamed}"
    for item in probe.state().objects:
        if item.id in names and item.class_name != names[item.id]:
            yield f"object {item.id} is {item.class_name!r} and {names[item.id]!r}"


def _body(probe: Probe) -> Iterator[str]:
    info = probe.body.info
    for name, low, high in (
        ("radius_m", 0.05, 1.0),
        ("eye_height_m", 0.3, 2.5),
        ("fov_y_rad", 0.2, 2.5),
        ("reach_m", 0.2, 3.0),
        ("reach_top_m", 0.3, 3.5),
        ("correction_m", 0.0, 5.0),
    ):
        value = getattr(info, name)
        if not low <= value <= high:
            yield f"{name} is {value:g}, not {low:g} to {high:g}"


def _eyes(probe: Probe) -> Iterator[str]:
    body, info = probe.state().body, probe.body.info
    if abs(body.eyes.z - info.eye_height_m) > 0.1:
        yield f"the eyes are at {body.eyes.z:.2f} m, and eye_height_m is {info.eye_height_m:.2f}"
    if body.eyes.horizontal_distance(body.position) > 0.4:
        yield f"the eyes {body.eyes} are not above the body {body.position}"
    if not -math.pi - 1e-6 <= body.heading_rad <= math.pi + 1e-6:
        yield f"heading_rad is {body.heading_rad}, not in (-pi, pi]"


def _sound(probe: Probe) -> Iterator[str]:
    yield from state_faults(probe.state())


def _boxes(probe: Probe) -> Iterator[str]:
    for item in probe.state().objects:
        size, turn = item.box.size, item.box.orientation
        if not (min(size.x, size.y, size.z) >= 0.001 and max(size.x, size.y, size.z) <= 3.0):
            yield f"object {item.id} is {size} large"
        if abs(float((turn.array() ** 2).sum()) - 1) > 1e-3:
            yield f"the orientation of object {item.id} is no unit quaternion"


def _supports(probe: Probe) -> Iterator[str]:
    state = probe.state()
    tops = {s.support: s.center.z for piece in state.furniture for s in piece.surfaces}
    tops[FLOOR] = 0.0
    for item in state.objects:
        if item.support is None or (under := supporting_object(item.support)) == item.id:
            yield f"object {item.id} rests on {item.support}"
        elif under is not None:
            if under not in probe.world.object_names:
                yield f"object {item.id} rests on object {under}, which is not there"
        elif item.support not in tops and state.furniture:
            yield f"object {item.id} rests on {item.support!r}, which no furniture is called"
        elif abs(item.box.bottom_z - tops.get(item.support, item.box.bottom_z)) > TOUCH_M:
            gap = item.box.bottom_z - tops[item.support]
            yield f"object {item.id} is {gap:+.3f} m from the top of {item.support!r}"


def _furniture(probe: Probe) -> Iterator[str]:
    for piece in probe.state().furniture:
        points = piece.points
        closed = zip(points, points[1:] + points[:1], strict=True)
        if sum(a[0] * b[1] - a[1] * b[0] for a, b in closed) <= 0:
            yield f"the outline of {piece.name!r} is not counter-clockwise seen from above"
        if not piece.bottom_m <= piece.top_m:
            yield f"{piece.name!r} goes from {piece.bottom_m} to {piece.top_m} m"


def _reset(probe: Probe) -> Iterator[str]:
    before = probe.state()
    probe.body.look(before.body.position)
    probe.body.walk(before.scene.nearest(before.body.eyes + before.body.eyes))
    for item in before.objects[:3]:
        probe.body.pick(item.id)
    probe.world.reset(0)
    yield from unchanged(before, probe.state())


def _repeat(probe: Probe) -> Iterator[str]:
    first, second = probe.state(), probe.state()
    if first.hash() != second.hash():
        yield "two states in a row differ: something moves while nobody acts"


ROOM_CHECKS: dict[str, CheckFunction] = {
    "scene-extent": _extent,
    "scene-areas": _areas,
    "scene-names": _names,
    "scene-furniture": _furniture,
    "body-sizes": _body,
    "body-eyes": _eyes,
    "state-sound": _sound,
    "state-boxes": _boxes,
    "state-supports": _supports,
    "state-still": _repeat,
    "reset-start": _reset,
}
