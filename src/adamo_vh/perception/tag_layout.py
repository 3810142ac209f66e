"""Where tags go: a pure search for places that hide nothing that matters.

Promises, in this order:

1. Every placed tag lies inside the picture, and no two overlap.
2. No tag overlaps the anchor it names, unless the anchor leaves no room beside it. Then an
   object's tag goes over the anchor, where it hides least.
3. A tag for which even that finds no place is left out. Requests come in order of priority, so a
   later tag never costs an earlier one its place.

Beyond that a tag hides as little of other objects, marks and leader lines as it can, and stays
close. The search is greedy, one request after the other, and deterministic.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from adamo_vh.perception.clutter import Clutter
from adamo_vh.perception.visibility import PixelBox

Ints = NDArray[np.int64]
Floats = NDArray[np.float64]
Line = tuple[tuple[int, int], tuple[int, int]]

# Costs are in units of "one tag height farther away".
_HIDING = 16.0
"""Of hiding one whole object."""
_MARK = 1.5
"""Of covering a mark or a sample of a leader line."""
_FOREIGN = 0.9
"""Of touching or covering the box of another object, whose name the tag could seem to be."""
_LEADER = 0.5
"""Of needing a leader line at all."""
_CROSSED = 3.0
"""Of a leader line that runs below another tag."""
_THROUGH = 0.4
"""Of each sample of a leader line in the box of another object."""
_FAR = 0.6
"""Exponent of distance: the tenth tag height costs less than the first."""
_CORNER = 0.5
"""Of meeting the anchor at a corner instead of along a side."""
_BELOW = 0.2
"""Of standing below the anchor instead of above."""
_MISALIGNED = 0.04
"""Of each tag height between the left edges of tag and anchor."""

_RINGS = (np.array([0.0, 0.6, 1.2]), np.array([2.0, 3.0, 4.5, 6.5, 9.0, 13.0, 18.0]))
"""Distances from the anchor at which places are tried, in tag heights, in two rounds."""
_ALONG = np.linspace(0.0, 1.0, 7)
"""Places along each side of a ring, from one corner to the other."""
_LEADER_SAMPLES = np.linspace(0.1, 0.9, 7)
_SHORTLIST = 12
"""Best places whose leader lines are compared."""
_NOTHING_HIDDEN = 1e-6
"""What rounding may leave of a cost of zero."""
_TOUCHING = np.array([-2, -2, 2, 2])
"""Grows a tag by the distance at which it seems to touch a box."""


@dataclass(frozen=True, slots=True)
class TagRequest:
    """A tag that wants a place."""

    tag: str
    anchor: PixelBox
    """What the tag names and must not cover."""
    size: tuple[int, int]
    """Width and height of the tag in pixels."""
    is_object: bool
    """Whether it names an object in a box, else a mark. A tag that has no place beside its anchor
    goes over the anchor if it names an object, and is left out if it names a mark."""


@dataclass(frozen=True, slots=True)
class PlacedTag:
    """A tag and its place."""

    tag: str
    rect: PixelBox
    leader: Line | None
    """From tag to anchor; None for a tag that touches or nearly touches its anchor."""


def place_tags(
    width_px: int,
    height_px: int,
    requests: Sequence[TagRequest],
    clutter: Clutter,
    marks: Sequence[tuple[int, int]] = (),
) -> tuple[PlacedTag, ...]:
    """Find a place for each tag.

    Args:
        width_px: Width of the picture.
        height_px: Height of the picture.
        requests: The tags, by priority.
        clutter: What tags should not hide.
        marks: (u, v) of small things that tags should not cover either.

    Returns:
        The placed tags in the order of the requests; those without a place are missing.
    """
    boxes = _table([request.anchor for request in requests if request.is_object], 4)
    board = _Board(width_px, height_px, clutter, boxes, _table(marks, 2))
    return tuple(placed for request in requests if (placed := board.place(request)))


class _Board:
    """The picture with the tags placed so far."""

    def __init__(
        self, width_px: int, height_px: int, clutter: Clutter, boxes: Ints, marks: Ints
    ) -> None:
        self.width_px = width_px
        self.height_px = height_px
        self.clutter = clutter
        self.boxes = boxes
        """(B, 4) boxes of all objects."""
        self.others = boxes
        """Those of all objects but the one whose tag is being placed."""
        self.marks = marks
        """(M, 2) points to keep clear; leader lines add theirs."""
        self.taken: Ints = _table([], 4)
        """(T, 4) rectangles of the tags placed so far."""

    def place(self, request: TagRequest) -> PlacedTag | None:
        """Take the best place for a request, if there is any."""
        if request.size[0] > self.width_px or request.size[1] > self.height_px:
            return None
        self.others = self.boxes[(self.boxes != request.anchor).any(axis=1)]
        rect = self._ideal(request)
        if rect is None:
            rect = self._near(request)
        if rect is None:
            rect = self._anywhere(request)
        if rect is None:
            return None
        self.taken = np.concatenate([self.taken, rect[None]])
        leader = None
        start, end = (ends[0] for ends in _leaders(rect[None], request.anchor))
        if math.dist(start, end) > _slack(request):
            leader = (_pixel(start), _pixel(end))
            samples = start + _LEADER_SAMPLES[:, None] * (end - start)
            self.marks = np.concatenate([self.marks, samples.astype(np.int64)])
        left, top, right, bottom = rect.tolist()
        return PlacedTag(request.tag, (left, top, right, bottom), leader)

    def _ideal(self, request: TagRequest) -> Ints | None:
        """The place on top of the anchor if it costs nothing: nothing can beat it."""
        left, bottom = request.anchor[:2]
        right, top = left + request.size[0], bottom - request.size[1]
        if top < 0 or right > self.width_px:
            return None
        rects = _table([(left, top, right, bottom)], 4)
        if self._free(rects).all() and self._hiding(rects)[0] < _NOTHING_HIDDEN:
            return np.asarray(rects[0])
        return None

    def _near(self, request: TagRequest) -> Ints | None:
        """Search the rings around the anchor, from the inside out."""
        best: Ints | None = None
        best_cost = np.inf
        for rings in _RINGS:
            # Farther rings cannot beat what costs less than getting there.
            if best_cost <= rings[0] ** _FAR:
                break
            rects = _ring_rects(request, rings, self.width_px, self.height_px)
            rects = rects[self._free(rects, request.anchor)]
            if len(rects):
                costs = self._hiding(rects) + _standing(rects, request)
                shortlist = costs.argsort(kind="stable")[:_SHORTLIST]
                rects = rects[shortlist]
                costs = costs[shortlist] + self._leading(rects, request)
                winner = int(costs.argmin())
                if costs[winner] < best_cost:
                    best, best_cost = rects[winner], costs[winner]
        return best

    def _anywhere(self, request: TagRequest) -> Ints | None:
        """Search a lattice over the whole picture."""
        width, height = request.size
        xs, ys = _lattice(self.width_px, width, height), _lattice(self.height_px, height, height)
        x, y = (axis.ravel() for axis in np.meshgrid(xs, ys))
        rects = np.stack([x, y, x + width, y + height], axis=1)
        rects = rects[self._free(rects)]
        beside = rects[~_overlaps(rects, _table([request.anchor], 4))[:, 0]]
        if len(beside):
            costs = self._hiding(beside) + _standing(beside, request)
            return np.asarray(beside[costs.argmin()])
        if len(rects) and request.is_object:
            return np.asarray(rects[self._hiding(rects).argmin()])
        return None

    def _free(self, rects: Ints, *anchor: PixelBox) -> NDArray[np.bool_]:
        """Whether places overlap no placed tag, nor an anchor."""
        solid = np.concatenate([self.taken, _table(anchor, 4)])
        return np.asarray(~_overlaps(rects, solid).any(axis=1))

    def _hiding(self, rects: Ints) -> Floats:
        """What each place would hide or seem to name."""
        foreign = _overlaps(rects + _TOUCHING, self.others).sum(axis=1)
        marks = _contains(rects, self.marks).sum(axis=1)
        hidden = self.clutter.hidden(rects)
        return np.asarray(_HIDING * hidden + _MARK * marks + _FOREIGN * foreign)

    def _leading(self, rects: Ints, request: TagRequest) -> Floats:
        """What the leader line of each place costs."""
        start, end = _leaders(rects, request.anchor)
        needed = np.hypot(*(end - start).T) > _slack(request)
        if not needed.any():
            return np.zeros(len(rects))
        lines = start[:, None] + _LEADER_SAMPLES[:, None] * (end - start)[:, None]
        samples, shape = lines.reshape(-1, 2), lines.shape[:2]
        below = _contains(self.taken, samples).reshape(len(self.taken), *shape)
        through = _contains(self.others, samples).any(axis=0).reshape(shape)
        crossed, inside = below.any(axis=2).sum(axis=0), through.sum(axis=1)
        return np.asarray(needed * (_LEADER + _CROSSED * crossed + _THROUGH * inside))


def _ring_rects(request: TagRequest, rings: Floats, width_px: int, height_px: int) -> Ints:
    """(N, 4) candidate places on rings around an anchor, moved into the picture."""
    left, top, right, bottom = request.anchor
    width, height = request.size
    gaps = np.rint(rings * height)[:, None]
    # Each side offers even steps, and the two places that are flush with the anchor's ends.
    count = len(_ALONG) + 2
    xs, ys = np.empty((2, len(rings), count))
    xs[:, 0], xs[:, 1], ys[:, 0], ys[:, 1] = left, right - width, top, bottom - height
    xs[:, 2:] = left - gaps - width + _ALONG * (right - left + width + 2 * gaps)
    ys[:, 2:] = top - gaps - height + _ALONG * (bottom - top + height + 2 * gaps)
    corners = np.empty((4, len(rings), count, 2))
    corners[0, ..., 0], corners[0, ..., 1] = xs, top - gaps - height
    corners[1, ..., 0], corners[1, ..., 1] = xs, bottom + gaps
    corners[2, ..., 0], corners[2, ..., 1] = left - gaps - width, ys
    corners[3, ..., 0], corners[3, ..., 1] = right + gaps, ys
    room = np.array([width_px - width, height_px - height])
    corner = np.rint(np.minimum(np.maximum(corners.reshape(-1, 2), 0), room)).astype(np.int64)
    return np.concatenate([corner, corner + np.array(request.size)], axis=1)


def _standing(rects: Ints, request: TagRequest) -> Floats:
    """What each place costs for where it stands relative to the anchor."""
    low, high = np.array(request.anchor[:2]), np.array(request.anchor[2:])
    size = np.array(request.size)
    shared = np.minimum(rects[:, 2:], high) - np.maximum(rects[:, :2], low)
    away = np.hypot(*np.maximum(-shared, 0).T) / size[1]
    contact = (np.maximum(shared, 0) / np.minimum(size, high - low)).max(axis=1)
    below = rects[:, 1] >= high[1]
    shift = abs(rects[:, 0] - low[0]) / size[1]
    cost = away**_FAR + _CORNER * (1.0 - contact) + _BELOW * below + _MISALIGNED * shift
    return np.asarray(cost)


def _overlaps(rects: Ints, others: Ints) -> NDArray[np.bool_]:
    """(N, M): whether each of (N, 4) rectangles overlaps each of (M, 4) others."""
    left, top, right, bottom = rects.T[:, :, None]
    other_left, other_top, other_right, other_bottom = others.T
    return np.asarray(
        (left < other_right) & (other_left < right) & (top < other_bottom) & (other_top < bottom)
    )


def _contains(rects: Ints, points: NDArray[np.number]) -> NDArray[np.bool_]:
    """(N, P): whether each of (N, 4) rectangles holds each of (P, 2) points."""
    left, top, right, bottom = rects.T[:, :, None]
    u, v = points.T
    return np.asarray((left <= u) & (u < right) & (top <= v) & (v < bottom))


def _leaders(rects: Ints, anchor: PixelBox) -> tuple[Floats, Floats]:
    """Lines from tags to their anchor: (N, 2) starts on the tags and ends on the anchor."""
    near, far = np.array(anchor[:2]), np.array(anchor[2:]) - 1
    middle = (rects[:, :2] + rects[:, 2:]) / 2
    end = np.minimum(np.maximum(middle, near), far)
    start = np.minimum(np.maximum(end, rects[:, :2]), rects[:, 2:] - 1)
    return start, end


def _slack(request: TagRequest) -> float:
    """Longest distance from tag to anchor, in pixels, that needs no leader line."""
    return max(2.0, request.size[1] * 0.3)


def _pixel(point: Floats) -> tuple[int, int]:
    return round(float(point[0])), round(float(point[1]))


def _lattice(extent_px: int, size: int, height: int) -> Ints:
    """Starts of tags along one axis, half a tag height apart, both ends included."""
    last = extent_px - size
    return np.unique(np.append(np.arange(0, last, max(1, height // 2)), last))


def _table(rows: Sequence[Sequence[int]], columns: int) -> Ints:
    return np.array(rows, dtype=np.int64).reshape(-1, columns)
