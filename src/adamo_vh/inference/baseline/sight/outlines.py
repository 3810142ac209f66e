"""How large each kind of thing would look where a thing stands, beside how large it does look."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from statistics import median

import numpy as np
from numpy.typing import NDArray

from adamo_vh.geometry import Camera, Vec3
from adamo_vh.inference.baseline.prompt.reading import Listed, Prompt
from adamo_vh.inference.baseline.sight.marks import PixelBox
from adamo_vh.inference.baseline.sight.prototypes import Prototype, prototypes

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]

_TURNS = 8
_RIM_POINTS = 12
_SPREAD = 0.2
"""Standard deviation of the logarithm of a side, within a class."""
_BOX_OFF_PX = 1.5
_LOPSIDED, _MIDDLE_OFF_PX = 1.5, 3.0
"""From which on a side of a box is so much nearer to the middle that something hides a part."""
_MOST = 12.0
_NEAREST_M = 0.2


def misfits(things: Sequence[Listed], camera: Camera) -> Mapping[str, Mapping[str, float]]:
    """How badly each prototype, scaled to the volume, fills each thing's box in the frame.

    Args:
        things: Their centres, volumes and boxes are told.
        camera: Of the frame.

    Returns:
        By tag, negative log likelihoods by class, up to a constant; things without a box, or too
        near to tell, are left out.
    """
    known = [
        (thing, thing.box_px)
        for thing in things
        if thing.box_px and thing.position.distance(camera.position) >= _NEAREST_M
    ]
    if not known:
        return {}
    outlines = _outlines()
    volumes = np.array([[max(thing.volume_cm3, 0.1)] for thing, _ in known])
    centres = np.array([[thing.position.array()] for thing, _ in known])
    scales = np.cbrt(volumes / outlines.volumes_cm3)[:, outlines.class_of_point]
    points = centres + outlines.points * scales[..., None]
    pixels = camera.project(points.reshape(-1, 3)).reshape(points.shape)
    corners = pixels[..., :2]
    spans = np.maximum.reduceat(corners, outlines.starts, axis=1) - np.minimum.reduceat(
        corners, outlines.starts, axis=1
    )
    middles = camera.project(centres[:, 0])[:, :2]
    seen = np.array([_whole(box, *uv) for (_, box), uv in zip(known, middles, strict=True)])
    seen = seen[:, None]
    # A box is told, or found in the picture, to about a pixel on either side.
    off = np.log(seen / np.maximum(spans, 1.0)) / np.hypot(_SPREAD, _BOX_OFF_PX / seen)
    best = np.minimum.reduceat((off**2).sum(axis=2) / 2, outlines.first_turns, axis=1)
    nearest = pixels[..., 2].min(axis=1)
    return {
        thing.tag: dict(zip(prototypes(), row.tolist(), strict=True))
        for (thing, _), row, depth in zip(known, np.minimum(best, _MOST), nearest, strict=True)
        if depth >= _NEAREST_M / 2
    }


def _whole(box: PixelBox, u: float, v: float) -> tuple[float, float]:
    """Width and height of a box, with what is hidden of it: its middle is where the centre is."""
    left, top, right, bottom = box
    return _side(left, u, right), _side(top, v, bottom)


def _side(low: float, middle: float, high: float) -> float:
    longer, shorter = max(high - middle, middle - low), min(high - middle, middle - low)
    is_hidden = longer > _LOPSIDED * max(shorter, 0.0) + _MIDDLE_OFF_PX
    return max(2 * longer if is_hidden else high - low, 1.0)


@dataclass(frozen=True, slots=True)
class _Outlines:
    """Points around each prototype in each turn, one after the other."""

    points: Floats
    """(points, 3), about the centre, metres."""
    class_of_point: Indices
    starts: Indices
    """Where the points of each turn of each class begin."""
    first_turns: Indices
    """The first turn of each class."""
    volumes_cm3: Floats


@cache
def _outlines() -> _Outlines:
    points: list[Floats] = []
    class_of_point: list[int] = []
    first_turns: list[int] = []
    for index, prototype in enumerate(prototypes().values()):
        first_turns.append(len(points))
        # Turned upright, what is round looks the same.
        turns = 1 if _is_round(prototype) else _TURNS
        points += [_outline(prototype, turn * math.pi / _TURNS) for turn in range(turns)]
        class_of_point += [index] * sum(len(turn) for turn in points[first_turns[-1] :])
    lengths = [len(turn) for turn in points]
    return _Outlines(
        np.concatenate(points),
        np.array(class_of_point),
        np.cumsum([0, *lengths[:-1]]),
        np.array(first_turns),
        np.array([p.volume_cm3 for p in prototypes().values()]),
    )


def _is_round(prototype: Prototype) -> bool:
    return prototype.size_m[0] == prototype.size_m[1]


def _outline(prototype: Prototype, angle: float) -> Floats:
    """The rims of an upright cylinder, or the corners of a turned box, about its centre."""
    length, width, height = prototype.size_m
    if _is_round(prototype):
        around = np.arange(_RIM_POINTS) * 2 * math.pi / _RIM_POINTS
        flat = np.stack([np.cos(around), np.sin(around)], axis=1) * length / 2
    else:
        corners = np.array([(1, 1), (1, -1), (-1, -1), (-1, 1)]) * (length / 2, width / 2)
        cos, sin = math.cos(angle), math.sin(angle)
        flat = corners @ np.array([(cos, sin), (-sin, cos)])
    levels = [np.full((len(flat), 1), z) for z in (-height / 2, height / 2)]
    return np.concatenate([np.hstack([flat, level]) for level in levels])


EYES_M = 1.6
"""Height of a grown person's eyes."""
_EYES_AHEAD_M = 0.08
"""How far they are in front of the body's axis."""
_USUAL_FOV_RAD = math.radians(74)
_OFF_AXIS = 0.12
"""Things nearer to the axis (as a tangent) say too little about the focal length."""


def camera_of(prompt: Prompt) -> Camera | None:
    """The pinhole camera of the latest frame; None if the text does not tell where the eyes look.

    The focal length is not told; it follows from the places of the listed things in the world and
    of their boxes in the frame.
    """
    frame, gaze, position = prompt.frame, prompt.body.gaze, prompt.body.position
    if frame is None or gaze is None:
        return None
    heading = prompt.body.heading_rad
    if heading is None:
        heading = math.atan2(gaze.y - position.y, gaze.x - position.x)
    eyes = position + Vec3(
        _EYES_AHEAD_M * math.cos(heading), _EYES_AHEAD_M * math.sin(heading), EYES_M
    )
    line = gaze - eyes
    flat = math.hypot(line.x, line.y)
    yaw = math.atan2(line.y, line.x) if flat > 1e-6 else heading
    camera = Camera(
        eyes, yaw, math.atan2(line.z, flat), _USUAL_FOV_RAD, frame.width_px, frame.height_px
    )
    focal = _focal_px(prompt, camera)
    if focal is None:
        return camera
    fov = 2 * math.atan(frame.height_px / 2 / focal)
    return Camera(eyes, camera.yaw_rad, camera.pitch_rad, fov, frame.width_px, frame.height_px)


def _focal_px(prompt: Prompt, camera: Camera) -> float | None:
    boxes = [(thing.position, thing.box_px) for thing in prompt.things if thing.box_px]
    if len(boxes) < 3:
        return None
    pixels = camera.project(np.array([position.array() for position, _ in boxes]))
    found = []
    for (u, v, depth), (_, box) in zip(pixels, boxes, strict=True):
        if depth < 0.3 or box is None:
            continue
        middle = ((box[0] + box[2]) / 2, (box[1] + box[3]) / 2)
        axes = ((u, middle[0], camera.width_px), (v, middle[1], camera.height_px))
        for projected, seen, size in axes:
            tangent = (projected - size / 2) / camera.focal_px
            if abs(tangent) > _OFF_AXIS:
                found.append((seen - size / 2) / tangent)
    usual = camera.focal_px
    plausible = [focal for focal in found if usual / 3 < focal < usual * 3]
    return median(plausible) if len(plausible) >= 4 else None
