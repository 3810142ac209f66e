"""The supervisor: every episode gets its score, whatever happens to what plays it."""

from __future__ import annotations

from pathlib import Path

import pytest
from tests.study.episodes import Act, Heard, TableExecutor, failed, record, small_study

from adamo_vh.errors import EngineError, FileError
from adamo_vh.record.termination import TerminationReason
from adamo_vh.study.executor import Finished, Lost, Report
from adamo_vh.study.plan import Planned, plan
from adamo_vh.study.store import Store, read_outcomes
from adamo_vh.study.supervisor import RETRIES, Supervisor, Verdict
from adamo_vh.study.tally import Tally

KEYS = [one.key for one in plan(small_study())]


def _play(
    folder: Path, goes_wrong: Act | None = None, slots: int = 2
) -> tuple[Verdict, TableExecutor, Heard, Tally]:
    study = small_study()
    executor, heard = TableExecutor(folder, goes_wrong, slots), Heard()
    with Store(folder, study, plan(study)) as store:
        tally = Tally(store.episodes.values(), store.outcomes)
        left = [one for one in store.episodes.values() if not store.is_done(one.key)]
        verdict = Supervisor(store, executor, tally).run(left, heard)
    return verdict, executor, heard, tally


def test_every_episode_is_played_once(tmp_path: Path) -> None:
    verdict, executor, heard, tally = _play(tmp_path)
    assert executor.started == KEYS == heard.began_
    assert (verdict.problems, verdict.stopped) == ({}, False)
    assert (tally.total.done, tally.total.running, tally.total.unscored) == (6, 0, 0)
    outcomes, damaged = read_outcomes(tmp_path)
    assert [one.key for one in outcomes] == KEYS
    assert damaged == {}
    assert {one.model for one in outcomes} == {"random"}


def test_the_same_again_plays_nothing(tmp_path: Path) -> None:
    _play(tmp_path)
    assert _play(tmp_path)[1].started == []


def test_a_fault_of_the_provider_is_tried_again_after_the_others(tmp_path: Path) -> None:
    def once(planned: Planned, tries: int) -> Report | None:
        return failed(planned, again=True) if planned.key == KEYS[0] and tries == 1 else None

    verdict, executor, heard, tally = _play(tmp_path, once)
    assert executor.started == [*KEYS, KEYS[0]]
    assert heard.ended_[0] == (KEYS[0], "the provider is down", True)
    assert verdict.problems == {}
    assert tally.total.done == 6


def test_after_three_further_tries_it_is_reported_and_the_others_are_played(tmp_path: Path) -> None:
    def always(planned: Planned, tries: int) -> Report | None:
        return failed(planned, again=True) if planned.key == KEYS[2] else None

    verdict, executor, heard, tally = _play(tmp_path, always)
    assert executor.started.count(KEYS[2]) == 1 + RETRIES
    assert verdict.problems == {KEYS[2]: "the provider is down"}
    assert (tally.total.done, tally.total.unscored) == (5, 1)
    assert heard.ended_[-1] == (KEYS[2], "the provider is down", False)
    again = _play(tmp_path)
    assert again[1].started == [KEYS[2]]
    assert again[0].problems == {}


def test_a_broken_episode_is_kept_without_a_score_and_tried_again(tmp_path: Path) -> None:
    study = small_study()
    with Store(tmp_path, study, plan(study)) as store:
        (one,) = [one for one in store.episodes.values() if one.key == KEYS[1]]
        store.add(record(tmp_path, one, TerminationReason.BROKEN))
    outcomes, _ = read_outcomes(tmp_path)
    assert [(o.key, o.is_scored) for o in outcomes] == [(KEYS[1], False)]


def test_what_no_try_would_change_is_not_tried_again(tmp_path: Path) -> None:
    def wrong(planned: Planned, tries: int) -> Report | None:
        return failed(planned, "no such scene") if planned.key == KEYS[0] else None

    verdict, executor, _, _ = _play(tmp_path, wrong)
    assert executor.started == KEYS
    assert verdict.problems == {KEYS[0]: "no such scene"}


def test_what_is_lost_together_is_played_alone_so_that_one_takes_no_others(tmp_path: Path) -> None:
    poison = KEYS[0]

    def deadly(planned: Planned, tries: int) -> Report | None:
        return Lost((), "killed") if planned.key == poison else None

    verdict, executor, _, tally = _play(tmp_path, deadly, slots=4)
    assert verdict.problems == {poison: "killed"}
    assert tally.total.done == 5
    assert executor.started.count(poison) == 1 + 5
    assert all(executor.started.count(key) <= 2 for key in KEYS[1:])


def test_a_full_disk_ends_it_at_once(tmp_path: Path) -> None:
    def full(planned: Planned, tries: int) -> Report | None:
        full_ = planned.key == KEYS[3]
        return failed(planned, "No space left on device.", fatal=True) if full_ else None

    with pytest.raises(FileError, match="No space left"):
        _play(tmp_path, full)
    assert len(read_outcomes(tmp_path)[0]) == 3


def test_workers_that_only_die_are_given_up(tmp_path: Path) -> None:
    with pytest.raises(EngineError, match="one after the other"):
        _play(tmp_path, lambda planned, tries: Lost((), "exit code -11"))


def test_a_stop_lets_what_is_played_come_to_its_end(tmp_path: Path) -> None:
    study = small_study()
    executor, heard = TableExecutor(tmp_path), Heard()
    with Store(tmp_path, study, plan(study)) as store:
        supervisor = Supervisor(store, executor, Tally(store.episodes.values(), {}))
        heard.tick = supervisor.stop  # type: ignore[method-assign]
        verdict = supervisor.run(store.episodes.values(), heard)
    assert verdict.stopped
    assert executor.started == KEYS[:2]
    assert len(read_outcomes(tmp_path)[0]) == 2


def test_a_spent_budget_begins_nothing_more(tmp_path: Path) -> None:
    def spent(planned: Planned, tries: int) -> Report | None:
        if planned.key != KEYS[2]:
            return None
        return Finished(planned.key, record(tmp_path, planned, TerminationReason.RUN_BUDGET))

    verdict, executor, _, _ = _play(tmp_path, spent, slots=1)
    assert executor.started == KEYS[:3]
    assert verdict.budget_spent
    assert set(verdict.problems) == {KEYS[2]}
