"""Soft shapes as signed distance functions: round cones, ellipsoids, lofts, and smooth unions.

A shape takes (N, 3) points in metres, body frame, and returns (N,) distances: negative inside. The
distances are exact near the surface and good enough further out.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import reduce

import numpy as np

from adamo_vh.geometry import Array

Shape = Callable[[Array], Array]
Point = tuple[float, float, float]


def round_cone(a: Point, b: Point, radius_a: float, radius_b: float) -> Shape:
    """A capsule from a to b whose radius changes linearly."""
    start, axis = np.array(a), np.subtract(b, a)
    square = float(axis @ axis)

    def distance(p: Array) -> Array:
        q = p - start
        t = np.clip(q @ axis / square, 0.0, 1.0)
        away = q - t[:, None] * axis
        radius = radius_a + t * (radius_b - radius_a)
        return np.asarray(np.sqrt(np.einsum("ij,ij->i", away, away)) - radius)

    return distance


def chain(points: Sequence[Point], radii: Sequence[float], softness: float = 0.0) -> Shape:
    """Round cones from point to point."""
    return union(
        softness,
        *(
            round_cone(a, b, r, s)
            for a, b, r, s in zip(points[:-1], points[1:], radii[:-1], radii[1:], strict=True)
        ),
    )


def ellipsoid(center: Point, radii: Point, turn: Array | None = None) -> Shape:
    """An ellipsoid; `turn` (3, 3) takes its own axes to the body's."""
    middle, scale = np.array(center), np.array(radii)

    def distance(p: Array) -> Array:
        q = p - middle
        if turn is not None:
            q = q @ turn
        return _implicit(q / scale, q / scale**2, min(radii))

    return distance


def _implicit(scaled: Array, gradient: Array, smallest: float) -> Array:
    """First-order distance to an ellipse or ellipsoid, (N,) from its scaled coordinates."""
    k = np.sqrt(np.einsum("ij,ij->i", scaled, scaled))
    slope = np.sqrt(np.einsum("ij,ij->i", gradient, gradient))
    return np.where(slope > 1e-9, k * (k - 1.0) / np.maximum(slope, 1e-9), -smallest)


def loft(rows: Sequence[tuple[float, float, float, float]], rounding: float = 0.02) -> Shape:
    """Stacked ellipses along Z: rows of (z, center x, half depth, half width), from below."""
    from scipy.interpolate import PchipInterpolator

    table = np.array(rows)
    curve = PchipInterpolator(table[:, 0], table[:, 1:], axis=0)
    low, high = table[0, 0], table[-1, 0]

    def distance(p: Array) -> Array:
        x, depth, width = np.moveaxis(curve(np.clip(p[:, 2], low, high)), 1, 0)
        q = np.stack([p[:, 0] - x, p[:, 1]], axis=1)
        scale = np.stack([depth, width], axis=1)
        side = _implicit(q / scale, q / scale**2, 0.05)
        return smooth_max(rounding, side, np.maximum(low - p[:, 2], p[:, 2] - high))

    return distance


def slab(low: float, high: float) -> Shape:
    """Everything between two heights, metres."""
    return lambda p: np.maximum(low - p[:, 2], p[:, 2] - high)


def half_space(point: Point, outward: Point) -> Shape:
    """Everything behind a plane."""
    normal = np.array(outward) / np.linalg.norm(outward)
    return lambda p: (p - np.array(point)) @ normal


def smooth_min(softness: float, a: Array, b: Array) -> Array:
    """The smaller one, with a rounded valley of this width where both are alike."""
    if softness <= 0:
        return np.minimum(a, b)
    h = np.maximum(softness - np.abs(a - b), 0.0) / softness
    return np.minimum(a, b) - h * h * softness / 4


def smooth_max(softness: float, a: Array, b: Array) -> Array:
    """The larger one, with a rounded ridge where both are alike."""
    return -smooth_min(softness, -a, -b)


def union(softness: float, *shapes: Shape) -> Shape:
    """All shapes together, blended over `softness` metres."""
    return lambda p: reduce(lambda a, b: smooth_min(softness, a, b), (s(p) for s in shapes))


def common(softness: float, *shapes: Shape) -> Shape:
    """Where all shapes overlap."""
    return lambda p: reduce(lambda a, b: smooth_max(softness, a, b), (s(p) for s in shapes))


def minus(softness: float, shape: Shape, *cuts: Shape) -> Shape:
    """A shape without the others."""
    return lambda p: reduce(
        lambda a, b: smooth_max(softness, a, -b), (s(p) for s in cuts), shape(p)
    )


def mirrored(shape: Shape) -> Shape:
    """What is modelled on the left, on both sides; a sharp seam at y = 0."""
    return lambda p: shape(p * [1.0, 0.0, 1.0] + np.abs(p) * [0.0, 1.0, 0.0])


def right_of(shape: Shape) -> Shape:
    """The mirror image alone."""
    return lambda p: shape(p * [1.0, -1.0, 1.0])


def both(softness: float, shape: Shape) -> Shape:
    """A left shape and its mirror image, blended where they meet."""
    return union(softness, shape, right_of(shape))


def grown(shape: Shape, by: float) -> Shape:
    """Thicker by some metres."""
    return lambda p: shape(p) - by


def displaced(shape: Shape, field: Callable[[Array], Array]) -> Shape:
    """Pushed outward by a field in metres: folds, curls, strands."""
    return lambda p: shape(p) - field(p)


def turned(roll: float = 0.0, pitch: float = 0.0, yaw: float = 0.0) -> Array:
    """(3, 3) rotation from angles in degrees about X, then Y, then Z."""
    from scipy.spatial.transform import Rotation

    return np.asarray(Rotation.from_euler("xyz", (roll, pitch, yaw), degrees=True).as_matrix())
