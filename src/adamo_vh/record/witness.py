"""Keeps the whole state after every step on record, for tasks that ask in which order things came.

It speaks to the records alone: no state reaches the model, its guards or those who look on.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

from adamo_vh.engine import WorldState
from adamo_vh.errors import RecordError
from adamo_vh.observation import Frame
from adamo_vh.record.trajectory import (
    Acted,
    Event,
    Happened,
    Observer,
    Restored,
    Stood,
    Trajectory,
)


class Witness:
    """Passes every event on to the records and adds to each step how the world stood after it."""

    def __init__(self, records: Sequence[Observer], state: Callable[[], WorldState]) -> None:
        """Watch an episode that is about to begin.

        Args:
            records: What keeps the events.
            state: Tells the world's state.
        """
        self._records = tuple(records)
        self._state = state
        self._last = state()

    def notify(self, event: Event, frame: Frame | None = None) -> None:
        """Pass an event on; after a step, the state as well."""
        for record in self._records:
            record.notify(event, frame)
        if isinstance(event, Acted | Happened | Restored):
            now, before = self._state(), self._last
            stood = _change(event.step, before, now)
            self._last = now
            for record in self._records:
                record.notify(stood)


def _change(step: int, before: WorldState, now: WorldState) -> Stood:
    """What is otherwise than before."""
    old = {item.id: item for item in before.objects}
    changed = tuple(item for item in now.objects if old.get(item.id) != item)
    gone = tuple(sorted(set(old) - {item.id for item in now.objects}))
    return Stood(step, changed, gone, now.body, now.hash())


def states_between(recorded: Trajectory, initial: WorldState) -> tuple[WorldState, ...]:
    """The states after each step, in order.

    Args:
        recorded: Kept by a witness.
        initial: The state at the start.

    Raises:
        RecordError: States are missing, or are not those that the steps led to.
    """
    states, now, hashed = [], initial, ""
    for event in recorded.events:
        if isinstance(event, Acted | Happened | Restored):
            if hashed:
                break
            hashed = event.state_hash
        elif isinstance(event, Stood):
            items = {item.id: item for item in (*now.objects, *event.changed)}
            kept = tuple(items[i] for i in sorted(items) if i not in event.gone)
            now = WorldState(now.scene, kept, event.body, now.furniture)
            if now.hash() != hashed:
                hashed = hashed or "none"
                break
            states.append(now)
            hashed = ""
    if hashed:
        raise RecordError(
            f"The record does not say how the world stood after each step (step {len(states) + 1} "
            "is missing or damaged), and the task asks what came first. Run it again."
        )
    return tuple(states)
