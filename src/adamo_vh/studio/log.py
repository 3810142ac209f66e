"""The messages of a room, kept for whoever comes later, and within bounds."""

from __future__ import annotations

import bisect
import json
import threading
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass

from adamo_vh.studio.messages import Message

_MOST = 40_000
"""So many messages are kept: about twenty minutes of motion. Then old poses are thinned."""


@dataclass(frozen=True, slots=True)
class Logged:
    """A message, as it is sent."""

    number: int
    message: Message
    text: str


class Log:
    """Grows in the thread of a room; is read from any."""

    def __init__(self, most: int = _MOST) -> None:
        """Begin empty.

        Args:
            most: So many messages are kept.
        """
        self._most = most
        self._kept: list[Logged] = []
        self._count = 0
        self._seconds = 0.0
        self._lock = threading.Lock()
        self._wakes: dict[object, Callable[[], object]] = {}
        self.closed = False
        """Whether nothing more will come."""

    def append(self, message: Message, seconds: float) -> None:
        """Keep a message, and wake who waits for it.

        Args:
            message: Without serial and time.
            seconds: The simulated second that it belongs to.
        """
        with self._lock:
            self._count += 1
            whole = {"n": self._count, "t": round(seconds, 3), **message}
            self._kept.append(Logged(self._count, whole, _text(whole)))
            if len(self._kept) > self._most:
                self._kept = _thinned(self._kept)
                # Events alone are more than may be kept: the oldest go.
                del self._kept[: max(0, len(self._kept) - self._most)]
        self._wake()

    def close(self) -> None:
        """Let nobody wait any longer."""
        self.closed = True
        self._wake()

    def since(self, number: int, most: int = 500) -> list[Logged]:
        """The messages from a serial on, so many at most; where some were thinned, the next."""
        with self._lock:
            start = bisect.bisect_left(self._kept, number, key=lambda kept: kept.number)
            return self._kept[start : start + most]

    def watch(self, wake: Callable[[], object]) -> object:
        """Be woken by every message; gives what `leave` takes."""
        key = object()
        with self._lock:
            self._wakes[key] = wake
        return key

    def leave(self, key: object) -> None:
        """Be woken no longer."""
        with self._lock:
            self._wakes.pop(key, None)

    @property
    def watchers(self) -> int:
        """How many look on."""
        return len(self._wakes)

    def _wake(self) -> None:
        with self._lock:
            wakes = list(self._wakes.values())
        for wake in wakes:
            # A loop that has ended meanwhile is no fault of the room's.
            with suppress(RuntimeError):
                wake()


def _thinned(kept: list[Logged]) -> list[Logged]:
    """Without every other pose of the older three quarters; what one changed goes to the next."""
    old = len(kept) * 3 // 4
    found: list[Logged] = []
    dropped: Message | None = None
    for place, one in enumerate(kept):
        is_pose = one.message["type"] == "pose"
        if dropped is not None:
            message = _merged(dropped, one.message)
            found.append(Logged(one.number, message, _text(message)))
            dropped = None
        elif is_pose and place < old and _next_is_pose(kept, place):
            dropped = one.message
        else:
            found.append(one)
    return found


def _text(message: Message) -> str:
    return json.dumps(message, separators=(",", ":"))


def _next_is_pose(kept: list[Logged], place: int) -> bool:
    return place + 1 < len(kept) and kept[place + 1].message["type"] == "pose"


def _merged(before: Message, after: Message) -> Message:
    """A pose that follows one which is left out."""
    merged = {k: before[k] for k in ("gone", "lights") if k in before} | after
    if things := before.get("things", {}) | after.get("things", {}):
        merged["things"] = things
    return merged
