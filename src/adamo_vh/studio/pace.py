"""Simulated time beside real time: so fast as is wished, and never hurried to catch up."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable

_LATE_S = 0.25
"""Who is later than this goes on from here: what was missed is not made up in a rush."""


class Pace:
    """Lets the moments of an action come when they are due; for one thread that waits."""

    def __init__(self, cut: threading.Event, is_watched: Callable[[], bool]) -> None:
        """Begin.

        Args:
            cut: Ends any wait.
            is_watched: Whether anybody looks on; else nothing is waited for.
        """
        self._cut = cut
        self._is_watched = is_watched
        self._speed = 1.0
        self._from: tuple[float, float] | None = None
        """A real and a simulated second that belong together."""

    @property
    def speed(self) -> float:
        """How many times faster simulated time passes."""
        return self._speed

    @speed.setter
    def speed(self, factor: float) -> None:
        self._speed, self._from = factor, None

    def wait(self, seconds: float) -> None:
        """Wait until a simulated second is due."""
        now = time.monotonic()
        anchor = self._from
        if anchor is None or not self._is_watched():
            self._from = (now, seconds)
            return
        due = anchor[0] + (seconds - anchor[1]) / self._speed
        if due > now:
            self._cut.wait(due - now)
        elif now - due > _LATE_S:
            self._from = (now, seconds)

    def rest(self) -> None:
        """Nothing moves now: the next moment comes at once."""
        self._from = None
