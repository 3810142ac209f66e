"""The boxes that are drawn in a frame, found where the text does not tell them.

The lines are bright with a dark rim on both sides, upright and level. Where a thing is follows from
its centre in the world, and roughly how large from its volume; the four lines around that place
that are best covered are its box.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from adamo_vh.geometry import Camera
from adamo_vh.inference.baseline.prompt.state_text import Listed
from adamo_vh.inference.baseline.sight.marks import PixelBox

Counts = NDArray[np.int32]
Places = NDArray[np.intp]
Shares = NDArray[np.float64]

_STEP = 30
"""Least difference in brightness between a line and its rims."""
_RIM_BELOW = 110
"""Greatest brightness of a rim, after JPEG."""
_SMALLEST, _LARGEST = 0.3, 5.5
"""Sides of a box over the side of a cube of the same volume."""
_OFF_CENTRE = 0.32
"""How far the middle of a box may be from where the thing's centre appears, over its side."""
_COVERED = 0.25
"""Least share of each side that must show a line; tags may hide the rest."""
_MEAN_COVERED = 0.7
_COVERED_MIDDLE = 0.4
_MOST_LINES = 16


def with_boxes(
    bright: NDArray[np.uint8], things: Sequence[Listed], camera: Camera
) -> tuple[Listed, ...]:
    """Add the boxes that the text leaves out.

    Args:
        bright: Brightest channel of each pixel of the frame, (H, W).
        things: What is listed as in view.
        camera: Of the frame.

    Returns:
        The same things; those whose box is not found stay without.
    """
    if not things:
        return ()
    pixels = camera.project(np.array([thing.position.array() for thing in things]))
    sides = [
        float(np.cbrt(max(thing.volume_cm3, 0.1)) / 100 * camera.focal_px / max(depth, 0.1))
        for thing, (_, _, depth) in zip(things, pixels, strict=True)
    ]
    reach = np.array([_reach(side) for side in sides])[:, None]
    low = np.floor((pixels[:, :2] - reach).min(axis=0)).clip(0).astype(int)
    high = np.ceil((pixels[:, :2] + reach).max(axis=0)).clip(0).astype(int) + 1
    part = bright[low[1] : high[1], low[0] : high[0]]
    if min(part.shape[:2]) < 8:
        return tuple(things)
    width = _line_px(bright.shape[0])
    upright, level = _lines(part, width)
    found = []
    for thing, (u, v, depth), side in zip(things, pixels, sides, strict=True):
        box = thing.box_px
        if box is None and depth > 0:
            middle = (float(u) - low[0], float(v) - low[1])
            box = _box_around(upright, level, middle, side, width)
            box = box and _shifted(box, int(low[0]), int(low[1]))
        found.append(replace(thing, box_px=box))
    return tuple(found)


def _reach(side: float) -> float:
    """How far from its middle a line of a box may be."""
    return (_LARGEST * side + 6) * (0.5 + _OFF_CENTRE)


def _shifted(box: PixelBox, x: int, y: int) -> PixelBox:
    left, top, right, bottom = box
    return left + x, top + y, right + x, bottom + y


def _lines(bright: NDArray[np.uint8], width: int) -> tuple[Counts, Counts]:
    """Where upright and level lines begin, as integral pictures."""
    import cv2

    # A line is never dark: its brightest channel stands out on any ground.
    upright, level = (cv2.integral(_starts(bright, width, axis)) for axis in (1, 0))
    return np.asarray(upright, np.int32), np.asarray(level, np.int32)


def _starts(value: NDArray[np.uint8], width: int, axis: int) -> NDArray[np.uint8]:
    """1 at the first of ``width`` bright pixels along an axis with a dark one on either side."""
    import cv2

    end = value.shape[axis] - width

    def along(first: int, last: int) -> tuple[slice, ...]:
        return (slice(None),) * axis + (slice(first, last),)

    bright = value[along(1, end)]
    if width > 1:
        bright = np.asarray(cv2.min(bright, value[along(width, end + width - 1)]), np.uint8)
    rims = cv2.max(value[along(0, end - 1)], value[along(1 + width, end + width)])
    found = np.zeros(value.shape, bool)
    stands_out = np.asarray(cv2.subtract(bright, rims)) > _STEP
    found[along(1, end)] = stands_out & (np.asarray(rims) < _RIM_BELOW)
    return found.view(np.uint8)


def _line_px(height_px: int) -> int:
    return max(1, round(height_px / 540))


def _column(sums: Counts, x: Places, top: Places | int, bottom: Places | int) -> Counts:
    """Line pixels in a column between two rows."""
    right = sums[bottom, x + 1] - sums[top, x + 1]
    return np.asarray(right - sums[bottom, x] + sums[top, x], np.int32)


def _box_around(
    upright: Counts, level: Counts, middle: tuple[float, float], side: float, line_px: int
) -> PixelBox | None:
    """The best rectangle of lines around a point."""
    height, width = (size - 1 for size in upright.shape)
    u, v = middle
    low, high = max(4.0, _SMALLEST * side), _LARGEST * side + 6
    reach = _reach(side)
    x0, x1 = int(max(0, u - reach)), int(min(width, u + reach + 1))
    y0, y1 = int(max(0, v - reach)), int(min(height, v + reach + 1))
    if x1 - x0 < low or y1 - y0 < low:
        return None
    columns = _crossing(upright, np.arange(x0, x1), u, (y0, v, y1), side)
    rows = _crossing(level.T, np.arange(y0, y1), v, (x0, u, x1), side)
    spans_x = _pairs(columns, u, low, high)
    spans_y = _pairs(rows, v, low, high)
    if not len(spans_x) or not len(spans_y):
        return None
    a, b = spans_x[:, None, 0], spans_x[:, None, 1]
    c, d = spans_y[None, :, 0], spans_y[None, :, 1]
    wide, tall = (b - a).astype(float), (d - c).astype(float)
    lefts, rights = _covered(upright, columns, spans_x, spans_y)
    tops, bottoms = _covered(level.T, rows, spans_y, spans_x)
    mean = ((lefts + rights) + (tops + bottoms).T) / 4
    least = np.minimum(np.minimum(lefts, rights), np.minimum(tops, bottoms).T)
    good = (least >= _COVERED) & (mean >= _MEAN_COVERED)
    if not good.any():
        return None
    off = np.abs((a + b) / 2 - u) / wide + np.abs((c + d) / 2 - v) / tall
    i, j = np.unravel_index(np.argmax(np.where(good, mean - off, -9.0)), mean.shape)
    left, right = (int(x) for x in spans_x[i])
    top, bottom = (int(y) for y in spans_y[j])
    inside = line_px + 1
    return left + inside, top + inside, right - 1, bottom - 1


def _covered(sums: Counts, lines: Places, pairs: Places, spans: Places) -> tuple[Shares, Shares]:
    """Shares of the two lines of each pair that are covered within each span, (pairs, spans)."""
    first, last = spans[:, 0], spans[:, 1]
    shares = _column(sums, lines[:, None], first, last) / (last - first)
    at = np.searchsorted(lines, pairs)
    return shares[at[:, 0]], shares[at[:, 1]]


def _crossing(
    sums: Counts, places: Places, centre: float, across: tuple[int, float, int], side: float
) -> Places:
    """Columns whose line passes the height of the middle; the nearest to it, if many."""
    low, middle, high = across
    found = np.zeros(len(places), bool)
    # A tag may hide a line at the middle, and a small box has no line far from it.
    for part in (_SMALLEST / 2, _SMALLEST * 2):
        half = max(2.0, part * side)
        top = int(min(max(middle - half, low), high - 1))
        bottom = int(min(max(middle + half + 1, top + 1), high))
        found |= _column(sums, places, top, bottom) >= _COVERED_MIDDLE * (bottom - top)
    crossing = places[found]
    nearest = np.argsort(np.abs(crossing - centre), kind="stable")[:_MOST_LINES]
    return np.asarray(np.sort(crossing[nearest]), np.intp)


def _pairs(places: Places, middle: float, low: float, high: float) -> Places:
    """Pairs of lines that may be two sides of a box around a place."""
    if len(places) < 2:
        return np.zeros((0, 2), np.intp)
    first, second = places[:, None], places[None, :]
    span = second - first
    off = np.abs((first + second) / 2 - middle)
    i, j = np.nonzero((span >= low) & (span <= high) & (off <= _OFF_CENTRE * span + 2))
    return np.asarray(np.stack([places[i], places[j]], axis=1), np.intp)
