"""Runs `adamo-vh` as people do: with words, a place and streams of bytes, to an exit code.

Most commands run in the process of the test, which has done the imports, and whose engines are at
hand: both take longer than most commands. Where flags of Python or the environment at its start
matter, a command gets a process of its own.
"""

from __future__ import annotations

import io
import json
import os
import signal
import subprocess
import sys
import tempfile
import warnings
from collections.abc import Mapping, Sequence
from contextlib import ExitStack
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from adamo_vh.cli import main

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
        return _here(arguments, cwd, said)
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


def _here(arguments: Sequence[str | bytes], cwd: Path, said: bytes) -> Done:
    kept = (sys.argv, sys.stdin, sys.stdout, sys.stderr)
    place, environment = Path.cwd(), dict(os.environ)
    handlers = {number: signal.getsignal(number) for number in (signal.SIGINT, signal.SIGTERM)}
    with ExitStack() as stack:
        stack.enter_context(warnings.catch_warnings())
        streams = [stack.enter_context(tempfile.TemporaryFile()) for _ in range(3)]
        streams[0].write(said)
        streams[0].seek(0)
        code = 0
        try:
            os.chdir(cwd)
            sys.argv = ["adamo-vh", *(os.fsdecode(word) for word in arguments)]
            texts = [io.TextIOWrapper(stream, "utf-8", write_through=True) for stream in streams]
            sys.stdin, sys.stdout, sys.stderr = texts
            main()
        except SystemExit as end:
            code = int(end.code or 0)
        finally:
            sys.argv, sys.stdin, sys.stdout, sys.stderr = kept
            os.chdir(place)
            for name in {*os.environ} - {*environment}:
                del os.environ[name]
            os.environ.update(environment)
            for number, handler in handlers.items():
                signal.signal(number, handler)
        out, err = (os.pread(stream.fileno(), 1 << 26, 0) for stream in streams[1:])
        return _done(code, out, err)


def walk(commands: Sequence[Sequence[str]], *, cwd: Path) -> list[Done]:
    """Run many commands, one after another; each is told "hi" by its standard input."""
    return [adamo(*words, cwd=cwd, said=b"hi") for words in commands]


def script(folder: Path, *entries: dict[str, Any]) -> str:
    """The URI of a scripted model."""
    path = folder / "said.json"
    path.write_text(json.dumps(entries))
    return f"scripted:{path}"
