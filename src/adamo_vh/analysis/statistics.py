"""How sure a mean is: one formula for the intervals, pass^k, and rank correlation.

An interval is made of groups of values. What a group is decides which question it answers: the
repetitions of each cell (*would this repeat?*), the means of all tasks (*would it hold for other
tasks?*), or the means of each task's variations (*would it hold for other layouts?*).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from math import comb, fsum

CONFIDENCE = 0.95
"""Of every interval."""
_ENOUGH = 14.0
"""Degrees of freedom of a cell of 15 episodes, as many as the paper played."""


@dataclass(frozen=True, slots=True)
class Interval:
    """Where the true mean lies, with `CONFIDENCE`."""

    low: float
    high: float


@dataclass(frozen=True, slots=True)
class Rank:
    """Spearman's rank correlation."""

    rho: float | None
    """-1 to 1; None if one of the two does not vary, or there are fewer than 3 pairs."""
    p: float | None
    """How often chance alone gives a correlation at least as strong; two-sided."""
    n: int
    """Pairs."""


def mean(values: Sequence[float]) -> float | None:
    """The mean; None if there is nothing, because that is not 0."""
    return fsum(values) / len(values) if values else None


def standard_error(groups: Sequence[Sequence[float]]) -> float | None:
    """Of the mean of the groups' means, by the spread within each group.

    Args:
        groups: Values of each group; the groups themselves are taken as given.

    Returns:
        None if it cannot be told, because a group has a single value or there is none.
    """
    if not groups or min(map(len, groups)) < 2:
        return None
    return math.sqrt(fsum(_variance(group) / len(group) for group in groups)) / len(groups)


def freedom(groups: Sequence[Sequence[float]]) -> float:
    """Degrees of freedom of that error, after Welch and Satterthwaite.

    At least those of the smallest group, which are all there are if one group alone varies. More
    than `_ENOUGH` are not counted on: they are exact for bell-shaped values, and scores are not.
    """
    least = min(map(len, groups)) - 1
    parts = [_variance(group) / len(group) for group in groups]
    squares = fsum(part**2 / (len(group) - 1) for part, group in zip(parts, groups, strict=True))
    pooled = fsum(parts) ** 2 / squares if squares else 0.0
    return max(float(least), round(min(pooled, _ENOUGH), 1))


def interval(groups: Sequence[Sequence[float]], centre: float) -> Interval | None:
    """The interval of a mean over groups, for values from 0 to 1.

    It is a t interval that is never narrower than the rule of three allows: if `n` values agree
    altogether, up to a share of `1 - 0.05 ** (1 / n)` of all others may still differ.

    Args:
        groups: Values of each group, from 0 to 1.
        centre: The mean that it is about: that of the groups' means, but for gaps in the data.

    Returns:
        None if it cannot be told, because a group has a single value or there is none.
    """
    error = standard_error(groups)
    if error is None:
        return None
    half = max(quantile(freedom(groups)) * error, agreement(sum(map(len, groups))))
    return around(centre, half, 0.0, 1.0)


def around(centre: float, half: float, least: float, most: float) -> Interval:
    """The interval of a half width, cut off where no value can be."""
    return Interval(max(least, centre - half), min(most, centre + half))


def agreement(count: int) -> float:
    """The largest share of others that may differ, although so many values agreed."""
    return 1.0 - math.pow(1.0 - CONFIDENCE, 1.0 / count)


@cache
def quantile(degrees: float, share: float = (1.0 + CONFIDENCE) / 2) -> float:
    """Of Student's t distribution."""
    from scipy import stats

    return float(stats.t.ppf(share, degrees))


def pass_hat(successes: int, n: int, k: int) -> float | None:
    """pass^k: how likely all of k repetitions succeed, estimated from n without bias.

    Args:
        successes: Repetitions that succeeded.
        n: All repetitions.
        k: At most n, else None.
    """
    return float(comb(successes, k) / comb(n, k)) if 1 <= k <= n else None


def rank_correlation(levels: Sequence[float], values: Sequence[float]) -> Rank:
    """Spearman's correlation of two columns, with its p-value."""
    n = len(levels)
    if n < 3 or len(set(levels)) < 2 or len(set(values)) < 2:
        return Rank(None, None, n)
    from scipy import stats

    found = stats.spearmanr(levels, values)
    return Rank(float(found.statistic), float(found.pvalue), n)


def _variance(values: Sequence[float]) -> float:
    """Of the population that the values were drawn from."""
    centre = fsum(values) / len(values)
    return fsum((value - centre) ** 2 for value in values) / (len(values) - 1)
