"""What a thing may be: each known class weighed by its volume, its outline, colours and print."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache

import numpy as np
from numpy.typing import NDArray

from adamo_vh.inference.baseline.colours import COLOURS
from adamo_vh.inference.baseline.prototypes import class_of, prototypes
from adamo_vh.inference.baseline.sight import Sight
from adamo_vh.inference.baseline.words import named_kinds

Beliefs = Mapping[str, float]
"""Probability of each class for one thing."""
Floats = NDArray[np.float64]

_VIVID = {"grey": 0.0, "white": 0.0, "black": 0.5, "brown": 0.5}
"""How much a colour speaks against glass; all others fully."""
_SHADING = 0.1
"""Share of grey or black that says nothing."""
_READABLE_PX = 600
"""Pixels from which missing print means something."""
_PRINT_WEIGHT = 0.7
_WORD_WEIGHT = 5.0
_LEAST_PIXELS = 30
"""A thing with fewer is judged by its volume alone."""


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
    if sight is not None and sight.pixels >= _LEAST_PIXELS:
        if not sight.cut and sight.misfits:
            misfit = misfit + np.array([sight.misfits.get(name, 0.0) for name in usual.names])
        misfit = misfit + _colour_misfit(sight) + _print_misfit(sight) - _named(sight)
    weights = np.exp(-misfit)
    total = float(weights.sum()) or 1.0
    return dict(zip(usual.names, (weights / total).tolist(), strict=True))


def likeliest(beliefs: Beliefs) -> str:
    """What a thing most probably is."""
    return max(beliefs, key=lambda name: beliefs[name])


@dataclass(frozen=True, slots=True)
class _Usual:
    """All prototypes as arrays over the classes."""

    names: tuple[str, ...]
    log_volume: Floats
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
        np.log([p.volume_cm3 for p in known]),
        np.array([p.spread for p in known]),
        np.array([p.label for p in known]),
        np.array([p.transparent for p in known]),
        1 - np.array([[colours.get(name, 0.0) for name in COLOURS] for colours in usual]),
    )


def _colour_misfit(sight: Sight) -> Floats:
    """How unusual the colours are for each class."""
    vivid = sum(_VIVID.get(colour, 1.0) * share for colour, share in sight.colours.items())
    telling = [
        # Shadows and highlights are on everything.
        max(0.0, sight.share(name) - (_SHADING if name in ("grey", "black") else 0.0))
        for name in COLOURS
    ]
    glassy = (1 - sight.clear) * (1.5 + 3.0 * vivid)
    usual = _usual()
    odd = usual.odd @ np.array(telling)
    return np.where(usual.transparent, glassy, 2.5 * odd + 1.5 * sight.clear)


def _print_misfit(sight: Sight) -> Floats:
    """Printed rows speak for what usually carries a label, and a large plain face against it."""
    if sight.pixels < _READABLE_PX:
        return np.zeros(len(_usual().names))
    printed = math.tanh(sight.text / 0.08)
    expected = 0.1 + 0.8 * _usual().label
    likely = printed * expected + (1 - printed) * (1 - expected * 0.7)
    return np.asarray(-_PRINT_WEIGHT * np.log(likely))


def _named(sight: Sight) -> Floats:
    """A name that can be read on a thing says what it is, if such things carry their names."""
    usual, words = _usual(), named_kinds(sight.words)
    read = np.array([words.get(name, 0.0) for name in usual.names])
    return _WORD_WEIGHT * read * np.minimum(1.0, 2 * usual.label)
