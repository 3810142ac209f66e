"""Runs `adamo-vh` as people do: as a process of its own, whose streams are bytes."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

SMALL = ("--resolution", "640x360")


@dataclass(frozen=True)
class Done:
    """What a process printed, and how it ended."""

    code: int
    out: str
    err: str

    @property
    def all(self) -> str:
        return self.out + self.err


def adamo(
    *arguments: str | bytes,
    cwd: Path,
    said: bytes = b"",
    flags: str = "",
    environment: Mapping[str, str] | None = None,
) -> Done:
    """Run a command to its end.

    Args:
        arguments: Of the command.
        cwd: Where.
        said: What stands on its standard input.
        flags: Of Python.
        environment: Variables set otherwise.
    """
    command = [sys.executable, *flags.split(), "-m", "adamo_vh", *arguments]
    done = subprocess.run(
        command,
        input=said,
        capture_output=True,
        cwd=cwd,
        check=False,
        env={**os.environ, **(environment or {})},
    )
    out, err = (stream.decode("utf-8", "replace") for stream in (done.stdout, done.stderr))
    assert "Traceback" not in err, err
    return Done(done.returncode, out, err)


_ONE_PROCESS = """
import contextlib, io, json, sys
from adamo_vh.cli import _run
for words in json.load(sys.stdin):
    sys.argv, sys.stdin = ["adamo-vh", *words], io.StringIO("hi")
    out, err = io.StringIO(), io.StringIO()
    with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
        code = int(_run())
    print(json.dumps([code, out.getvalue(), err.getvalue()]), flush=True)
"""


def walk(commands: Sequence[Sequence[str]], *, cwd: Path) -> list[Done]:
    """Run many commands one after another in one process, which takes a tenth of the time."""
    told = subprocess.run(
        [sys.executable, "-c", _ONE_PROCESS],
        input=json.dumps(commands).encode(),
        stdout=-1,
        cwd=cwd,
        check=True,
    )
    return [Done(*json.loads(line)) for line in told.stdout.splitlines()]


def script(folder: Path, *entries: dict[str, Any]) -> str:
    """The URI of a scripted model."""
    path = folder / "said.json"
    path.write_text(json.dumps(entries))
    return f"scripted:{path}"
