"""Where the labels of a map stand, so that none covers another."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from unicodedata import east_asian_width

import numpy as np
from numpy.typing import NDArray

from adamo_vh.geometry import Array

_GAP = 0.12
"""Free space around a label, in parts of its size."""
_RINGS = 14
_DIRECTIONS = 16
_LONGEST = 26
_Place = tuple[float, float]


@dataclass(frozen=True, slots=True)
class Wish:
    """A label that is to be placed. Lengths in metres, y downwards."""

    text: str
    kind: str
    x: float
    y: float
    """What it belongs to."""
    size: float
    """Of the font."""
    away: float
    """How far it keeps from that point; 0 if it may stand on it."""
    farthest: float = math.inf
    """Left out if no place is free within this."""


@dataclass(frozen=True, slots=True)
class Label:
    """A label in its place."""

    text: str
    kind: str
    x: float
    y: float
    """Its middle."""
    size: float
    origin: _Place | None
    """What it belongs to, where it stands so far off that a line must tell."""

    @property
    def extent(self) -> tuple[float, float, float, float]:
        """Left, top, right and bottom, as estimated."""
        x, y = _half(self.text, self.size)
        return self.x - float(x), self.y - float(y), self.x + float(x), self.y + float(y)


@dataclass(frozen=True, slots=True)
class Ground:
    """What labels are placed on."""

    left: float
    top: float
    right: float
    bottom: float
    busy: Sequence[_Place] = ()
    """Points that are better not covered: dots, ways, things."""


def placed(wishes: Sequence[Wish], ground: Ground) -> tuple[Label, ...]:
    """Place labels one after another, the important ones first.

    Args:
        wishes: In order of importance.
        ground: Where they may stand, and what is better not covered.

    Returns:
        The labels that found a place; no two overlap.
    """
    busy = np.array(ground.busy, dtype=np.float64).reshape(-1, 2)
    taken = np.empty((0, 5))  # Middle, half extents and size of each label.
    labels: list[Label] = []
    for wish in wishes:
        text = wish.text if len(wish.text) <= _LONGEST else f"{wish.text[: _LONGEST - 1]}…"
        half = _half(text, wish.size)
        spots, gaps = _spots(wish, half)
        free = np.flatnonzero(
            _is_inside(spots, half, ground) & _is_clear(spots, half, wish.size, taken)
        )
        if not len(free):
            continue
        away = np.hypot(*(spots[free] - [wish.x, wish.y]).T)
        covered = _covered(spots[free], half, busy)
        best = int(free[(away + 0.6 * wish.size * covered).argmin()])
        x, y = (round(float(value), 3) for value in spots[best])
        origin = (wish.x, wish.y) if gaps[best] - wish.away > wish.size else None
        labels.append(Label(text, wish.kind, x, y, wish.size, origin))
        taken = np.vstack([taken, [x, y, *half, wish.size]])
    return tuple(labels)


def _spots(wish: Wish, half: Array) -> tuple[Array, Array]:
    """Where a label may stand: on its point if it may, then all around, ever farther off.

    Returns:
        (K, 2) middles, and (K,) how far each label keeps from the point.
    """
    gaps = wish.away + np.arange(_RINGS) * 0.5 * wish.size
    gaps = gaps[gaps <= wish.farthest]
    angles = np.arange(_DIRECTIONS) * (2 * math.pi / _DIRECTIONS)
    ways = np.stack([np.cos(angles), np.sin(angles)], axis=1)
    around = (ways * (half + gaps[:, None, None])).reshape(-1, 2)
    on_it = np.zeros((0 if wish.away else 1, 2))
    spots = np.vstack([on_it, around]) + np.array([wish.x, wish.y])
    return spots, np.concatenate([np.zeros(len(on_it)), np.repeat(gaps, _DIRECTIONS)])


def _half(text: str, size: float) -> Array:
    """Half of the width and height of a text, as estimated."""
    letters = sum(1.0 if east_asian_width(letter) in "WF" else 0.6 for letter in text)
    return np.array([letters * size / 2, 0.55 * size])


def _covered(spots: Array, half: Array, busy: Array) -> NDArray[np.int64]:
    """How many busy points a label at each spot would cover."""
    # Few are within reach of any.
    reach = np.abs(busy - (spots.max(axis=0) + spots.min(axis=0)) / 2) - np.ptp(spots, axis=0) / 2
    x, y = busy[(reach < half * 1.01).all(axis=1)].T
    across = np.abs(spots[:, :1] - x) < half[0]
    return np.asarray((across & (np.abs(spots[:, 1:] - y) < half[1])).sum(axis=1))


def _is_inside(spots: Array, half: Array, ground: Ground) -> NDArray[np.bool_]:
    low, high = spots - half, spots + half
    corner, end = [ground.left, ground.top], [ground.right, ground.bottom]
    return np.asarray((low >= corner).all(axis=1) & (high <= end).all(axis=1))


def _is_clear(spots: Array, half: Array, size: float, taken: Array) -> NDArray[np.bool_]:
    """Whether a label at each spot keeps off all others."""
    gap = _GAP * np.maximum(taken[:, 4:], size) * [1.0, 0.5]
    reach = half + taken[:, 2:4] + gap
    apart = np.abs(spots[:, :1] - taken[:, 0]) >= reach[:, 0]
    apart |= np.abs(spots[:, 1:] - taken[:, 1]) >= reach[:, 1]
    return np.asarray(apart.all(axis=1), dtype=np.bool_)
