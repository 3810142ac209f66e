"""Conditions: atomic ones, and what joins them: and, or, not, once and ordered.

How they count: an `And` as its parts, an `Ordered` as its steps, everything else as one condition.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Annotated, Literal

from pydantic import Field

from adamo_vh.benchmark.atoms import (
    MOVED_M,
    NEAR_M,
    Aim,
    Atom,
    Beside,
    Holds,
    InArea,
    Near,
    NothingElseMoved,
    On,
    OnFloor,
    Stays,
)
from adamo_vh.engine import WorldState

__all__ = [
    "MOVED_M",
    "NEAR_M",
    "Aim",
    "And",
    "Atom",
    "Beside",
    "Condition",
    "Holds",
    "InArea",
    "Near",
    "Not",
    "NothingElseMoved",
    "On",
    "OnFloor",
    "Once",
    "Or",
    "Ordered",
    "Stays",
    "atoms",
    "counted",
    "flat",
    "holds",
    "needs_history",
    "verdicts",
]


@dataclass(frozen=True, slots=True)
class And:
    """All of several conditions hold."""

    parts: tuple[Condition, ...]
    type: Literal["and"] = "and"

    @property
    def objects(self) -> frozenset[int]:
        """Ids of the objects that it is about."""
        return frozenset().union(*(part.objects for part in self.parts))

    @property
    def moves(self) -> frozenset[int]:
        """Ids of the objects that are to be moved for it."""
        return frozenset().union(*(part.moves for part in self.parts))

    def satisfied(self, now: WorldState, past: Sequence[WorldState] = ()) -> bool:
        """Whether it is so in this state."""
        return all(holds(part, now, past) for part in self.parts)

    def __str__(self) -> str:
        return " and ".join(map(_inside, self.parts))


@dataclass(frozen=True, slots=True)
class Or:
    """At least one of several conditions holds."""

    parts: tuple[Condition, ...]
    type: Literal["or"] = "or"

    @property
    def objects(self) -> frozenset[int]:
        """Ids of the objects that it is about."""
        return frozenset().union(*(part.objects for part in self.parts))

    @property
    def moves(self) -> frozenset[int]:
        """Ids of the objects that may be moved for it."""
        return frozenset().union(*(part.moves for part in self.parts))

    def satisfied(self, now: WorldState, past: Sequence[WorldState] = ()) -> bool:
        """Whether it is so in this state."""
        return any(holds(part, now, past) for part in self.parts)

    def __str__(self) -> str:
        return " or ".join(map(_inside, self.parts))


@dataclass(frozen=True, slots=True)
class Not:
    """A condition does not hold."""

    part: Condition
    type: Literal["not"] = "not"

    @property
    def objects(self) -> frozenset[int]:
        """Ids of the objects that it is about."""
        return self.part.objects

    @property
    def moves(self) -> frozenset[int]:
        """Ids of the objects that may be moved for it."""
        return self.part.moves

    def satisfied(self, now: WorldState, past: Sequence[WorldState] = ()) -> bool:
        """Whether it is so in this state."""
        return not holds(self.part, now, past)

    def __str__(self) -> str:
        return f"not {_inside(self.part)}"


@dataclass(frozen=True, slots=True)
class Once:
    """A condition held in some state after the start, whether or not it does now."""

    part: Condition
    type: Literal["once"] = "once"

    @property
    def objects(self) -> frozenset[int]:
        """Ids of the objects that it is about."""
        return self.part.objects

    @property
    def moves(self) -> frozenset[int]:
        """Ids of the objects that are to be moved for it."""
        return self.part.moves

    def satisfied(self, now: WorldState, past: Sequence[WorldState] = ()) -> bool:
        """Whether it is so in this state, or was in one after the start."""
        states = (*past, now)
        return any(holds(self.part, states[i], states[:i]) for i in range(1, len(states)))

    def __str__(self) -> str:
        return f"once {_inside(self.part)}"


@dataclass(frozen=True, slots=True)
class Ordered:
    """Several conditions hold, and came about one after the other.

    Since when a step holds is the first state of the last unbroken stretch in which it does. A step
    counts if it holds, every step before it counts, and it did not come about before them.
    """

    parts: tuple[Condition, ...]
    type: Literal["ordered"] = "ordered"

    @property
    def objects(self) -> frozenset[int]:
        """Ids of the objects that it is about."""
        return frozenset().union(*(part.objects for part in self.parts))

    @property
    def moves(self) -> frozenset[int]:
        """Ids of the objects that are to be moved for it."""
        return frozenset().union(*(part.moves for part in self.parts))

    def satisfied(self, now: WorldState, past: Sequence[WorldState] = ()) -> bool:
        """Whether all steps count."""
        return self.done(now, past) == len(self.parts)

    def done(self, now: WorldState, past: Sequence[WorldState] = ()) -> int:
        """How many steps count, from the first one on."""
        states = (*past, now)
        latest = 0
        for count, part in enumerate(self.parts):
            since = _since(part, states)
            if since is None or since < latest:
                return count
            latest = since
        return len(self.parts)

    def __str__(self) -> str:
        return ", then ".join(map(_inside, self.parts))


Combined = And | Or | Not | Once | Ordered
Condition = Annotated[Atom | Combined, Field(discriminator="type")]
"""What a task asks for."""


def holds(condition: Condition, now: WorldState, past: Sequence[WorldState] = ()) -> bool:
    """Whether a condition holds.

    What speaks of an object that somebody took out of the room does not.

    Args:
        condition: Any.
        now: The world now.
        past: The states before it, the start first; none if this is the start.

    Raises:
        KeyError: It names an object that the world never had.
    """
    if isinstance(condition, Atom):
        here = {item.id for item in now.objects}
        had = {item.id for item in past[0].objects} if past else here
        if condition.objects & had - here:
            return False
    return condition.satisfied(now, past)


def verdicts(
    conditions: Sequence[Condition], now: WorldState, past: Sequence[WorldState] = ()
) -> tuple[tuple[str, bool], ...]:
    """Each condition that counts, and whether it does, in order.

    What forbids (a `Not`, `Stays` or `NothingElseMoved`) and holds from the start is no
    achievement: it counts only when all others do. So doing nothing is worth nothing.
    """
    start = past[0] if past else now
    found: list[tuple[str, bool, bool]] = []
    for condition in flat(conditions):
        if isinstance(condition, Ordered):
            done = condition.done(now, past)
            for i, step in enumerate(condition.parts):
                found.append((f"{'then' if i else 'first'} {_inside(step)}", i < done, False))
        else:
            is_limit = isinstance(condition, Not | Stays | NothingElseMoved)
            kept = is_limit and holds(condition, start)
            found.append((str(condition), holds(condition, now, past), kept))
    is_rest_done = all(is_so for _, is_so, kept in found if not kept)
    return tuple((text, is_so and (is_rest_done or not kept)) for text, is_so, kept in found)


def counted(conditions: Sequence[Condition]) -> tuple[Condition, ...]:
    """What each of the `verdicts` is about, in the same order."""
    return tuple(
        part
        for condition in flat(conditions)
        for part in (condition.parts if isinstance(condition, Ordered) else (condition,))
    )


def needs_history(condition: Condition) -> bool:
    """Whether it depends on the states between the first and the last."""
    match condition:
        case Once() | Ordered():
            return True
        case And(parts=parts) | Or(parts=parts):
            return any(map(needs_history, parts))
        case Not(part=part):
            return needs_history(part)
        case _:
            return False


def atoms(conditions: Sequence[Condition]) -> Iterator[Atom]:
    """Every atomic condition inside."""
    for condition in conditions:
        match condition:
            case And(parts=parts) | Or(parts=parts) | Ordered(parts=parts):
                yield from atoms(parts)
            case Not(part=part) | Once(part=part):
                yield from atoms((part,))
            case _:
                yield condition


def flat(conditions: Sequence[Condition]) -> Iterator[Condition]:
    """The conditions, each `And` as its parts."""
    for condition in conditions:
        if isinstance(condition, And):
            yield from flat(condition.parts)
        else:
            yield condition


def _since(condition: Condition, states: Sequence[WorldState]) -> int | None:
    """Number of the first state of the last stretch in which it holds; None if it does not now."""
    since = None
    for i in range(len(states) - 1, -1, -1):
        if not holds(condition, states[i], states[:i]):
            break
        since = i
    return since


def _inside(condition: Condition) -> str:
    """A condition as a part of another one."""
    joins = isinstance(condition, And | Or | Ordered)
    return f"({condition})" if joins else str(condition)
