"""Whole episodes: recorded as they happen, replayed to the same hashes, scored from records."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import time
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from tests.spread import spread

import adamo_vh
from adamo_vh.episode.result import read_manifest, read_result, summarise
from adamo_vh.errors import ConfigError, RecordError
from adamo_vh.inference.model import ModelKind
from adamo_vh.record.run_folder import EVENTS, FRAMES
from adamo_vh.record.termination import Limits, TerminationReason
from adamo_vh.record.trajectory import Observed, read_trajectory
from adamo_vh.runtime.builtin import BuiltinEngine

SMALL = (320, 180)
PLATE_TO_FLOOR = [
    {"note": "Look for open floor.", "tool": "Look", "args": {"x": -1.5, "y": -2.5, "z": 0}},
    {"note": "Take the plate.", "tool": "Pick", "args": {"object": "Plate_57"}},
    {
        "note": "Put it there.",
        "tool": "Drop",
        "args": {"object": "Plate_57", "x": -1.5, "y": -2.5, "z": 0},
    },
]


@pytest.fixture
def script(tmp_path: Path) -> Path:
    path = tmp_path / "script.json"
    path.write_text(json.dumps(PLATE_TO_FLOOR))
    return path


def recorded(script: Path, folder: Path, engine: BuiltinEngine) -> adamo_vh.EpisodeResult:
    return adamo_vh.run_episode(
        task="T4",
        model=f"scripted:{script}",
        resolution=SMALL,
        out=folder,
        engine=engine,
    )


def test_a_scripted_episode_is_scored_and_recorded(
    script: Path, tmp_path: Path, engine: BuiltinEngine
) -> None:
    result = recorded(script, tmp_path / "run", engine)
    assert (result.completion, result.strict) == (1.0, 1.0)
    assert result.termination is TerminationReason.ANSWERED
    assert result.model_kind is ModelKind.SCRIPTED
    assert result.calls == {"Drop": 1, "Look": 1, "Pick": 1}
    assert (result.steps, result.model_calls, result.missing_notes) == (3, 4, 0)
    assert 4.0 < result.direct_m <= result.walked_m < 6.0
    folder = tmp_path / "run"
    manifest, trajectory = read_manifest(folder), read_trajectory(folder)
    assert manifest.config.task == "T4"
    assert set(manifest.versions) >= {"adamo-vh", "python", "mujoco"}
    assert {e.frame for e in trajectory.events if isinstance(e, Observed)} == {
        path.name for path in (folder / FRAMES).iterdir()
    }
    page = (folder / "episode.html").read_text(encoding="utf-8")
    assert "Pick the plate and place it on the floor" in page


def test_an_episode_can_be_scored_again_from_its_records(
    script: Path, tmp_path: Path, engine: BuiltinEngine
) -> None:
    folder = tmp_path / "run"
    result = recorded(script, folder, engine)
    kept = read_result(folder)
    assert kept == result
    again = summarise(read_manifest(folder), read_trajectory(folder), kept.final, folder)
    assert replace(again, seal=kept.seal) == result


def test_a_replay_reproduces_every_hash_and_frame(
    script: Path, tmp_path: Path, engine: BuiltinEngine
) -> None:
    recorded(script, tmp_path / "run", engine)
    report = adamo_vh.replay_episode(tmp_path / "run")
    assert (report.steps, report.mismatches, report.frames_differ) == (3, (), 0)


def test_a_replay_notices_a_changed_record(
    script: Path, tmp_path: Path, engine: BuiltinEngine
) -> None:
    recorded(script, tmp_path / "run", engine)
    path = tmp_path / "run" / EVENTS
    text = path.read_text()
    assert '"x":-1.5,"y":-2.5' in text
    path.write_text(text.replace('"x":-1.5,"y":-2.5', '"x":-1.7,"y":-2.5'))
    report = adamo_vh.replay_episode(tmp_path / "run")
    assert any("step 3: Drop" in line for line in report.mismatches)


def test_a_recorded_run_can_be_the_model(
    script: Path, tmp_path: Path, engine: BuiltinEngine
) -> None:
    first = recorded(script, tmp_path / "run", engine)
    model = f"replay:{tmp_path / 'run'}"
    second = adamo_vh.run_episode(task="T4", model=model, resolution=SMALL, engine=engine)
    assert second.model_kind is ModelKind.REPLAY
    assert second.state_hash == first.state_hash


def test_the_same_seed_twice_is_the_same_episode(script: Path, engine: BuiltinEngine) -> None:
    results = [
        adamo_vh.run_episode(
            task="T4", model=f"scripted:{script}", seed=7, resolution=SMALL, engine=engine
        )
        for _ in range(2)
    ]
    assert results[0].state_hash == results[1].state_hash
    assert results[0].final == results[1].final


def test_a_folder_is_never_overwritten(script: Path, tmp_path: Path, engine: BuiltinEngine) -> None:
    recorded(script, tmp_path / "run", engine)
    with pytest.raises(RecordError, match="already holds an episode"):
        recorded(script, tmp_path / "run", engine)


def test_an_instruction_without_a_task_is_not_scored(engine: BuiltinEngine) -> None:
    result = adamo_vh.run_episode(
        "Look around", resolution=SMALL, engine=engine, limits=Limits(max_steps=1)
    )
    assert result.completion is None
    assert result.strict is None


@pytest.mark.parametrize(
    ("settings", "part"),
    [
        ({}, "Say what to do"),
        ({"task": "T4", "instruction": "and this"}, "not both"),
        ({"task": "T99"}, "Tasks: T1"),
        ({"instruction": "  "}, "empty"),
        ({"task": "T1", "labeling": "french"}, "Use one of sem, opaq"),
        ({"task": "T1", "resolution": (10, 10)}, "64x64"),
        ({"task": "T1", "grid": 99}, "0 to 20"),
        ({"task": "T1", "k": 0}, "at least 1"),
        ({"task": "T1", "text_form": "long"}, "full"),
    ],
)
def test_wrong_settings_start_nothing(settings: dict[str, Any], part: str) -> None:
    with pytest.raises(ConfigError) as caught:
        adamo_vh.run_episode(**settings)
    assert part in str(caught.value)


def test_a_kill_loses_only_the_step_in_flight(tmp_path: Path, engine: BuiltinEngine) -> None:
    """kill -9 in the middle: what was recorded reads back and replays to the same hashes."""
    steps = [{"tool": "Look", "args": {"x": 0.1 * (i % 9), "y": -1.0, "z": 0.8}} for i in range(12)]
    script = tmp_path / "long.json"
    script.write_text(json.dumps(steps))
    folder = tmp_path / "run"
    arguments = ["run", "Look around", "--model", f"scripted:{script}", "--out", str(folder)]
    process = subprocess.Popen(
        [sys.executable, "-m", "adamo_vh", *arguments, "--resolution", "160x90"],
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
    )
    events = folder / EVENTS
    deadline = time.monotonic() + 120
    while time.monotonic() < deadline:
        if events.exists() and events.read_bytes().count(b'"type":"acted"') >= 4:
            break
        time.sleep(0.02)
    os.kill(process.pid, signal.SIGKILL)
    process.wait()
    assert len(read_trajectory(folder).acts) >= 4
    assert read_result(folder) is None
    assert adamo_vh.replay_episode(folder, engine=engine).mismatches == ()
    resumed = adamo_vh.resume_episode(folder, engine=engine)
    assert resumed.steps == 12
    straight = adamo_vh.run_episode(
        "Look around", model=f"scripted:{script}", resolution=(160, 90), engine=engine
    )
    assert resumed.state_hash == straight.state_hash
    assert [act.step for act in read_trajectory(folder).acts] == list(range(1, 13))
    assert adamo_vh.replay_episode(folder).mismatches == ()
    with pytest.raises(RecordError, match="has ended"):
        adamo_vh.resume_episode(folder)


@pytest.mark.parametrize("kept_lines", spread(range(1, 11), 3))
def test_an_episode_resumes_from_any_moment(
    kept_lines: int, script: Path, tmp_path: Path, engine: BuiltinEngine
) -> None:
    """Cut the record after any line, even in the middle of the next: the end is the same."""
    folder = tmp_path / "run"
    whole = recorded(script, folder, engine)
    path = folder / EVENTS
    lines = path.read_bytes().splitlines(keepends=True)
    path.write_bytes(b"".join(lines[:kept_lines]) + lines[kept_lines][:20])
    (folder / "result.json").unlink()
    again = adamo_vh.resume_episode(folder, engine=engine)
    assert again.state_hash == whole.state_hash
    assert (again.completion, again.steps, again.calls) == (1.0, whole.steps, whole.calls)
    types = [json.loads(line)["type"] for line in path.read_bytes().splitlines()]
    assert types == [json.loads(line)["type"] for line in lines]
    assert adamo_vh.replay_episode(folder).mismatches == ()


@pytest.mark.parametrize("start", [0, 1, 2, 3])
def test_a_replay_can_start_at_any_step(
    start: int, script: Path, tmp_path: Path, engine: BuiltinEngine
) -> None:
    recorded(script, tmp_path / "run", engine)
    report = adamo_vh.replay_episode(tmp_path / "run", start)
    assert (report.steps, report.mismatches, report.frames_differ) == (3 - start, (), 0)
    with pytest.raises(RecordError, match="steps 0 to 3"):
        adamo_vh.replay_episode(tmp_path / "run", 4)


def test_damaged_records_are_named(script: Path, tmp_path: Path, engine: BuiltinEngine) -> None:
    with pytest.raises(RecordError, match="is no run folder"):
        read_manifest(tmp_path)
    folder = tmp_path / "run"
    recorded(script, folder, engine)
    lines = (folder / EVENTS).read_text().splitlines()
    (folder / EVENTS).write_text("\n".join([*lines[:2], "{broken", *lines[2:]]) + "\n")
    with pytest.raises(RecordError, match="line 3 is damaged"):
        read_trajectory(folder)
    (folder / "manifest.json").write_text("{}")
    with pytest.raises(RecordError, match="written by another version"):
        read_manifest(folder)
