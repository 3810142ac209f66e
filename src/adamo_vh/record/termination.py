"""When and why an episode ends. Terminated, truncated and broken are three different facts."""

from __future__ import annotations

import math
import time
from dataclasses import dataclass
from enum import StrEnum

from adamo_vh.errors import ConfigError
from adamo_vh.inference.model import Spent


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
    STOPPED = "stopped"
    """Truncated: a person stopped it; see `EpisodeResult.assisted`."""
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

    @property
    def is_truncated(self) -> bool:
        """Whether a cap or a person ended it before the agent did."""
        return self in _CAPS


_CAPS = (
    TerminationReason.LOOP,
    TerminationReason.STOPPED,
    TerminationReason.BUDGET,
    TerminationReason.STEP_LIMIT,
    TerminationReason.TIME_LIMIT,
)


@dataclass(frozen=True, slots=True)
class Stop:
    """A decision to end now."""

    reason: TerminationReason
    why: str = ""
    """In words, where there is more to say than the reason."""
    answer: str = ""
    """What the agent said at the end; the fault, if the episode broke."""
    spent: Spent | None = None
    """What was spent on an answer that never came, if one did not."""


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

    def __post_init__(self) -> None:
        """Refuse what is no cap."""
        for name in ("max_steps", "max_unreadable"):
            if not _is_whole(getattr(self, name), least=1):
                raise ConfigError(f"{name} is {getattr(self, name)!r}: use a whole number from 1.")
        if not _is_whole(self.max_repeats, least=0):
            raise ConfigError(f"max_repeats is {self.max_repeats!r}: use a whole number from 0.")
        if not (_is_number(self.max_seconds) and self.max_seconds >= 0):
            raise ConfigError(f"max_seconds is {self.max_seconds!r}: use a number from 0.")

    def exceeded(self, steps: int, seconds: float) -> Stop | None:
        """Why to stop now, if a cap is reached."""
        if steps >= self.max_steps:
            return Stop(TerminationReason.STEP_LIMIT)
        if seconds >= self.max_seconds:
            return Stop(TerminationReason.TIME_LIMIT)
        return None


def _is_whole(value: object, *, least: int) -> bool:
    return isinstance(value, int) and not isinstance(value, bool) and value >= least


def _is_number(value: object) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool) and math.isfinite(value)


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
