"""The failures that were labelled by hand: the file, and that one of them plays again as it was."""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path

import pytest
from benchmarks.labelled import (
    LABELLED,
    Labelled,
    difference,
    end_of,
    read_labelled,
    write_labelled,
)

from adamo_vh.benchmark.tasks import task
from adamo_vh.episode.config import EpisodeConfig
from adamo_vh.inference.players.scripted import read_script
from adamo_vh.session.lending import LentWorld

EPISODES = read_labelled()


def test_there_are_enough_of_them_and_no_two_are_one() -> None:
    assert len({episode.name for episode in EPISODES}) == len(EPISODES) >= 60
    assert len({(e.scene, e.variation, e.task, e.end, str(e.replies)) for e in EPISODES}) >= 60


def test_the_file_is_small_and_written_as_it_is_read(tmp_path: Path) -> None:
    write_labelled(EPISODES, tmp_path / "again.jsonl")
    assert (tmp_path / "again.jsonl").read_bytes() == LABELLED.read_bytes()
    assert LABELLED.stat().st_size < 600_000


@pytest.mark.parametrize("episode", EPISODES, ids=lambda episode: episode.name)
def test_each_is_a_failure_with_a_label_and_calls_that_can_be_given(episode: Labelled) -> None:
    assert episode.label.meaning
    assert re.fullmatch(r"[A-Z].{20,}\.", episode.reason)
    assert read_script(episode.replies, episode.name)
    settings = {k: v for k, v in episode.settings.items() if k != "max_steps"}
    config = EpisodeConfig.of(
        task=episode.task, scene=episode.scene, variation=episode.variation, **settings
    )
    assert config.scored_task == task(episode.task)
    assert len(episode.end.met) >= 1
    assert re.fullmatch(r"[0-9a-f]{64}", episode.end.state)


def test_one_plays_again_to_the_end_that_was_read(lent: LentWorld, tmp_path: Path) -> None:
    episode = min(
        (e for e in EPISODES if (e.scene, e.variation) == ("s1", 0) and any(e.end.met)),
        key=lambda e: len(e.replies),
    )
    result = episode.again(lent, tmp_path)
    assert difference(episode.end, end_of(episode, result, tmp_path / episode.name)) == ""


def test_what_is_no_longer_the_same_is_told() -> None:
    end = next(e.end for e in EPISODES if len(e.end.feedback) > 2)
    assert difference(end, end) == ""
    other = ("else", *end.feedback[1:])
    assert difference(end, replace(end, feedback=other)).startswith("call 1 came to else, not ")
    assert "calls, not" in difference(end, replace(end, feedback=end.feedback[:-1]))
    assert "hold at the end" in difference(end, replace(end, met=tuple(not m for m in end.met)))
    assert "was in view, not" in difference(end, replace(end, seen=(99,)))
    assert difference(end, replace(end, state="0")) == "the last state is another one"
