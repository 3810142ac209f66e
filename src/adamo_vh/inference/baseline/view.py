"""The camera behind a frame, worked out from the text: where the eyes are and how wide they see."""

from __future__ import annotations

import math
from statistics import median

import numpy as np

from adamo_vh.geometry import Camera, Vec3
from adamo_vh.inference.baseline.reading import Prompt

_EYES_M = 1.6
"""Height of a grown person's eyes."""
_EYES_AHEAD_M = 0.08
"""How far they are in front of the body's axis."""
_USUAL_FOV_RAD = math.radians(65)
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
        _EYES_AHEAD_M * math.cos(heading), _EYES_AHEAD_M * math.sin(heading), _EYES_M
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
