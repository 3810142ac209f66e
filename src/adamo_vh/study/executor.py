"""Where episodes are played: the contract of all executors, and what they report."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol

from adamo_vh.analysis.outcome import Outcome
from adamo_vh.study.plan import Planned


@dataclass(frozen=True, slots=True)
class Finished:
    """An episode has ended and is safe in its run folder."""

    key: str
    outcome: Outcome


@dataclass(frozen=True, slots=True)
class Failed:
    """An episode could not be played to its end."""

    key: str
    why: str
    again: bool = False
    """Whether another try may help."""
    fatal: bool = False
    """Whether no other episode would fare better, e.g. because the disk is full."""


@dataclass(frozen=True, slots=True)
class Lost:
    """What played some episodes is gone: a killed process, a lost machine."""

    keys: tuple[str, ...]
    why: str


@dataclass(frozen=True, slots=True)
class Noted:
    """Something that people should know; nothing depends on it."""

    text: str


Report = Finished | Failed | Lost | Noted


class Executor(Protocol):
    """Plays episodes somewhere; knows nothing of studies."""

    def can_take(self, *, alone: bool = False) -> bool:
        """Whether another episode can be started now.

        Args:
            alone: With nothing beside it that would be lost with it.
        """
        ...

    def start(self, planned: Planned, *, alone: bool = False) -> None:
        """Start an episode; `can_take` has said that it is possible."""
        ...

    def wait(self, seconds: float) -> Sequence[Report]:
        """What has come since the last time; waits for something at most so long."""
        ...

    def close(self) -> None:
        """End at once; what is still being played stays as far as it came."""
        ...
