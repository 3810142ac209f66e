"""Cut out of a mesh what its picture shows as transparent.

The engine draws a surface wholly or not at all. Hair, lashes and lace that are drawn on larger
triangles get their outline as a mesh: triangles on the edge are split, and the smallest ones cut
where the picture is half solid.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from adamo_vh.geometry import Array

_ROUNDS = 3
"""How often a triangle on the edge is split into four."""
_STEPS = 6
"""Samples along an edge of a triangle, to see whether all of it is solid."""


@dataclass(frozen=True, slots=True, eq=False)
class Cut:
    """The mesh that is left: new vertices as mixtures of old ones."""

    faces: NDArray[np.int64]
    """(M, 3) corners, places in `parents`."""
    parents: NDArray[np.int64]
    """(N, 3) the old vertices that each new one lies between."""
    shares: Array
    """(N, 3) how much of each; they sum to 1."""


def cut(
    faces: NDArray[np.int64], uvs: Array, alpha: NDArray[np.float32], solid_from: float, most: int
) -> Cut:
    """Cut a mesh along the outline of its picture.

    Args:
        faces: (M, 3) corners.
        uvs: (N, 2) texture coordinates, v down.
        alpha: (H, W) how solid the picture is.
        solid_from: What is less is cut away.
        most: No more triangles than about this are made.
    """
    count = len(faces)
    # Each triangle as three corners, given by their shares of the old triangle's corners.
    owners = np.arange(count)
    corners = np.tile(np.eye(3), (count, 1, 1))
    kept_owners: list[NDArray[np.int64]] = []
    kept_corners: list[Array] = []
    made = 0
    for step in range(_ROUNDS + 1):
        level = _solid(faces, uvs, alpha, owners, corners) - solid_from
        whole, none = level.min(axis=1) >= 0, level.max(axis=1) < 0
        kept_owners.append(owners[whole])
        kept_corners.append(corners[whole])
        made += int(whole.sum())
        edge = ~whole & ~none
        owners, corners = owners[edge], corners[edge]
        if step == _ROUNDS or made + 4 * len(owners) > most:
            break
        owners, corners = np.repeat(owners, 4), _split(corners)
    level = _at_corners(faces, uvs, alpha, owners, corners) - solid_from
    for part_owners, part_corners in _outlined(owners, corners, level):
        kept_owners.append(part_owners)
        kept_corners.append(part_corners)
    return _joined(faces, np.concatenate(kept_owners), np.concatenate(kept_corners))


def _grid() -> Array:
    """(S, 3) places inside a triangle and near its edges."""
    at = np.array(
        [
            (i / _STEPS, j / _STEPS, 1 - (i + j) / _STEPS)
            for i in range(_STEPS + 1)
            for j in range(_STEPS + 1 - i)
        ]
    )
    # A little inside, as the picture begins anew where it ends.
    return np.asarray(0.998 * at + 0.002 / 3)


def _sampled(uvs: Array, alpha: NDArray[np.float32]) -> Array:
    height, width = alpha.shape
    x = np.floor(np.mod(uvs[..., 0], 1.0) * width).astype(int) % width
    y = np.floor(np.mod(uvs[..., 1], 1.0) * height).astype(int) % height
    return np.asarray(alpha[y, x], float)


def _solid(
    faces: NDArray[np.int64],
    uvs: Array,
    alpha: NDArray[np.float32],
    owners: NDArray[np.int64],
    corners: Array,
) -> Array:
    """(M, S) how solid the picture is at places all over each triangle."""
    at = np.einsum("sc,mck->msk", _grid(), corners)
    return _sampled(np.einsum("msk,mki->msi", at, uvs[faces[owners]]), alpha)


def _at_corners(
    faces: NDArray[np.int64],
    uvs: Array,
    alpha: NDArray[np.float32],
    owners: NDArray[np.int64],
    corners: Array,
) -> Array:
    """(M, 3) how solid the picture is around each corner."""
    at = np.einsum("mck,mki->mci", corners, uvs[faces[owners]])
    height, width = alpha.shape
    around = [
        _sampled(at + np.array([dx / width, dy / height]), alpha)
        for dx in (-0.5, 0.5)
        for dy in (-0.5, 0.5)
    ]
    return np.asarray(np.mean(around, axis=0))


def _split(corners: Array) -> Array:
    """(4 M, 3, 3) each triangle in four."""
    a, b, c = corners[:, 0], corners[:, 1], corners[:, 2]
    ab, bc, ca = (a + b) / 2, (b + c) / 2, (c + a) / 2
    four = [(a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca)]
    return np.stack([np.stack(t, axis=1) for t in four], axis=1).reshape(-1, 3, 3)


def _outlined(
    owners: NDArray[np.int64], corners: Array, level: Array
) -> list[tuple[NDArray[np.int64], Array]]:
    """What is left of triangles that the outline crosses: level above 0."""
    found = [(owners[chosen], corners[chosen]) for chosen in [(level >= 0).all(axis=1)]]
    for first in range(3):
        order = [first, (first + 1) % 3, (first + 2) % 3]
        a, b, c = (corners[:, k] for k in order)
        la, lb, lc = (level[:, k] for k in order)
        one = (la >= 0) & (lb < 0) & (lc < 0)
        two = (la < 0) & (lb >= 0) & (lc >= 0)
        with np.errstate(divide="ignore", invalid="ignore"):
            ab = a + (b - a) * np.nan_to_num(la / (la - lb))[:, None]
            ac = a + (c - a) * np.nan_to_num(la / (la - lc))[:, None]
        found.append((owners[one], np.stack([a, ab, ac], axis=1)[one]))
        found.append((owners[two], np.stack([ab, b, c], axis=1)[two]))
        found.append((owners[two], np.stack([ab, c, ac], axis=1)[two]))
    return found


def _joined(faces: NDArray[np.int64], owners: NDArray[np.int64], corners: Array) -> Cut:
    """The triangles with vertices that neighbours within an old triangle share."""
    parents = np.repeat(faces[owners], 3, axis=0).reshape(-1, 3)
    shares = corners.reshape(-1, 3)
    # Corners of old triangles stay the vertices that they were.
    alone = shares.max(axis=1) > 1.0 - 1e-9
    only = parents[np.arange(len(parents)), shares.argmax(axis=1)]
    parents = np.where(alone[:, None], only[:, None], parents)
    shares = np.where(alone[:, None], np.array([1.0, 0.0, 0.0]), shares)
    keys = np.concatenate([parents, np.rint(shares * 4096).astype(np.int64)], axis=1)
    _, first, places = np.unique(keys, axis=0, return_index=True, return_inverse=True)
    return Cut(places.reshape(-1, 3), parents[first], shares[first])
