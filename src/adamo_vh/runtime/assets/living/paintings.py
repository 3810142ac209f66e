"""The pictures on the walls and the pattern of the rug, drawn by code and seeded.

Earth colours only: nothing here is blue, and nothing is near white.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from adamo_vh.runtime.assets.paint import Field, Picture, noise

_SAND = (178, 150, 108)
_OCHRE = (184, 132, 60)
_RUST = (150, 80, 48)
_OLIVE = (108, 108, 70)
_MOSS = (74, 80, 56)
_UMBER = (84, 60, 46)


def hills(height: int = 256, width: int = 384) -> Picture:
    """Hills behind hills under an evening sun."""
    v, u = _grid(height, width)
    picture = np.array(_SAND) * (0.92 + 0.14 * v[..., None]) + 10 * (1 - v[..., None])
    sun = _soft(0.085 - np.hypot((u - 0.68) * width / height, v - 0.30), height)
    picture = _over(picture, _OCHRE, sun)
    layers = ((0.44, _OCHRE), (0.54, _RUST), (0.66, _OLIVE), (0.80, _MOSS), (0.93, _UMBER))
    for k, (level, colour) in enumerate(layers):
        ridge = level + 0.05 * noise(1, width, (1, width / 5), 30 + k)
        picture = _over(picture, colour, _soft(v - ridge, height))
    return _brushed(picture, 36)


def leaves(height: int = 320, width: int = 232) -> Picture:
    """A branch of broad leaves."""
    v, u = _grid(height, width)
    x, y = (u - 0.5) * width / height, 1.0 - v
    picture = np.full((height, width, 3), _SAND, dtype=np.float64)
    stem = _soft(0.006 - np.abs(x - 0.03 * np.sin(5 * y)) - 9 * np.maximum(y - 0.86, 0), height)
    picture = _over(picture, _UMBER, stem * (y > 0.08))
    for k in range(9):
        side = -1 if k % 2 else 1
        foot = 0.18 + 0.075 * k
        angle = np.deg2rad(52 - 3 * k)
        dx, dy = side * (x - 0.03 * np.sin(5 * foot)), y - foot
        along = dx * np.cos(angle) + dy * np.sin(angle)
        across = -dx * np.sin(angle) + dy * np.cos(angle)
        long = 0.26 - 0.014 * k
        blade = 0.052 * np.sin(np.pi * np.clip(along / long, 0, 1)) ** 0.8 - np.abs(across)
        colour = (_MOSS, _OLIVE, _RUST)[k % 3]
        picture = _over(picture, colour, _soft(blade, height) * (along > 0) * (along < long))
    return _brushed(picture, 48)


def shapes(height: int = 288, width: int = 288) -> Picture:
    """Arches and bars."""
    v, u = _grid(height, width)
    picture = np.full((height, width, 3), _SAND, dtype=np.float64)
    for radius, colour in ((0.40, _RUST), (0.30, _OCHRE), (0.20, _MOSS), (0.10, _SAND)):
        dome = np.where(v < 0.58, np.hypot(u - 0.44, v - 0.58), np.abs(u - 0.44))
        picture = _over(picture, colour, _soft(radius - dome, height) * (v < 0.84))
    picture = _over(picture, _UMBER, _soft(0.05 - np.abs(v - 0.87), height))
    picture = _over(picture, _OLIVE, _soft(0.09 - np.abs(u - 0.90), height) * (v > 0.22))
    return _brushed(picture, 60)


def bordered_rug(height: int = 384, width: int = 512) -> Picture:
    """A field of small diamonds inside two borders."""
    v, u = _grid(height, width)
    edge = np.minimum(np.minimum(u, 1 - u) * 2.6, np.minimum(v, 1 - v) * 1.9)
    picture = np.full((height, width, 3), (150, 108, 78), dtype=np.float64)
    row, column = v * 13, u * 18
    diamond = np.abs(row % 1 - 0.5) + np.abs(column % 1 - 0.5)
    picture = _over(picture, (134, 90, 64), 0.7 * (diamond < 0.26))
    picture = _over(picture, (160, 120, 86), 0.5 * (diamond < 0.10))
    picture = _over(picture, (104, 70, 52), edge < 0.24)
    picture = _over(picture, (160, 118, 80), (edge < 0.205) & (edge > 0.185))
    picture = _over(picture, (160, 118, 80), (edge < 0.075) & (edge > 0.055))
    pile = noise(height, width, (1.5, 1.5), 80) + 0.5 * noise(height, width, (30, 30), 81)
    return _bytes(picture * (1 + 0.055 * pile[..., None]))


def _grid(height: int, width: int) -> tuple[Field, Field]:
    """Each pixel's v (down) and u (right) in [0, 1]."""
    v, u = (np.mgrid[0:height, 0:width] + 0.5) / np.array((height, width))[:, None, None]
    return v, u


def _soft(inside: Field, height: int) -> Field:
    """Coverage of what is inside where a field, in parts of the height, is positive."""
    return np.clip(inside * height / 1.5 + 0.5, 0.0, 1.0)


def _over(picture: Field, colour: tuple[int, int, int], weight: ArrayLike) -> Field:
    cover = np.asarray(weight, dtype=np.float64)[..., None]
    return np.asarray(picture * (1 - cover) + np.array(colour) * cover)


def _brushed(picture: Field, seed: int) -> Picture:
    """Visible strokes."""
    height, width = picture.shape[:2]
    strokes = noise(height, width, (2, 14), seed) + 0.6 * noise(height, width, (40, 50), seed + 1)
    return _bytes(picture * (1 + 0.03 * strokes[..., None]))


def _bytes(picture: Field) -> Picture:
    return np.clip(np.rint(picture), 0, 200).astype(np.uint8)
