"""The executor of many machines: a cluster of two nodes on this one, and a node that is lost."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import pytest
from tests.records import assert_the_same_record
from tests.study.episodes import Heard

from adamo_vh.analysis.outcome import Outcome
from adamo_vh.cognition.budget import Budget
from adamo_vh.errors import BudgetError, ConfigError
from adamo_vh.record.run_folder import RESULT
from adamo_vh.study.cluster import Cluster, Office
from adamo_vh.study.ledger import Amount
from adamo_vh.study.plan import Study, plan
from adamo_vh.study.running import Means, run_study
from adamo_vh.study.store import episode_folder, read_outcomes
from adamo_vh.study.supervisor import Supervisor
from adamo_vh.study.tally import Tally
from adamo_vh.study.verifying import verify_chain, verify_episodes
from adamo_vh.study.worker import Setup

STUDY = Study(
    ("T1", "T8"),
    models=("random",),
    repetitions=3,
    settings={"resolution": "160x90", "grid": 3, "limits": {"max_steps": 6}},
)
EPISODES = plan(STUDY)
MEMORY = 100 * 2**20


@dataclass
class Losing(Heard):
    """Takes a node away as soon as some episodes have ended while others are played."""

    cluster: Any
    node: Any
    after: int = 2
    lost: bool = False
    began_: list[str] = field(default_factory=list)
    ended_: list[tuple[str, str, bool]] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)

    def tick(self) -> None:
        playing = len(self.began_) - len(self.ended_)
        if not self.lost and len(self.ended_) >= self.after and playing:
            self.lost = True
            self.cluster.remove_node(self.node)


@pytest.fixture(scope="module")
def two_nodes() -> Iterator[tuple[Any, Any]]:
    pytest.importorskip("ray")
    import ray
    from ray.cluster_utils import Cluster as Nodes

    nodes = Nodes(
        initialize_head=True, head_node_args={"num_cpus": 1, "object_store_memory": MEMORY}
    )
    second = nodes.add_node(num_cpus=1, object_store_memory=MEMORY)
    nodes.wait_for_nodes()
    yield nodes, second
    ray.shutdown()
    nodes.shutdown()


@pytest.fixture(scope="module")
def near(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The study, played by one process of this machine."""
    folder = tmp_path_factory.mktemp("near") / "study"
    run_study(STUDY, folder, Means(), lambda tally, supervisor: Heard())
    return folder


def timeless(outcome: Outcome) -> Outcome:
    """An outcome without the seconds that it took."""
    return replace(outcome, model_s=0.0, world_s=0.0, waited_s=0.0)


@pytest.mark.extras
@pytest.mark.parametrize("scheme", ["file://", ""])
def test_a_lost_node_costs_nothing_but_what_it_played(
    two_nodes: tuple[Any, Any], near: Path, tmp_path: Path, scheme: str
) -> None:
    nodes, second = two_nodes
    watcher = Losing(nodes, second)
    if not scheme:
        watcher.node = nodes.add_node(num_cpus=1, object_store_memory=MEMORY)
    shared = f"{scheme}{tmp_path / 'shared'}" if scheme else ""

    def watch(tally: Tally, supervisor: Supervisor) -> Losing:
        return watcher

    means = Means(workers=2, cluster=Cluster(nodes.address, shared))
    played = run_study(STUDY, tmp_path / "far", means, watch)
    assert watcher.lost
    assert (played.tally.total.done, played.verdict.problems) == (len(EPISODES), {})
    again = [why for _, why, again in watcher.ended_ if again]
    assert all("in the cluster is gone" in why for why in again)

    far, alone = (read_outcomes(folder)[0] for folder in (tmp_path / "far", near))
    assert [one.state_hash for one in far] == [one.state_hash for one in alone]
    for planned in EPISODES:
        runs = (episode_folder(folder, planned.key) for folder in (tmp_path / "far", near))
        assert_the_same_record(*runs)
    assert verify_chain(tmp_path / "far").problems == ()
    checked = dict(verify_episodes(tmp_path / "far", replayed=False))
    assert [found.problems for found in checked.values()] == [()] * len(EPISODES)
    assert not list(tmp_path.rglob("*.part"))

    # What was played is not played again, and what is gone here is taken from where it is.
    if scheme:
        run = episode_folder(tmp_path / "far", EPISODES[0].key)
        (run / RESULT).unlink()
        (tmp_path / "far" / "index.sqlite").unlink()
        means = Means(workers=1, cluster=Cluster(nodes.address, shared))
        run_study(STUDY, tmp_path / "far", means, lambda tally, supervisor: Heard())
        # An episode that was played twice, once on the lost node, took another time each.
        found = read_outcomes(tmp_path / "far")[0]
        assert [timeless(one) for one in found] == [timeless(one) for one in far]


@pytest.mark.extras
def test_a_cluster_that_is_not_there_is_told(tmp_path: Path) -> None:
    ray = pytest.importorskip("ray")
    ray.shutdown()
    means = Means(cluster=Cluster("127.0.0.1:1"))
    with pytest.raises(ConfigError, match="cannot be reached"):
        run_study(STUDY, tmp_path, means, lambda tally, supervisor: Heard())


def test_the_office_keeps_budget_and_pace_for_all(tmp_path: Path) -> None:
    office = Office(Setup(tmp_path, budget=Budget(calls=1)))
    number, error = office.ask("purse", "reserve", ("x", Amount(1, 10)))
    assert error is None
    assert office.ask("purse", "settle", (number, Amount(1, 7))) == (None, None)
    _, error = office.ask("purse", "reserve", ("y", Amount(1, 10)))
    assert isinstance(error, BudgetError) and "1 of 1 model calls" in str(error)
    ticket, error = office.ask("gate", "acquire", ("somebody", 10))
    assert error is None
    assert office.ask("gate", "settle", (ticket, 12, None)) == (None, None)
