"""Whether boxes overlap each other or a floor area, by the separating axis theorem."""

from __future__ import annotations

import numpy as np

from adamo_vh.engine import Area
from adamo_vh.geometry import Array, Box

_PARALLEL = 1e-6
"""Axes shorter than this come from parallel edges and separate nothing."""


def penetration_m(a: Box, b: Box) -> float:
    """How deep two oriented boxes are in each other.

    Args:
        a: One box.
        b: The other box.

    Returns:
        The least distance in metres by which one of them must move to get clear of the other;
        zero or negative if they are apart.
    """
    axes_a, axes_b = a.orientation.matrix(), b.orientation.matrix()
    half_a, half_b = a.size.array() / 2, b.size.array() / 2
    apart = (b.center - a.center).array()

    def along(axes: Array) -> float:
        reach = np.abs(axes @ axes_a) @ half_a + np.abs(axes @ axes_b) @ half_b
        return float((reach - np.abs(axes @ apart)).min())

    depth = along(np.concatenate([axes_a.T, axes_b.T]))
    if depth <= 0:
        return depth
    crosses = np.cross(axes_a.T[:, None, :], axes_b.T[None, :, :]).reshape(9, 3)
    lengths = np.linalg.norm(crosses, axis=1)
    skew = lengths > _PARALLEL
    if not skew.any():
        return depth
    return min(depth, along(crosses[skew] / lengths[skew, None]))


def footprint_overlaps(box: Box, area: Area) -> bool:
    """Whether the footprint of a box shares more than an edge with a floor area.

    The footprint is the convex hull of the corners in plan. Its edges run along the box's own
    edges seen from above, so their normals and the area's two are all the axes to test.
    """
    edges = box.orientation.matrix()[:2, :]
    normals = np.stack([-edges[1], edges[0]], axis=1)
    lengths = np.linalg.norm(normals, axis=1)
    long = lengths > _PARALLEL
    axes = np.concatenate([normals[long] / lengths[long, None], np.eye(2)])
    rectangle = np.array(
        [(x, y) for x in (area.x_min, area.x_max) for y in (area.y_min, area.y_max)]
    )
    low_a, high_a = _extent(box.corners()[:, :2], axes)
    low_b, high_b = _extent(rectangle, axes)
    return bool((np.minimum(high_a, high_b) - np.maximum(low_a, low_b) > 0).all())


def _extent(points: Array, axes: Array) -> tuple[Array, Array]:
    along = points @ axes.T
    return along.min(axis=0), along.max(axis=0)
