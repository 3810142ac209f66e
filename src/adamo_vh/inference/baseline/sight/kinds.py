"""What people know about household things: usual sizes, colours, shapes, labels, white parts.

Ordinary round numbers about each class in general. They stand in for the world knowledge that a
learned model brings along, and are never about one certain object.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache

import numpy as np
from numpy.typing import NDArray

from adamo_vh.inference.baseline.sight.measures import COLOURS, Sight
from adamo_vh.inference.baseline.sight.printed import named_kinds
from adamo_vh.inference.baseline.tags import parts_of


@dataclass(frozen=True, slots=True)
class Prototype:
    """A class of things."""

    name: str
    size_m: tuple[float, float, float]
    """Usual length, width and height at rest, length >= width, metres."""
    colours: tuple[tuple[str, float], ...]
    """Colours that such things often have, with how often."""
    shape: tuple[str, ...]
    """Words for its shape."""
    white: float = 0.05
    """How often it has white or cream parts."""
    label: float = 0.03
    """How often it carries printed text."""
    transparent: bool = False
    spread: float = 0.5
    """How much the logarithm of the volume varies within the class (standard deviation)."""

    @property
    def volume_cm3(self) -> float:
        """Volume of the usual box."""
        length, width, height = self.size_m
        return length * width * height * 1e6


_METAL = (("grey", 0.5), ("yellow", 0.3), ("brown", 0.3))

_ALL = (
    Prototype("Lock", (0.05, 0.022, 0.07), _METAL, ("box",), spread=0.5),
    Prototype(
        "Flashlight", (0.17, 0.045, 0.045), (("black", 0.7), ("yellow", 0.4)),
        ("long", "cylinder"), label=0.05,
    ),
    Prototype(
        "Battery", (0.035, 0.03, 0.08),
        (("black", 0.5), ("brown", 0.4), ("green", 0.3), ("grey", 0.2)),
        ("cylinder", "long"), label=0.2, spread=0.8,
    ),
    Prototype(
        "Tape", (0.13, 0.13, 0.045), (("blue", 0.3), ("grey", 0.3), ("brown", 0.3)),
        ("round", "ring", "flat", "cylinder"), white=0.1, label=0.05, spread=0.5,
    ),
    Prototype(
        "Screwdriver", (0.22, 0.025, 0.024), (("red", 0.4), ("grey", 0.5), ("yellow", 0.2)),
        ("long",), spread=0.5,
    ),
    Prototype(
        "PeanutButter", (0.10, 0.10, 0.15), (("brown", 0.7), ("red", 0.3), ("orange", 0.3)),
        ("cylinder", "round"), white=0.2, label=0.95, spread=0.4,
    ),
    Prototype(
        "TomatoSoup", (0.072, 0.072, 0.105), (("red", 0.8), ("grey", 0.4), ("white", 0.5)),
        ("cylinder",), white=0.6, label=0.95, spread=0.4,
    ),
    Prototype(
        "Pills", (0.055, 0.055, 0.09), (("orange", 0.6), ("brown", 0.4), ("white", 0.7)),
        ("cylinder", "bottle"), white=0.8, label=0.9, spread=0.4,
    ),
    Prototype(
        "Binoculars", (0.18, 0.16, 0.065), (("black", 0.9),), ("box",), spread=0.5,
    ),
    Prototype(
        "Painkiller", (0.045, 0.045, 0.10), (("white", 0.9),),
        ("cylinder", "bottle"), white=0.9, label=0.9, spread=0.4,
    ),
    Prototype(
        "Lighter", (0.06, 0.02, 0.085), (("grey", 0.6), ("red", 0.2), ("yellow", 0.2)),
        ("box", "flat"), spread=0.5,
    ),
    Prototype(
        "Key", (0.06, 0.025, 0.003), (("yellow", 0.5), ("grey", 0.5), ("brown", 0.4)),
        ("long", "flat"), spread=0.8,
    ),
    Prototype(
        "WineBottle", (0.07, 0.07, 0.26),
        (("green", 0.5), ("black", 0.6), ("red", 0.4), ("white", 0.4)),
        ("bottle", "cylinder", "long"), white=0.6, label=0.95, spread=0.4,
    ),
    Prototype(
        "Glass", (0.09, 0.09, 0.14), (("grey", 0.5),), ("cylinder", "round"),
        transparent=True, spread=0.4,
    ),
    Prototype(
        "Cup", (0.13, 0.10, 0.12),
        (("orange", 0.25), ("blue", 0.25), ("red", 0.25), ("green", 0.2), ("white", 0.3)),
        ("cylinder", "round"), white=0.25, label=0.05, spread=0.4,
    ),
    Prototype(
        "IndoorPlant", (0.26, 0.26, 0.35), (("green", 0.95), ("brown", 0.5), ("orange", 0.3)),
        ("irregular",), spread=0.7,
    ),
    Prototype(
        "Plate", (0.25, 0.25, 0.03), (("red", 0.2), ("white", 0.5), ("blue", 0.2)),
        ("round", "flat"), white=0.5, spread=0.4,
    ),
)  # fmt: skip


@cache
def prototypes() -> dict[str, Prototype]:
    """All known classes by name."""
    return {prototype.name: prototype for prototype in _ALL}


@cache
def _by_lower_name() -> dict[str, str]:
    return {name.lower(): name for name in prototypes()}


def class_of(tag: str) -> str | None:
    """The class that a semantic tag names, or None for an opaque or unknown one."""
    name, _ = parts_of(tag)
    return _by_lower_name().get(name.replace("_", "").lower())


def size_of(name: str, volume_cm3: float) -> tuple[float, float]:
    """Usual width and height of a thing of a class that has a certain volume.

    Returns:
        Largest horizontal extent and height, metres.
    """
    prototype = prototypes()[name]
    scale = (max(volume_cm3, 0.1) / prototype.volume_cm3) ** (1 / 3)
    return prototype.size_m[0] * scale, prototype.size_m[2] * scale


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
_PLAIN_PX, _PLAIN_WEIGHT = 150, 2.0
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
        misfit = misfit + _plain_misfit(sight)
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
