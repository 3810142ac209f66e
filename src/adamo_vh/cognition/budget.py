"""Budgets: tokens, money, calls and seconds, of an episode and of a whole run.

A guard adds up what an episode spends and is asked before every model call, so that a cap stops
within one call. The budget of a run is one `Ledger` that all its episodes share.
"""

from __future__ import annotations

import math
import threading
from collections.abc import Iterator
from dataclasses import dataclass, replace

from adamo_vh.errors import ConfigError
from adamo_vh.inference.model import Reply, Usage
from adamo_vh.observation import Frame
from adamo_vh.record.termination import Stop, TerminationReason
from adamo_vh.record.trajectory import Acted, Ended, Event, Lost, Started, Thought


@dataclass(frozen=True, slots=True)
class Budget:
    """Caps; None is no cap, and 0 allows nothing."""

    tokens: int | None = None
    """Input plus output."""
    usd: float | None = None
    """US dollars."""
    calls: int | None = None
    """Model calls; a repair turn and retries belong to their call."""
    seconds: float | None = None
    """Thinking and acting, without waits for retries and rate limits."""

    def __post_init__(self) -> None:
        """Refuse what is no amount."""
        for name in ("tokens", "usd", "calls", "seconds"):
            cap = getattr(self, name)
            if cap is not None and not (_is_amount(cap) and cap >= 0):
                raise ConfigError(f"The budget of {name} must be 0 or more, not {cap}.")

    def __bool__(self) -> bool:
        """Whether anything is capped."""
        return self != Budget()


def _is_amount(cap: object) -> bool:
    return isinstance(cap, int | float) and not isinstance(cap, bool) and math.isfinite(cap)


@dataclass(frozen=True, slots=True)
class Spent:
    """What was spent."""

    tokens: int = 0
    usd: float = 0.0
    """Of the calls whose price is known."""
    calls: int = 0
    seconds: float = 0.0
    unpriced: int = 0
    """Calls whose price is not known."""


class Ledger:
    """Adds up what was spent; several threads may share one."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._spent = Spent()

    @property
    def spent(self) -> Spent:
        """All so far."""
        with self._lock:
            return self._spent

    def spend(
        self, usage: Usage, cost_usd: float | None, *, calls: int = 1, seconds: float = 0.0
    ) -> None:
        """Add what some calls took.

        Args:
            usage: Their tokens.
            cost_usd: Their price; None if it is not known, which is not 0.
            calls: How many they were.
            seconds: How long they took.
        """
        with self._lock:
            before = self._spent
            self._spent = Spent(
                before.tokens + usage.total_tokens,
                before.usd + (cost_usd or 0.0),
                before.calls + calls,
                before.seconds + seconds,
                before.unpriced + (calls if cost_usd is None else 0),
            )

    def pass_time(self, seconds: float) -> None:
        """Add seconds in which no model was asked."""
        with self._lock:
            self._spent = replace(self._spent, seconds=self._spent.seconds + seconds)

    def exceeded(self, budget: Budget, next_tokens: int = 0) -> str | None:
        """Why another call does not fit into a budget; None if it may.

        Args:
            budget: The caps.
            next_tokens: Tokens that the next call takes at least.
        """
        return next(_reasons(self.spent, budget, next_tokens), None)


def _reasons(spent: Spent, budget: Budget, next_tokens: int) -> Iterator[str]:
    if budget.calls is not None and spent.calls >= budget.calls:
        yield f"{spent.calls} of {budget.calls} model calls are used"
    if budget.tokens is not None:
        used = f"{spent.tokens:,} of {budget.tokens:,} tokens are used"
        if spent.tokens >= budget.tokens:
            yield used
        elif spent.tokens + next_tokens > budget.tokens:
            yield f"{used}, and the next call reads about {next_tokens:,}"
    if budget.usd is not None:
        if spent.unpriced:
            yield (
                f"the price of {spent.unpriced} of {spent.calls} calls is not known, so that a "
                f"budget of {budget.usd:g} US dollars cannot be kept; put the model into the "
                "price table (prices.toml)"
            )
        if spent.usd >= budget.usd:
            yield f"{spent.usd:.4f} of {budget.usd:g} US dollars are used"
    if budget.seconds is not None and spent.seconds >= budget.seconds:
        yield f"{spent.seconds:.1f} of {budget.seconds:g} seconds are used"


class BudgetGuard:
    """Stops an episode whose own budget, or that of the whole run, is used up.

    A call that would surely not fit is not made: the next prompt is taken to be at least as long as
    the last one, which holds as long as no old step or picture has just left the prompt.
    """

    def __init__(
        self, budget: Budget, ledger: Ledger | None = None, run_budget: Budget | None = None
    ) -> None:
        """Set the caps.

        Args:
            budget: Of this episode, anew for every instruction.
            ledger: What the whole run has spent; this episode is added to it.
            run_budget: Of the whole run.
        """
        self._budget = budget
        self._run_budget = run_budget or Budget()
        self._own = Ledger()
        self._run = ledger or Ledger()
        self._last_input = 0

    @property
    def spent(self) -> Spent:
        """What this episode has spent."""
        return self._own.spent

    def notify(self, event: Event, frame: Frame | None = None) -> None:
        """Add up what an event took."""
        if isinstance(event, Started):
            self._own, self._last_input = Ledger(), 0
        elif isinstance(event, Thought):
            # A repair turn reads the prompt again, so its input is the sum of both.
            reply = event.reply
            self._last_input = reply.usage.input_tokens // max(1, reply.requests)
            cost = 0.0 if _is_free(reply) else reply.cost_usd
            for ledger in (self._own, self._run):
                ledger.spend(reply.usage, cost, seconds=reply.seconds)
        elif isinstance(event, Lost | Ended) and event.spent is not None:
            lost = event.spent
            for ledger in (self._own, self._run):
                ledger.spend(lost.usage, lost.cost_usd, seconds=lost.seconds)
        elif isinstance(event, Acted):
            for ledger in (self._own, self._run):
                ledger.pass_time(event.world_s)

    def stop(self) -> Stop | None:
        """`BUDGET` or `RUN_BUDGET` if another call does not fit."""
        if why := self._own.exceeded(self._budget, self._last_input):
            return Stop(TerminationReason.BUDGET, f"The budget of this episode is used up: {why}.")
        if why := self._run.exceeded(self._run_budget, self._last_input):
            return Stop(
                TerminationReason.RUN_BUDGET, f"The budget of the whole run is used up: {why}."
            )
        return None


def _is_free(reply: Reply) -> bool:
    """Whether no provider was asked: no wire, and no tokens that one has counted."""
    counted = reply.usage != Usage() and not reply.usage.estimated
    return reply.cost_usd is None and reply.rung is None and not counted
