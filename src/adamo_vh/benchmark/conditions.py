"""Atomic conditions: what must be true of the world when an episode ends.

Each is plain data that reads a `WorldState`; `str()` of one is its line in a report.
"""

from __future__ import annotations

from dataclasses import dataclass

from adamo_vh.benchmark.overlap import footprint_overlaps
from adamo_vh.engine import FLOOR, ObjectState, WorldState, supporting_object

NEAR_M = 0.30
"""Two objects are near when the centres of their boxes are at most this far apart in plan."""


@dataclass(frozen=True, slots=True)
class Holds:
    """The object is in the hand."""

    id: int

    @property
    def objects(self) -> frozenset[int]:
        """Ids of the objects that it is about."""
        return frozenset({self.id})

    def satisfied(self, state: WorldState) -> bool:
        """Whether it is so in this state."""
        return state.object(self.id).held and state.body.held == self.id

    def __str__(self) -> str:
        return f"holds {self.id}"


@dataclass(frozen=True, slots=True)
class OnFloor:
    """The object is released and rests on the floor (a rug counts as floor)."""

    id: int

    @property
    def objects(self) -> frozenset[int]:
        """Ids of the objects that it is about."""
        return frozenset({self.id})

    def satisfied(self, state: WorldState) -> bool:
        """Whether it is so in this state."""
        return _resting_on(state.object(self.id)) == FLOOR

    def __str__(self) -> str:
        return f"{self.id} on floor"


@dataclass(frozen=True, slots=True)
class Near:
    """The object and its anchor rest on the same surface, within `NEAR_M` of each other."""

    id: int
    anchor: int

    @property
    def objects(self) -> frozenset[int]:
        """Ids of the objects that it is about."""
        return frozenset({self.id, self.anchor})

    def satisfied(self, state: WorldState) -> bool:
        """Whether it is so in this state."""
        item, anchor = state.object(self.id), state.object(self.anchor)
        surface = _resting_on(item)
        return (
            surface is not None
            and surface == _resting_on(anchor)
            and item.box.center.horizontal_distance(anchor.box.center) <= NEAR_M
        )

    def __str__(self) -> str:
        return f"{self.id} near {self.anchor}"


@dataclass(frozen=True, slots=True)
class InArea:
    """The object rests on the floor and its footprint overlaps an area of a kind."""

    id: int
    kind: str = "corner"

    @property
    def objects(self) -> frozenset[int]:
        """Ids of the objects that it is about."""
        return frozenset({self.id})

    def satisfied(self, state: WorldState) -> bool:
        """Whether it is so in this state."""
        item = state.object(self.id)
        return _resting_on(item) == FLOOR and any(
            footprint_overlaps(item.box, area)
            for area in state.scene.areas
            if area.kind == self.kind
        )

    def __str__(self) -> str:
        return f"{self.id} in a {self.kind} area"


Condition = Holds | OnFloor | Near | InArea


def _resting_on(item: ObjectState) -> str | None:
    """Name of the surface under a released object.

    None for what is in the hand, in the air, or on another object, which is no surface.
    """
    if item.held or item.support is None or supporting_object(item.support) is not None:
        return None
    return item.support
