"""A program is run to its end or to ours, its words are kept, and nothing of it is left behind."""

from __future__ import annotations

import os
import sys
import time
from pathlib import Path

import pytest

from adamo_vh.service.agent.program import MOST_BYTES, Finished, run_program


def _run(tmp_path: Path, code: str, over_after_s: float = 60.0, grace_s: float = 0.2) -> Finished:
    began = time.monotonic()
    return run_program(
        [sys.executable, "-c", code],
        {"WORD": "told"},
        tmp_path,
        tmp_path,
        lambda: time.monotonic() - began > over_after_s,
        grace_s,
    )


def _kept(tmp_path: Path) -> tuple[str, str]:
    out, err = tmp_path / "stdout.txt", tmp_path / "stderr.txt"
    return out.read_text(), err.read_text()


def test_what_it_writes_is_kept_and_its_code_told(tmp_path: Path) -> None:
    code = "import os, sys; print(os.environ['WORD']); print('oh', file=sys.stderr); sys.exit(3)"
    assert _run(tmp_path, code).code == 3
    assert _kept(tmp_path) == ("told\n", "oh\n")


def test_it_gets_nothing_that_it_was_not_given(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("SECRET_KEY", "xyz")
    _run(tmp_path, "import os; print(sorted(set(os.environ) - {'LC_CTYPE'}))")
    assert _kept(tmp_path)[0] == "['WORD']\n"


def test_one_that_writes_without_end_is_read_and_cut(tmp_path: Path) -> None:
    assert _run(tmp_path, f"print('x' * {3 * MOST_BYTES})").code == 0
    text = _kept(tmp_path)[0]
    assert len(text) < MOST_BYTES + 100 and text.endswith(
        "(Cut here: it wrote more than is kept.)\n"
    )


def test_one_that_does_not_end_is_ended_with_its_children(tmp_path: Path) -> None:
    code = (
        "import signal, subprocess, sys, time\n"
        "signal.signal(signal.SIGTERM, signal.SIG_IGN)\n"
        "print(subprocess.Popen(['sleep', '600']).pid, flush=True)\n"
        "time.sleep(600)"
    )
    finished = _run(tmp_path, code, over_after_s=1.0)
    assert finished.code is None and 1.0 < finished.seconds < 15
    child = int(_kept(tmp_path)[0])
    # Dead at once; its body is taken away by whoever inherited it.
    state = Path(f"/proc/{child}/stat")
    assert not state.exists() or state.read_text().rpartition(")")[2].split()[0] == "Z"


def test_children_that_stay_behind_are_ended_too(tmp_path: Path) -> None:
    code = "import subprocess; print(subprocess.Popen(['sleep', '600']).pid, flush=True)"
    began = time.monotonic()
    assert _run(tmp_path, code).code == 0
    assert time.monotonic() - began < 15
    child = int(_kept(tmp_path)[0])
    assert not os.path.exists(f"/proc/{child}/exe") or not os.path.realpath(
        f"/proc/{child}/exe"
    ).endswith("sleep")


def test_one_that_is_not_there_is_told(tmp_path: Path) -> None:
    with pytest.raises(OSError, match="No such file"):
        run_program(["/no/such"], {}, tmp_path, tmp_path, lambda: False, 1)
