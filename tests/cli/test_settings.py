"""Settings that are written on the command line: how they are read, and what is told of faults."""

from __future__ import annotations

import pytest

from adamo_vh.cli.settings import axes_of, pairs, read_cluster, read_shard, values_of
from adamo_vh.errors import ConfigError
from adamo_vh.study.cluster import Cluster


def test_a_cluster_is_named_for_ray_alone() -> None:
    assert read_cluster("local", "", "") is None
    assert read_cluster("ray", "", "") == Cluster()
    assert read_cluster("ray", "10.0.0.1:6379", "s3://b/x") == Cluster("10.0.0.1:6379", "s3://b/x")


@pytest.mark.parametrize(
    ("given", "said"),
    [
        (("slurm", "", ""), "use local or ray"),
        (("RAY", "", ""), "use local or ray"),
        (("local", "10.0.0.1:6379", ""), "--executor ray"),
        (("local", "", "/shared"), "--executor ray"),
    ],
)
def test_another_executor_is_refused(given: tuple[str, str, str], said: str) -> None:
    with pytest.raises(ConfigError, match=said):
        read_cluster(*given)


def test_shards_pairs_and_values_are_read() -> None:
    assert read_shard(" 2/4 ") == (2, 4)
    assert pairs(["a=1", " b = x=y "], "set") == {"a": "1", "b": "x=y"}
    assert values_of(["k=4", "figure=ken", "limits.max_steps=40"]) == {
        "k": 4, "figure": "ken", "limits.max_steps": 40,
    }  # fmt: skip
    assert axes_of(["k=4,6", "grid=[3, 4]"]) == {"k": [4, 6], "grid": [3, 4]}


@pytest.mark.parametrize("text", ["", "2", "/4", "2/", "a/b", "1/4/2", "-1/4"])
def test_what_is_no_shard_is_told(text: str) -> None:
    with pytest.raises(ConfigError, match="write I/N"):
        read_shard(text)
