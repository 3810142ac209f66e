"""What the pixels of one object say, as plain numbers."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field


@dataclass(frozen=True, slots=True)
class Sight:
    """Measurements inside an object's box in the frame."""

    pixels: int
    """Pixels taken to show the object."""
    colours: Mapping[str, float] = field(default_factory=dict)
    """Share of those pixels by colour name; black, grey and white included."""
    text: float = 0.0
    """Share of the object that looks like rows of letters, 0 to 1."""
    roundness: float = 0.0
    """How well an ellipse fits the silhouette, 0 to 1."""
    clear: float = 0.0
    """How much the object looks like what is behind it, 0 to 1."""
    misfits: Mapping[str, float] = field(default_factory=dict)
    """How badly each class of things would fill the box, see `silhouettes.misfits`; empty if the
    place of the eyes is not known."""
    words: tuple[str, ...] = ()
    """Printed words that were read on it."""
    cut: bool = False
    """Whether the box touches the edge of the frame."""

    def share(self, colour: str) -> float:
        """Share of one colour."""
        return self.colours.get(colour, 0.0)
