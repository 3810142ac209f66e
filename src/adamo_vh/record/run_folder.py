"""The run folder: what its files are called, and who may write them.

`manifest.json` says how an episode was set up, `events.jsonl` has one event a line, each flushed at
once, so that a kill loses at most the step in flight, and `frames/` holds pictures named by their
content. Everything else, the score too, can be computed from these. Reading needs no lock.
"""

from __future__ import annotations

import fcntl
import json
import os
import socket
from contextlib import suppress
from datetime import UTC, datetime
from functools import cache
from pathlib import Path
from typing import Any, Self
from weakref import WeakSet

from adamo_vh.errors import FileError, FolderInUseError, RecordError
from adamo_vh.files import make_folder, naming

MANIFEST = "manifest.json"
EVENTS = "events.jsonl"
FRAMES = "frames"
RESULT = "result.json"
LOCK = "run.lock"
SCENE, SCRIPT, FIGURE = "scene.toml", "script.json", "figure.glb"
"""Own files that the episode rests on."""
FORMAT = 2
"""Of the files; older ones can be read, not continued."""


class FolderLock:
    """Makes its owner the only writer of a run folder, until it is closed or its process ends.

    The lock is the kernel's, so that no kill leaves it behind. What its file says is for people.
    """

    def __init__(self, folder: Path) -> None:
        """Lock a folder, which is made if it is missing.

        Raises:
            FolderInUseError: Somebody else writes it now; says who.
            FileError: It cannot be written.
        """
        with naming("written", make_folder(folder)):
            self._file = (folder / LOCK).open("a+b")
        try:
            fcntl.flock(self._file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            with self._file as file:
                file.seek(0)
                who = _spelt(file.read())
            raise FolderInUseError(
                f"{folder} is being written by {who}; wait until that has ended, or stop it first."
            ) from None
        except OSError:
            # A network file system without locks: a new folder is still taken by one alone.
            pass
        _held().add(self)
        holder = {
            "pid": os.getpid(),
            "host": socket.gethostname(),
            "since": datetime.now(UTC).isoformat(timespec="seconds"),
        }
        self._say(json.dumps(holder).encode())

    def close(self) -> None:
        """Let others write."""
        if not self._file.closed:
            self._say(b"")
            with suppress(OSError):
                fcntl.flock(self._file, fcntl.LOCK_UN)
            self._file.close()

    def let_go(self) -> None:
        """Leave the lock to the process that this one was forked from, which holds it too."""
        self._file.close()

    def _say(self, text: bytes) -> None:
        self._file.truncate(0)
        self._file.write(text)
        self._file.flush()

    def __enter__(self) -> Self:
        """Itself."""
        return self

    def __exit__(self, *_: object) -> None:
        """Close it."""
        self.close()


@cache
def _held() -> WeakSet[FolderLock]:
    """The locks of this process; a child made by fork must not hold them any longer than it."""
    held: WeakSet[FolderLock] = WeakSet()

    def let_go() -> None:
        for lock in held:
            lock.let_go()

    os.register_at_fork(after_in_child=let_go)
    return held


def _spelt(told: bytes) -> str:
    """Who holds a lock, from what its file says."""
    try:
        holder = json.loads(told)
        return f"process {holder['pid']} on {holder['host']} (since {holder['since']})"
    except (ValueError, KeyError, TypeError):
        return "another process"


def check_unused(folder: Path) -> None:
    """Make sure that a folder holds no episode yet; hold its lock.

    Raises:
        RecordError: It does; says what can be done with it.
    """
    if (folder / MANIFEST).exists():
        raise RecordError(
            f"{folder} already holds an episode; choose another --out folder, or go on with it: "
            f"adamo-vh run --resume {folder}"
        )
    if (folder / EVENTS).exists():
        check_begun(folder)


def check_begun(folder: Path) -> None:
    """Make sure that a folder holds a run.

    Raises:
        RecordError: It does not; says what can be done.
    """
    if (folder / MANIFEST).is_file():
        return
    if not (folder / EVENTS).is_file():
        raise RecordError(f"{folder} is no run folder: {MANIFEST} is missing.")
    if (folder / EVENTS).stat().st_size:
        raise RecordError(
            f"{folder} holds events of an episode, and {MANIFEST} is missing: without it nothing "
            "can be done with them. Put it back, or choose another folder."
        )
    raise RecordError(
        f"{folder} was left before anything was recorded; delete it and run again, or choose "
        "another --out folder."
    )


def read_head(folder: Path) -> dict[str, Any]:
    """The manifest as plain data, if it can be read; else nothing."""
    try:
        head = json.loads((folder / MANIFEST).read_bytes())
    except (OSError, ValueError, RecursionError):
        return {}
    return head if isinstance(head, dict) else {}


def reserve(parent: Path, name: str) -> Path:
    """Make a new folder that nobody else gets, also in the same moment.

    Args:
        parent: Is made if it is missing.
        name: Of the folder; a number is added where the name is taken.

    Raises:
        FileError: It cannot be made.
    """
    make_folder(parent)
    number = 1
    while True:
        folder = parent / (name if number == 1 else f"{name}-{number}")
        try:
            with naming("written", folder):
                folder.mkdir()
        except FileError:
            if not folder.exists():
                raise
            number += 1
        else:
            return folder
