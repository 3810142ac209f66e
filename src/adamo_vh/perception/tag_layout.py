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
    fitting = [item for item in requests if item.size[0] <= width_px and item.size[1] <= height_px]
    if not fitting:
        return ()
    board = _Board(width_px, height_px, fitting, clutter, boxes, _table(marks, 2))
    return tuple(placed for number in range(len(fitting)) if (placed := board.place(number)))


@dataclass(frozen=True, slots=True)
class _Places:
    """(R, N): N places for the tag of each of R requests, and what they cost on an empty board."""

    rects: Ints
    """(4, R, N) left, top, right and bottom."""
    standing: Floats
    """What each costs for where it stands relative to the anchor."""
    hidden: Floats
    """What hiding objects costs."""
    marks: Ints
    """How many marks each covers."""
    foreign: Floats
    """What seeming to name other objects costs."""
    least: Floats
    """What each costs in all at least; infinite where it covers its anchor."""


class _Board:
    """The picture with the tags placed so far.

    Most of what a place costs does not depend on the tags that are placed before, so it is worked
    out for all requests at once.
    """

    def __init__(
        self,
        width_px: int,
        height_px: int,
        requests: Sequence[TagRequest],
        clutter: Clutter,
        boxes: Ints,
        marks: Ints,
    ) -> None:
        self.requests = requests
        self.extent = np.array([width_px, height_px])
        self.anchors = _table([request.anchor for request in requests], 4)
        self.sizes = _table([request.size for request in requests], 2)
        self.clutter = clutter
        self.boxes = boxes
        """(4, B) boxes of all objects."""
        self.foreign = (boxes[:, :, None] != self.anchors[:, None]).any(axis=0)
        """(B, R): whether a box is not what the request names."""
        self.marks = marks
        """(2, M) points to keep clear."""
        self.lines: Ints = _table([], 2)
        """(2, L) samples of leader lines, to keep clear as well."""
        self.taken: Ints = _table([], 4)
        """(4, T) rectangles of the tags placed so far."""
        self.rings: dict[int, _Places] = {}
        """Places on the rings of each round that was needed."""
        self.lattices: dict[tuple[int, int], Ints] = {}
        """(4, N) free places for tags of a size, all over the picture."""
        left, top = corner = self.anchors[:2] - self.sizes * np.array([[0], [1]])
        inside = (top >= 0) & (left + self.sizes[0] <= width_px)
        corner = np.minimum(np.maximum(corner, 0), self.extent[:, None] - self.sizes)
        self.ideal = self._weighed(_rects(corner[..., None], self.sizes), slice(None))
        """(R, 1): on top of each anchor, flush left."""
        hiding = self.ideal.hidden + _MARK * self.ideal.marks + self.ideal.foreign
        self.costless = inside & (hiding[:, 0] < _NOTHING_HIDDEN)
        """(R,): whether that place costs nothing on an empty board."""

    def place(self, number: int) -> PlacedTag | None:
        """Take the best place for a request, if there is any."""
        request = self.requests[number]
        rect = self._ideal(number)
        if rect is None:
            rect = self._near(number)
        if rect is None:
            rect = self._anywhere(number)
        if rect is None:
            return None
        self.taken = np.concatenate([self.taken, rect[:, None]], axis=1)
        leader = None
        start, end = _leaders(rect, request.anchor)
        if math.dist(start, end) > _slack(request):
            leader = (_pixel(start), _pixel(end))
            samples = start[:, None] + _LEADER_SAMPLES * (end - start)[:, None]
            self.lines = np.concatenate([self.lines, samples.astype(np.int64)], axis=1)
        left, top, right, bottom = rect.tolist()
        return PlacedTag(request.tag, (left, top, right, bottom), leader)

    def _ideal(self, number: int) -> Ints | None:
        """The place on top of the anchor if it costs nothing: nothing can beat it."""
        if not self.costless[number]:
            return None
        rect = self.ideal.rects[:, number, 0]
        hides = (
            _overlap(rect[:, None], self.taken).any() or _contain(rect[:, None], self.lines).any()
        )
        return None if hides else rect

    def _near(self, number: int) -> Ints | None:
        """Search the rings around the anchor, from the inside out."""
        best: Ints | None = None
        best_cost = np.inf
        for count, rings in enumerate(_RINGS):
            # Farther rings cannot beat what costs less than getting there.
            if best_cost <= rings[0] ** _FAR:
                break
            places = self._round(count)
            which = (places.least[number] < best_cost + _NOTHING_HIDDEN).nonzero()[0]
            which = which[self._free(places.rects[:, number, which])]
            if len(which):
                costs = self._hiding(places, number, which) + places.standing[number, which]
                shortlist = costs.argsort(kind="stable")[:_SHORTLIST]
                rects = places.rects[:, number, which[shortlist]]
                costs = costs[shortlist] + self._leading(rects, number)
                winner = int(costs.argmin())
                if costs[winner] < best_cost:
                    best, best_cost = rects[:, winner], costs[winner]
        return best

    def _round(self, count: int) -> _Places:
        """The places of all requests on the rings of a round."""
        if count not in self.rings:
            rects = _ring_rects(self.anchors, self.sizes, _RINGS[count], self.extent)
            self.rings[count] = self._weighed(rects, slice(None))
        return self.rings[count]

    def _anywhere(self, number: int) -> Ints | None:
        """Search a lattice over the whole picture."""
        request = self.requests[number]
        rects = self.lattices.get(request.size)
        if rects is None:
            rects = _lattice_rects(request.size, self.extent)
        # What is taken stays taken.
        self.lattices[request.size] = rects = rects[:, self._free(rects)]
        if not rects.size:
            return None
        places = self._weighed(rects[:, None], slice(number, number + 1))
        hiding = self._hiding(places, 0, slice(None))
        beside = np.isfinite(places.least[0])
        if beside.any():
            costs = np.where(beside, hiding + places.standing[0], np.inf)
            return np.asarray(rects[:, costs.argmin()])
        return np.asarray(rects[:, hiding.argmin()]) if request.is_object else None

    def _weighed(self, rects: Ints, numbers: slice) -> _Places:
        """Weigh (4, R, N) places of some requests by all that is known before tags are placed."""
        anchors, sizes = self.anchors[:, numbers, None], self.sizes[:, numbers, None]
        touching = _overlap(rects + _TOUCHING[:, None, None], self.boxes[..., None, None])
        touching &= self.foreign[:, numbers, None]
        foreign = _FOREIGN * touching.sum(axis=0)
        marks = _contain(rects, self.marks[..., None, None]).sum(axis=0)
        hidden = _HIDING * self.clutter.hidden(rects.reshape(4, -1).T).reshape(marks.shape)
        standing = _standing(rects, anchors, sizes)
        least = hidden + _MARK * marks + foreign + standing
        least[_overlap(rects, anchors)] = np.inf
        return _Places(rects, standing, hidden, marks, foreign, least)

    def _free(self, rects: Ints) -> NDArray[np.bool_]:
        """Whether places overlap no placed tag."""
        return np.asarray(~_overlap(rects, self.taken[..., None]).any(axis=0))

    def _hiding(self, places: _Places, number: int, which: NDArray[np.intp] | slice) -> Floats:
        """What some places of a request would hide or seem to name."""
        rects = places.rects[:, number, which]
        marks = places.marks[number, which] + _contain(rects, self.lines[..., None]).sum(axis=0)
        hidden, foreign = places.hidden[number, which], places.foreign[number, which]
        return np.asarray(hidden + _MARK * marks + foreign)

    def _leading(self, rects: Ints, number: int) -> Floats:
        """What the leader line of each place costs."""
        request = self.requests[number]
        start, end = _leaders(rects, request.anchor)
        needed = np.hypot(*(end - start)) > _slack(request)
        if not needed.any():
            return np.zeros(len(needed))
        lines = start[..., None] + _LEADER_SAMPLES * (end - start)[..., None]
        below = _contain(self.taken[..., None, None], lines)
        others = self.boxes[:, self.foreign[:, number]]
        through = _contain(others[..., None, None], lines).any(axis=0)
        crossed, inside = below.any(axis=2).sum(axis=0), through.sum(axis=1)
        return np.asarray(needed * (_LEADER + _CROSSED * crossed + _THROUGH * inside))


def _ring_rects(anchors: Ints, sizes: Ints, rings: Floats, extent: Ints) -> Ints:
    """(4, R, N) candidate places on rings around (4, R) anchors, moved into the picture."""
    left, top, right, bottom = anchors[..., None, None]
    width, height = sizes[..., None, None]
    gaps = np.rint(rings[:, None] * height)
    # Each side offers even steps, and the two places that are flush with the anchor's ends.
    count = len(_ALONG) + 2
    xs, ys = np.empty((2, anchors.shape[1], len(rings), count))
    xs[..., :1], xs[..., 1:2], ys[..., :1], ys[..., 1:2] = left, right - width, top, bottom - height
    xs[..., 2:] = left - gaps - width + _ALONG * (right - left + width + 2 * gaps)
    ys[..., 2:] = top - gaps - height + _ALONG * (bottom - top + height + 2 * gaps)
    corners = np.empty((2, anchors.shape[1], 4, len(rings), count))
    corners[0, :, 0], corners[1, :, 0] = xs, top - gaps - height
    corners[0, :, 1], corners[1, :, 1] = xs, bottom + gaps
    corners[0, :, 2], corners[1, :, 2] = left - gaps - width, ys
    corners[0, :, 3], corners[1, :, 3] = right + gaps, ys
    room = (extent[:, None] - sizes)[..., None]
    corner = np.rint(np.minimum(np.maximum(corners.reshape(*sizes.shape, -1), 0), room))
    return _rects(corner.astype(np.int64), sizes)


def _rects(corner: Ints, sizes: Ints) -> Ints:
    """(4, R, N) places from (2, R, N) corners and (2, R) sizes."""
    return np.concatenate([corner, corner + sizes[..., None]])


def _lattice_rects(size: tuple[int, int], extent: Ints) -> Ints:
    """(4, N) places for tags of a size, all over the picture."""
    width, height = size
    xs, ys = _lattice(int(extent[0]), width, height), _lattice(int(extent[1]), height, height)
    x, y = (axis.ravel() for axis in np.meshgrid(xs, ys))
    return np.stack([x, y, x + width, y + height])


def _standing(rects: Ints, anchors: Ints, sizes: Ints) -> Floats:
    """What each place costs for where it stands relative to its anchor."""
    left, top, right, bottom = rects
    low_x, low_y, high_x, high_y = anchors
    width, height = sizes
    shared_x = np.minimum(right, high_x) - np.maximum(left, low_x)
    shared_y = np.minimum(bottom, high_y) - np.maximum(top, low_y)
    away = np.hypot(np.maximum(-shared_x, 0), np.maximum(-shared_y, 0)) / height
    contact = np.maximum(
        np.maximum(shared_x, 0) / np.minimum(width, high_x - low_x),
        np.maximum(shared_y, 0) / np.minimum(height, high_y - low_y),
    )
    shift = abs(left - low_x) / height
    cost = away**_FAR + _CORNER * (1.0 - contact) + _BELOW * (top >= high_y) + _MISALIGNED * shift
    return np.asarray(cost)


def _overlap(rects: Ints, others: Ints) -> NDArray[np.bool_]:
    """Whether (4, ...) rectangles overlap others."""
    left, top, right, bottom = rects
    other_left, other_top, other_right, other_bottom = others
    return np.asarray(
        (left < other_right) & (other_left < right) & (top < other_bottom) & (other_top < bottom)
    )


def _contain(rects: Ints, points: NDArray[np.number]) -> NDArray[np.bool_]:
    """Whether (4, ...) rectangles hold (2, ...) points."""
    left, top, right, bottom = rects
    u, v = points
    return np.asarray((left <= u) & (u < right) & (top <= v) & (v < bottom))


def _leaders(rects: Ints, anchor: PixelBox) -> tuple[Floats, Floats]:
    """Lines from (4, ...) tags to their anchor: (2, ...) starts on tags and ends on the anchor."""
    left, top, right, bottom = rects
    x = np.minimum(np.maximum((left + right) / 2, anchor[0]), anchor[2] - 1)
    y = np.minimum(np.maximum((top + bottom) / 2, anchor[1]), anchor[3] - 1)
    start_x = np.minimum(np.maximum(x, left), right - 1)
    start_y = np.minimum(np.maximum(y, top), bottom - 1)
    return np.array([start_x, start_y]), np.array([x, y])


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
    """(columns, rows): each column in one piece of memory."""
    return np.array(rows, dtype=np.int64).reshape(-1, columns).T.copy()
