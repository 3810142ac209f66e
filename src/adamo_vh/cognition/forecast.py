"""What a run will take, said before it starts.

Basis. The prompt of call i of an episode has the tokens of the first one plus (i - 1) times its
growth, and every reply has the same length, so n calls read n first + growth n (n - 1) / 2 tokens.
The growth is taken to go on: a short memory (k) makes it less. How many calls an episode needs is
the least known, so the range is that of half and of twice the expected calls. Money is at list
price without any provider cache, which makes it an upper figure for the calls assumed.
"""

from __future__ import annotations

from dataclasses import dataclass

from adamo_vh.cognition.budget import Budget
from adamo_vh.errors import ConfigError
from adamo_vh.inference.cost.prices import cost_usd
from adamo_vh.inference.model import Usage

SECONDS_PER_CALL = 6.85
"""The paper's mean for GPT-4o over both labelings and scenes."""


@dataclass(frozen=True, slots=True)
class Forecast:
    """What a run is expected to take."""

    uri: str
    episodes: int
    calls: int
    """Model calls of all episodes."""
    tokens_low: int
    tokens_typical: int
    tokens_high: int
    usd: float | None
    """US dollars for the typical tokens; None if no price is known."""
    usd_high: float | None
    """US dollars for the high ones."""
    seconds: float
    """One episode after the other."""

    def text(self) -> str:
        """One sentence."""
        money = "no price known"
        if self.usd is not None and self.usd_high is not None:
            money = f"about {_dollars(self.usd)} (at most about {_dollars(self.usd_high)})"
        return (
            f"{_counted(self.episodes, 'episode')} with {self.uri}: "
            f"about {_counted(self.calls, 'model call')}, {_short(self.tokens_typical)} tokens "
            f"({_short(self.tokens_low)} to {_short(self.tokens_high)}), {money}, "
            f"{_duration(self.seconds)} of model time."
        )

    def warns(self, budget: Budget) -> str | None:
        """What to say if a budget for the whole run may not be enough; None if it is."""
        if budget.usd is not None and self.usd is None:
            return (
                f"No price is known for {self.uri}, so that a budget of {_dollars(budget.usd)} "
                "will stop the run after its first call. Put the model into the price table "
                "(prices.toml), or leave the money out."
            )
        caps = (
            ("tokens", budget.tokens, self.tokens_typical, self.tokens_high, _short),
            ("money", budget.usd, self.usd, self.usd_high, _dollars),
            ("calls", budget.calls, self.calls, 2 * self.calls, _short),
            ("time", budget.seconds, self.seconds, 2 * self.seconds, _duration),
        )
        for name, cap, typical, high, shown in caps:
            if cap is None or typical is None or high is None or high <= cap:
                continue
            surely = "will not" if typical > cap else "may not"
            return (
                f"The budget of {name} ({shown(cap)}) {surely} be enough: "
                f"about {shown(typical)} expected, up to {shown(high)}."
            )
        return None


def forecast(
    uri: str,
    calls_expected: float,
    first_request_tokens: int,
    growth_per_call_tokens: float,
    output_per_call: float,
    episodes: int = 1,
    *,
    seconds_per_call: float = SECONDS_PER_CALL,
) -> Forecast:
    """Forecast a run.

    Args:
        uri: Model URI, for the price.
        calls_expected: Model calls of an episode.
        first_request_tokens: Input of the first call of an episode.
        growth_per_call_tokens: By how much the input grows from call to call.
        output_per_call: Tokens of a reply.
        episodes: How many episodes.
        seconds_per_call: How long the model takes.

    Raises:
        ConfigError: A number makes no sense.
    """
    least = min(first_request_tokens, growth_per_call_tokens, output_per_call, episodes)
    if calls_expected < 1 or least < 0:
        raise ConfigError("A forecast needs at least one call an episode and no negative number.")

    def usages(factor: float) -> list[Usage]:
        calls = max(1, round(calls_expected * factor))
        output = round(output_per_call)
        return [
            Usage(round(first_request_tokens + number * growth_per_call_tokens), output)
            for number in range(calls)
        ]

    low, typical, high = usages(0.5), usages(1.0), usages(2.0)
    return Forecast(
        uri,
        episodes,
        len(typical) * episodes,
        _tokens(low) * episodes,
        _tokens(typical) * episodes,
        _tokens(high) * episodes,
        _price(uri, typical, episodes),
        _price(uri, high, episodes),
        len(typical) * episodes * seconds_per_call,
    )


def _tokens(usages: list[Usage]) -> int:
    return sum(usage.total_tokens for usage in usages)


def _price(uri: str, usages: list[Usage], episodes: int) -> float | None:
    """What episodes of these calls cost; each call by itself, since long ones may cost more."""
    prices = [cost_usd(uri, usage) for usage in usages]
    known = [price for price in prices if price is not None]
    return sum(known) * episodes if len(known) == len(prices) else None


def _counted(number: int, what: str) -> str:
    return f"{number:,} {what}" + ("" if number == 1 else "s")


def _short(number: float) -> str:
    for size, sign in ((1e9, "G"), (1e6, "M"), (1e4, "k")):
        if number >= size:
            unit = 1e3 if sign == "k" else size
            return f"{number / unit:.3g} {sign}"
    return f"{number:,.0f}"


def _dollars(number: float) -> str:
    return f"${number:,.2f}" if number >= 1 else f"${number:.2g}"


def _duration(seconds: float) -> str:
    if seconds < 120:
        return f"{seconds:.0f} s"
    return f"{seconds / 60:.0f} min" if seconds < 7200 else f"{seconds / 3600:.1f} h"
