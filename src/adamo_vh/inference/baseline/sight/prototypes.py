"""What people know about household things: usual sizes, colours, shapes, labels, white parts.

Ordinary round numbers about each class in general. They stand in for the world knowledge that a
learned model brings along, and are never about one certain object.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cache
from types import MappingProxyType


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
    weight: float = 1.0
    """How likely one is to be there, before anything is seen."""

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


_FURTHER = (
    Prototype("Apple", (0.08, 0.08, 0.075), (("red", 0.5), ("green", 0.5), ("yellow", 0.3)),
              ("round",)),
    Prototype("Orange", (0.08, 0.08, 0.08), (("orange", 0.9),), ("round",)),
    Prototype("Banana", (0.19, 0.08, 0.04), (("yellow", 0.9), ("brown", 0.2)), ("long",)),
    Prototype("Pumpkin", (0.22, 0.22, 0.18), (("orange", 0.8), ("green", 0.3)), ("round",)),
    Prototype("Bread", (0.28, 0.12, 0.10), (("brown", 0.8), ("orange", 0.4)), ("long",)),
    Prototype("Teapot", (0.23, 0.15, 0.15),
              (("blue", 0.3), ("green", 0.3), ("red", 0.2), ("brown", 0.2), ("grey", 0.2)),
              ("round",), white=0.4, spread=0.6),
    Prototype("Bowl", (0.16, 0.16, 0.07), (("blue", 0.3), ("green", 0.2), ("red", 0.2)),
              ("round",), white=0.5),
    Prototype("Vase", (0.13, 0.13, 0.26), (("blue", 0.3), ("green", 0.2), ("brown", 0.2)),
              ("round",), white=0.3, spread=0.7),
    Prototype("Pan", (0.42, 0.26, 0.06), (("black", 0.8), ("grey", 0.5)), ("round", "flat")),
    Prototype("Spoon", (0.27, 0.055, 0.03), (("brown", 0.5), ("grey", 0.5), ("orange", 0.3)),
              ("long",), spread=0.7),
    Prototype("Fork", (0.20, 0.025, 0.02), (("grey", 0.9),), ("long",)),
    Prototype("Scissors", (0.19, 0.085, 0.012),
              (("grey", 0.7), ("red", 0.3), ("black", 0.3), ("orange", 0.2), ("pink", 0.2)),
              ("long", "flat")),
    Prototype("RemoteControl", (0.18, 0.05, 0.022), (("black", 0.8), ("grey", 0.4)), ("long",)),
    Prototype("Phone", (0.15, 0.075, 0.01), (("black", 0.8), ("grey", 0.4)), ("flat",)),
    Prototype("Pen", (0.14, 0.011, 0.011), (("blue", 0.4), ("black", 0.5), ("red", 0.2)),
              ("long",)),
    Prototype("Book", (0.22, 0.15, 0.03),
              (("blue", 0.3), ("red", 0.3), ("green", 0.2), ("brown", 0.2), ("black", 0.2)),
              ("flat", "box"), white=0.3, label=0.8, spread=0.7),
    Prototype("Hammer", (0.30, 0.12, 0.032), (("brown", 0.6), ("grey", 0.6), ("black", 0.3)),
              ("long",)),
    Prototype("Pliers", (0.18, 0.06, 0.02), (("red", 0.4), ("grey", 0.6), ("blue", 0.2)),
              ("long",)),
    Prototype("ToyCar", (0.12, 0.06, 0.05),
              (("red", 0.4), ("blue", 0.3), ("yellow", 0.3), ("black", 0.4)), ("box",), spread=0.7),
    Prototype("Duck", (0.10, 0.08, 0.09), (("yellow", 0.9), ("orange", 0.4)), ("irregular",)),
    Prototype("Teddy", (0.20, 0.16, 0.26), (("brown", 0.8), ("yellow", 0.2)), ("irregular",),
              spread=0.8),
    Prototype("Ball", (0.16, 0.16, 0.16),
              (("red", 0.3), ("blue", 0.3), ("yellow", 0.2), ("green", 0.2)), ("round",),
              white=0.2, spread=0.9),
    Prototype("Candle", (0.07, 0.07, 0.11), (("red", 0.3), ("yellow", 0.3)), ("cylinder",),
              white=0.5),
    Prototype("Shoe", (0.28, 0.10, 0.11), (("black", 0.5), ("brown", 0.4)), ("long",), white=0.2),
    Prototype("Brush", (0.21, 0.06, 0.04), (("brown", 0.5), ("black", 0.4), ("blue", 0.2)),
              ("long",)),
    Prototype("Clock", (0.12, 0.06, 0.12), (("black", 0.4), ("grey", 0.4)), ("round",), white=0.5,
              label=0.3),
)  # fmt: skip
"""Other things that homes have. Without them, everything would have to be one of the above."""

_OTHER = 0.15
"""Weight of each of them: what is asked for by name is likelier to be there."""


@cache
def prototypes() -> Mapping[str, Prototype]:
    """All known classes by name, those that instructions can name first."""
    further = (replace(prototype, weight=_OTHER) for prototype in _FURTHER)
    return MappingProxyType({prototype.name: prototype for prototype in (*_ALL, *further)})
