"""Which kind of thing something is: by its tag, or by its volume and its looks."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache

import numpy as np
from numpy.typing import NDArray

from adamo_vh.inference.baseline.sight.measures import COLOURS, Sight
from adamo_vh.inference.baseline.sight.printed import named_kinds
from adamo_vh.inference.baseline.sight.prototypes import prototypes
from adamo_vh.inference.baseline.tags import parts_of


@cache
def _by_lower_name() -> dict[str, str]:
    return {name.lower(): name for name in prototypes()}


def class_of(tag: str) -> str | None:
    """The class that a semantic tag names, or None for an opaque or unknown one.

    Its last word counts if the whole is not known: a "WoodenSpoon" is a spoon.
    """
    name, _ = parts_of(tag)
    known, words = _by_lower_name(), re.findall(r"[A-Z]?[a-z]+", name)
    return known.get(name.replace("_", "").lower()) or known.get(words[-1].lower() if words else "")


def size_of(name: str, volume_cm3: float) -> tuple[float, float]:
    """Usual width and height of a thing of a class that has a certain volume.

    Returns:
        Largest horizontal extent and height, metres.
    """
    prototype = prototypes()[name]
    scale = (max(volume_cm3, 0.1) / prototype.volume_cm3) ** (1 / 3)
    return prototype.size_m[0] * scale, prototype.size_m[2] * scale


Beliefs = Mapping[str, float]
"""Probability of each class for one thing; what is left to 1 is that it is none of them."""
Floats = NDArray[np.float64]

_VIVID = {"grey": 0.0, "white": 0.0, "black": 0.5, "brown": 0.5}
"""How much a colour speaks against glass; all others fully."""
_SHADING = 0.1
"""Share of grey or black that says nothing."""
_READABLE_PX = 600
"""Pixels from which missing print means something."""
_PRINT_WEIGHT = 0.7
_PLAIN_PX, _PLAIN_WEIGHT = 150, 2.0
_WORD_WEIGHT = 5.0
_LEAST_PIXELS = 30
"""A thing with fewer is judged by its volume alone."""
_HEIGHT_SPREAD, _HEIGHT_OFF_M = 0.2, 0.012
"""Within a class, as a logarithm; and what a height is off by."""
_MOST_BY_HEIGHT = 4.0
"""It may be on something that no point tells of."""
_NONE_OF_THESE = math.exp(-7)
"""Weight of all kinds that are not known; what fits none of the known ones is none of them."""


def classify(tag: str, volume_cm3: float, sight: Sight | None) -> Beliefs:
    """What a thing may be.

    A semantic tag names the class. Behind an opaque tag, each prototype is weighed by the volume
    (as the text tells), by the extents in the picture and by the colours.
    """
    if named := class_of(tag):
        return {named: 1.0}
    usual = _usual()
    off = (math.log(max(volume_cm3, 0.1)) - usual.log_volume) / usual.spread
    misfit = off * off / 2
    if sight is not None and sight.height_m is not None:
        misfit = misfit + _height_misfit(volume_cm3, sight.height_m)
    if sight is not None and sight.pixels >= _LEAST_PIXELS:
        if not sight.cut and sight.misfits:
            misfit = misfit + np.array([sight.misfits.get(name, 0.0) for name in usual.names])
        misfit = misfit + _colour_misfit(sight) + _print_misfit(sight) - _named(sight)
        misfit = misfit + _plain_misfit(sight)
    weights = usual.weight * np.exp(-misfit)
    total = float(weights.sum()) + _NONE_OF_THESE
    return dict(zip(usual.names, (weights / total).tolist(), strict=True))


def likeliest(beliefs: Beliefs) -> str:
    """What a thing most probably is."""
    return max(beliefs, key=lambda name: beliefs[name])


@dataclass(frozen=True, slots=True)
class _Usual:
    """All prototypes as arrays over the classes."""

    names: tuple[str, ...]
    weight: Floats
    log_volume: Floats
    log_height: Floats
    """Of a thing of 1 cm3 with the usual proportions, metres."""
    spread: Floats
    label: Floats
    transparent: NDArray[np.bool_]
    odd: Floats
    """(classes, colours), how unusual each colour is."""


@cache
def _usual() -> _Usual:
    known = list(prototypes().values())
    usual = [dict(p.colours) for p in known]
    for prototype, colours in zip(known, usual, strict=True):
        colours["white"] = max(colours.get("white", 0.0), prototype.white)
    return _Usual(
        tuple(p.name for p in known),
        np.array([p.weight for p in known]),
        np.log([p.volume_cm3 for p in known]),
        np.log([p.size_m[2] / np.cbrt(p.volume_cm3) for p in known]),
        np.array([p.spread for p in known]),
        np.array([p.label for p in known]),
        np.array([p.transparent for p in known]),
        1 - np.array([[colours.get(name, 0.0) for name in COLOURS] for colours in usual]),
    )


def _height_misfit(volume_cm3: float, height_m: float) -> Floats:
    """How unusual the height is for things of each class with this volume."""
    usual = _usual().log_height + math.log(max(volume_cm3, 0.1)) / 3
    off = (math.log(height_m) - usual) / np.hypot(_HEIGHT_SPREAD, _HEIGHT_OFF_M / np.exp(usual))
    return np.asarray(np.minimum(off * off / 2, _MOST_BY_HEIGHT))


def _colour_misfit(sight: Sight) -> Floats:
    """How unusual the colours are for each class."""
    vivid = sum(_VIVID.get(colour, 1.0) * share for colour, share in sight.colours.items())
    telling = [
        # Shadows and highlights are on everything.
        max(0.0, sight.share(name) - (_SHADING if name in ("grey", "black") else 0.0))
        for name in COLOURS
    ]
    glassy = (1 - sight.clear) * (0.6 + 5.0 * vivid)
    usual = _usual()
    odd = usual.odd @ np.array(telling)
    return np.where(usual.transparent, glassy, 3.0 * odd + 1.5 * sight.clear)


def _print_misfit(sight: Sight) -> Floats:
    """Printed rows speak for what usually carries a label, and a large plain face against it."""
    if sight.pixels < _READABLE_PX:
        return np.zeros(len(_usual().names))
    printed = math.tanh(sight.text / 0.08)
    expected = 0.1 + 0.8 * _usual().label
    likely = printed * expected + (1 - printed) * (1 - expected * 0.7)
    return np.asarray(-_PRINT_WEIGHT * np.log(likely))


def _plain_misfit(sight: Sight) -> Floats:
    """A label differs from what it is on: a thing of one vivid colour all over has none."""
    vivid = [share for colour, share in sight.colours.items() if colour not in _VIVID]
    plain = min(max((max(vivid, default=0.0) - 0.75) / 0.15, 0.0), 1.0)
    enough = sight.pixels >= _PLAIN_PX
    return np.asarray(_PLAIN_WEIGHT * plain * enough * _usual().label)


def _named(sight: Sight) -> Floats:
    """A name that can be read on a thing says what it is, if such things carry their names."""
    usual, words = _usual(), named_kinds(sight.words)
    read = np.array([words.get(name, 0.0) for name in usual.names])
    return _WORD_WEIGHT * read * np.minimum(1.0, 2 * usual.label)
