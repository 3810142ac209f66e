"""The executor of one machine: real processes, killed and stopped at bad moments."""

from __future__ import annotations

import os
import signal
import time
from collections.abc import Callable, Iterator
from contextlib import closing
from pathlib import Path

import pytest

from adamo_vh.study.executor import Failed, Finished, Lost, Report
from adamo_vh.study.local import LocalExecutor
from adamo_vh.study.plan import Planned, Study, plan
from adamo_vh.study.worker import Setup

EPISODES = plan(
    Study(
        ("T1", "T8"),
        models=("random",),
        repetitions=2,
        settings={"resolution": "160x90", "limits": {"max_steps": 6}},
    )
)
FAILURES = plan(
    Study(
        ("T1", "T8"),
        models=("random",),
        repetitions=5,
        settings={"resolution": "160x90", "limits": {"max_steps": 3}},
    )
)
_PATIENCE_S = 120


@pytest.fixture
def make(tmp_path: Path) -> Iterator[Callable[..., LocalExecutor]]:
    made: list[LocalExecutor] = []

    def new(workers: int = 1, in_flight: int = 1, **other: float) -> LocalExecutor:
        made.append(LocalExecutor(Setup(tmp_path), workers, in_flight, **other))
        return made[-1]

    yield new
    for executor in made:
        with closing(executor):
            pass


def _until(executor: LocalExecutor, found: Callable[[Report], bool]) -> list[Report]:
    """What is reported, up to what is looked for."""
    reports: list[Report] = []
    end = time.monotonic() + _PATIENCE_S
    while time.monotonic() < end:
        for report in executor.wait(0.2):
            reports.append(report)
            if found(report):
                return reports
    raise AssertionError(f"nothing came but {reports}")


def _of(planned: Planned) -> Callable[[Report], bool]:
    return lambda report: isinstance(report, Finished | Failed) and report.key == planned.key


@pytest.mark.slow
def test_a_killed_worker_costs_what_it_played_and_is_replaced(
    make: Callable[..., LocalExecutor],
) -> None:
    executor = make()
    first, second = EPISODES[:2]
    executor.start(first)
    assert not executor.can_take()
    _until(executor, _of(first))  # The process is warm now: the next one is killed while it plays.
    executor.start(second)
    time.sleep(0.05)
    (pid,) = executor.pids
    os.kill(pid, signal.SIGKILL)
    (lost,) = _until(executor, lambda report: isinstance(report, Lost))
    assert isinstance(lost, Lost)
    assert lost.keys == (second.key,)
    assert "exit code -9" in lost.why
    assert executor.pids != (pid,)
    assert executor.can_take(alone=True)
    executor.start(second)
    *_, report = _until(executor, _of(second))
    assert isinstance(report, Finished)


@pytest.mark.slow
def test_a_worker_that_is_killed_before_it_plays_is_replaced_too(
    make: Callable[..., LocalExecutor],
) -> None:
    executor = make(workers=2)
    for pid in executor.pids:
        os.kill(pid, signal.SIGKILL)
    executor.start(EPISODES[0])
    _until(executor, lambda report: isinstance(report, Lost) and bool(report.keys))
    executor.start(EPISODES[0])
    *_, report = _until(executor, _of(EPISODES[0]))
    assert isinstance(report, Finished)


@pytest.mark.slow
def test_a_worker_that_hangs_is_killed(make: Callable[..., LocalExecutor]) -> None:
    executor = make(silent_s=8.0)
    executor.start(EPISODES[0])
    _until(executor, _of(EPISODES[0]))
    os.kill(executor.pids[0], signal.SIGSTOP)
    executor.start(EPISODES[1])
    (lost,) = _until(executor, lambda report: isinstance(report, Lost))
    assert isinstance(lost, Lost)
    assert lost.keys == (EPISODES[1].key,)


@pytest.mark.slow
def test_several_episodes_are_in_flight_in_one_process(
    make: Callable[..., LocalExecutor],
) -> None:
    executor = make(in_flight=3)
    for planned in EPISODES[:3]:
        assert executor.can_take()
        executor.start(planned)
    assert not executor.can_take()
    assert not executor.can_take(alone=True)
    done: list[str] = []
    while len(done) < 3:
        done += [r.key for r in executor.wait(0.5) if isinstance(r, Finished)]
    assert sorted(done) == sorted(one.key for one in EPISODES[:3])


@pytest.mark.slow
@pytest.mark.parametrize(("in_flight", "most"), [(1, 1), (2, 4)])
def test_others_begin_while_failures_are_explained(
    make: Callable[..., LocalExecutor], in_flight: int, most: int
) -> None:
    executor, waiting, done, at_once = make(in_flight=in_flight), list(FAILURES), 0, 0
    while done < len(FAILURES):
        while waiting and executor.can_take():
            executor.start(waiting.pop())
            at_once = max(at_once, len(FAILURES) - len(waiting) - done)
        done += sum(isinstance(report, Finished) for report in executor.wait(0.02))
    assert at_once <= most
    assert (at_once > in_flight) == (in_flight > 1)


@pytest.mark.slow
def test_what_is_suspected_is_played_alone(make: Callable[..., LocalExecutor]) -> None:
    executor = make(in_flight=3)
    executor.start(EPISODES[0], alone=True)
    assert not executor.can_take()
    _until(executor, _of(EPISODES[0]))
    assert executor.can_take()


@pytest.mark.slow
def test_workers_end_when_nobody_gives_orders_any_more(
    make: Callable[..., LocalExecutor],
) -> None:
    executor = make()
    process = executor._workers[0].process
    executor._workers[0].pipe.close()
    process.join(_PATIENCE_S)
    assert process.exitcode == 1
