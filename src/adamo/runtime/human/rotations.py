"""Rotations as 3x3 matrices, for single joints and for stacks of them.

All functions take and return arrays with any leading axes. Angles are radians, right-handed: about
+Z a positive angle turns left, about +Y it pitches down, about +X it leans to the right.
"""

from __future__ import annotations

import numpy as np
from scipy.spatial.transform import Rotation

from adamo.geometry import Array


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
    flat = rotations.reshape(-1, 3, 3)
    return np.asarray(Rotation.from_matrix(flat).as_rotvec()).reshape(rotations.shape[:-1])


def from_rotation_vectors(vectors: Array) -> Array:
    """Rotations from axis times angle: (..., 3) to (..., 3, 3)."""
    flat = Rotation.from_rotvec(vectors.reshape(-1, 3)).as_matrix()
    return np.asarray(flat).reshape(*vectors.shape, 3)


def blended(a: Array, b: Array, weight: float) -> Array:
    """The rotation on the shortest arc from `a` (weight 0) to `b` (weight 1); (..., 3, 3)."""
    turn = rotation_vectors(np.swapaxes(a, -1, -2) @ b)
    return np.asarray(a @ from_rotation_vectors(weight * turn))


def angles(a: Array, b: Array) -> Array:
    """Angles between rotations in radians: two (..., 3, 3) to (...)."""
    return np.asarray(np.linalg.norm(rotation_vectors(np.swapaxes(a, -1, -2) @ b), axis=-1))


def quaternions(rotations: Array) -> Array:
    """Unit quaternions, scalar first and not negative: (..., 3, 3) to (..., 4)."""
    flat = Rotation.from_matrix(rotations.reshape(-1, 3, 3)).as_quat(canonical=True)
    return np.asarray(flat)[:, [3, 0, 1, 2]].reshape(*rotations.shape[:-2], 4)


def from_quaternions(values: Array) -> Array:
    """Rotations from quaternions, scalar first: (..., 4) to (..., 3, 3)."""
    flat = values.reshape(-1, 4)[:, [1, 2, 3, 0]]
    return np.asarray(Rotation.from_quat(flat).as_matrix()).reshape(*values.shape[:-1], 3, 3)


def eased(value: Array | float) -> Array:
    """A smooth step: 0 up to 0, 1 from 1 on, with no kink in speed or acceleration."""
    x = np.clip(value, 0.0, 1.0)
    return np.asarray(x * x * x * (x * (6.0 * x - 15.0) + 10.0))
