"""Runs `adamo-vh` as people do: as a process of its own, whose streams are bytes.

It is forked from one that has done the imports, which take longer than most commands. Where flags
of Python or the environment at its start matter, it is started as people start it.
"""

from __future__ import annotations

import atexit
import json
import os
import subprocess
import sys
import tempfile
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cache
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
    if not (flags or environment):
        return _forked(arguments, cwd, said)
    command = [sys.executable, *flags.split(), "-m", "adamo_vh", *arguments]
    done = subprocess.run(
        command,
        input=said,
        capture_output=True,
        cwd=cwd,
        check=False,
        env={**os.environ, **(environment or {})},
    )
    return _done(done.returncode, done.stdout, done.stderr)


def _done(code: int, out: bytes, err: bytes) -> Done:
    printed, complained = (stream.decode("utf-8", "replace") for stream in (out, err))
    assert "Traceback" not in complained, complained
    return Done(code, printed, complained)


_PARENT = """
import atexit, importlib, io, json, os, sys
for name in sys.argv[1].split():
    importlib.import_module(name)
for line in sys.stdin:
    words, cwd, environment, streams = json.loads(line)
    child = os.fork()
    if child == 0:
        for number, path in enumerate(streams):
            os.dup2(os.open(path, os.O_WRONLY if number else os.O_RDONLY), number)
        sys.stdin = io.TextIOWrapper(open(0, "rb", closefd=False), "utf-8")
        sys.stdout = io.TextIOWrapper(open(1, "wb", closefd=False), "utf-8")
        sys.stderr = io.TextIOWrapper(open(2, "wb", closefd=False), "utf-8", "backslashreplace")
        os.chdir(cwd)
        os.environ.clear()
        os.environ.update(environment)
        sys.argv = ["adamo-vh", *words]
        code = 70
        try:
            from adamo_vh.cli import main
            main()
        except SystemExit as end:
            code = int(end.code or 0)
        except BaseException:
            import traceback
            traceback.print_exc()
        finally:
            atexit._run_exitfuncs()
            for stream in (sys.stdout, sys.stderr):
                stream.flush()
            os._exit(code)
    print(os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]), flush=True)
"""
_IMPORTED = (
    "numpy cv2 PIL.Image pydantic typer rich.console jinja2 adamo_vh.cli.app adamo_vh.session.runs "
    "adamo_vh.report.page adamo_vh.runtime.scenes.scene adamo_vh.runtime.human.looks"
)
"""What most commands import; nothing that draws, since no drawing survives a fork."""


@cache
def _parent() -> subprocess.Popen[str]:
    """A process that has done the imports, and forks into one that carries out a command."""
    command = [sys.executable, "-c", _PARENT, _IMPORTED]
    parent = subprocess.Popen(command, stdin=-1, stdout=-1, text=True)
    atexit.register(parent.kill)
    return parent


def _forked(arguments: Sequence[str | bytes], cwd: Path, said: bytes) -> Done:
    parent = _parent()
    assert parent.stdin and parent.stdout
    with tempfile.TemporaryDirectory() as folder:
        streams = [Path(folder, name) for name in ("in", "out", "err")]
        for path in streams:
            path.write_bytes(said if path.name == "in" else b"")
        words = [os.fsdecode(word) for word in arguments]
        told = (words, str(cwd), dict(os.environ), [str(path) for path in streams])
        print(json.dumps(told), file=parent.stdin, flush=True)
        code = int(parent.stdout.readline())
        return _done(code, streams[1].read_bytes(), streams[2].read_bytes())


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
