"""The way of the body's axis over the floor: straight lines, rounded corners, turns on the spot.

A route is measured in its own length: metres walked, plus a length for every radian turned on the
spot. The body moves along it as a smooth function of that length.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from adamo_vh.geometry import Array, Vec3, wrap_angle

TURN_M = 0.62
"""Length of a route for each radian turned on the spot."""
_SAMPLE_M = 0.01
_ROUNDING_M = 0.13
"""Half of the length over which a corner is rounded."""
_TURNING_M = 0.55
"""Half of the length over which the heading changes at a corner."""


class Stand(NamedTuple):
    """Where the axis of the body is."""

    x: float
    y: float
    heading_rad: float


@dataclass(frozen=True, slots=True, eq=False)
class Route:
    """A way from one stand to another."""

    lengths_m: Array
    """(N,) lengths at the samples, from 0 on."""
    stands: Array
    """(N, 3) x, y and heading (continuous, in radians) at the samples."""
    walked_m: Array
    """(N,) metres walked, without the turns."""

    @property
    def length_m(self) -> float:
        """Length of the whole route."""
        return float(self.lengths_m[-1])

    def at(self, length_m: float) -> Stand:
        """The stand after a length; the ends hold beyond the ends."""
        return Stand(*(float(np.interp(length_m, self.lengths_m, c)) for c in self.stands.T))

    def walked(self, length_m: float) -> float:
        """Metres walked after a length."""
        return float(np.interp(length_m, self.lengths_m, self.walked_m))


def route(heading_rad: float, points: Sequence[Vec3], end_heading_rad: float) -> Route:
    """The way through the corners of a path.

    Args:
        heading_rad: Heading at the start.
        points: Corners, the first one where the body stands; one point for a turn on the spot.
        end_heading_rad: Heading at the end.
    """
    knots = [(points[0].x, points[0].y, heading_rad)]
    for a, b in pairwise(points):
        if a.horizontal_distance(b) < 1e-9:
            continue
        ahead = _turned(knots[-1][2], float(np.arctan2(b.y - a.y, b.x - a.x)))
        knots += [(a.x, a.y, ahead), (b.x, b.y, ahead)]
    knots.append((points[-1].x, points[-1].y, _turned(knots[-1][2], end_heading_rad)))
    corners = np.array(knots)
    steps = np.hypot(*np.diff(corners[:, :2], axis=0).T)
    # Corners on the way are turned while walking; only the ends are turned on the spot.
    turns = np.abs(np.diff(corners[:, 2]))
    inner = np.where(np.arange(len(turns)) == 0, 1.0, 0.0)
    inner[-1] = 1.0
    sharp = np.clip((turns - np.radians(100.0)) / np.radians(80.0), 0.0, 1.0)
    at = np.concatenate([[0.0], np.cumsum(steps + TURN_M * turns * np.maximum(inner, sharp))])
    keep = np.concatenate([[True], np.diff(at) > 1e-12])
    if keep.sum() == 1:
        return Route(np.zeros(1), corners[-1:], np.zeros(1))
    # Two corners at one length (a turn while walking) are kept as a jump; smoothing rounds it.
    samples = np.linspace(0.0, float(at[-1]), max(2, int(np.ceil(at[-1] / _SAMPLE_M)) + 1))
    places = _smoothed(samples, at, corners[:, :2], _ROUNDING_M)
    headings = _smoothed(samples, at, corners[:, 2:], _TURNING_M)
    walked = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(places, axis=0).T))])
    return Route(samples, np.concatenate([places, headings], axis=1), walked)


def _turned(heading_rad: float, to_rad: float) -> float:
    """The heading `to_rad` as the nearest continuation of another."""
    return heading_rad + wrap_angle(to_rad - heading_rad)


def _smoothed(samples: Array, at: Array, values: Array, half_m: float) -> Array:
    """Values over the length, averaged twice over a window that shrinks to nothing at the ends.

    Args:
        samples: (N,) lengths.
        at: (K,) lengths of the corners, not falling.
        values: (K, C) values at the corners.
        half_m: Half of the window.
    """
    end = float(samples[-1])
    smooth = np.stack([np.interp(samples, at, v) for v in values.T], axis=1)
    half = np.minimum(half_m, np.minimum(samples, end - samples)) / 2
    for _ in range(2):
        steps = np.diff(samples)[:, None] * (smooth[1:] + smooth[:-1]) / 2
        area = np.concatenate([np.zeros((1, values.shape[1])), np.cumsum(steps, axis=0)])
        means = []
        for c in range(values.shape[1]):
            upper = _integral(samples + half, samples, smooth[:, c], area[:, c])
            lower = _integral(samples - half, samples, smooth[:, c], area[:, c])
            narrow = half < 1e-9
            mean = (upper - lower) / np.where(narrow, 1.0, 2 * half)
            means.append(np.where(narrow, smooth[:, c], mean))
        smooth = np.stack(means, axis=1)
    return smooth


def _integral(x: Array, samples: Array, values: Array, area: Array) -> Array:
    """Integral of a piecewise linear function from the first sample to each x."""
    i = np.clip(np.searchsorted(samples, x, side="right") - 1, 0, len(samples) - 2)
    part = x - samples[i]
    slope = (values[i + 1] - values[i]) / (samples[i + 1] - samples[i])
    return np.asarray(area[i] + part * (values[i] + 0.5 * slope * part))
