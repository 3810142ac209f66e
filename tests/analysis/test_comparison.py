"""Two runs compared: what is paired, what the effect is, and how sure it is."""

from __future__ import annotations

import json
import random
from dataclasses import replace

import pytest
from tests.outcomes import made, repeated

from adamo_vh.analysis.comparison import MEASURES, compare
from adamo_vh.analysis.outcome import Outcome
from adamo_vh.inference.model import ModelKind


def run(skill: float, *, seed: int = 0, tasks: int = 15, times: int = 15) -> list[Outcome]:
    lots = random.Random(seed)
    return [
        outcome
        for n in range(1, tasks + 1)
        for outcome in repeated(f"T{n}", *(float(lots.random() < skill) for _ in range(times)))
    ]


def test_a_run_does_not_differ_from_itself() -> None:
    same = run(0.5)
    found = compare(same, same)
    assert found is not None
    assert (found.effect, found.p) == (0.0, 1.0)
    assert found.repeat is not None and found.repeat.low < 0 < found.repeat.high


def test_a_clear_difference_is_found() -> None:
    found = compare(run(0.2), run(0.8, seed=1))
    assert found is not None and found.p is not None
    assert found.effect == pytest.approx(0.6, abs=0.1)
    assert found.effect == pytest.approx(found.second - found.first)
    assert found.p < 0.001
    for interval in (found.repeat, found.task):
        assert interval is not None and interval.low > 0
    assert found.n == (225, 225) and len(found.tasks) == 15


def test_what_only_one_has_played_is_left_out() -> None:
    found = compare(run(0.0, tasks=15), run(1.0, tasks=3))
    assert found is not None and list(found.tasks) == ["T1", "T2", "T3"]
    assert found.n == (45, 45)


def test_variations_are_paired_too() -> None:
    first = [made("T8", 1.0, variation=0), made("T8", 0.0, variation=1)]
    found = compare(first, [made("T8", 1.0, variation=0)])
    assert found is not None and found.effect == 0.0 and found.n == (1, 1)


def test_nothing_in_common_is_no_comparison() -> None:
    assert compare(run(1.0, tasks=1), [made("T2")]) is None
    assert compare([made("T1", None)], [made("T1")]) is None


def test_unscored_episodes_play_no_part() -> None:
    found = compare([made("T1", 1.0), made("T1", None, repetition=2)], [made("T1", 1.0)])
    assert found is not None and found.effect == 0.0


def test_few_tasks_cannot_give_a_small_p_and_it_is_said() -> None:
    found = compare(run(0.0, tasks=4), run(1.0, tasks=4))
    assert found is not None
    assert found.p == found.least_p == pytest.approx(2 / 2**4)


def test_a_single_task_says_nothing_of_others() -> None:
    found = compare(run(0.0, tasks=1), run(1.0, tasks=1))
    assert found is not None
    assert (found.p, found.task, found.detectable_task) == (None, None, None)
    assert found.repeat is not None


def test_two_deterministic_runs_have_no_interval_of_repetitions() -> None:
    def kind(outcome: Outcome) -> Outcome:
        return replace(outcome, model_kind=ModelKind.RULE_BASED)

    first = [kind(made(f"T{n}", 1.0)) for n in range(1, 16)]
    second = [kind(made(f"T{n}", float(n % 2))) for n in range(1, 16)]
    found = compare(first, second)
    assert found is not None and found.repeat is None and found.task is not None


def test_one_deterministic_run_adds_no_error_of_its_own() -> None:
    sure = [replace(made(f"T{n}", 1.0), model_kind=ModelKind.RULE_BASED) for n in range(1, 16)]
    found = compare(sure, run(0.5))
    both = compare(run(0.5, seed=2), run(0.5))
    assert found is not None and both is not None
    assert found.repeat is not None and both.repeat is not None
    assert found.repeat.high - found.repeat.low < both.repeat.high - both.repeat.low


def test_more_repetitions_can_show_smaller_differences() -> None:
    few = compare(run(0.5, times=3), run(0.5, times=3, seed=1))
    many = compare(run(0.5, times=30), run(0.5, times=30, seed=1))
    assert few is not None and many is not None
    assert few.detectable_repeat is not None and many.detectable_repeat is not None
    assert many.detectable_repeat < few.detectable_repeat / 2


def test_the_detectable_difference_is_found_as_often_as_promised() -> None:
    once = compare(run(0.5, seed=1, tasks=6), run(0.5, seed=2, tasks=6))
    assert once is not None and once.detectable_repeat is not None
    shift = once.detectable_repeat
    seen = 0
    for seed in range(100):
        better = run(0.5 + shift, seed=3 * seed + 1, tasks=6)
        found = compare(run(0.5, seed=3 * seed, tasks=6), better)
        assert found is not None and found.repeat is not None
        seen += found.repeat.low > 0
    assert 0.7 <= seen / 100 <= 0.95


@pytest.mark.parametrize("measure", MEASURES)
def test_every_measure_can_be_compared(measure: str) -> None:
    dearer = [replace(o, cost_usd=0.04, steps=9, model_s=16.0) for o in run(0.5, seed=1)]
    found = compare(run(0.5), dearer, measure)
    assert found is not None
    json.dumps([found.effect, found.p, found.detectable_repeat, found.repeat and found.repeat.low])
    if measure == "cost_usd":
        assert found.effect == pytest.approx(0.02)


def test_unknown_costs_are_not_compared() -> None:
    unknown = [replace(o, cost_usd=None) for o in run(0.5)]
    assert compare(run(0.5), unknown, "cost_usd") is None
