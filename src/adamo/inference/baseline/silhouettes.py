"""How large each kind of thing would look where a thing stands, beside how large it does look."""

from __future__ import annotations

import math
from collections.abc import Mapping
from functools import cache

import numpy as np
from numpy.typing import NDArray

from adamo.geometry import Camera
from adamo.inference.baseline.prototypes import Prototype, prototypes
from adamo.inference.baseline.reading import Listed

Outlines = NDArray[np.float64]

_TURNS = 8
_RIM_POINTS = 12
_SPREAD = 0.16
"""Standard deviation of the logarithm of a side, within a class."""
_MOST = 12.0
_NEAREST_M = 0.2


def misfits(thing: Listed, camera: Camera) -> Mapping[str, float]:
    """How badly each prototype, scaled to the volume, fills the thing's box in the frame.

    Args:
        thing: Its centre, volume and box are told.
        camera: Of the frame.

    Returns:
        Negative log likelihood by class, up to a constant; empty if the thing has no box or is
        too near to tell.
    """
    if thing.box_px is None or thing.position.distance(camera.position) < _NEAREST_M:
        return {}
    outlines, volumes_cm3 = _outlines()
    scale = np.cbrt(max(thing.volume_cm3, 0.1) / volumes_cm3)
    points = outlines * scale[:, None, None, None] + thing.position.array()
    pixels = camera.project(points.reshape(-1, 3)).reshape(points.shape)
    if (pixels[..., 2] < _NEAREST_M / 2).any():
        return {}
    spans = np.ptp(pixels[..., :2], axis=2)
    left, top, right, bottom = thing.box_px
    seen = np.array([max(right - left, 1), max(bottom - top, 1)], float)
    off = np.log(seen / np.maximum(spans, 1.0)) / _SPREAD
    best = (off**2).sum(axis=2).min(axis=1) / 2
    return {
        name: float(misfit)
        for name, misfit in zip(prototypes(), np.minimum(best, _MOST), strict=True)
    }


@cache
def _outlines() -> tuple[Outlines, NDArray[np.float64]]:
    """Points around each prototype in each turn, (classes, turns, points, 3), and the volumes."""
    known = list(prototypes().values())
    return (
        np.array([[_outline(p, turn * math.pi / _TURNS) for turn in range(_TURNS)] for p in known]),
        np.array([p.volume_cm3 for p in known]),
    )


def _outline(prototype: Prototype, angle: float) -> Outlines:
    """The rims of an upright cylinder, or the corners of a turned box, about its centre."""
    length, width, height = prototype.size_m
    if length == width:
        around = np.arange(_RIM_POINTS) * 2 * math.pi / _RIM_POINTS
        flat = np.stack([np.cos(around), np.sin(around)], axis=1) * length / 2
    else:
        corners = np.array([(1, 1), (1, -1), (-1, -1), (-1, 1)]) * (length / 2, width / 2)
        cos, sin = math.cos(angle), math.sin(angle)
        flat = np.repeat(corners @ np.array([(cos, sin), (-sin, cos)]), _RIM_POINTS // 4, axis=0)
    levels = [np.full((len(flat), 1), z) for z in (-height / 2, height / 2)]
    return np.concatenate([np.hstack([flat, level]) for level in levels])
