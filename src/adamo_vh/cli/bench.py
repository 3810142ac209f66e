"""`adamo-vh bench`: plays a study, shows how far it is, and stops when it is told to."""

from __future__ import annotations

import hashlib
import json
import signal
from dataclasses import asdict
from pathlib import Path
from types import FrameType
from typing import Any, Self

import typer
from rich.console import Console

from adamo_vh.cli.exits import Exit
from adamo_vh.cli.study_progress import JsonLines, LiveTable, PlainLines, put_summary
from adamo_vh.cli.terminal import complain
from adamo_vh.study.axes import slug
from adamo_vh.study.plan import Study
from adamo_vh.study.running import Means, run_study
from adamo_vh.study.supervisor import Supervisor, Watcher
from adamo_vh.study.tally import Tally

STUDIES = Path("studies")


def play_and_show(study: Study, out: Path | None, means: Means, *, as_json: bool) -> None:
    """Play a study and show what happens.

    Args:
        study: What is played.
        out: Its folder; one below studies/ that follows from the study by default.
        means: What it is played with.
        as_json: Print one JSON object a line.
    """
    folder = out or default_folder(study)
    stopping = Stopping()

    def watch(tally: Tally, supervisor: Supervisor) -> Watcher:
        stopping.supervisor = supervisor
        if as_json:
            return JsonLines(folder, tally)
        return LiveTable(tally) if Console().is_terminal else PlainLines(tally)

    with stopping:
        played = run_study(study, folder, means, watch)
    put_summary(played, folder, as_json=as_json)
    if played.verdict.stopped:
        complain(f"stopped; the same command goes on: {folder} holds all that was finished")
        raise typer.Exit(Exit.STOPPED)
    if played.tally.total.done < played.tally.total.planned:
        raise typer.Exit(Exit.NO)


def default_folder(study: Study) -> Path:
    """Where a study is kept, if nobody says: the same place for the same study."""
    digest = hashlib.sha256(json.dumps(asdict(study), sort_keys=True).encode()).hexdigest()
    return STUDIES / f"{slug(study.name or 'study')}-{digest[:8]}"


class Stopping:
    """Heeds Ctrl+C: the first lets what is being played come to its end, the second does not.

    An end that the system asks for (SIGTERM) is taken at once: little time is left then, and what
    was begun is gone on with later.
    """

    def __init__(self) -> None:
        """Heed nothing yet."""
        self.supervisor: Supervisor | None = None
        self._before: dict[int, Any] = {}

    def __enter__(self) -> Self:
        """Begin to heed."""
        for number in (signal.SIGINT, signal.SIGTERM):
            self._before[number] = signal.signal(number, self._heed)
        return self

    def __exit__(self, *_: object) -> None:
        """Leave it to whoever heeded before."""
        for number, before in self._before.items():
            signal.signal(number, before)

    def _heed(self, number: int, frame: FrameType | None) -> None:
        supervisor, self.supervisor = self.supervisor, None
        if supervisor is None or number == signal.SIGTERM:
            raise KeyboardInterrupt
        supervisor.stop()
        complain("stopping when what is being played has ended; Ctrl+C again stops at once")
