"""Checks of pictures, of what they show where, and of rays."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from adamo_vh.action_server.frame_check import frame_fault
from adamo_vh.geometry import Array, Box, Vec3
from adamo_vh.observation import NOTHING, Percept
from adamo_vh.service.conformance.check import (
    SIZE_PX,
    CheckFunction,
    NotTriedError,
    Probe,
    pixels_of,
    unchanged,
)

_SIZES_PX = (SIZE_PX, (320, 180), (200, 200))
_OFF_PX = 3.0
"""How far a pixel may be outside of the projected box."""


def _frames(probe: Probe) -> Iterator[str]:
    for width, height in _SIZES_PX:
        percept = probe.see((width, height))
        if percept.rgb.shape != (height, width, 3) or percept.rgb.dtype != np.uint8:
            yield f"{width}x{height}: the picture is {percept.rgb.shape} {percept.rgb.dtype}"
        if any(layer.shape != (height, width) for layer in percept.id_layers):
            yield f"{width}x{height}: a layer of ids has another shape"
        if (percept.camera.width_px, percept.camera.height_px) != (width, height):
            yield f"{width}x{height}: the camera says another size"


def _drawn(probe: Probe) -> Iterator[str]:
    rgb = probe.see().rgb
    if not rgb.any():
        yield "the picture is black"
    elif len(np.unique(rgb[::8, ::8].reshape(-1, 3), axis=0)) < 20:
        yield "the picture has hardly any colours"


def _camera(probe: Probe) -> Iterator[str]:
    percept, info = probe.see(), probe.body.info
    camera, body = percept.camera, percept.body
    if camera.position.distance(body.eyes) > 0.01:
        yield f"the camera is at {camera.position}, the eyes are at {body.eyes}"
    if abs(camera.fov_y_rad - info.fov_y_rad) > 0.01:
        yield f"it sees {camera.fov_y_rad:.3f} rad vertically, the body {info.fov_y_rad:.3f}"
    u, v, depth = camera.project(body.gaze.array()[None])[0]
    if depth <= 0 or math.hypot(u - SIZE_PX[0] / 2, v - SIZE_PX[1] / 2) > _OFF_PX:
        yield f"the gaze {body.gaze} is at pixel ({u:.0f}, {v:.0f}), not in the middle"


def _moment(probe: Probe) -> Iterator[str]:
    percept = probe.see()
    if percept.body != probe.body.state():
        yield "the body in the answer is not the body's state"
    if percept.body != probe.state().body:
        yield "the body in the answer is not that of the state"


def _listed(probe: Probe) -> Iterator[str]:
    percept, state = probe.see(), probe.state()
    shown = {int(i) for layer in percept.id_layers for i in np.unique(layer)} - {NOTHING}
    if shown != set(percept.objects):
        yield f"pixels show {sorted(shown)}, listed are {sorted(percept.objects)}"
    there = {item.id: item for item in state.objects}
    for number, item in percept.objects.items():
        if number not in there:
            yield f"object {number} is seen and not in the state"
        elif item.box != there[number].box:
            yield f"object {number} is seen at {item.box.center}, and is at {there[number].box}"
    if not shown:
        yield "no object is in the first view; let the body start where it sees some"


def _strays(percept: Percept, flip: Array) -> float:
    """Share of the objects' pixels that are not inside their projected boxes.

    Args:
        percept: A view.
        flip: (2,) 1, or -1 where the picture is mirrored before.
    """
    outside, count = 0, 0
    middle = np.array([percept.camera.width_px, percept.camera.height_px]) / 2
    for number, item in percept.objects.items():
        corners = percept.camera.project(item.box.corners())
        pixels = (pixels_of(percept, number) - middle) * flip + middle
        if (corners[:, 2] <= 0.05).any() or not len(pixels) or number == percept.body.held:
            continue
        low, high = corners[:, :2].min(axis=0) - _OFF_PX, corners[:, :2].max(axis=0) + _OFF_PX
        outside += int((~((pixels >= low) & (pixels <= high)).all(axis=1)).sum())
        count += len(pixels)
    return outside / count if count else 1.0


def _projected(probe: Probe) -> Iterator[str]:
    share = _strays(probe.see(), np.array([1, 1]))
    if share > 0.02:
        yield f"{share:.0%} of the objects' pixels lie outside of their projected boxes"


def _handed(probe: Probe) -> Iterator[str]:
    percept = probe.see()
    straight = _strays(percept, np.array([1, 1]))
    for what, flip in (("left and right", (-1, 1)), ("up and down", (1, -1))):
        if straight > 0.3 and _strays(percept, np.array(flip)) < straight / 2:
            yield f"{what} are exchanged: the picture fits better when it is mirrored"


def _colours_fit(probe: Probe) -> Iterator[str]:
    percept = probe.see()
    if percept.from_boxes:
        return
    grey = percept.rgb.astype(np.float64).sum(axis=2)
    steps = np.abs(np.diff(grey, axis=1))[:-1] + np.abs(np.diff(grey, axis=0))[:, :-1]
    ids = percept.id_layers[0]
    edges = (np.diff(ids, axis=1)[:-1] != 0) | (np.diff(ids, axis=0)[:, :-1] != 0)
    if edges.sum() < 50:
        raise NotTriedError("too few objects are in the first view")
    own = float(steps[edges].mean())
    for what, turned in (("mirrored", edges[:, ::-1]), ("upside down", edges[::-1])):
        if float(steps[turned].mean()) > own:
            yield f"outlines of the ids fit the colours better when they are {what}"
    if own < 1.2 * float(steps.mean()):
        yield "outlines of the ids do not lie on edges of the colours"


def _seeing(probe: Probe) -> Iterator[str]:
    before = probe.state()
    probe.see()
    probe.see((320, 180))
    yield from unchanged(before, probe.state())


def _gaze_follows(probe: Probe) -> Iterator[str]:
    first = probe.see()
    here = first.body
    behind = here.eyes + (here.eyes - here.gaze)
    probe.body.look(Vec3(behind.x, behind.y, 1.0))
    second = probe.see()
    if np.array_equal(first.rgb, second.rgb):
        yield "the colours are the same after the body turned round"
    if set(first.objects) == set(second.objects) and len(first.objects) > 3:
        yield "the same objects are seen after the body turned round"


def _left_out(probe: Probe) -> Iterator[str]:
    percept = probe.see()
    if fault := frame_fault(percept, probe.state(), probe.body):
        yield fault


def _same_picture(probe: Probe) -> Iterator[str]:
    first, second = probe.see(), probe.see()
    if not np.array_equal(first.rgb, second.rgb):
        yield "two pictures of the same moment differ"


def _closeup(probe: Probe) -> Iterator[str]:
    view = probe.see()
    seen = sorted(probe.visible(view), key=lambda item: -item.pixels)
    if not seen:
        raise NotTriedError("no object is in the first view")
    before, item = probe.state(), view.objects[seen[0].id]
    point, fov = item.box.center, view.camera.fov_y_rad / 4
    near = probe.body.closeup(point, fov, 256, 256)
    if near.rgb.shape != (256, 256, 3):
        yield f"the close-up is {near.rgb.shape}"
    if near.camera.position.distance(view.camera.position) > 0.01:
        yield "the close-up is not taken from the eyes"
    u, v, depth = near.camera.project(point.array()[None])[0]
    if depth <= 0 or math.hypot(u - 128, v - 128) > _OFF_PX:
        yield f"its point is at pixel ({u:.0f}, {v:.0f}), not in the middle"
    if abs(near.camera.fov_y_rad - fov) > 0.01:
        yield f"it sees {near.camera.fov_y_rad:.3f} rad instead of {fov:.3f}"
    if item.id not in near.objects:
        yield f"object {item.id} is not in the picture that is centred on it"
    if _strays(near, np.array([1, 1])) > 0.05:
        yield "pixels lie outside of the projected boxes"
    yield from unchanged(before, probe.state())


def _rays_count(probe: Probe) -> Iterator[str]:
    percept = probe.see()
    u, v = np.meshgrid((np.arange(6) + 0.5) * SIZE_PX[0] / 6, (np.arange(6) + 0.5) * SIZE_PX[1] / 6)
    ways = percept.camera.rays(np.stack([u.ravel(), v.ravel()], axis=1))
    hits = probe.body.rays(percept.camera.position, ways)
    if len(hits) != 36:
        yield f"{len(hits)} answers for 36 rays"
        return
    for way, hit in zip(ways, hits, strict=True):
        if hit is None:
            continue
        offset = hit.array() - percept.camera.position.array()
        if np.linalg.norm(np.cross(offset, way)) > 0.01 or offset @ way <= 0:
            yield f"the hit {hit} is not on its ray"
            return
    if sum(hit is not None for hit in hits) < 18:
        yield "most rays of the first view hit nothing: walls and floor stop rays too"


def _rays_floor(probe: Probe) -> Iterator[str]:
    place = probe.place()
    (hit,) = probe.body.rays(Vec3(place.x, place.y, 1.0), np.array([[0.0, 0.0, -1.0]]))
    if hit is None or abs(hit.z) > 0.03 or hit.horizontal_distance(place) > 0.01:
        yield f"a ray down at {place} hits {hit}, not the floor at z = 0"


def _rays_objects(probe: Probe) -> Iterator[str]:
    percept = probe.see()
    seen = [item for item in probe.visible(percept) if item.pixels >= 60]
    if not seen:
        raise NotTriedError("no object is large enough in the first view")
    missed = []
    for item in seen:
        pixels = pixels_of(percept, item.id)
        middle = np.median(pixels, axis=0)
        chosen = pixels[np.argsort(np.linalg.norm(pixels - middle, axis=1))[:1]]
        (hit,) = probe.body.rays(percept.camera.position, percept.camera.rays(chosen))
        if hit is None or not _is_on(hit, percept.objects[item.id].box):
            missed.append(item.id)
    if len(missed) > 0.4 * len(seen):
        yield f"rays through the pixels of objects {missed} of {len(seen)} hit something else"


def _rays_pass_body(probe: Probe) -> Iterator[str]:
    body = probe.body.state()
    (hit,) = probe.body.rays(body.eyes, np.array([[0.0, 0.0, -1.0]]))
    if hit is None or hit.z > 0.05:
        yield f"a ray from the eyes down hits {hit}: the body itself does not stop rays"


def _rays_pass_hand(probe: Probe) -> Iterator[str]:
    number = probe.take()
    body = probe.body.state()
    if body.held_box is None:
        raise NotTriedError("the hand feels no box")
    way = body.held_box.center - body.eyes
    (hit,) = probe.body.rays(body.eyes, (way.array() / way.norm())[None])
    if hit is not None and _is_on(hit, body.held_box, 0.0):
        yield f"a ray from the eyes hits object {number} in the hand"


def _is_on(hit: Vec3, box: Box, skin_m: float = 0.03) -> bool:
    local = (hit.array() - box.center.array()) @ box.orientation.matrix()
    return bool((np.abs(local) <= box.size.array() / 2 + skin_m).all())


SIGHT_CHECKS: dict[str, CheckFunction] = {
    "capture-size": _frames,
    "capture-colours": _drawn,
    "capture-camera": _camera,
    "capture-moment": _moment,
    "capture-objects": _listed,
    "capture-projection": _projected,
    "capture-handedness": _handed,
    "capture-layers": _colours_fit,
    "capture-passive": _seeing,
    "capture-turns": _gaze_follows,
    "capture-complete": _left_out,
    "capture-repeatable": _same_picture,
    "closeup-aim": _closeup,
    "rays-line": _rays_count,
    "rays-floor": _rays_floor,
    "rays-objects": _rays_objects,
    "rays-body": _rays_pass_body,
    "rays-hand": _rays_pass_hand,
}
