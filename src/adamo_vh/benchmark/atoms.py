"""Atomic conditions: what must be true of the world when an episode ends.

Each is plain data that reads the world `now` and the states before it (`past`, the first of them
the start of the episode; none if this is the start). `str()` of one is its line in a report.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np

from adamo_vh.benchmark.overlap import footprint_overlaps
from adamo_vh.engine import FLOOR, ObjectState, WorldState, supporting_object
from adamo_vh.geometry import Array

NEAR_M = 0.30
"""Two objects are near when the centres of their boxes are at most this far apart in plan."""
BESIDE_M = 0.60
"""What is left or right of an anchor is at most this far from it, between centres in plan."""
ASIDE_M = 0.03
"""What is left or right of an anchor is at least this far to its side."""
MOVED_M = 0.02
"""An object whose centre went further than this was moved; less is settling."""


@dataclass(frozen=True, slots=True)
class Holds:
    """The object is in the hand."""

    id: int
    type: Literal["holds"] = "holds"

    @property
    def objects(self) -> frozenset[int]:
        """Ids of the objects that it is about."""
        return frozenset({self.id})

    @property
    def moves(self) -> frozenset[int]:
        """Ids of the objects that are to be moved for it; anchors are not."""
        return frozenset({self.id})

    def satisfied(self, now: WorldState, past: Sequence[WorldState] = ()) -> bool:
        """Whether it is so in this state."""
        return now.object(self.id).held and now.body.held == self.id

    def __str__(self) -> str:
        return f"holds {self.id}"


@dataclass(frozen=True, slots=True)
class OnFloor:
    """The object is released and rests on the floor (a rug counts as floor)."""

    id: int
    type: Literal["on_floor"] = "on_floor"

    @property
    def objects(self) -> frozenset[int]:
        """Ids of the objects that it is about."""
        return frozenset({self.id})

    @property
    def moves(self) -> frozenset[int]:
        """Ids of the objects that are to be moved for it; anchors are not."""
        return frozenset({self.id})

    def satisfied(self, now: WorldState, past: Sequence[WorldState] = ()) -> bool:
        """Whether it is so in this state."""
        return _resting_on(now.object(self.id)) == FLOOR

    def __str__(self) -> str:
        return f"{self.id} on floor"


@dataclass(frozen=True, slots=True)
class On:
    """The object is released and rests on a piece of furniture, or on one level of it."""

    id: int
    surface: str
    """Name of a piece ("tall shelf": any of its levels) or of a level ("tall shelf/top")."""
    type: Literal["on"] = "on"

    @property
    def objects(self) -> frozenset[int]:
        """Ids of the objects that it is about."""
        return frozenset({self.id})

    @property
    def moves(self) -> frozenset[int]:
        """Ids of the objects that are to be moved for it; anchors are not."""
        return frozenset({self.id})

    def satisfied(self, now: WorldState, past: Sequence[WorldState] = ()) -> bool:
        """Whether it is so in this state."""
        return self.means(_resting_on(now.object(self.id)))

    def means(self, support: str | None) -> bool:
        """Whether a support is what it names."""
        return support is not None and (
            support == self.surface or support.partition("/")[0] == self.surface
        )

    def __str__(self) -> str:
        return f"{self.id} on {self.surface}"


@dataclass(frozen=True, slots=True)
class Near:
    """The object and its anchor rest on the same surface, within `NEAR_M` of each other."""

    id: int
    anchor: int
    type: Literal["near"] = "near"

    @property
    def objects(self) -> frozenset[int]:
        """Ids of the objects that it is about."""
        return frozenset({self.id, self.anchor})

    @property
    def moves(self) -> frozenset[int]:
        """Ids of the objects that are to be moved for it; anchors are not."""
        return frozenset({self.id})

    def satisfied(self, now: WorldState, past: Sequence[WorldState] = ()) -> bool:
        """Whether it is so in this state."""
        return _together(now.object(self.id), now.object(self.anchor), NEAR_M)

    def __str__(self) -> str:
        return f"{self.id} near {self.anchor}"


@dataclass(frozen=True, slots=True)
class Beside:
    """The object rests left or right of its anchor, on the same surface.

    The frame is that of somebody who stands where the body stood when the episode began, and looks
    at the anchor where it is now: at least `ASIDE_M` to that side, more to the side than before or
    behind, and at most `BESIDE_M` away, all between the centres of the boxes in plan.
    """

    id: int
    anchor: int
    side: Literal["left", "right"]
    type: Literal["beside"] = "beside"

    @property
    def objects(self) -> frozenset[int]:
        """Ids of the objects that it is about."""
        return frozenset({self.id, self.anchor})

    @property
    def moves(self) -> frozenset[int]:
        """Ids of the objects that are to be moved for it; anchors are not."""
        return frozenset({self.id})

    def satisfied(self, now: WorldState, past: Sequence[WorldState] = ()) -> bool:
        """Whether it is so in this state."""
        item, anchor = now.object(self.id), now.object(self.anchor)
        if not _together(item, anchor, BESIDE_M):
            return False
        ahead, aside = _seen_from(past[0] if past else now, item, anchor)
        aside = aside if self.side == "left" else -aside
        return aside >= ASIDE_M and aside > abs(ahead)

    def __str__(self) -> str:
        return f"{self.id} {self.side} of {self.anchor}"


@dataclass(frozen=True, slots=True)
class InArea:
    """The object rests on the floor and its footprint overlaps an area of a kind."""

    id: int
    kind: str = "corner"
    type: Literal["in_area"] = "in_area"

    @property
    def objects(self) -> frozenset[int]:
        """Ids of the objects that it is about."""
        return frozenset({self.id})

    @property
    def moves(self) -> frozenset[int]:
        """Ids of the objects that are to be moved for it; anchors are not."""
        return frozenset({self.id})

    def satisfied(self, now: WorldState, past: Sequence[WorldState] = ()) -> bool:
        """Whether it is so in this state."""
        item = now.object(self.id)
        return _resting_on(item) == FLOOR and any(
            footprint_overlaps(item.box, area) for area in now.scene.areas if area.kind == self.kind
        )

    def __str__(self) -> str:
        return f"{self.id} in a {self.kind} area"


@dataclass(frozen=True, slots=True)
class Stays:
    """The object rests where it did at the start, up to `MOVED_M`."""

    id: int
    type: Literal["stays"] = "stays"

    @property
    def objects(self) -> frozenset[int]:
        """Ids of the objects that it is about."""
        return frozenset({self.id})

    @property
    def moves(self) -> frozenset[int]:
        """Nothing is to be moved for it."""
        return frozenset()

    def satisfied(self, now: WorldState, past: Sequence[WorldState] = ()) -> bool:
        """Whether it is so in this state."""
        return unmoved((past[0] if past else now).object(self.id), now.object(self.id))

    def __str__(self) -> str:
        return f"{self.id} where it was"


@dataclass(frozen=True, slots=True)
class NothingElseMoved:
    """Every object rests where it did at the start, but for those that the task moves."""

    but: tuple[int, ...]
    """Ids of these, ascending."""
    type: Literal["nothing_else_moved"] = "nothing_else_moved"

    @property
    def objects(self) -> frozenset[int]:
        """It is about none in particular."""
        return frozenset()

    @property
    def moves(self) -> frozenset[int]:
        """Nothing is to be moved for it."""
        return frozenset()

    def satisfied(self, now: WorldState, past: Sequence[WorldState] = ()) -> bool:
        """Whether it is so in this state."""
        return not self.moved(now, past)

    def moved(self, now: WorldState, past: Sequence[WorldState] = ()) -> tuple[int, ...]:
        """Ids of what was moved and should not; what was taken out of the room is not."""
        before = {item.id: item for item in (past[0] if past else now).objects}
        return tuple(
            item.id
            for item in now.objects
            if item.id not in self.but and item.id in before and not unmoved(before[item.id], item)
        )

    def __str__(self) -> str:
        return "nothing else moved"


Aim = Holds | OnFloor | On | Near | Beside | InArea
"""Where one object is to be: in the hand, or put down somewhere."""
Atom = Aim | Stays | NothingElseMoved
"""An atomic condition."""


def unmoved(before: ObjectState, after: ObjectState) -> bool:
    """Whether an object rests on the same thing in the same place."""
    apart = before.box.center.distance(after.box.center)
    return after.held == before.held and after.support == before.support and apart <= MOVED_M


def _resting_on(item: ObjectState) -> str | None:
    """Name of the surface under a released object.

    None for what is in the hand, in the air, or on another object, which is no surface.
    """
    if item.held or item.support is None or supporting_object(item.support) is not None:
        return None
    return item.support


def _together(item: ObjectState, anchor: ObjectState, within_m: float) -> bool:
    """Whether two objects rest on the same surface, at most so far apart in plan."""
    surface = _resting_on(item)
    return (
        surface is not None
        and surface == _resting_on(anchor)
        and item.box.center.horizontal_distance(anchor.box.center) <= within_m
    )


def _seen_from(start: WorldState, item: ObjectState, anchor: ObjectState) -> tuple[float, float]:
    """How far behind its anchor and how far to the left of it an object is, in metres."""
    there = _plan(anchor)
    ahead = there - start.body.position.array()[:2]
    length = float(np.hypot(*ahead))
    if length == 0.0:
        return 0.0, 0.0
    ahead = ahead / length
    offset = _plan(item) - there
    return float(offset @ ahead), float(offset @ [-ahead[1], ahead[0]])


def _plan(item: ObjectState) -> Array:
    return item.box.center.array()[:2]
