"""A run folder as a track: every event with the world as it was, or a word on why not."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

import pytest

import adamo_vh
from adamo_vh.errors import RecordError
from adamo_vh.record.run_folder import EVENTS, FRAMES, MANIFEST
from adamo_vh.record.trajectory import read_trajectory
from adamo_vh.runtime.builtin import BuiltinEngine
from adamo_vh.studio.messages import Places
from adamo_vh.studio.tracks import Track, track_of

AT = Places("scene.glb", "figure.glb")


def shown(folder: Path) -> Track:
    return track_of(folder, "a run", lambda name: f"/frames/{name}", AT)


@pytest.fixture(scope="module")
def run(s1_engine: BuiltinEngine, tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("runs") / "look and take"
    script = folder.with_suffix(".json")
    steps = [
        {"tool": "Look", "args": {"x": 0.5, "y": 0.0, "z": 0.8}, "note": "<b>there</b>\u202e"},
        {"tool": "Pick", "args": {"object": "Tape_4"}, "note": "I take it."},
    ]
    script.write_text(json.dumps(steps))
    size = (160, 90)
    s1_engine.reset(0)
    adamo_vh.run_episode(
        "Take the cup", model=f"scripted:{script}", resolution=size, out=folder, engine=s1_engine
    )
    return folder


@pytest.fixture(scope="module")
def track(run: Path) -> Track:
    return shown(run)


def copied(run: Path, to: Path) -> Path:
    shutil.copytree(run, to)
    return to


def of(track: Track, kind: str) -> list[dict]:
    return [message for message in track.messages if message["type"] == kind]


def test_the_greeting_says_what_there_is(run, track):
    hello = track.hello
    assert (hello["type"], hello["run"], hello["live"], hello["rate"]) == (
        "hello", "a run", False, 30,
    )  # fmt: skip
    assert hello["scene"]["title"] == "Tabletop" and hello["scene"]["glb"] == "scene.glb"
    ids = {item["id"] for item in hello["scene"]["objects"]}
    tags = {item["tag"] for item in hello["scene"]["objects"]}
    assert {f"object/{i}" for i in ids} == {o["node"] for o in hello["scene"]["objects"]}
    assert len(tags) == len(ids)
    (table,) = hello["scene"]["furniture"]
    assert table["node"] == f"furniture/{table['name']}" and table["size"][2] > 0.5
    assert (
        hello["body"]["reach_m"] > 0.5 and len(hello["joints"]) == len(set(hello["joints"])) == 52
    )
    assert json.loads(json.dumps(hello)) == hello


def test_every_event_of_the_record_is_told_in_order(run, track):
    told = [message["event"]["type"] for message in of(track, "event")]
    assert told == [event.type for event in read_trajectory(run).events]
    assert [message["n"] for message in track.messages] == list(range(1, len(track.messages) + 1))
    seconds = [message["t"] for message in track.messages]
    assert seconds == sorted(seconds) and seconds[-1] > 1.0
    assert of(track, "notice") == []
    frames = [message["frame"] for message in of(track, "event") if message["frame"]]
    assert frames and all((run / FRAMES / f.removeprefix("/frames/")).is_file() for f in frames)


def test_actions_are_shown_moment_by_moment(track):
    poses = of(track, "pose")
    assert len(poses) > 30
    assert set(poses[0]["things"]) == {str(o["id"]) for o in track.hello["scene"]["objects"]}
    assert poses[-1]["held"] is not None
    statuses = [message["doing"] for message in of(track, "status")]
    assert statuses[0] == "seeing" and statuses[-1] == "idle"


def test_text_of_the_record_is_readable_whoever_wrote_it(track):
    thoughts = [m["event"] for m in of(track, "event") if m["event"]["type"] == "thought"]
    assert "\u202e" not in json.dumps(thoughts, ensure_ascii=False)
    assert "<b>there</b>" in json.dumps(thoughts)  # The page shows it as text.
    assert all("saved" not in m["event"] for m in of(track, "event"))


def test_a_damaged_record_still_shows_its_events_and_says_why(run, tmp_path):
    folder = copied(run, tmp_path / "damaged")
    lines = (folder / EVENTS).read_bytes().split(b"\n")
    (folder / EVENTS).write_bytes(b"\n".join([*lines[:3], b"{broken", *lines[4:]]))
    track = shown(folder)
    assert of(track, "pose") == [] and len(of(track, "event")) == len(lines) - 2
    assert "cannot be read" in of(track, "notice")[0]["text"]
    assert track.hello["body"] is None and track.hello["scene"]["glb"] == ""


def test_a_record_of_a_foreign_engine_says_that_it_is_needed(run, tmp_path):
    folder = copied(run, tmp_path / "foreign")
    manifest = json.loads((folder / MANIFEST).read_text())
    (folder / MANIFEST).write_text(json.dumps(manifest | {"engine": "TheirEngine"}))
    track = shown(folder)
    assert len(of(track, "event")) == len(read_trajectory(run).events)
    assert "TheirEngine" in of(track, "notice")[0]["text"]


def test_what_came_out_otherwise_is_said(run, tmp_path):
    folder = copied(run, tmp_path / "otherwise")
    lines = (folder / EVENTS).read_text().splitlines()
    at = next(i for i, line in enumerate(lines) if '"type":"acted"' in line)
    acted = json.loads(lines[at])
    lines[at] = json.dumps(acted | {"state_hash": "0" * 64})
    (folder / EVENTS).write_text("\n".join(lines) + "\n")
    (notice,) = of(shown(folder), "notice")
    assert "otherwise than recorded" in notice["text"] and notice["level"] == "warning"


def test_a_saved_state_that_is_spoilt_leaves_the_events(run, tmp_path):
    folder = copied(run, tmp_path / "spoilt")
    lines = (folder / EVENTS).read_text().splitlines()
    at = next(i for i, line in enumerate(lines) if '"type":"started"' in line)
    lines[at] = json.dumps(json.loads(lines[at]) | {"saved": "nonsense"})
    (folder / EVENTS).write_text("\n".join(lines) + "\n")
    track = shown(folder)
    assert len(of(track, "event")) == len(lines)
    assert "damaged" in of(track, "notice")[0]["text"]


def test_a_picture_whose_name_leads_elsewhere_has_no_address(run, tmp_path):
    folder = copied(run, tmp_path / "leading")
    text = (folder / EVENTS).read_text()
    lines = [json.loads(line) for line in text.splitlines()]
    for line in lines:
        if line["type"] == "observed":
            line["frame"] = "../../../etc/passwd"
    (folder / EVENTS).write_text("".join(json.dumps(line) + "\n" for line in lines))
    assert {m["frame"] for m in of(shown(folder), "event")} == {""}


def test_no_run_folder_is_no_track(tmp_path):
    with pytest.raises(RecordError, match="no run folder"):
        shown(tmp_path)
