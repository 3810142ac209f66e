"""The tally: what the live table counts, by cell."""

from __future__ import annotations

from pathlib import Path

import pytest
from tests.study.episodes import record, small_study

from adamo_vh.record.termination import TerminationReason
from adamo_vh.study.plan import plan
from adamo_vh.study.tally import Tally

EPISODES = plan(small_study())


class Clock:
    """Seconds as the test says."""

    def __init__(self) -> None:
        self.now = 100.0

    def __call__(self) -> float:
        return self.now


def test_what_was_done_before_counts_but_not_for_the_speed(tmp_path: Path) -> None:
    before = {EPISODES[0].key: record(tmp_path, EPISODES[0])}
    clock = Clock()
    tally = Tally(EPISODES, before, clock)
    assert (tally.total.planned, tally.total.done) == (6, 1)
    assert tally.per_hour is None
    assert tally.seconds_left is None
    clock.now += 60
    tally.began(EPISODES[1].key)
    tally.ended(EPISODES[1].key, record(tmp_path, EPISODES[1]))
    assert tally.per_hour == pytest.approx(60)
    assert tally.seconds_left == pytest.approx(4 * 60)


def test_each_cell_is_counted_by_itself(tmp_path: Path) -> None:
    tally = Tally(EPISODES, {})
    first, second = dict.fromkeys(one.cell for one in EPISODES)
    tally.began(EPISODES[0].key)
    assert tally.cells[first].running == 1
    tally.ended(EPISODES[0].key, record(tmp_path, EPISODES[0]))
    tally.began(EPISODES[1].key)
    tally.ended(EPISODES[1].key, None)
    cells = tally.cells
    assert (cells[first].done, cells[first].unscored, cells[first].running) == (1, 1, 0)
    assert cells[first].mean == 0.0
    assert cells[first].tokens > 0
    assert cells[second].mean is None


def test_an_episode_that_has_no_score_now_may_have_one_later(tmp_path: Path) -> None:
    tally = Tally(EPISODES, {})
    key = EPISODES[0].key
    tally.began(key)
    tally.ended(key, record(tmp_path / "a", EPISODES[0], TerminationReason.BROKEN))
    assert (tally.total.unscored, tally.total.done) == (1, 0)
    tally.began(key)
    assert (tally.total.unscored, tally.total.running) == (0, 1)
    tally.ended(key, record(tmp_path / "b", EPISODES[0]))
    assert (tally.total.unscored, tally.total.done) == (0, 1)


def test_a_try_of_which_nothing_came_leaves_what_came_of_the_one_before(tmp_path: Path) -> None:
    broken = record(tmp_path, EPISODES[0], TerminationReason.BROKEN)
    tally = Tally(EPISODES, {EPISODES[0].key: broken})
    tally.began(EPISODES[0].key)
    tally.ended(EPISODES[0].key, None)
    assert tally.total.unscored == 1
    assert tally.total.tokens == broken.usage.total_tokens
