"""Rotations as 3x3 matrices, for single joints and for stacks of them.

All functions take and return arrays with any leading axes. Angles are radians, right-handed: about
+Z a positive angle turns left, about +Y it pitches down, about +X it leans to the right.

Numpy alone does it: importing SciPy's rotations takes a tenth of the time to the first picture.
"""

from __future__ import annotations

import numpy as np

from adamo_vh.geometry import Array

_SMALL_RAD = 1e-3
"""Below this a series is more exact than dividing by a sine."""


def about(axis: Array | tuple[float, float, float], angle_rad: Array | float) -> Array:
    """Rotation about a unit axis.

    Args:
        axis: (3,) unit vector.
        angle_rad: Any shape S.

    Returns:
        (*S, 3, 3).
    """
    x, y, z = axis
    cos, sin = np.cos(angle_rad), np.sin(angle_rad)
    rest = 1.0 - cos
    turn = np.array(
        [
            [x * x * rest + cos, x * y * rest - z * sin, x * z * rest + y * sin],
            [x * y * rest + z * sin, y * y * rest + cos, y * z * rest - x * sin],
            [x * z * rest - y * sin, y * z * rest + x * sin, z * z * rest + cos],
        ]
    )
    return np.moveaxis(turn, (0, 1), (-2, -1)) if turn.ndim > 2 else turn


def about_x(angle_rad: Array | float) -> Array:
    """Rotation about +X; a positive angle leans to the right."""
    return about((1.0, 0.0, 0.0), angle_rad)


def about_y(angle_rad: Array | float) -> Array:
    """Rotation about +Y; a positive angle pitches down."""
    return about((0.0, 1.0, 0.0), angle_rad)


def about_z(angle_rad: Array | float) -> Array:
    """Rotation about +Z; a positive angle turns left."""
    return about((0.0, 0.0, 1.0), angle_rad)


def looking(direction: Array) -> Array:
    """The rotation without roll that turns +X to a direction.

    Args:
        direction: (3,), not zero.
    """
    flat = float(np.hypot(direction[0], direction[1]))
    yaw = float(np.arctan2(direction[1], direction[0])) if flat > 1e-9 else 0.0
    return np.asarray(about_z(yaw) @ about_y(-float(np.arctan2(direction[2], flat))))


def basis(first: Array, second: Array) -> Array:
    """Orthonormal axes as columns: along `first`, then towards `second`, then their cross product.

    Args:
        first: (3,), not zero.
        second: (3,), not parallel to `first`.
    """
    x = first / np.linalg.norm(first)
    y = second - x * float(x @ second)
    y = y / np.linalg.norm(y)
    return np.stack([x, y, cross(x, y)], axis=1)


def cross(a: Array, b: Array) -> Array:
    """Cross product of two (3,) vectors; numpy's own is slow for single ones."""
    return np.array(
        [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
    )


def rotation_vectors(rotations: Array) -> Array:
    """Axis times angle of rotations: (..., 3, 3) to (..., 3)."""
    q = quaternions(rotations)
    w, xyz = q[..., 0], q[..., 1:]
    angle = 2.0 * np.arctan2(np.sqrt((xyz * xyz).sum(axis=-1)), w)
    small = angle <= _SMALL_RAD
    squared = angle * angle
    series = 2.0 + squared / 12.0 + 7.0 * squared * squared / 2880.0
    scale = np.where(small, series, angle / np.sin(np.where(small, 1.0, angle / 2.0)))
    return np.asarray(scale[..., None] * xyz)


def from_rotation_vectors(vectors: Array) -> Array:
    """Rotations from axis times angle: (..., 3) to (..., 3, 3)."""
    squared = (vectors * vectors).sum(axis=-1)
    angle = np.sqrt(squared)
    small = angle <= _SMALL_RAD
    series = 0.5 - squared / 48.0 + squared * squared / 3840.0
    scale = np.where(small, series, np.sin(angle / 2.0) / np.where(small, 1.0, angle))
    return _matrices(np.cos(angle / 2.0), scale[..., None] * vectors)


def blended(a: Array, b: Array, weight: float) -> Array:
    """The rotation on the shortest arc from `a` (weight 0) to `b` (weight 1); (..., 3, 3)."""
    turn = rotation_vectors(np.swapaxes(a, -1, -2) @ b)
    return np.asarray(a @ from_rotation_vectors(weight * turn))


def angles(a: Array, b: Array) -> Array:
    """Angles between rotations in radians: two (..., 3, 3) to (...)."""
    return np.asarray(np.linalg.norm(rotation_vectors(np.swapaxes(a, -1, -2) @ b), axis=-1))


def quaternions(rotations: Array) -> Array:
    """Unit quaternions, scalar first and not negative: (..., 3, 3) to (..., 4)."""
    flat = np.asarray(rotations, np.float64).reshape(-1, 3, 3)
    diagonal = np.stack([flat[:, 0, 0], flat[:, 1, 1], flat[:, 2, 2]], axis=1)
    trace = diagonal.sum(axis=1)
    # The largest part is computed first and the others from it, which loses no digits.
    choice = np.argmax(np.column_stack([diagonal, trace]), axis=1)
    i = choice % 3
    j, k = (i + 1) % 3, (i + 2) % 3
    n = np.arange(len(flat))
    xyz = np.empty((len(flat), 3))
    xyz[n, i] = 1.0 - trace + 2.0 * flat[n, i, i]
    xyz[n, j] = flat[n, j, i] + flat[n, i, j]
    xyz[n, k] = flat[n, k, i] + flat[n, i, k]
    upright = np.stack(
        [
            flat[:, 2, 1] - flat[:, 1, 2],
            flat[:, 0, 2] - flat[:, 2, 0],
            flat[:, 1, 0] - flat[:, 0, 1],
        ],
        axis=1,
    )
    by_trace = choice == 3
    w = np.where(by_trace, 1.0 + trace, flat[n, k, j] - flat[n, j, k])
    found = np.column_stack([w, np.where(by_trace[:, None], upright, xyz)])
    found /= np.sqrt((found * found).sum(axis=1))[:, None]
    first = found[n, np.argmax(found != 0.0, axis=1)]
    found *= np.where(first < 0.0, -1.0, 1.0)[:, None]
    return found.reshape(*rotations.shape[:-2], 4)


def _matrices(w: Array, xyz: Array) -> Array:
    x, y, z = xyz[..., 0], xyz[..., 1], xyz[..., 2]
    xx, yy, zz, ww = x * x, y * y, z * z, w * w
    xy, xz, yz, xw, yw, zw = x * y, x * z, y * z, x * w, y * w, z * w
    rows = [
        xx - yy - zz + ww, 2 * (xy - zw), 2 * (xz + yw),
        2 * (xy + zw), -xx + yy - zz + ww, 2 * (yz - xw),
        2 * (xz - yw), 2 * (yz + xw), -xx - yy + zz + ww,
    ]  # fmt: skip
    return np.stack(rows, axis=-1).reshape(*w.shape, 3, 3)


def eased(value: Array | float) -> Array:
    """A smooth step: 0 up to 0, 1 from 1 on, with no kink in speed or acceleration."""
    x = np.clip(value, 0.0, 1.0)
    return np.asarray(x * x * x * (x * (6.0 * x - 15.0) + 10.0))
