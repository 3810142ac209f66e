"""How far from done a state is: the tool calls that the oracle would still make from it.

Planned on the state alone, without moving anything: what the engine may correct or refuse is not
foreseen, so the figure is the least that is left.
"""

from __future__ import annotations

from collections.abc import Container, Sequence

from adamo_vh.benchmark.conditions import Condition, Holds, flat
from adamo_vh.benchmark.goals import needed_goals
from adamo_vh.engine import WorldState


def calls_left(
    conditions: Sequence[Condition],
    state: WorldState,
    seen: Container[int] = (),
    past: Sequence[WorldState] = (),
) -> int:
    """The least number of calls that make all conditions true.

    An object that was not seen yet takes a Look, one that is not in the hand a Pick, and one that
    is to lie somewhere a Drop; what else is in the hand is put down first.

    Args:
        conditions: What is to be brought about.
        state: The world now.
        seen: Ids of the objects that have been listed in an observation so far.
        past: The states before, the start of the episode first; none if this is the start.

    Returns:
        0 if all is done. An object that is out of the room counts as if it were in it.
    """
    held = state.body.held
    left, picks = 0, 0
    wanted: set[int] = set()
    for goal in (g for c in conditions for g in needed_goals(c, state, past)):
        if held == goal.id and not (isinstance(goal.condition, Holds) and not goal.is_undoing):
            left += 1
            wanted.add(held)
        elif isinstance(goal.condition, Holds) or goal.is_undoing:
            # Whatever is to be in the hand at the end is taken last.
            left, picks = left + 1, picks + 1
        else:
            left, picks = left + 2, picks + 1
        left += goal.id not in seen
    if held is not None and held not in wanted and picks:
        keeps = any(isinstance(c, Holds) and c.id == held for c in flat(conditions))
        left += 2 if keeps else 1
    return left
