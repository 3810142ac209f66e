"""Records of format 1 open as before: to be shown, scored and replayed, not continued."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

import adamo_vh
from adamo_vh.episode.result import read_manifest, read_result
from adamo_vh.errors import RecordError
from adamo_vh.inference.model import Ending
from adamo_vh.record.trajectory import LeftOut, read_trajectory
from adamo_vh.report.page import write_page
from adamo_vh.session.session import Session

OLD = Path(__file__).parents[1] / "data" / "format_1"


@pytest.fixture
def old(tmp_path: Path) -> Path:
    """T4 under the paper's profile, as the version before wrote it; its frames are lost."""
    return Path(shutil.copytree(OLD / "s1-sem-paper-T4", tmp_path / "old"))


def test_an_old_record_reads_as_one_of_today(old: Path) -> None:
    manifest, recorded, result = read_manifest(old), read_trajectory(old), read_result(old)
    assert (manifest.format, manifest.config.task, manifest.config.variation) == (1, "T4", 0)
    assert result is not None
    assert result.score is not None
    assert (result.completion, result.strict, result.violations) == (1.0, 1.0, ())
    thoughts = recorded.thoughts
    assert [t.reply.ending for t in thoughts] == [Ending.CALL, Ending.CALL, Ending.ANSWER]
    assert thoughts[0].turn.note
    calls = [wish.call.id for thought in thoughts for wish in thought.turn.wishes]
    assert [act.call_id for act in recorded.acts] == calls
    assert not [e for e in recorded.events if isinstance(e, LeftOut)]


def test_an_old_record_has_its_page(old: Path) -> None:
    page = write_page(old).read_text(encoding="utf-8")
    assert "Pick the plate and place it on the floor" in page


def test_an_old_record_is_replayed_from_its_saved_state(old: Path) -> None:
    before = {path.name: path.read_bytes() for path in old.iterdir()}
    report = adamo_vh.replay_episode(old)
    assert (report.steps, report.mismatches) == (2, ())
    assert {path.name: path.read_bytes() for path in old.iterdir()} == before


@pytest.mark.parametrize("attempt", [Session.resume, adamo_vh.resume_episode])
def test_an_old_record_is_not_continued(attempt, tmp_path: Path) -> None:
    folder = Path(shutil.copytree(OLD / "chat", tmp_path / "chat"))
    before = (folder / "events.jsonl").read_bytes()
    with pytest.raises(RecordError, match=r"older version|is a conversation"):
        attempt(folder)
    assert (folder / "events.jsonl").read_bytes() == before
