"""Many prisms at once: how far points are from a room's furniture, and what lines it blocks."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from adamo_vh.geometry import Array, Solid, Vec3


@dataclass(frozen=True, slots=True, eq=False)
class Solids:
    """Many prisms at once, as arrays: a room has more than a hundred."""

    centres: Array
    """(S, 3) middles in metres."""
    halves: Array
    """(S, 3) half extents along the own axes, metres."""
    axes: Array
    """(S, 2) cosine and sine of the headings."""

    @classmethod
    def of(cls, solids: Sequence[Solid]) -> Solids:
        """Gather prisms."""
        rows = [
            (s.x, s.y, (s.z_min + s.z_max) / 2, s.half_x, s.half_y, (s.z_max - s.z_min) / 2)
            for s in solids
        ]
        table = np.array(rows, dtype=np.float64).reshape(-1, 6)
        yaw = np.array([s.yaw_rad for s in solids], dtype=np.float64)
        return cls(table[:, :3], table[:, 3:], np.stack([np.cos(yaw), np.sin(yaw)], axis=1))

    def distance(self, points: Array) -> Array:
        """Horizontal distance of points from the nearest rectangle; 0 inside one.

        Args:
            points: (N, 2) metres.

        Returns:
            (N,) metres; infinity where there are no solids.
        """
        cos, sin = self.axes.T
        dx = points[:, :1] - self.centres[:, 0]
        dy = points[:, 1:] - self.centres[:, 1]
        along = np.maximum(np.abs(dx * cos + dy * sin) - self.halves[:, 0], 0.0)
        across = np.maximum(np.abs(dy * cos - dx * sin) - self.halves[:, 1], 0.0)
        squares = along * along + across * across
        return np.asarray(np.sqrt(squares.min(axis=1, initial=np.inf)))

    def hold(self, points: Array, skin_m: float) -> NDArray[np.bool_]:
        """Whether points are inside any prism, not counting a skin.

        Args:
            points: (N, 3) metres.
            skin_m: How far below the surface inside begins.

        Returns:
            (N,) true for what is inside.
        """
        half = self.halves - skin_m
        return np.array([(np.abs(self._local(p)) < half).all(axis=1).any() for p in points])

    def depth(self, points: Array, radius_m: float) -> Array:
        """How deep balls are in the prism that they are deepest in; 0 outside.

        Args:
            points: (N, 3) their middles, metres.
            radius_m: Theirs.

        Returns:
            (N,) metres.
        """
        apart = np.abs(self._local(points[:, None]))
        inside = (self.halves + radius_m - apart).min(axis=-1)
        return np.asarray(inside.max(axis=-1, initial=0.0))

    def block(self, start: Vec3, end: Vec3) -> bool:
        """Whether a straight line passes through any prism, not counting a skin of 1 cm."""
        half = self.halves - 0.01
        a, b = self._local(start.array()), self._local(end.array())
        along = np.where(np.abs(b - a) < 1e-9, 1e-9, b - a)
        enter, leave = (-half - a) / along, (half - a) / along
        first = np.minimum(enter, leave).max(axis=1)
        last = np.maximum(enter, leave).min(axis=1)
        passes = (half > 0).all(axis=1) & (first < last) & (first < 1) & (last > 0)
        return bool(passes.any())

    def _local(self, point: Array) -> Array:
        """(..., S, 3) a point, (3,), or points, (N, 1, 3), in each prism's own frame."""
        cos, sin = self.axes.T
        offset = point - self.centres
        x, y = offset[..., 0], offset[..., 1]
        return np.stack([x * cos + y * sin, y * cos - x * sin, offset[..., 2]], axis=-1)


def outline(points: Array, directions: int = 32) -> Array:
    """The convex outline of points: those that are farthest in directions all around.

    Args:
        points: (N, 2) metres.
        directions: Evenly spread; so many corners at most.

    Returns:
        (M, 2) corners, counter-clockwise.
    """
    angles = np.arange(directions) * (2 * math.pi / directions)
    farthest = (points @ np.stack([np.cos(angles), np.sin(angles)])).argmax(axis=0)
    corners = points[farthest]
    apart = np.abs(corners - np.roll(corners, 1, axis=0)) > 1e-6
    return np.asarray(corners[apart.any(axis=1)])
