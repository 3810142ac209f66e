"""A study from its plan to its last episode: `adamo-vh bench`, and the same from Python."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Sequence
from contextlib import ExitStack, closing
from dataclasses import dataclass, field
from pathlib import Path

from adamo_vh.cognition.budget import Budget
from adamo_vh.errors import ConfigError
from adamo_vh.inference.registry import is_remote
from adamo_vh.record.signing import Signer
from adamo_vh.session.builtin import check_scene
from adamo_vh.session.figures import check_figure, is_own
from adamo_vh.session.forecasting import check_price
from adamo_vh.session.minds import model_of
from adamo_vh.study.cluster import Cluster, RayExecutor
from adamo_vh.study.executor import Executor
from adamo_vh.study.ledger import StudyLedger, check_caps
from adamo_vh.study.limiter import Rates
from adamo_vh.study.local import LocalExecutor
from adamo_vh.study.plan import Planned, Study, plan
from adamo_vh.study.store import Store
from adamo_vh.study.supervisor import Supervisor, Verdict, Watcher
from adamo_vh.study.tally import Tally
from adamo_vh.study.worker import Setup

_REMOTE_IN_FLIGHT = 16
"""Episodes at once in a process that waits for a provider most of the time."""
_MOST_WORKERS = 256
_MOST_IN_FLIGHT = 256


@dataclass(frozen=True, slots=True)
class Means:
    """What a study is played with; nothing of it changes what comes out."""

    workers: int | None = 1
    """Processes; None for as many as cores, on this machine at most 4."""
    in_flight: int | None = None
    """Episodes at once in each; None for 1, or 16 if a model is remote."""
    shard: tuple[int, int] = (1, 1)
    """Which part of the plan, of how many: 1/4 to 4/4 are played by four machines."""
    budget: Budget = field(default=Budget())
    """Of the whole study."""
    frame_cache: bool = True
    """Whether views that episodes share are drawn once in each process."""
    rates: Rates = field(default=Rates())
    """How much each provider may be asked by all processes together."""

    sign: Path | None = None
    """Private key that signs every result and the chain of all; see `Signer`."""
    cluster: Cluster | None = None
    """The machines that play; None for this one alone."""

    def __post_init__(self) -> None:
        """Refuse what is nothing to play with."""
        check_caps(self.budget)
        if self.workers is not None and not 1 <= self.workers <= _MOST_WORKERS:
            raise ConfigError(f"workers is {self.workers}: use 1 to {_MOST_WORKERS}.")
        if self.in_flight is not None and not 1 <= self.in_flight <= _MOST_IN_FLIGHT:
            raise ConfigError(f"in-flight is {self.in_flight}: use 1 to {_MOST_IN_FLIGHT}.")
        number, count = self.shard
        if not 1 <= number <= count:
            raise ConfigError(f"shard is {number}/{count}: use 1/{count} to {count}/{count}.")


@dataclass(frozen=True, slots=True, eq=False)
class Played:
    """What came of a command."""

    verdict: Verdict
    tally: Tally


def run_study(
    study: Study,
    folder: Path,
    means: Means,
    watch: Callable[[Tally, Supervisor], Watcher],
) -> Played:
    """Play a study, or go on with it, until every episode has a score.

    Args:
        study: What is played.
        folder: Where it is kept; is made if it is missing.
        means: What it is played with.
        watch: Makes what is told of everything that happens.

    Raises:
        ConfigError: A setting is wrong; nothing was started.
        ModelConfigError: A model is unknown or lacks a key or an extra; nothing was started.
        SceneError: A scene is unknown or wrong; nothing was started.
        FolderInUseError: Somebody else plays it now.
        RecordError: The folder holds another study, or is damaged.
        FileError: The folder cannot be written; the same command goes on once it can.
    """
    episodes = plan(study)
    mine = ordered(sharded(episodes, means.shard))
    check_parts(mine, means.budget)
    signer = Signer(means.sign) if means.sign else None
    with ExitStack() as stack:
        store = stack.enter_context(Store(folder, study, episodes, signer))
        tally = Tally(mine, store.outcomes)
        left = [one for one in mine if not store.is_done(one.key)]
        in_flight = means.in_flight or default_in_flight(study.models)
        StudyLedger(folder, means.budget).begin(store.outcomes.values())
        setup = Setup(folder.absolute(), means.frame_cache, means.budget, means.rates)
        executor = _executor(setup, means, in_flight, len(left))
        stack.callback(executor.close)
        supervisor = Supervisor(store, executor, tally)
        watcher = stack.enter_context(closing(watch(tally, supervisor)))
        return Played(supervisor.run(left, watcher), tally)


def _executor(setup: Setup, means: Means, in_flight: int, left: int) -> Executor:
    """What plays the episodes that are left."""
    if means.cluster is not None:
        return RayExecutor(setup, means.cluster, means.workers, in_flight, min(left, _MOST_WORKERS))
    workers = default_workers() if means.workers is None else means.workers
    return LocalExecutor(setup, min(workers, left), in_flight)


def sharded(episodes: Sequence[Planned], shard: tuple[int, int]) -> Sequence[Planned]:
    """The part of a plan that one of several machines plays: every n-th episode."""
    number, count = shard
    return episodes[number - 1 :: count]


def ordered(episodes: Iterable[Planned]) -> list[Planned]:
    """Episodes as they are best played: those that share an engine after one another."""
    return sorted(episodes, key=lambda one: (one.config.scene, one.config.figure, one.variation))


def check_parts(episodes: Iterable[Planned], budget: Budget | None = None) -> None:
    """Make sure that every scene and model is there, before anything is started or paid for.

    Raises:
        SceneError: A scene is unknown or wrong.
        FileError: An own figure cannot be used.
        ModelConfigError: A model is unknown or lacks a key or an extra.
        ModelError: A model has to be asked what it can do, and cannot be reached.
        ConfigError: There is a budget of money, and the price of a model is not known.
    """
    for scene in dict.fromkeys(one.config.scene for one in episodes):
        check_scene(scene)
    for figure in dict.fromkeys(one.config.figure for one in episodes):
        if is_own(figure):
            check_figure(Path(figure))
    models = {(one.config.model, one.config.tool_calls): one.config for one in episodes}
    for config in models.values():
        model = model_of(config.model, tools=config.tool_calls, profile=config.profile)
        check_price(config.model, budget or Budget(), model)
        model.info.close()


def default_in_flight(models: Iterable[str]) -> int:
    """How many episodes a process plays at once, if nobody says."""
    return _REMOTE_IN_FLIGHT if any(map(is_remote, models)) else 1


def default_workers() -> int:
    """How many processes play, if nobody says."""
    return min(4, os.cpu_count() or 1)
