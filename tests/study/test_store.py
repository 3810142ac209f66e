"""The store: run folders are the truth, the index follows, and nothing finished is lost."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest
from tests.study.episodes import record, small_study

from adamo_vh.errors import FileError, FolderInUseError, RecordError
from adamo_vh.record.run_folder import RESULT
from adamo_vh.study.index import INDEX, Index
from adamo_vh.study.plan import Study, plan
from adamo_vh.study.store import STUDY, Store, episode_folder, read_outcomes, read_planned, reindex

STUDY_ = small_study()
EPISODES = plan(STUDY_)


def _opened(folder: Path, study: Study = STUDY_) -> Store:
    return Store(folder, study, plan(study))


def _filled(folder: Path, count: int = 6) -> None:
    with _opened(folder) as store:
        for planned in EPISODES[:count]:
            store.add(record(folder, planned))


def test_a_plan_is_read_back_as_it_was_written(tmp_path: Path) -> None:
    study = small_study(axes={"k": (4, 50)}, settings={"resolution": "640x360"}, name="mine")
    _opened(tmp_path, study).close()
    assert read_planned(tmp_path) == (study, plan(study))


def test_an_episode_that_was_finished_before_the_index_knew_is_not_lost(tmp_path: Path) -> None:
    _filled(tmp_path, 2)
    record(tmp_path, EPISODES[2])  # Then everything was killed.
    assert [one.key for one in read_outcomes(tmp_path)[0]] == [one.key for one in EPISODES[:3]]
    with _opened(tmp_path) as store:
        assert list(store.outcomes) == [one.key for one in EPISODES[:3]]


def test_an_episode_that_somebody_deleted_is_played_again(tmp_path: Path) -> None:
    _filled(tmp_path, 2)
    (episode_folder(tmp_path, EPISODES[0].key) / RESULT).unlink()
    with _opened(tmp_path) as store:
        assert list(store.outcomes) == [EPISODES[1].key]
    assert list(Index(tmp_path).read()) == [EPISODES[1].key]


def test_the_index_is_made_again_from_the_run_folders(tmp_path: Path) -> None:
    _filled(tmp_path)
    before = read_outcomes(tmp_path)
    (tmp_path / INDEX).unlink()
    assert reindex(tmp_path) == (6, {})
    assert read_outcomes(tmp_path) == before


@pytest.mark.parametrize("harm", [b"", b"x" * 5000, b"SQLite format 3\0" + b"\xff" * 5000])
def test_a_damaged_index_is_told_and_made_again(tmp_path: Path, harm: bytes) -> None:
    _filled(tmp_path)
    before = read_outcomes(tmp_path)
    (tmp_path / INDEX).write_bytes(harm)
    for read in (lambda: read_outcomes(tmp_path), lambda: _opened(tmp_path)):
        with pytest.raises(RecordError, match=f"adamo-vh reindex {tmp_path}"):
            read()
    assert reindex(tmp_path) == (6, {})
    assert read_outcomes(tmp_path) == before


def test_a_damaged_row_is_told(tmp_path: Path) -> None:
    import sqlite3

    _filled(tmp_path)
    with sqlite3.connect(tmp_path / INDEX) as database:
        database.execute("UPDATE outcomes SET outcome = '{}'")
    database.close()
    with pytest.raises(RecordError, match="reindex"):
        read_outcomes(tmp_path)


@pytest.mark.parametrize("harm", ["{", "[]", "{}", '{"format": 1}', '{"format": 99}', "nan"])
def test_a_damaged_plan_is_told_and_costs_no_episode(tmp_path: Path, harm: str) -> None:
    _filled(tmp_path)
    before = read_outcomes(tmp_path)
    (tmp_path / STUDY).write_text(harm)
    for read in (lambda: read_outcomes(tmp_path), lambda: _opened(tmp_path)):
        with pytest.raises(RecordError) as caught:
            read()
        assert "\n" not in str(caught.value)
    (tmp_path / STUDY).unlink()
    _opened(tmp_path).close()
    assert read_outcomes(tmp_path) == before


def test_a_damaged_result_is_told_and_the_others_are_read(tmp_path: Path) -> None:
    _filled(tmp_path)
    path = episode_folder(tmp_path, EPISODES[3].key) / RESULT
    path.write_text("{")
    count, damaged = reindex(tmp_path)
    assert count == 5
    assert list(damaged) == [EPISODES[3].key]
    assert str(path) in damaged[EPISODES[3].key]


def test_two_cannot_play_one_study(tmp_path: Path) -> None:
    with _opened(tmp_path):
        code = (
            "import sys; from pathlib import Path; from tests.study.test_store import _opened\n"
            "_opened(Path(sys.argv[1]))"
        )
        run = subprocess.run(
            [sys.executable, "-c", code, str(tmp_path)], capture_output=True, text=True, check=False
        )
    assert "FolderInUseError" in run.stderr
    assert f"process {os.getpid()}" in run.stderr


def test_reindex_leaves_a_study_alone_that_is_being_played(tmp_path: Path) -> None:
    with _opened(tmp_path), pytest.raises(FolderInUseError):
        reindex(tmp_path)


def test_another_study_is_refused_and_says_in_what_it_differs(tmp_path: Path) -> None:
    _opened(tmp_path).close()
    with pytest.raises(RecordError, match=r"labelings sem, not opaq"):
        _opened(tmp_path, small_study(labelings=("opaq",)))
    with pytest.raises(RecordError, match=r"repetitions 3, not 2"):
        _opened(tmp_path, small_study(repetitions=2))


def test_a_study_may_grow(tmp_path: Path) -> None:
    _filled(tmp_path)
    larger = small_study(repetitions=4, labelings=("sem", "opaq"))
    with _opened(tmp_path, larger) as store:
        assert len(store.outcomes) == 6
    assert len(read_planned(tmp_path)[1]) == 16


def test_a_folder_that_cannot_be_written_is_told(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    with pytest.raises(FileError, match="another folder"):
        _opened(tmp_path / "file")


def test_what_is_no_study_is_told(tmp_path: Path) -> None:
    with pytest.raises(RecordError, match="is no study"):
        read_outcomes(tmp_path)


def test_the_plan_is_plain_json(tmp_path: Path) -> None:
    _opened(tmp_path).close()
    told = json.loads((tmp_path / STUDY).read_text())
    assert told["episodes"] == [one.key for one in EPISODES]
    assert told["study"]["models"] == ["random"]


def test_a_switch_that_is_varied_is_told_by_its_axis_alone(tmp_path: Path) -> None:
    study = Study(("T1",), models=("random",), settings={"switches": {"terse": "on"}},
                  axes={"switches.buffer_unit": ("step", "block")})  # fmt: skip
    episodes = plan(study)
    outcomes = [record(tmp_path, one) for one in episodes]
    assert [one.profile for one in outcomes] == ["paper (terse=on)"] * 2
    assert [one.axes for one in outcomes] == [
        {"switches.buffer_unit": "step"},
        {"switches.buffer_unit": "block"},
    ]
