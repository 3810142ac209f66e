"""Writes what happens into a run folder; what is on record already is verified instead."""

from __future__ import annotations

from collections import deque
from collections.abc import Sequence
from pathlib import Path

from adamo_vh.errors import FileError, RecordError
from adamo_vh.files import append_line, make_folder, naming, write_whole
from adamo_vh.observation import Frame
from adamo_vh.record.run_folder import EVENTS, FRAMES, RESULT, FolderLock
from adamo_vh.record.trajectory import Event, Observed, Shown, codec


class TrajectoryWriter:
    """Writes events and frames into a run folder, each at once."""

    def __init__(
        self, folder: Path, *, known: Sequence[Event] | None = None, lock: FolderLock | None = None
    ) -> None:
        """Open a run folder.

        Args:
            folder: Is made if it is missing.
            known: Go on with an interrupted episode: these events are the first of the file and
                will come again; they are not written twice. What the file has after them stays
                until all of them came again and something new happens.
            lock: Of the folder, if the caller holds it already; taken and closed here otherwise.

        Raises:
            RecordError: It already holds an episode, or somebody else writes it.
        """
        self.fault: RecordError | FileError | None = None
        """Why nothing more is written; None if all is well."""
        self._folder, self._frames, self._events = folder, folder / FRAMES, folder / EVENTS
        self._known = None if known is None else deque(known)
        self._count = len(known or ())
        self._goes_on = known is not None
        self._own_lock = FolderLock(folder) if lock is None else None
        try:
            if known is None:
                if self._events.exists():
                    raise RecordError(
                        f"{folder} already holds an episode; choose another --out folder."
                    )
                with naming("written", make_folder(self._frames)):
                    self._events.touch()
        except BaseException:
            self.close()
            raise

    def notify(self, event: Event, frame: Frame | None = None) -> None:
        """Write an event; its frame first, so that no event names a missing picture.

        Raises:
            RecordError: A known event came out otherwise this time. Nothing is written afterwards.
            FileError: The folder cannot be written any more; neither is it afterwards.
        """
        if self.fault is not None:
            return
        try:
            if self._known:
                self._verify(event, self._known.popleft())
            else:
                with naming("written", self._folder):
                    self._write(event, frame)
        except (RecordError, FileError) as error:
            self.fault = error
            raise

    def _verify(self, event: Event, known: Event) -> None:
        """Make sure that an event came again: in the same state, where it tells one."""
        states = [getattr(one, "state_hash", "") for one in (event, known)]
        if event.type == known.type and states[0] == states[1]:
            return
        line = self._count - len(self._known or ())
        raise RecordError(
            f"{self._folder} cannot be continued: executed again, it came out otherwise. First "
            f"difference in line {line} of {EVENTS}: {_spelt(event)}, where {_spelt(known)} was "
            "recorded. Was it recorded by another version, with other tools, or on another kind "
            "of machine? The record is as it was."
        )

    def _write(self, event: Event, frame: Frame | None) -> None:
        if frame is not None and isinstance(event, Observed | Shown):
            path = self._frames / event.frame
            if not path.exists():
                write_whole(path, frame.data)
        path, line = self._events, codec().dump_json(event)
        if self._goes_on:
            # Now that all came again as it was, a later end and what a kill left may go; in one
            # move, because what comes instead may tell what was paid.
            (self._folder / RESULT).unlink(missing_ok=True)
            write_whole(path, _first_lines(path, self._count) + line + b"\n")
            self._goes_on = False
        else:
            append_line(path, line)

    def close(self) -> None:
        """Let others write."""
        if self._own_lock is not None:
            self._own_lock.close()


def _first_lines(path: Path, count: int) -> bytes:
    """The first lines of a file; nothing, if it is missing."""
    lines = path.read_bytes().split(b"\n")[:count] if path.exists() else []
    return b"".join(line + b"\n" for line in lines)


def _spelt(event: Event) -> str:
    """An event in a few words, with the state that it led to."""
    name, step = getattr(event, "name", ""), getattr(event, "step", None)
    state = getattr(event, "state_hash", "")[:12]
    words = [f'"{event.type}"', name, "" if step is None else f"at step {step}"]
    return " ".join(word for word in (*words, f"in state {state}" if state else "") if word)
