"""How many sessions a server plays at once, whichever face they came in by."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager

from adamo_vh.session.pooling import BusyError


class Seats:
    """The room of a server. Each face says how many it plays, and takes a seat to begin another."""

    def __init__(self, most: int) -> None:
        """Begin empty.

        Args:
            most: So many are played at once.
        """
        self._most = most
        self._counts: list[Callable[[], int]] = []
        self._beginning = 0
        self._lock = threading.Lock()

    def count(self, played: Callable[[], int]) -> None:
        """Count what a face plays.

        Args:
            played: Says how many sessions that is now; from any thread, without waiting.
        """
        self._counts.append(played)

    @contextmanager
    def one_more(self) -> Iterator[None]:
        """Keep a seat while a session begins; when it is left, the face counts the session.

        Raises:
            BusyError: There is none.
        """
        with self._lock:
            if self._beginning + sum(played() for played in self._counts) >= self._most:
                played = "1 session is" if self._most == 1 else f"{self._most} sessions are"
                raise BusyError(f"{played} played already; finish one, or wait.")
            self._beginning += 1
        try:
            yield
        finally:
            with self._lock:
                self._beginning -= 1
