"""Guards: each watches an episode for one reason to stop it early, and says so when asked."""

from __future__ import annotations

import json
from collections import Counter
from typing import Protocol

from adamo_vh.observation import Frame
from adamo_vh.record.termination import Stop, TerminationReason
from adamo_vh.record.trajectory import Acted, Event, Started, Thought


class Guard(Protocol):
    """Watches the events of an episode; asked before every model call."""

    def notify(self, event: Event, frame: Frame | None = None) -> None:
        """Take note of an event."""
        ...

    def stop(self) -> Stop | None:
        """Why to stop now; None to go on."""
        ...


class LoopGuard:
    """Stops an agent that repeats itself without effect.

    A repetition is the same call that ends in the same state of world and body: a look back and
    forth between two points, a refused pick, a walk to where it stands. What changes the world in
    between makes the next one new. So is one reply after another that leads to no action at all.
    """

    def __init__(self, max_repeats: int = 4) -> None:
        """Set how often the same may happen before it is a loop; 0 never stops."""
        self._max_repeats = max_repeats
        self._seen: Counter[str] = Counter()
        self._idle = 0
        self._unread: dict[str, str] = {}
        """What was written as the arguments of a call, where it is no JSON object, by call id."""

    def notify(self, event: Event, frame: Frame | None = None) -> None:
        """Count a call with the state that it led to, or a reply that led to none."""
        if isinstance(event, Started):
            self._seen.clear()
            self._idle = 0
        if isinstance(event, Thought) and not event.reply.unreadable:
            self._idle += 1
        if isinstance(event, Thought):
            calls = event.reply.message.calls
            self._unread = {call.id: call.raw for call in calls if call.arguments is None}
        if isinstance(event, Acted):
            self._idle = 0
            arguments = json.dumps(event.arguments, sort_keys=True, default=str)
            if event.arguments is None:
                arguments = self._unread.get(event.call_id, "")
            self._seen[f"{event.name} {arguments} {event.state_hash}"] += 1

    def stop(self) -> Stop | None:
        """`LOOP` if one of them came too often."""
        call, count = max(self._seen.items(), key=lambda item: item[1], default=("", 0))
        if not self._max_repeats or max(count, self._idle) < self._max_repeats:
            return None
        why = f"{call.rpartition(' ')[0]} led to the same state {count} times."
        if count < self._max_repeats:
            why = f"{self._idle} replies in a row led to no action."
        return Stop(TerminationReason.LOOP, why)


class ProtocolGuard:
    """Stops an agent whose model says nothing that can be read, several times in a row."""

    def __init__(self, max_unreadable: int = 3) -> None:
        """Set how many unreadable replies in a row are too many."""
        self._max_unreadable = max_unreadable
        self._in_a_row = 0

    def notify(self, event: Event, frame: Frame | None = None) -> None:
        """Count unreadable replies."""
        if isinstance(event, Started):
            self._in_a_row = 0
        if isinstance(event, Thought):
            self._in_a_row = self._in_a_row + 1 if event.reply.unreadable else 0

    def stop(self) -> Stop | None:
        """`PROTOCOL` if there were too many."""
        if self._in_a_row < self._max_unreadable:
            return None
        why = f"{self._in_a_row} replies in a row were neither a call nor an answer."
        return Stop(TerminationReason.PROTOCOL, why)
