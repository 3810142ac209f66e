"""What two objects have in common that may have led to a mix-up: class, colour, shape, size."""

from __future__ import annotations

import colorsys
from collections import Counter

import numpy as np

from adamo_vh.analysis.diagnosis.sight import best_glimpse
from adamo_vh.analysis.diagnosis.story import Story
from adamo_vh.engine import acting_body
from adamo_vh.geometry import Vec3
from adamo_vh.observation import NOTHING, Percept

_SIZE_PX = (640, 360)
"""Of the picture that colours are taken from."""
_LONG, _FLAT, _ROUND = 2.5, 0.4, 0.85
_SHARE = 0.25
"""A colour that this part of an object has is one of its colours."""
_ALIKE = 0.7
"""Sizes are alike if the smaller one is this part of the larger one, along each edge."""
_HUES = ((20, "red"), (45, "orange"), (70, "yellow"), (165, "green"), (255, "blue"))


def shared(story: Story, one: int, other: int) -> tuple[str, ...]:
    """The attributes that two objects share, in words; none if they are quite unlike."""
    found = []
    if story.names.get(one) == story.names.get(other):
        found.append(f"class ({story.names[one]})")
    hues = sorted(_colours(story, one) & _colours(story, other))
    if hues:
        found.append(f"colour ({', '.join(hues)})")
    first, second = (story.moments[0].object(number) for number in (one, other))
    if first is not None and second is not None:
        a, b = first.box.size, second.box.size
        if _shape(a) == _shape(b):
            found.append(f"shape ({_shape(a)})")
        edges = zip(sorted((a.x, a.y, a.z)), sorted((b.x, b.y, b.z)), strict=True)
        if all(min(pair) >= _ALIKE * max(pair) for pair in edges):
            found.append("size")
    return tuple(found)


def _shape(size: Vec3) -> str:
    """The shape of a box in a word; upright things keep their height, so z is told apart."""
    wide, narrow = max(size.x, size.y), min(size.x, size.y)
    if max(wide, size.z) >= _LONG * sorted((size.x, size.y, size.z))[1]:
        return "long and thin"
    if size.z <= _FLAT * narrow:
        return "flat and round" if narrow >= _ROUND * wide else "flat"
    return "round and upright" if narrow >= _ROUND * wide else "box-like"


def _colours(story: Story, object_id: int) -> frozenset[str]:
    """The colours of an object as the agent saw it best; none if it never did."""
    glimpse = best_glimpse(story, object_id)
    if glimpse is None:
        return frozenset()
    story.put_back(glimpse.moment)
    percept = acting_body(story.world).see(*_SIZE_PX)
    pixels = percept.rgb[_mask(percept, object_id)]
    counted = Counter(_colour(*(float(v) / 255 for v in pixel)) for pixel in pixels)
    least = _SHARE * max(1, counted.total())
    return frozenset(name for name, count in counted.items() if count >= least)


def _mask(percept: Percept, object_id: int) -> np.ndarray:
    front = percept.id_layers[0]
    shows = front == object_id
    if not shows.any() and object_id != NOTHING:
        for layer in percept.id_layers[1:]:
            shows = shows | (layer == object_id)
    return np.asarray(shows)


def _colour(red: float, green: float, blue: float) -> str:
    """A colour in a word."""
    hue, saturation, value = colorsys.rgb_to_hsv(red, green, blue)
    if value < 0.2:
        return "black"
    if saturation < 0.2:
        return "white" if value > 0.75 else "grey"
    degrees = hue * 360
    if 10 <= degrees < 45 and value < 0.55:
        return "brown"
    return next(
        (name for limit, name in _HUES if degrees < limit), "red" if degrees > 330 else "violet"
    )
