"""A studio that is killed in the middle of an action: its record is whole, and is gone on with."""

from __future__ import annotations

import json
import os
import re
import signal
import subprocess
import sys
import urllib.request
from pathlib import Path

import pytest
from tests.studio.visitor import Visitor

from adamo_vh.record.trajectory import read_trajectory
from adamo_vh.session.runs import replay_episode
from adamo_vh.session.session import Session


@pytest.mark.slow
def test_what_was_being_done_when_it_was_killed_is_done_when_it_is_resumed(tmp_path: Path) -> None:
    words = ["studio", "--port", "0", "--resolution", "160x90", "--out", str(tmp_path)]
    process = subprocess.Popen(
        [sys.executable, "-m", "adamo_vh", *words],
        stdout=subprocess.PIPE,
        text=True,
        env={**os.environ, "PYTHONUNBUFFERED": "1", "COLUMNS": "300"},
    )
    try:
        assert process.stdout is not None
        found = re.search(r"http://\S+?(?=/studio/)", process.stdout.readline())
        assert found is not None
        asked = urllib.request.Request(
            f"{found[0]}/studio/api/rooms",
            json.dumps({"scene": "s1"}).encode(),
            {"content-type": "application/json"},
        )
        with urllib.request.urlopen(asked, timeout=60) as answer:
            room = json.loads(answer.read())["room"]
        with Visitor(found[0], room) as visitor:
            visitor.ask("say", text="Pick the plate")
            visitor.doing("acting")
            for _ in range(10):
                visitor.until(lambda m: m["type"] == "pose")
            process.send_signal(signal.SIGKILL)
            process.wait(30)
    finally:
        process.kill()
        process.wait(30)
    (folder,) = (path for path in tmp_path.iterdir() if path.name.endswith("-studio"))
    assert read_trajectory(folder).ended is None
    with Session.resume(folder) as session:
        ended = session.trajectory.ended
        assert ended is not None and ended.reason == "answered"
        assert session.engine.state().body.held == 57
        session.result()
    assert replay_episode(folder).mismatches == ()
