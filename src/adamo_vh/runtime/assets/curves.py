"""Plane and space curves of the modelling kit: outlines, profiles and paths, as (N, D) arrays."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

Floats = NDArray[np.float64]


def arc(
    center: tuple[float, float],
    radius: float,
    start_deg: float,
    end_deg: float,
    count: int = 8,
) -> Floats:
    """(count, 2) points of a circular arc, both ends included."""
    angle = np.deg2rad(np.linspace(start_deg, end_deg, count))
    return np.asarray(np.column_stack((np.cos(angle), np.sin(angle))) * radius + center)


def circle(radius_x: float, radius_y: float | None = None, count: int = 24) -> Floats:
    """(count, 2) closed counter-clockwise circle or ellipse about the origin."""
    angle = np.linspace(0.0, 2 * np.pi, count, endpoint=False)
    ellipse = (radius_x, radius_x if radius_y is None else radius_y)
    return np.asarray(np.column_stack((np.cos(angle), np.sin(angle))) * ellipse)


def rectangle(size_x: float, size_y: float, radius: float = 0.0, segments: int = 4) -> Floats:
    """Closed counter-clockwise rectangle about the origin, its corners rounded by `radius`."""
    half_x, half_y = size_x / 2, size_y / 2
    corners = np.array(((half_x, -half_y), (half_x, half_y), (-half_x, half_y), (-half_x, -half_y)))
    return fillet(corners, radius, segments, closed=True) if radius > 0 else corners


def fillet(
    points: ArrayLike, radius: float | Sequence[float], segments: int = 4, *, closed: bool = False
) -> Floats:
    """Round the corners of a polyline in the plane or in space.

    Args:
        points: (N, 2) or (N, 3).
        radius: Of all corners, or one for every point (0 keeps it sharp).
        segments: Pieces of each rounding.
        closed: Whether the last point is joined to the first; else the ends are kept.
    """
    line = np.asarray(points, dtype=np.float64)
    radii = np.broadcast_to(np.asarray(radius, dtype=np.float64), len(line))
    rounded: list[Floats] = []
    for i, corner in enumerate(line):
        end = not closed and i in (0, len(line) - 1)
        before, after = line[i - 1] - corner, line[(i + 1) % len(line)] - corner
        long_before, long_after = float(np.linalg.norm(before)), float(np.linalg.norm(after))
        if end or radii[i] <= 0 or min(long_before, long_after) == 0:
            rounded.append(corner[None])
            continue
        before, after = before / long_before, after / long_after
        half = np.arccos(np.clip(before @ after, -1.0, 1.0)) / 2
        reach = min(radii[i] / max(np.tan(half), 1e-9), 0.499 * long_before, 0.499 * long_after)
        if half > np.pi / 2 - 1e-3:
            rounded.append(corner[None])
            continue
        bisector = (before + after) / np.linalg.norm(before + after)
        middle = corner + bisector * reach / np.cos(half)
        swing = np.linspace(half - np.pi / 2, np.pi / 2 - half, segments + 1)[:, None]
        across = (after - before) / np.linalg.norm(after - before)
        arm = reach * np.tan(half)
        rounded.append(middle + arm * (np.sin(swing) * across - np.cos(swing) * bisector))
    return np.concatenate(rounded)


def spline(points: ArrayLike, count: int = 24, *, closed: bool = False) -> Floats:
    """(count, D) smooth curve through the points (cubic in arc length)."""
    from scipy.interpolate import CubicSpline

    knots = np.asarray(points, dtype=np.float64)
    if closed:
        knots = np.vstack((knots, knots[:1]))
    steps = np.linalg.norm(np.diff(knots, axis=0), axis=1)
    position = np.concatenate(((0.0,), np.cumsum(steps)))
    curve = CubicSpline(position, knots, bc_type="periodic" if closed else "natural")
    where = np.linspace(0.0, position[-1], count, endpoint=not closed)
    return np.asarray(curve(where), dtype=np.float64)
