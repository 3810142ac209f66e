"""The command line: what it prints, as text and as JSON, and how it fails."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest
from tests.cli.process import adamo

SCRIPT = [
    {"note": "Take it.", "tool": "Pick", "args": {"object": "34"}},
]


@pytest.fixture
def script(tmp_path: Path) -> str:
    path = tmp_path / "script.json"
    path.write_text(json.dumps(SCRIPT))
    return f"scripted:{path}"


def run_json(*arguments: str, cwd: Path) -> dict[str, Any]:
    done = adamo(*arguments, "--json", cwd=cwd)
    assert done.code == 0, done.err
    found: dict[str, Any] = json.loads(done.out)
    return found


def test_run_prints_one_json_object(script: str, tmp_path: Path) -> None:
    found = run_json("run", "--task", "T1", "--model", script, cwd=tmp_path)
    assert found["task"] == "T1"
    assert (found["completion"], found["strict"]) == (1.0, 1.0)
    assert found["termination"] == "answered"
    assert found["calls"] == {"Pick": 1}
    assert found["steps"] == 1
    assert {"answer", "tokens", "model_s", "world_s", "run", "state_hash"} <= set(found)
    assert len(found["world"]) == 19
    key = next(item for item in found["world"] if item["id"] == 34)
    assert set(key) == {"id", "tag", "class", "position", "support", "held"}
    assert key["held"] is True
    assert key["support"] is None
    plate = next(item for item in found["world"] if item["id"] == 57)
    assert (plate["tag"], plate["class"], plate["support"]) == ("Plate_57", "Plate", "table")
    assert len(plate["position"]) == 3
    assert (tmp_path / found["run"] / "episode.html").is_file()
    assert (tmp_path / "runs" / "latest" / "manifest.json").is_file()
    replayed = run_json("replay", "runs/latest", cwd=tmp_path)
    assert replayed["same"] is True


def test_run_tells_the_story_as_plain_lines(script: str, tmp_path: Path) -> None:
    out = adamo("run", "Take the key", "--model", script, "--out", "here", cwd=tmp_path).out
    lines = [" ".join(line.split()) for line in out.splitlines()]
    assert "instruction Take the key" in lines
    assert "step 1 Take it." in lines
    assert 'call Pick {"object": "34"}' in lines
    assert any(
        line.startswith("feedback Done: walked") and line.endswith("Key_34 is in your hand.")
        for line in lines
    )
    assert "page here/episode.html" in lines
    assert "\x1b" not in out


@pytest.mark.parametrize(
    ("arguments", "part"),
    [
        (("run",), "Say what to do"),
        (("run", "--task", "T77"), "There is no task"),
        (("run", "x", "--scene", "mars"), "There is no scene"),
        (("run", "x", "--model", "gpt"), "gpt"),
        (("run", "x", "--model", "scripted:none.json"), "none.json"),
        (("run", "x", "--resolution", "big"), "WIDTHxHEIGHT"),
        (("replay", "nowhere"), "no run folder"),
        (("report", "nowhere"), "nowhere"),
    ],
)
def test_wrong_input_is_one_line_that_helps(
    arguments: tuple[str, ...], part: str, tmp_path: Path
) -> None:
    done = adamo(*arguments, cwd=tmp_path)
    assert done.code == 2
    assert part in done.err


def test_tasks_and_scenes_are_listed(tmp_path: Path) -> None:
    tasks = run_json("tasks", cwd=tmp_path)["tasks"]
    assert [task["id"] for task in tasks] == [f"T{i}" for i in range(1, 16)]
    assert tasks[13]["printed"]["total"] == 15
    assert tasks[13]["computed"]["total"] == 18
    assert "T15" in adamo("tasks", cwd=tmp_path).out
    scenes = run_json("scenes", cwd=tmp_path)["scenes"]
    assert scenes[0]["name"] == "s1"
    assert scenes[0]["objects"] == 19


def test_doctor_finds_a_working_machine(tmp_path: Path) -> None:
    findings = {f["check"]: f for f in run_json("doctor", cwd=tmp_path)["findings"]}
    assert set(findings) == {
        "versions",
        "text",
        "cache",
        "runs",
        "graphics",
        "test frame",
        "way to models",
        "keys",
    }
    assert all(finding["ok"] for finding in findings.values())
    assert "objects in view" in findings["test frame"]["found"]


def test_the_figure_is_exported_with_its_clips(tmp_path: Path) -> None:
    done = adamo("figure", "out/ken.glb", "--who", "ken", cwd=tmp_path)
    assert done.code == 0, done.err
    assert "clips walk, reach, idle" in done.out
    assert (tmp_path / "out" / "ken.glb").read_bytes()[:4] == b"glTF"
    assert "choose one of" in adamo("figure", "x.glb", "--who", "bob", cwd=tmp_path).err
