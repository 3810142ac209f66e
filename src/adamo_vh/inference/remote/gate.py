"""A gate that requests to providers go through, where somebody set one up: it spreads them out.

What is set up for a context holds for every request that is made in it, whatever model makes it,
probes and repairs included.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass
from typing import Protocol

from adamo_vh.inference.remote.retry import Failure


@dataclass(frozen=True, slots=True)
class Ticket:
    """Leave to make one request."""

    number: int
    provider: str
    waited_s: float = 0.0
    """Seconds that it was waited for."""


class Gate(Protocol):
    """Lets requests through at the pace that a provider allows."""

    def acquire(self, provider: str, tokens: int) -> Ticket:
        """Wait for leave to make a request.

        Args:
            provider: Who is asked; each has its own pace.
            tokens: What the request will take, about.
        """
        ...

    def settle(self, ticket: Ticket, tokens: int, failure: Failure | None = None) -> None:
        """Say that a request has ended.

        Args:
            ticket: Its leave.
            tokens: What it took.
            failure: Why it brought no answer, if it did not.
        """
        ...


_current: ContextVar[Gate | None] = ContextVar("adamo_gate", default=None)


@contextmanager
def through(gate: Gate | None) -> Iterator[None]:
    """Let every request that is made meanwhile in this thread go through a gate."""
    token = _current.set(gate)
    try:
        yield
    finally:
        _current.reset(token)


class Passage:
    """The requests of one answer, each through the gate of this context, if there is one."""

    def __init__(self, provider: str, estimate: Callable[[], int]) -> None:
        """Prepare.

        Args:
            provider: Who is asked.
            estimate: Tells the tokens that a request will take, about; asked only at a gate.
        """
        self._gate = _current.get()
        self._provider = provider
        self._tokens = 0 if self._gate is None else estimate()
        self._ticket: Ticket | None = None

    def enter(self) -> float:
        """Wait for leave to make a request; for how many seconds."""
        if self._gate is None:
            return 0.0
        self._ticket = self._gate.acquire(self._provider, self._tokens)
        return self._ticket.waited_s

    def leave(self, tokens: int, failure: Failure | None) -> None:
        """Say that the request has ended; see `Gate.settle`.

        Args:
            tokens: What it took; 0 if nobody counted, then it is what was estimated.
            failure: Why it brought no answer, if it did not.
        """
        if self._gate is not None and self._ticket is not None:
            ticket, self._ticket = self._ticket, None
            self._gate.settle(ticket, tokens if failure else tokens or self._tokens, failure)
