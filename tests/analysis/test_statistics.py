"""Intervals, pass^k and rank correlation against what is known of them."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from adamo_vh.analysis.statistics import (
    agreement,
    freedom,
    interval,
    mean,
    pass_hat,
    rank_correlation,
    standard_error,
)

shares = st.floats(0.0, 1.0)


def test_one_group_gives_the_t_interval_that_scipy_gives() -> None:
    from scipy import stats

    values = [0.2, 0.9, 0.4, 0.7, 0.5, 0.6, 0.3, 0.8, 0.45, 0.55, 0.35, 0.65] * 3
    found = interval([values], sum(values) / len(values))
    low, high = stats.t.interval(
        0.95, len(values) - 1, loc=np.mean(values), scale=stats.sem(values)
    )
    half = max((high - low) / 2, 1 - 0.05 ** (1 / len(values)))
    assert found is not None
    assert (found.low, found.high) == pytest.approx(
        (np.mean(values) - half, np.mean(values) + half)
    )


def test_the_spread_between_groups_says_nothing_of_repetitions() -> None:
    apart = [[0.0, 0.1] * 10, [0.9, 1.0] * 10]
    alike = [[0.45, 0.55] * 10, [0.45, 0.55] * 10]
    assert standard_error(apart) == pytest.approx(standard_error(alike))


def test_perfect_agreement_is_not_certainty() -> None:
    fifteen = interval([[1.0] * 15], 1.0)
    assert fifteen is not None
    assert (fifteen.low, fifteen.high) == pytest.approx((0.05 ** (1 / 15), 1.0))
    assert agreement(225) == pytest.approx(0.0132, abs=1e-4)


@pytest.mark.parametrize("groups", [[], [[]], [[1.0]], [[1.0, 0.0], [1.0]]])
def test_what_cannot_be_told_is_none(groups: list[list[float]]) -> None:
    assert interval(groups, 0.5) is None


def test_nothing_has_no_mean() -> None:
    assert mean([]) is None


@pytest.mark.parametrize(
    ("groups", "degrees"),
    [
        ([[0.0, 1.0, 0.5]], 2),
        ([[0.0, 1.0]] * 4, 4),
        ([[0.0, 1.0]] * 40, 14),  # No more are counted on.
        ([[0.0, 1.0, 1.0], *[[1.0] * 3] * 9], 2),  # One group alone varies.
        ([[1.0] * 5] * 4, 4),
        ([[0.0, 1.0] * 20], 39),
    ],
)
def test_groups_lend_each_other_degrees_of_freedom(
    groups: list[list[float]], degrees: float
) -> None:
    assert freedom(groups) == pytest.approx(degrees)


@pytest.mark.parametrize("repetitions", [2, 3, 5, 15])
def test_a_mean_that_would_repeat_is_held_as_often_as_promised(repetitions: int) -> None:
    lots = np.random.default_rng(repetitions)
    held = []
    for _ in range(600):
        skills = lots.beta(5, 3, 15)
        groups = [list(lots.binomial(2, skill, repetitions) / 2) for skill in skills]
        found = interval(groups, float(np.mean(groups)))
        assert found is not None
        held.append(found.low <= np.mean(skills) <= found.high)
    assert 0.94 <= np.mean(held) <= 0.985


@given(st.lists(st.lists(shares, min_size=2, max_size=6), min_size=1, max_size=6))
def test_an_interval_holds_its_mean_and_stays_between_0_and_1(groups: list[list[float]]) -> None:
    centre = float(np.mean([np.mean(group) for group in groups]))
    found = interval(groups, centre)
    assert found is not None
    assert 0.0 <= found.low <= centre + 1e-12 and centre - 1e-12 <= found.high <= 1.0


@given(st.integers(1, 20).flatmap(lambda n: st.tuples(st.integers(0, n), st.just(n))))
def test_pass_hat_1_is_the_rate_and_more_is_never_likelier(counts: tuple[int, int]) -> None:
    successes, n = counts
    found = [pass_hat(successes, n, k) for k in range(1, n + 1)]
    assert found[0] == pytest.approx(successes / n)
    assert found == sorted(found, reverse=True)  # type: ignore[type-var]
    assert pass_hat(successes, n, n + 1) is None and pass_hat(successes, n, 0) is None


def test_pass_hat_is_unbiased() -> None:
    rng = np.random.default_rng(0)
    drawn = rng.binomial(10, 0.8, 20_000)
    found = np.mean([pass_hat(int(c), 10, 3) for c in drawn])
    assert found == pytest.approx(0.8**3, abs=0.005)


def test_ranks_go_with_scipy() -> None:
    from scipy import stats

    levels, values = [1, 2, 2, 4, 5, 6], [1.0, 0.9, 1.0, 0.5, 0.6, 0.1]
    found = rank_correlation(levels, values)
    expected = stats.spearmanr(levels, values)
    assert (found.rho, found.p, found.n) == (expected.statistic, expected.pvalue, 6)


@pytest.mark.parametrize(
    ("levels", "values"),
    [([], []), ([1, 2], [1, 0]), ([1, 2, 3], [1, 1, 1]), ([2, 2, 2], [1, 2, 3])],
)
def test_what_does_not_vary_has_no_rank(levels: list[float], values: list[float]) -> None:
    found = rank_correlation(levels, values)
    assert (found.rho, found.p) == (None, None)
