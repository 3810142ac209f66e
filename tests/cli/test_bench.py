"""`adamo-vh bench` and its kin, as processes: what they print, how they end, what they survive."""

from __future__ import annotations

import json
import signal
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

import pytest
from tests.cli.process import SMALL, adamo

SMALLEST = ("--resolution", "160x90", "--set", "limits.max_steps=6")
STUDY = ("bench", "--tasks", "T1,T8", "--model", "random", "--repetitions", "2", *SMALLEST)


def _events(out: str) -> list[dict[str, Any]]:
    return [json.loads(line) for line in out.splitlines()]


def test_a_study_is_played_and_told_as_events(tmp_path: Path) -> None:
    done = adamo(*STUDY, "--workers", "2", "--out", "mine", "--json", cwd=tmp_path)
    assert done.code == 0, done.all
    events = _events(done.out)
    assert events[0] == {"event": "study", "folder": "mine", "episodes": 4, "done": 0}
    last = events[-1]
    assert (last["event"], last["scored"], last["unscored"]) == ("done", 4, 0)
    keys = [f"s1/T{task}/sem/random/paper/v0000/r0{n}" for task in ("01", "08") for n in (1, 2)]
    assert sorted(e["episode"] for e in events if e["event"] == "ended") == keys
    assert all((tmp_path / "mine" / "episodes" / key / "result.json").is_file() for key in keys)
    assert not list((tmp_path / "mine").rglob("episode.html"))
    again = adamo(*STUDY, "--out", "mine", cwd=tmp_path)
    assert (again.code, "4/4" in again.out) == (0, True)
    assert "completion" not in again.out  # Nothing was played.


@pytest.mark.parametrize(
    ("options", "said"),
    [
        (("--tasks", "T99"), "no task 'T99'"),
        (("--labeling", "auto"), "no labeling 'auto'"),
        (("--scene", "s9"), "no scene 's9'"),
        (("--model", "gpt"), "Unknown model 'gpt'"),
        (("--variations", "4-0"), "a range as"),
        (("--repetitions", "0"), "whole number from 1"),
        (("--resolution", "big"), "write WIDTHxHEIGHT"),
        (("--axis", "k"), "write KEY=VALUE"),
        (("--axis", "nose=1"), "cannot set or vary 'nose'"),
        (("--set", "k=many"), "write a whole number"),
        (("--workers", "0"), "use 1 to"),
        (("--in-flight", "0"), "use 1 to"),
        (("--shard", "3/2"), "use 1/2 to 2/2"),
        (("--shard", "half"), "write I/N"),
        (("--study", "nature"), "or a TOML file"),
        (("--executor", "slurm"), "use local or ray"),
        (("--shared", "/tmp"), "for --executor ray"),
        (("--cluster", "127.0.0.1:1"), "for --executor ray"),
    ],
)
def test_what_is_wrong_is_told_before_anything_starts(
    tmp_path: Path, options: tuple[str, ...], said: str
) -> None:
    done = adamo("bench", *options, cwd=tmp_path)
    assert done.code == 2, done.all
    assert said in done.err
    assert list(tmp_path.iterdir()) == []


def test_without_a_folder_the_same_study_has_the_same_one(tmp_path: Path) -> None:
    for _ in range(2):
        done = adamo("bench", "--tasks", "T1", "--model", "random:1", *SMALLEST, cwd=tmp_path)
        assert done.code == 0, done.all
    assert len(list((tmp_path / "studies").iterdir())) == 1


def test_an_episode_without_a_score_is_reported_in_the_exit_code(tmp_path: Path) -> None:
    (tmp_path / "broken.json").write_text("{")
    done = adamo("bench", "--model", "scripted:broken.json", "--out", "x", cwd=tmp_path)
    assert done.code == 2
    assert "broken.json" in done.err
    assert not (tmp_path / "x").exists()


@pytest.mark.slow
def test_one_stop_waits_for_what_is_played_and_the_same_command_goes_on(tmp_path: Path) -> None:
    command = [sys.executable, "-m", "adamo_vh", "bench", "--model", "random"]
    command += ["--repetitions", "2", *SMALL, "--workers", "1", "--out", "x", "--json"]
    process = subprocess.Popen(command, stdout=subprocess.PIPE, text=True, cwd=tmp_path)
    assert process.stdout is not None
    for line in process.stdout:
        if '"ended"' in line:
            process.send_signal(signal.SIGINT)
            break
    rest = _events(process.stdout.read())
    assert process.wait() == 130
    assert rest[-1]["stopped"]
    begun = sum(event["event"] == "began" for event in rest)
    assert sum(event["event"] == "ended" for event in rest) - begun in (0, 1)
    scored = rest[-1]["scored"]
    assert 1 <= scored < 30
    told = json.loads(adamo("reindex", "x", "--json", cwd=tmp_path).out)
    assert told == {"episodes": scored, "damaged": {}}


@pytest.mark.slow
def test_two_stops_end_at_once_and_nothing_is_lost(tmp_path: Path) -> None:
    command = [sys.executable, "-m", "adamo_vh", *STUDY, "--workers", "1", "--out", "x", "--json"]
    process = subprocess.Popen(command, stdout=subprocess.PIPE, text=True, cwd=tmp_path)
    assert process.stdout is not None
    process.stdout.readline()
    process.stdout.readline()
    process.send_signal(signal.SIGINT)
    time.sleep(0.3)
    process.send_signal(signal.SIGINT)
    process.stdout.read()
    assert process.wait() == 130
    done = adamo(*STUDY, "--out", "x", "--json", cwd=tmp_path)
    assert _events(done.out)[-1]["scored"] == 4
