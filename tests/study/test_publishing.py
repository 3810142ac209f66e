"""Episodes are published whole or not at all, and collected as they were."""

from __future__ import annotations

import zipfile
from pathlib import Path

import pytest
from tests.records import assert_the_same_record
from tests.study.episodes import record, small_study

from adamo_vh.errors import ConfigError, FileError
from adamo_vh.record.run_folder import LOCK
from adamo_vh.record.termination import TerminationReason
from adamo_vh.study.plan import plan
from adamo_vh.study.publishing import check_place, collect, forget, publish
from adamo_vh.study.store import EPISODES, episode_folder

PLANNED = plan(small_study())[0]
KEY = PLANNED.key


def _played(folder: Path, reason: TerminationReason = TerminationReason.ANSWERED) -> Path:
    record(folder, PLANNED, reason)
    run = episode_folder(folder, KEY)
    (run / LOCK).write_text("")
    return run


@pytest.mark.parametrize("scheme", ["", "file://"])
def test_what_is_published_is_collected_as_it_was(tmp_path: Path, scheme: str) -> None:
    if scheme:
        pytest.importorskip("fsspec")
    place = f"{scheme}{tmp_path / 'shared'}"
    check_place(place)
    there = tmp_path / "study" / EPISODES / KEY
    assert not collect(place, KEY, there)
    run = _played(tmp_path / "node")
    publish(run, place, KEY)
    assert collect(place, KEY, there)
    assert_the_same_record(run, there)
    assert not (there / LOCK).exists()
    again = _played(tmp_path / "other", TerminationReason.STEP_LIMIT)
    publish(again, place, KEY)
    assert collect(place, KEY, there)
    assert_the_same_record(again, there)
    assert not list(tmp_path.rglob("*.part"))
    forget(run)
    assert not run.exists()


def test_a_place_that_is_the_study_itself_is_left_alone(tmp_path: Path) -> None:
    run = _played(tmp_path)
    before = {path: path.stat().st_mtime_ns for path in run.rglob("*")}
    assert collect(str(tmp_path), KEY, run)
    assert before == {path: path.stat().st_mtime_ns for path in run.rglob("*")}


def test_a_place_that_cannot_be_used_is_told(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    run = _played(tmp_path / "node")
    with pytest.raises(FileError, match="another folder"):
        publish(run, str(tmp_path / "file"), KEY)
    pytest.importorskip("fsspec")
    with pytest.raises(ConfigError, match="nowhere://x cannot be used"):
        check_place("nowhere://x")
    with pytest.raises(FileError, match="the same command goes on"):
        publish(run, f"file://{tmp_path / 'file'}", KEY)
    archive = tmp_path / "shared" / EPISODES / f"{KEY}.zip"
    archive.parent.mkdir(parents=True)
    archive.write_bytes(b"no archive")
    with pytest.raises(FileError, match="damaged"):
        collect(f"file://{tmp_path / 'shared'}", KEY, tmp_path / "there")
    assert not (tmp_path / "there").exists()


def test_no_name_in_an_archive_leads_out_of_the_run(tmp_path: Path) -> None:
    pytest.importorskip("fsspec")
    archive = tmp_path / "shared" / EPISODES / f"{KEY}.zip"
    archive.parent.mkdir(parents=True)
    with zipfile.ZipFile(archive, "w") as made:
        made.writestr("../../outside", "x")
    assert collect(f"file://{tmp_path / 'shared'}", KEY, tmp_path / "there" / "run")
    assert [path for path in tmp_path.rglob("outside") if path.parent.name != "run"] == []
