"""When and why an episode ends. Terminated, truncated and broken are three different facts."""

from __future__ import annotations

import time
from dataclasses import dataclass
from enum import StrEnum


class TerminationReason(StrEnum):
    """Why an episode ended."""

    ANSWERED = "answered"
    """Terminated: the model answered without a tool call."""
    EMPTY_REPLY = "empty_reply"
    """Terminated: the model said nothing, also after the nudge."""
    STEP_LIMIT = "step_limit"
    """Truncated: too many steps."""
    TIME_LIMIT = "time_limit"
    """Truncated: too many seconds."""
    BROKEN = "broken"
    """A fault of ours or of a provider: the episode is unscored, never counted as 0."""

    @property
    def is_scored(self) -> bool:
        """Whether the episode counts."""
        return self is not TerminationReason.BROKEN


@dataclass(frozen=True, slots=True)
class Limits:
    """Caps on an episode; the time cap is the paper's (Sec. 4.2)."""

    max_steps: int = 60
    """Steps: model turns with a tool call."""
    max_seconds: float = 600.0
    """Wall-clock seconds without waits for retries and rate limits."""

    def exceeded(self, steps: int, seconds: float) -> TerminationReason | None:
        """The reason to stop now, if there is one."""
        if steps >= self.max_steps:
            return TerminationReason.STEP_LIMIT
        if seconds >= self.max_seconds:
            return TerminationReason.TIME_LIMIT
        return None


class Stopwatch:
    """Seconds since the start, without the time that was spent waiting for a provider."""

    def __init__(self) -> None:
        """Start."""
        self._start = time.monotonic()
        self._waited_s = 0.0

    def leave_out(self, seconds: float) -> None:
        """Do not count some seconds."""
        self._waited_s += seconds

    @property
    def seconds(self) -> float:
        """Counted seconds so far."""
        return time.monotonic() - self._start - self._waited_s
