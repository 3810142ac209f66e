"""`adamo-vh mcp` and `run --agent-cmd`: what is wrong is told in one line, with the fix."""

from __future__ import annotations

import json
import shlex
import sys
from pathlib import Path

import pytest
from tests.cli.process import adamo, walk
from tests.service.agent.test_playing import AGENT, FINISH

WRONG = [
    (["mcp", "--profile", "none"], "There is no profile 'none'"),
    (["mcp", "--task", "T99"], "T99"),
    (["mcp", "--task", "T8", "Sing."], "not both"),
    (["mcp", "--resolution", "big"], "write WIDTHxHEIGHT"),
    (["mcp", "--max-seconds", "-1"], "max_seconds is -1.0"),
    (["mcp", "--http", "99999"], "99999 is no port"),
    (["run", "--task", "T8", "--agent-cmd", "no-such-program"], "there is no program"),
    (["run", "--task", "T8", "--agent-cmd", "true", "--model", "random"], "--model does not go"),
    (["run", "--task", "T8", "--agent-cmd", "true", "--record"], "--record does not go with"),
    (["run", "--task", "T8", "--agent-env", "HOME"], "--agent-env is for --agent-cmd; add it"),
    (["run", "--task", "T8", "--isolation", "none"], "--isolation is for --agent-cmd; add it"),
    (["run", "--agent-cmd", "true"], "Say what to do"),
]


def test_a_wrong_setting_is_told_in_one_line(tmp_path: Path) -> None:
    for (words, told), done in zip(WRONG, walk([w for w, _ in WRONG], cwd=tmp_path), strict=True):
        assert done.code != 0 and told in done.err, (words, done)
        assert len(done.err.strip().splitlines()) == 1, done.err
    assert not (tmp_path / "runs").exists() or not list((tmp_path / "runs").iterdir())


@pytest.mark.slow
def test_a_program_plays_and_the_result_is_printed(tmp_path: Path) -> None:
    plan = json.dumps({"calls": [FINISH], "words": "I \x1b[31mhave finished."})
    command = shlex.join([sys.executable, str(AGENT), plan])
    arguments = ["run", "--task", "T8", "--resolution", "160x90", "--out", "one"]
    done = adamo(*arguments, "--agent-cmd", command, "--isolation", "none", cwd=tmp_path)
    assert done.code == 0
    assert "it wrote    I [31mhave finished." in done.out and "\x1b[31mhave" not in done.out
    assert "not ranked" in done.out and "completion 0.00 (0 of 2 conditions)" in done.out
    done = adamo(*arguments[:-1], "two", "--agent-cmd", command, "--json", cwd=tmp_path)
    result = json.loads(done.out)
    assert result["completion"] == 0.0 and result["isolation"] in ("bwrap", "none")
    assert result["answer"] == FINISH[1]["answer"]
