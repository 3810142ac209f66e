"""When a failed request is tried again, and for how long."""

from __future__ import annotations

import random
import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Generic, TypeVar

from adamo_vh.errors import ConfigError, ProviderError, RefusedError

T = TypeVar("T")

_LONGEST_BACKOFF_S = 60.0


@dataclass(frozen=True, slots=True)
class RetryPolicy:
    """Limits on trying again."""

    max_tries: int = 6
    """Requests at most for one answer."""
    max_wait_s: float = 600.0
    """Seconds at most that one answer may lose to failed tries and to the pauses between them."""
    base_s: float = 1.0
    """Pause after the first failure; doubles with each further one, up to a minute."""
    timeout_s: float = 300.0
    """Seconds at most for one try."""

    def __post_init__(self) -> None:
        """Refuse limits that make no sense."""
        if self.max_tries < 1 or self.max_wait_s < 0 or self.base_s < 0 or self.timeout_s <= 0:
            raise ConfigError(
                f"{self} makes no sense: give at least one try, a positive timeout_s, and "
                "max_wait_s and base_s that are not negative."
            )

    def pause_s(self, failures: int, asked_s: float | None) -> float:
        """How long to pause.

        Args:
            failures: Failed tries so far, at least 1.
            asked_s: Seconds that the server asked for (Retry-After), if it did.
        """
        backoff = min(self.base_s * 2.0 ** (failures - 1), _LONGEST_BACKOFF_S)
        # Jitter spreads parallel episodes that met the same rate limit at the same moment.
        return max(backoff * random.uniform(0.5, 1.0), asked_s or 0.0)


@dataclass(frozen=True, slots=True)
class Failure:
    """Why one try failed."""

    text: str
    """For people; free of secrets."""
    retryable: bool
    retry_after_s: float | None = None
    """Seconds that the server asked to wait."""
    refused: str = ""
    """Setting that the server refuses by name; empty if it complains of something else."""
    status: int | None = None
    """HTTP status that it comes to; None if nothing was answered."""
    words: str = ""
    """The server's own words; free of secrets."""
    most_pictures: int | None = None
    """How many pictures a prompt may hold, if it is about that."""


@dataclass(frozen=True, slots=True)
class Success(Generic[T]):
    """What a try brought, and the time it and the failures before it took."""

    value: T
    seconds: float
    waited_s: float


def run_with_retries(
    policy: RetryPolicy,
    name: str,
    attempt: Callable[[], T | Failure],
    adapt: Callable[[Failure], bool] = lambda failure: False,
    enter: Callable[[], float] = lambda: 0.0,
) -> Success[T]:
    """Try until an attempt succeeds or the policy says stop.

    Args:
        policy: The limits.
        name: Name of the model, for the error.
        attempt: One try; returns its value or why it failed.
        adapt: Told of each failure; true if it changed what the next attempt asks for, which then
            follows at once and is no retry of the same. It must not be true for ever.
        enter: Waits for leave to try; gives the seconds that it took, which are lost to no fault.

    Raises:
        RefusedError: The last failure was final.
        ProviderError: The limits are used up; its text tells the last failure.
    """
    begin = time.monotonic()
    failures, held_s = 0, 0.0
    while True:
        held_s += enter()
        start = time.monotonic()
        outcome = attempt()
        if not isinstance(outcome, Failure):
            return Success(outcome, time.monotonic() - start, start - begin)
        if adapt(outcome):
            continue
        if not outcome.retryable:
            text = f"{name}: {outcome.text}"
            raise RefusedError(text, outcome.status, outcome.words, outcome.most_pictures)
        failures += 1
        lost_s = time.monotonic() - begin - held_s
        pause_s = policy.pause_s(failures, outcome.retry_after_s)
        if failures == policy.max_tries or lost_s + pause_s > policy.max_wait_s:
            text = f"{name}: {_last_words(policy, outcome, failures, lost_s)}"
            raise ProviderError(text, outcome.status, outcome.words, outcome.most_pictures)
        time.sleep(pause_s)


def _last_words(policy: RetryPolicy, failure: Failure, tries: int, lost_s: float) -> str:
    asked_s = failure.retry_after_s
    asked = f" The server asked to wait {asked_s:.0f} s." if asked_s else ""
    return (
        f"{failure.text}{asked} Gave up after {tries} of {policy.max_tries} tries and "
        f"{lost_s:.1f} s; at most {policy.max_wait_s:g} s may be lost."
    )
