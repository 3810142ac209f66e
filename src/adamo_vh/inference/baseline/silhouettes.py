"""How large each kind of thing would look where a thing stands, beside how large it does look."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cache

import numpy as np
from numpy.typing import NDArray

from adamo_vh.geometry import Camera
from adamo_vh.inference.baseline.prototypes import Prototype, prototypes
from adamo_vh.inference.baseline.reading import Listed

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]

_TURNS = 8
_RIM_POINTS = 12
_SPREAD = 0.16
"""Standard deviation of the logarithm of a side, within a class."""
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
    seen = np.array([[(max(x1 - x0, 1), max(y1 - y0, 1))] for _, (x0, y0, x1, y1) in known], float)
    off = np.log(seen / np.maximum(spans, 1.0)) / _SPREAD
    best = np.minimum.reduceat((off**2).sum(axis=2) / 2, outlines.first_turns, axis=1)
    nearest = pixels[..., 2].min(axis=1)
    return {
        thing.tag: dict(zip(prototypes(), row.tolist(), strict=True))
        for (thing, _), row, depth in zip(known, np.minimum(best, _MOST), nearest, strict=True)
        if depth >= _NEAREST_M / 2
    }


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
