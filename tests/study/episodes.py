"""Studies for tests: planned, and played on the plain-data tabletop without an engine."""

from __future__ import annotations

import json
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from tests.run_folder import Recorder

from adamo_vh.analysis.diagnosis.finding import DIAGNOSIS, Code, Diagnosis, FailureClass
from adamo_vh.analysis.outcome import Outcome
from adamo_vh.record.termination import TerminationReason
from adamo_vh.study.executor import Failed, Finished, Lost, Report
from adamo_vh.study.plan import Planned, Study
from adamo_vh.study.store import episode_folder, finished


def small_study(**other: Any) -> Study:
    """Six episodes of a model that draws lots."""
    lists: dict[str, Any] = {"tasks": ("T1", "T8"), "models": ("random",), "repetitions": 3}
    return Study(**{**lists, **other})


def record(
    folder: Path, planned: Planned, reason: TerminationReason = TerminationReason.ANSWERED
) -> Outcome:
    """Write the run folder of an episode that has ended."""
    run = episode_folder(folder, planned.key)
    Recorder(run, planned.config).end("Done.", reason)
    if reason.is_scored:
        found = Diagnosis(FailureClass.EXECUTION, Code.FALSE_CLAIM, "Nothing was done.")
        (run / DIAGNOSIS).write_text(json.dumps(found.json()))
    outcome = finished(folder, planned)
    assert outcome is not None
    return outcome


Act = Callable[[Planned, int], Report | None]
"""What becomes of an episode at its n-th try; None for a good end."""


@dataclass
class TableExecutor:
    """Plays on the tabletop, in this process; things go wrong as a script says."""

    folder: Path
    goes_wrong: Act | None = None
    slots: int = 2
    started: list[str] = field(default_factory=list)
    running: list[tuple[Planned, bool]] = field(default_factory=list)

    def can_take(self, *, alone: bool = False) -> bool:
        return len(self.running) < (1 if alone else self.slots)

    def start(self, planned: Planned, *, alone: bool = False) -> None:
        assert self.can_take(alone=alone)
        self.started.append(planned.key)
        self.running.append((planned, alone))

    def wait(self, seconds: float) -> Sequence[Report]:
        if not self.running:
            return []
        planned, _ = self.running[0]
        report = None
        if self.goes_wrong is not None:
            report = self.goes_wrong(planned, self.started.count(planned.key))
        if isinstance(report, Lost):
            report = Lost(tuple(one.key for one, _ in self.running), report.why)
            self.running.clear()
            return [report]
        del self.running[0]
        return [report or Finished(planned.key, record(self.folder, planned))]

    def close(self) -> None:
        self.running.clear()


class Heard:
    """A watcher that keeps what it is told."""

    def __init__(self) -> None:
        self.began_: list[str] = []
        self.ended_: list[tuple[str, str, bool]] = []
        self.notes: list[str] = []

    def began(self, planned: Planned) -> None:
        self.began_.append(planned.key)

    def ended(self, planned: Planned, outcome: Outcome | None, why: str, *, again: bool) -> None:
        self.ended_.append((planned.key, why, again))

    def noted(self, text: str) -> None:
        self.notes.append(text)

    def tick(self) -> None:
        pass

    def close(self) -> None:
        pass


def failed(planned: Planned, why: str = "the provider is down", **other: bool) -> Failed:
    return Failed(planned.key, why, **other)
