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
    PROTOCOL = "protocol"
    """Terminated: several replies in a row were neither a valid call nor an answer."""
    LOOP = "loop"
    """Truncated: the same call in the same state, or replies without any call, again and again."""
    BUDGET = "budget"
    """Truncated: the episode's own budget of tokens, money, calls or seconds is used up."""
    STEP_LIMIT = "step_limit"
    """Truncated: too many steps."""
    TIME_LIMIT = "time_limit"
    """Truncated: too many seconds."""
    RUN_BUDGET = "run_budget"
    """The budget of the whole run is used up: unscored, to be run again."""
    BROKEN = "broken"
    """A fault of ours or of a provider: the episode is unscored, never counted as 0."""

    @property
    def is_scored(self) -> bool:
        """Whether the episode counts."""
        return self not in (TerminationReason.BROKEN, TerminationReason.RUN_BUDGET)


@dataclass(frozen=True, slots=True)
class Limits:
    """Caps on an episode; the time cap is the paper's (Sec. 4.2)."""

    max_steps: int = 60
    """Steps: tool calls that were executed or refused."""
    max_seconds: float = 600.0
    """Seconds of thinking and acting, without waits for retries and rate limits."""
    max_repeats: int = 4
    """The same call leading to the same state so often is a loop; 0 allows any number."""
    max_unreadable: int = 3
    """Replies in a row that are neither a valid call nor an answer."""

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
        """Do not count some seconds; a negative number counts some that passed elsewhere."""
        self._waited_s += seconds

    @property
    def seconds(self) -> float:
        """Counted seconds so far."""
        return time.monotonic() - self._start - self._waited_s
