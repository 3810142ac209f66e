"""What those who watch a session are told: all that happens, and never how it is judged."""

from __future__ import annotations

import asyncio
import threading
from collections import deque
from collections.abc import Callable, Mapping
from contextlib import suppress
from dataclasses import dataclass
from typing import Any

from adamo_vh.action_server.wire import Picture
from adamo_vh.observation import Frame
from adamo_vh.record.trajectory import (
    Acted,
    Ended,
    Event,
    Observed,
    Shown,
    Started,
    Thought,
    frame_type,
)

_KEPT = 1_000
_MOST_WATCHERS = 32


@dataclass(frozen=True, slots=True)
class Happening:
    """One thing that happened in a session."""

    number: int
    """Counts from 1."""
    kind: str
    """began, saw, thought, did, showed or ended."""
    step: int = 0
    text: str = ""
    """The instruction, the note or the feedback."""
    call: str = ""
    """Name of the tool that was called."""
    arguments: Mapping[str, Any] | None = None
    outcome: str = ""
    picture: Picture | None = None


@dataclass(frozen=True, slots=True)
class Happenings:
    """What happened since a watcher last asked."""

    happenings: tuple[Happening, ...]
    next: int
    """What to ask after next time."""
    ended: bool
    """Whether nothing more will happen."""


class Watch:
    """Keeps the latest happenings of a session, and wakes who waits for the next. An observer."""

    def __init__(self, href: Callable[[str], str]) -> None:
        """Start with nothing.

        Args:
            href: Where a picture can be had, by its name.
        """
        self._href = href
        self._kept: deque[Happening] = deque(maxlen=_KEPT)
        self._count = 0
        self._ended = False
        self._lock = threading.Lock()
        self._waiting: dict[int, Callable[[], object]] = {}

    def notify(self, event: Event, frame: Frame | None = None) -> None:
        """Keep what may be told of an event."""
        told = self._told(event)
        if told is None:
            return
        with self._lock:
            self._count += 1
            self._kept.append(Happening(self._count, **told))
            self._ended = self._ended or isinstance(event, Ended)
            waiting = tuple(self._waiting.values())
        for wake in waiting:
            wake()

    def _told(self, event: Event) -> dict[str, Any] | None:
        match event:
            case Started():
                return {"kind": "began", "text": event.instruction}
            case Observed() | Shown():
                return {
                    "kind": "saw" if isinstance(event, Observed) else "showed",
                    "step": event.step,
                    "picture": Picture(
                        event.frame,
                        frame_type(event.frame),
                        event.width_px,
                        event.height_px,
                        self._href(event.frame),
                    ),
                }
            case Thought():
                return {"kind": "thought", "step": event.step, "text": event.turn.note}
            case Acted():
                return {
                    "kind": "did",
                    "step": event.step,
                    "text": event.feedback.text,
                    "call": event.name,
                    "arguments": event.arguments,
                    "outcome": event.feedback.outcome.value,
                }
            case Ended():
                return {"kind": "ended", "step": event.steps}
        return None

    def close(self) -> None:
        """Let nobody wait any longer."""
        with self._lock:
            self._ended = True
            waiting = tuple(self._waiting.values())
        for wake in waiting:
            wake()

    def after(self, number: int) -> Happenings:
        """What happened after a happening; older ones than the last thousand are forgotten."""
        with self._lock:
            new = tuple(one for one in self._kept if one.number > number)
            return Happenings(new, self._count, self._ended)

    async def wait(self, number: int, seconds: float) -> Happenings:
        """The same; waits for the next one if there is none yet.

        Args:
            number: The last one that is known.
            seconds: To wait at most.
        """
        loop, come = asyncio.get_running_loop(), asyncio.Event()
        with self._lock:
            if len(self._waiting) < _MOST_WATCHERS:
                self._waiting[id(come)] = lambda: loop.call_soon_threadsafe(come.set)
        try:
            found = self.after(number)
            if not found.happenings and not found.ended:
                with suppress(TimeoutError):
                    await asyncio.wait_for(come.wait(), seconds)
                found = self.after(number)
            return found
        finally:
            with self._lock:
                self._waiting.pop(id(come), None)
