"""Colours that a mesh has at its vertices, as a picture: the engine paints surfaces with no others.

Each triangle gets the mean of its corners. Close colours are one, so that vertices are split only
where the colour really changes, and light still flows over the rest.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from adamo_vh.geometry import Array

_LEVELS = 24
"""Steps of red, green and blue that are told apart."""
_EDGE_PX = 4
"""Of the square that a colour has in the picture, so that neighbours do not run into it."""


@dataclass(frozen=True, slots=True, eq=False)
class Painted:
    """A mesh whose colours are in a picture."""

    faces: NDArray[np.int64]
    """(M, 3) corners, places in `rows`."""
    rows: NDArray[np.int64]
    """(N,) the old vertex that each new one is."""
    uvs: Array
    """(N, 2) where its colour is, v down."""
    picture: NDArray[np.uint8]
    """(H, W, 3) sRGB."""


def painted(faces: NDArray[np.int64], colours: Array) -> Painted:
    """Put the colours of vertices into a picture.

    Args:
        faces: (M, 3) corners.
        colours: (N, 3) linear, 0 to 1.
    """
    shown = srgb(colours[faces].mean(axis=1))
    cells, cell = np.unique(np.rint(shown * _LEVELS).astype(np.int64), axis=0, return_inverse=True)
    cell = cell.ravel()
    side = int(np.ceil(np.sqrt(len(cells))))
    corners = np.stack([faces.ravel(), np.repeat(cell, 3)], axis=1)
    pairs, places = np.unique(corners, axis=0, return_inverse=True)
    at = np.stack([pairs[:, 1] % side, pairs[:, 1] // side], axis=1)
    sheet = np.zeros((side * side, 3), np.uint8)
    sheet[: len(cells)] = np.rint(np.clip(cells / _LEVELS, 0.0, 1.0) * 255)
    picture = sheet.reshape(side, side, 3).repeat(_EDGE_PX, axis=0).repeat(_EDGE_PX, axis=1)
    return Painted(places.reshape(-1, 3), pairs[:, 0], (at + 0.5) / side, picture)


def srgb(linear: Array) -> Array:
    """Colours as screens have them, from linear ones."""
    value = np.clip(linear, 0.0, 1.0)
    return np.where(
        value <= 0.0031308, 12.92 * value, 1.055 * np.maximum(value, 1e-9) ** (1 / 2.4) - 0.055
    )
