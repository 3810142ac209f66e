"""Nothing that is printed steers the terminal, and nothing that it does stops the work."""

from __future__ import annotations

import json
import os
import re
import signal
import subprocess
import sys
import urllib.request
from contextlib import suppress
from pathlib import Path

import pytest
from tests.cli.process import SMALL, adamo, script, walk

HOSTILE = "x\x1b[31mRED\x1b]0;owned\x07\x9b2J\u202eevil\u2066\u200bz\r\x08"
BAD = re.compile("[\x00-\x08\x0b-\x1f\x7f-\x9f\u200b-\u200f\u202a-\u202e\u2060-\u206f\ufeff]")


def clean(text: str) -> None:
    assert BAD.findall(text) == [], BAD.findall(text)
    assert "RED" in text, "what is harmless in it is shown"


def test_what_a_model_says_steers_nothing(tmp_path: Path) -> None:
    model = script(
        tmp_path,
        {"note": HOSTILE, "tool": "Pick", "args": {"object": HOSTILE}},
        {"note": HOSTILE, "tool": HOSTILE, "args": {HOSTILE: 1}},
        {"note": f"{HOSTILE}\nscore       completion 1.00"},
    )
    done = adamo("run", HOSTILE, "--model", model, *SMALL, "--out", "a", cwd=tmp_path)
    assert done.code == 0, done.err
    clean(done.all)
    assert not [line for line in done.out.splitlines() if line.startswith("score")], "not faked"
    done = adamo("chat", "--model", model, "--out", "b", cwd=tmp_path, said=HOSTILE.encode())
    assert done.code == 0, done.err
    clean(done.all)


WALK = [
    ("run", "hi", "--scene", HOSTILE),
    ("run", "hi", "--model", HOSTILE),
    ("run", "hi", "--model", f"openai:{HOSTILE}@http://127.0.0.1:9/v1"),
    ("run", "hi", "--model", f"scripted:{HOSTILE}"),
    ("run", "hi", "--labeling", HOSTILE),
    ("run", "hi", "--switch", HOSTILE),
    ("run", "hi", "--switch", f"{HOSTILE}=1"),
    ("run", "hi", "--budget", f"tokens={HOSTILE}"),
    ("run", "hi", "--resolution", HOSTILE),
    ("run", "hi", "--video", HOSTILE),
    ("run", "--task", HOSTILE),
    ("run", "--resume", HOSTILE),
    ("run", f"--{HOSTILE}"),
    ("chat", "--resume", HOSTILE),
    ("replay", HOSTILE),
    ("report", HOSTILE),
    ("figure", HOSTILE),
    ("figure", "x.glb", "--who", HOSTILE),
    ("tasks", "verify", "--scene", HOSTILE),
    ("scenes", "check", HOSTILE),
    ("scenes", "show", HOSTILE),
    ("models", "check", HOSTILE),
    ("serve-model", HOSTILE),
    ("serve-model", "--faults", HOSTILE),
    ("serve-model", "--host", HOSTILE),
    (HOSTILE,),
]
"""Every command, with a hostile text in each place that takes one."""


def test_every_command_names_hostile_arguments_safely(tmp_path: Path) -> None:
    for words, done in zip(WALK, walk(WALK, cwd=tmp_path), strict=True):
        assert done.code in (1, 2), words
        clean(done.all)
        assert len(done.err.splitlines()) == 1, words


def test_a_hostile_scene_file_is_told_safely(tmp_path: Path) -> None:
    quoted = json.dumps(HOSTILE)
    (tmp_path / "x.toml").write_text(f"name = {quoted}\ntitle = {quoted}\n[{quoted}]\n{quoted} = 1")
    done = adamo("scenes", "check", "x.toml", cwd=tmp_path)
    assert done.code == 1
    assert BAD.findall(done.all) == []


def test_the_log_of_a_served_model_is_safe(tmp_path: Path) -> None:
    command = [sys.executable, "-m", "adamo_vh", "serve-model", "--port", "0"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT) as server:
        assert server.stdout is not None
        first = server.stdout.readline().decode()
        url = first.split()[-1]
        for path, body in (
            ("/chat/completions", json.dumps({"model": HOSTILE, "messages": HOSTILE})),
            ("/%1b%5b31m", json.dumps(HOSTILE)),
        ):
            request = urllib.request.Request(
                url + path, body.encode(), {"Content-Type": "application/json"}
            )
            with suppress(urllib.error.HTTPError):
                urllib.request.urlopen(request, timeout=20).close()
        server.send_signal(signal.SIGTERM)
        log = server.stdout.read().decode()
    assert BAD.findall(log) == []


@pytest.mark.parametrize(
    "environment",
    [
        {"PYTHONIOENCODING": "latin-1"},
        {"PYTHONIOENCODING": "ascii"},
        {"LC_ALL": "C", "PYTHONUTF8": "0", "PYTHONCOERCECLOCALE": "0"},
    ],
    ids="-".join,
)
def test_what_the_terminal_cannot_say_does_not_end_an_episode(
    environment: dict[str, str], tmp_path: Path
) -> None:
    model = script(
        tmp_path, {"note": "看 🔑", "tool": "Pick", "args": {"object": "34"}}, {"note": "好"}
    )
    arguments = ("run", "--task", "T1", "--model", model, *SMALL, "--out", "a")
    done = adamo(*arguments, cwd=tmp_path, environment=environment)
    assert done.code == 0, done.all
    assert "completion 1.00" in done.out
    assert "看 🔑" in (tmp_path / "a" / "events.jsonl").read_text("utf-8")


def test_words_in_another_encoding_are_refused_before_anything_starts(tmp_path: Path) -> None:
    done = adamo("run", b"caf\xe9", cwd=tmp_path)
    assert (done.code, done.out) == (2, "")
    assert "is not UTF-8 text" in done.err and "LC_ALL=C.UTF-8" in done.err
    assert os.listdir(tmp_path) == []


def test_a_lone_surrogate_in_a_script_leaves_the_record_whole(tmp_path: Path) -> None:
    model = script(tmp_path, {"note": "a\ud800b"}, {"note": "\udfff"})
    done = adamo("run", "hi", "--model", model, *SMALL, "--out", "a", cwd=tmp_path)
    assert done.code == 0, done.err
    lines = (tmp_path / "a" / "events.jsonl").read_text("utf-8").splitlines()
    assert json.loads(lines[-1])["type"] == "ended"
    assert adamo("report", "a", cwd=tmp_path).code == 0


def test_a_reader_that_goes_away_does_not_end_an_episode(tmp_path: Path) -> None:
    model = script(tmp_path, {"note": "Take it.", "tool": "Pick", "args": {"object": "34"}})
    words = ["run", "--task", "T1", "--model", model, *SMALL, "--out", "a"]
    reader, writer = os.pipe()
    os.close(reader)
    command = [sys.executable, "-m", "adamo_vh", *words]
    done = subprocess.run(command, stdout=writer, stderr=-1, cwd=tmp_path, check=False)
    os.close(writer)
    assert (done.returncode, done.stderr) == (0, b"")
    assert b'"completion": 1.0' in (tmp_path / "a" / "result.json").read_bytes()


def test_a_full_place_to_print_to_is_told_at_the_end(tmp_path: Path) -> None:
    with open("/dev/full", "wb") as full:
        command = [sys.executable, "-m", "adamo_vh", "tasks"]
        done = subprocess.run(command, stdout=full, stderr=-1, cwd=tmp_path, check=False)
    assert done.returncode == 1
    assert b"not all could be printed: No space left on device" in done.stderr


@pytest.mark.parametrize("closed", ["<&-", ">&-", "2>&-", "<&- >&- 2>&-"])
def test_closed_streams_are_no_fault(closed: str, tmp_path: Path) -> None:
    command = f"exec {sys.executable} -m adamo_vh chat {closed}"
    done = subprocess.run(command, shell=True, capture_output=True, cwd=tmp_path, check=False)
    assert done.returncode == 0, done.stderr
    assert b"Traceback" not in done.stderr
