"""The seal of a run: whatever is changed in its folder afterwards is told by name."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from tests.run_folder import played

from adamo_vh.episode.result import read_result
from adamo_vh.episode.sealing import read_plain, sealed_digest
from adamo_vh.errors import RecordError
from adamo_vh.record.digest import differences
from adamo_vh.record.trajectory import read_trajectory


def _told(folder: Path) -> list[str]:
    result = read_result(folder)
    assert result is not None and result.seal is not None
    return list(differences(folder, read_trajectory(folder), read_plain(folder), result.seal))


def _edited(path: Path, change: Callable[[Any], None]) -> None:
    told = json.loads(path.read_text())
    change(told)
    path.write_text(json.dumps(told, indent=4))


def _frame(folder: Path) -> Path:
    return sorted((folder / "frames").iterdir())[0]


def test_a_run_is_sealed_and_layout_of_the_json_is_no_difference(tmp_path: Path) -> None:
    played(tmp_path)
    assert _told(tmp_path) == []
    assert len(sealed_digest(tmp_path)) == 64
    _edited(tmp_path / "result.json", lambda told: None)
    assert _told(tmp_path) == []


HARM: dict[str, tuple[Callable[[Path], object], list[str]]] = {
    "manifest": (
        lambda f: _edited(f / "manifest.json", lambda told: told.update(model_name="other")),
        ["manifest.json was changed after the result was written"],
    ),
    "events": (
        lambda f: (f / "events.jsonl").write_text(
            (f / "events.jsonl").read_text().replace("I pick it", "I take it")
        ),
        ["events.jsonl was changed after the result was written"],
    ),
    "score": (
        lambda f: _edited(f / "result.json", lambda told: told["score"].update(completion=0.9)),
        ["result.json was changed after it was written"],
    ),
    "counts": (
        lambda f: _edited(f / "result.json", lambda told: told.update(model_calls=1)),
        ["result.json was changed after it was written"],
    ),
    "seal": (
        lambda f: _edited(f / "result.json", lambda told: told["seal"].update(digest="0" * 64)),
        ["result.json: the digest of the whole is not that of its parts"],
    ),
    "scene": (
        lambda f: (f / "scene.toml").write_text("name = 's1'"),
        ["scene.toml was added after the result was written"],
    ),
}


@pytest.mark.parametrize("name", HARM)
def test_what_was_changed_is_told(tmp_path: Path, name: str) -> None:
    played(tmp_path)
    harm, said = HARM[name]
    harm(tmp_path)
    assert _told(tmp_path) == said


def test_a_picture_that_is_missing_or_another_is_named(tmp_path: Path) -> None:
    played(tmp_path)
    path = _frame(tmp_path)
    data = path.read_bytes()
    path.write_bytes(data + b"x")
    name = f"frames/{path.name}"
    assert _told(tmp_path) == [f"{name} is another picture than the one that was recorded"]
    path.unlink()
    assert _told(tmp_path) == [f"{name} is missing"]
    path.write_bytes(data)
    (path.parent / "of-a-step-that-was-killed.jpg").write_bytes(b"")
    assert _told(tmp_path) == []


def test_no_picture_outside_the_folder_is_read(tmp_path: Path) -> None:
    played(tmp_path)
    path = tmp_path / "events.jsonl"
    path.write_text(path.read_text().replace(_frame(tmp_path).name, "../../secret.jpg"))
    with pytest.raises(RecordError, match="outside"):
        _told(tmp_path)
