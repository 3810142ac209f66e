"""What people know about household things: usual sizes, colours, shapes, labels, white parts.

Ordinary round numbers about each class in general. They stand in for the world knowledge that a
learned model brings along, and are never about one certain object.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache


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
    name = tag.rsplit("_", 1)[0]
    return _by_lower_name().get(name.lower())


def size_of(name: str, volume_cm3: float) -> tuple[float, float]:
    """Usual width and height of a thing of a class that has a certain volume.

    Returns:
        Largest horizontal extent and height, metres.
    """
    prototype = prototypes()[name]
    scale = (max(volume_cm3, 0.1) / prototype.volume_cm3) ** (1 / 3)
    return prototype.size_m[0] * scale, prototype.size_m[2] * scale
