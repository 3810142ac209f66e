"""A study from Python: the part of a shard, the order, and what is checked before the start."""

from __future__ import annotations

from pathlib import Path

import pytest

from adamo_vh.errors import ConfigError, ModelConfigError, SceneError
from adamo_vh.study.plan import Study, plan
from adamo_vh.study.running import (
    Means,
    check_parts,
    default_in_flight,
    default_workers,
    ordered,
    sharded,
)

EPISODES = plan(Study(("T1", "T2"), scenes=("s2", "s1"), models=("random",), repetitions=5))


@pytest.mark.parametrize("count", [1, 2, 3, 7, 20, 30])
def test_shards_are_a_partition_of_the_plan(count: int) -> None:
    parts = [sharded(EPISODES, (number, count)) for number in range(1, count + 1)]
    keys = [one.key for part in parts for one in part]
    assert sorted(keys) == sorted(one.key for one in EPISODES)
    assert max(map(len, parts)) - min(map(len, parts)) <= 1


def test_episodes_that_share_an_engine_are_played_after_one_another() -> None:
    scenes = [one.config.scene for one in ordered(EPISODES)]
    assert scenes == sorted(scenes)
    assert ordered(EPISODES) == ordered(reversed(EPISODES[::-1]))


@pytest.mark.parametrize(
    "means",
    [
        {"workers": 0},
        {"workers": 10_000},
        {"in_flight": 0},
        {"in_flight": -1},
        {"shard": (0, 1)},
        {"shard": (2, 1)},
    ],
)
def test_means_that_make_no_sense_are_refused(means: dict) -> None:
    with pytest.raises(ConfigError, match="use 1"):
        Means(**means)


def test_what_waits_for_a_provider_is_played_beside_others() -> None:
    assert default_in_flight(("baseline", "random")) == 1
    assert default_in_flight(("baseline", "openai:gpt-4o")) == 16
    assert default_workers() >= 1


def test_what_is_missing_is_told_before_anything_starts(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.delenv("ADAMO_VH_NO_REMOTE", raising=False)
    monkeypatch.delenv("OPENAI_API_KEY", raising=False)
    with pytest.raises(SceneError, match="no scene"):
        check_parts(plan(Study(("T1",), scenes=("nowhere",))))
    with pytest.raises(ModelConfigError, match="OPENAI_API_KEY"):
        check_parts(plan(Study(("T1",), models=("openai:gpt-4o",))))
    check_parts(plan(Study(("T1",), models=("baseline", "random"))))
