"""A program of somebody else's, run to its end or to ours, with all that it wrote kept."""

from __future__ import annotations

import os
import signal
import subprocess
import threading
import time
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import IO

MOST_BYTES = 2_000_000
"""Kept of each of its two streams."""
_CUT = b"\n(Cut here: it wrote more than is kept.)\n"
_CHECK_S = 0.1
_TERM_S = 3.0


@dataclass(frozen=True, slots=True)
class Finished:
    """How a program ended."""

    code: int | None
    """Its exit code; None if it was ended by us."""
    seconds: float


def run_program(
    command: Sequence[str],
    environment: Mapping[str, str],
    work: Path,
    kept: Path,
    is_over: Callable[[], bool],
    grace_s: float,
) -> Finished:
    """Run a program until it ends, or some time after it is over for it.

    Args:
        command: The program and its arguments; no shell reads them.
        environment: All variables that it gets.
        work: Its working folder.
        kept: Folder in which ``stdout.txt`` and ``stderr.txt`` are written.
        is_over: Whether nothing that it does counts any more.
        grace_s: Seconds that it has to end by itself then.

    Raises:
        OSError: It cannot be started.
    """
    began = time.monotonic()
    process = subprocess.Popen(
        command,
        env=dict(environment),
        cwd=work,
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        start_new_session=True,  # A group of its own, which can be ended whole.
    )
    readers = [
        threading.Thread(target=_keep, args=(stream, kept / name), daemon=True)
        for stream, name in ((process.stdout, "stdout.txt"), (process.stderr, "stderr.txt"))
    ]
    for reader in readers:
        reader.start()
    over_at: float | None = None
    try:
        while process.poll() is None:
            over_at = over_at or (time.monotonic() if is_over() else None)
            if over_at is not None and time.monotonic() - over_at > grace_s:
                break
            with suppress(subprocess.TimeoutExpired):
                process.wait(_CHECK_S)
        code = process.poll()
    finally:
        _end_group(process)
    for reader in readers:
        # Somebody who left the group may still hold the stream; it is not waited for.
        reader.join(_TERM_S)
    return Finished(code, time.monotonic() - began)


def _end_group(process: subprocess.Popen[bytes]) -> None:
    """End what is left of the program's group: first asked, then not."""
    for number in (signal.SIGTERM, signal.SIGKILL):
        try:
            os.killpg(process.pid, number)
        except (ProcessLookupError, PermissionError):
            break
        deadline = time.monotonic() + _TERM_S
        while time.monotonic() < deadline and _is_alive(process):
            time.sleep(_CHECK_S)
    process.wait()


def _is_alive(process: subprocess.Popen[bytes]) -> bool:
    """Whether any process of the group is left."""
    process.poll()
    try:
        os.killpg(process.pid, 0)
    except (ProcessLookupError, PermissionError):
        return False
    return True


def _keep(stream: IO[bytes] | None, path: Path) -> None:
    """Write a stream into a file, as far as it is kept; read it to its end all the same."""
    assert stream is not None
    left = MOST_BYTES
    with stream, path.open("wb") as file:
        while chunk := stream.read1(65536):  # type: ignore[attr-defined]
            file.write(chunk[:left])
            file.flush()
            if len(chunk) > left > 0:
                file.write(_CUT)
            left = max(0, left - len(chunk))
