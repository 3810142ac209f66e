"""Which objects are visible, decided by their pixels and never by a single ray."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from adamo_vh.observation import NOTHING, Percept

PixelBox = tuple[int, int, int, int]
"""Left, top, right, bottom in pixels; right and bottom are exclusive."""

REFERENCE_AREA_PX = 1920 * 1080
"""Picture size for which pixel thresholds are stated."""
FEWEST_PIXELS = 4
"""No picture is so small that fewer pixels count as seeing something."""

_Ids = NDArray[np.int16]


@dataclass(frozen=True, slots=True)
class VisibleObject:
    """An object with enough visible pixels."""

    id: int
    pixels: int
    """How many pixels show it, in whichever layer."""
    box_px: PixelBox
    """Tight around those pixels."""


def pixel_threshold(min_pixels: int, width_px: int, height_px: int) -> int:
    """Pixels that an object needs in a picture of a given size.

    Args:
        min_pixels: Pixels needed at 1920x1080.
        width_px: Width of the picture.
        height_px: Height of the picture.

    Returns:
        The same share of the picture's area, rounded up, and `FEWEST_PIXELS` at least.
    """
    scaled = -(-min_pixels * width_px * height_px // REFERENCE_AREA_PX)
    return max(FEWEST_PIXELS, scaled)


def visible_objects(percept: Percept, min_pixels: int) -> tuple[VisibleObject, ...]:
    """Count the pixels of each object over all layers and keep the objects with enough of them.

    A pixel shows an object if any layer says so: what stands behind glass shares its pixels with
    the glass, and both are visible.

    Args:
        percept: The raw capture.
        min_pixels: Pixels that an object needs at 1920x1080; see `pixel_threshold`.

    Returns:
        The visible objects, by ascending id.
    """
    layers = percept.id_layers
    height_px, width_px = layers[0].shape
    threshold = pixel_threshold(min_pixels, width_px, height_px)
    visible = []
    for object_id, box in sorted(_boxes(layers).items()):
        pixels = _count(layers, object_id, box)
        if pixels >= threshold:
            visible.append(VisibleObject(object_id, pixels, box))
    return tuple(visible)


def _boxes(layers: Sequence[_Ids]) -> dict[int, PixelBox]:
    """Tight box of every id over all layers."""
    boxes = _boxes_where(layers[0], layers[0] != NOTHING)
    for layer in layers[1:]:
        # What equals the front layer is boxed already, so only the windows of glass are searched.
        for object_id, box in _boxes_where(layer, layer != layers[0]).items():
            boxes[object_id] = _union(boxes.get(object_id, box), box)
    return boxes


def _boxes_where(layer: _Ids, changed: NDArray[np.bool_]) -> dict[int, PixelBox]:
    """Tight box of every id inside the rectangle that holds all changed pixels."""
    rows, columns = np.flatnonzero(changed.any(axis=1)), np.flatnonzero(changed.any(axis=0))
    if not len(rows):
        return {}
    top, left = int(rows[0]), int(columns[0])
    window = layer[top : rows[-1] + 1, left : columns[-1] + 1]
    ids, rows, starts, stops = _runs(window)
    if not len(ids):
        return {}
    first = np.flatnonzero(np.concatenate([[True], ids[1:] != ids[:-1]]))
    sides = (
        left + np.minimum.reduceat(starts, first),
        top + np.minimum.reduceat(rows, first),
        left + np.maximum.reduceat(stops, first),
        top + np.maximum.reduceat(rows, first) + 1,
    )
    boxes = zip(*(side.tolist() for side in sides), strict=True)
    return dict(zip(ids[first].tolist(), boxes, strict=True))


def _runs(window: _Ids) -> tuple[NDArray[np.intp], ...]:
    """Horizontal runs of one object's pixels: id, row, first and past-the-last column; by id.

    They are few, so that sorting them is much cheaper than looking for each id.
    """
    height, width = window.shape[0], window.shape[1] + 1
    padded = np.full((height, width), NOTHING, np.int16)
    # A column of nothing ends the last run of each row.
    padded[:, :-1] = window
    line = padded.ravel()
    ends = np.flatnonzero(line[1:] != line[:-1])
    starts = np.concatenate([[0], ends[:-1] + 1])[: len(ends)]
    ids = line[ends]
    shown = np.flatnonzero(ids != NOTHING)
    order = shown[np.argsort(ids[shown], kind="stable")]
    row, column = np.divmod(starts[order], width)
    return ids[order].astype(np.intp), row, column, ends[order] % width + 1


def _union(a: PixelBox, b: PixelBox) -> PixelBox:
    return min(a[0], b[0]), min(a[1], b[1]), max(a[2], b[2]), max(a[3], b[3])


def _count(layers: Sequence[_Ids], object_id: int, box: PixelBox) -> int:
    """Pixels in a box that show an object in any layer."""
    left, top, right, bottom = box
    shows = layers[0][top:bottom, left:right] == object_id
    for layer in layers[1:]:
        shows = shows | (layer[top:bottom, left:right] == object_id)
    return int(np.count_nonzero(shows))
