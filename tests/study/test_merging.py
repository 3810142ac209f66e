"""Parts of a study put together, and old records scored again."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from tests.study.episodes import record, small_study

from adamo_vh.errors import ConfigError, FolderInUseError, RecordError
from adamo_vh.record.run_folder import RESULT
from adamo_vh.record.termination import TerminationReason
from adamo_vh.study.merging import merge
from adamo_vh.study.plan import Planned, plan
from adamo_vh.study.rescoring import score_again
from adamo_vh.study.running import sharded
from adamo_vh.study.store import Store, episode_folder, read_outcomes

STUDY = small_study()
EPISODES = plan(STUDY)


def _part(folder: Path, episodes: tuple[Planned, ...] | list[Planned]) -> Path:
    with Store(folder, STUDY, EPISODES) as store:
        for planned in episodes:
            store.add(record(folder, planned))
    return folder


def _shards(folder: Path) -> list[Path]:
    return [
        _part(folder / str(number), list(sharded(EPISODES, (number, 3)))) for number in (1, 2, 3)
    ]


def test_shards_put_together_are_the_whole_study(tmp_path: Path) -> None:
    assert merge(tmp_path / "all", _shards(tmp_path)) == (6, 6)
    outcomes, damaged = read_outcomes(tmp_path / "all")
    assert ([one.key for one in outcomes], damaged) == ([one.key for one in EPISODES], {})
    assert not list((tmp_path / "all").rglob("*.part"))


def test_a_merge_that_was_interrupted_is_given_again(tmp_path: Path) -> None:
    parts = _shards(tmp_path)
    assert merge(tmp_path / "all", parts[:1]) == (2, 2)
    assert merge(tmp_path / "all", parts) == (4, 6)
    assert merge(tmp_path / "all", parts) == (0, 6)


def test_a_score_takes_the_place_of_none(tmp_path: Path) -> None:
    broken = tmp_path / "broken"
    with Store(broken, STUDY, EPISODES) as store:
        store.add(record(broken, EPISODES[0], TerminationReason.BROKEN))
    whole = _part(tmp_path / "whole", EPISODES[:1])
    assert merge(tmp_path / "a", [broken, whole]) == (2, 1)
    assert merge(tmp_path / "b", [whole, broken]) == (1, 1)


def test_different_ends_of_one_episode_are_told(tmp_path: Path) -> None:
    first, second = _part(tmp_path / "1", EPISODES[:1]), _part(tmp_path / "2", EPISODES[:1])
    path = episode_folder(second, EPISODES[0].key) / RESULT
    told = json.loads(path.read_text())
    path.write_text(json.dumps({**told, "state_hash": "f" * 64}))
    (second / "index.sqlite").unlink()
    with pytest.raises(RecordError, match="different ends"):
        merge(tmp_path / "all", [first, second])


def test_parts_of_different_studies_are_refused(tmp_path: Path) -> None:
    other = small_study(labelings=("opaq",))
    Store(tmp_path / "other", other, plan(other)).close()
    with pytest.raises(RecordError, match="another study"):
        merge(tmp_path / "all", [_part(tmp_path / "1", EPISODES[:1]), tmp_path / "other"])
    with pytest.raises(ConfigError, match="another folder"):
        merge(tmp_path / "1", [tmp_path / "1"])


def test_a_part_that_is_being_played_is_left_alone(tmp_path: Path) -> None:
    part = _part(tmp_path / "1", EPISODES[:1])
    with Store(part, STUDY, EPISODES), pytest.raises(FolderInUseError):
        merge(tmp_path / "all", [part])


def _tampered(folder: Path) -> Path:
    """A study one of whose episodes was scored by other checkers."""
    _part(folder, EPISODES[:2])
    path = episode_folder(folder, EPISODES[1].key) / RESULT
    told = json.loads(path.read_text())
    told["score"] |= {"completion": 1.0, "strict": 1.0}
    told["score"]["conditions"] = [{**c, "satisfied": True} for c in told["score"]["conditions"]]
    path.write_text(json.dumps(told))
    return folder


def test_scoring_again_says_what_changed_and_leaves_it(tmp_path: Path) -> None:
    folder = _tampered(tmp_path)
    same, changed = score_again(folder)
    assert (same.changed, same.problem) == ((), "")
    assert changed.episode == EPISODES[1].key
    assert changed.changed[0] == "completion 1.00, now 0.00"
    assert any("does not hold now" in text for text in changed.changed)
    assert score_again(folder) == (same, changed)


def test_new_scores_are_kept_when_that_is_asked_for(tmp_path: Path) -> None:
    folder = _tampered(tmp_path)
    score_again(folder, write=True)
    assert [one.changed for one in score_again(folder)] == [(), ()]
    assert [one.completion for one in read_outcomes(folder)[0]] == [0.0, 0.0]


def test_one_episode_can_be_scored_alone_and_damage_is_told(tmp_path: Path) -> None:
    folder = _tampered(tmp_path)
    run = episode_folder(folder, EPISODES[1].key)
    (one,) = score_again(run)
    assert one.changed
    (run / RESULT).write_text("{")
    _, damaged = score_again(folder)
    assert "result.json" in damaged.problem
    with pytest.raises(RecordError, match="neither a run folder"):
        score_again(tmp_path / "nowhere")
