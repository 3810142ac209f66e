"""What of a task is still to be brought about, as goals that concern one object each."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from adamo_vh.benchmark.conditions import (
    Aim,
    And,
    Atom,
    Condition,
    Not,
    NothingElseMoved,
    Once,
    Or,
    Ordered,
    Stays,
    atoms,
    holds,
)
from adamo_vh.engine import WorldState


@dataclass(frozen=True, slots=True)
class Goal:
    """An atomic condition that must come to hold, or must not hold any more."""

    condition: Atom
    id: int
    """The object that must be moved for it."""
    is_undoing: bool = False
    """Whether it must not hold any more."""


def needed_goals(condition: Condition, now: WorldState, past: Sequence[WorldState]) -> list[Goal]:
    """All that must be done for a condition, by the shortest choice; nothing if it holds.

    Args:
        condition: Any.
        now: The world now.
        past: The states before it, the start first.
    """
    if holds(condition, now, past):
        return []
    match condition:
        case And(parts=parts):
            return [goal for part in parts for goal in needed_goals(part, now, past)]
        case Or(parts=parts):
            return min((needed_goals(part, now, past) for part in parts), key=len)
        case Ordered(parts=parts):
            steps = parts[condition.done(now, past) :]
            # A step that holds already came too early: all of it is done again.
            return [
                goal
                for step in steps
                for goal in (
                    needed_goals(step, now, past)
                    or [Goal(atom, atom.id) for atom in atoms((step,)) if isinstance(atom, Aim)]
                )
            ]
        case _:
            return list(open_goals(condition, now, past))


def open_goals(
    condition: Condition, now: WorldState, past: Sequence[WorldState], wanted: bool = True
) -> Iterator[Goal]:
    """What can be done next for a condition, best first; nothing if it is as wanted.

    Args:
        condition: Any.
        now: The world now.
        past: The states before it, the start first.
        wanted: False, if it must not hold.
    """
    if holds(condition, now, past) == wanted:
        return
    match condition:
        case And(parts=parts) | Or(parts=parts):
            for part in parts:
                yield from open_goals(part, now, past, wanted)
        case Not(part=part):
            yield from open_goals(part, now, past, not wanted)
        case Once(part=part):
            if wanted:  # What was, was.
                yield from open_goals(part, now, past)
        case Ordered(parts=parts):
            if wanted:
                # A step that holds and does not count came too early: it is undone and done again.
                step = parts[condition.done(now, past)]
                yield from open_goals(step, now, past, not holds(step, now, past))
        case NothingElseMoved():
            for item in condition.moved(now, past) if wanted else ():
                yield Goal(Stays(item), item)
        case _:
            yield Goal(condition, condition.id, not wanted)
