"""How far a study has come, by cell: what the live table and the last line say."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass

from adamo_vh.analysis.outcome import Outcome
from adamo_vh.study.plan import CellKey, Planned


@dataclass(slots=True)
class CellTally:
    """How far one cell has come."""

    planned: int = 0
    done: int = 0
    """Scored episodes."""
    running: int = 0
    unscored: int = 0
    """Episodes that have ended, for now, without a score."""
    completion_sum: float = 0.0
    tokens: int = 0
    usd: float = 0.0
    """Of the episodes whose price is known."""

    @property
    def mean(self) -> float | None:
        """Mean completion; None if nothing is scored."""
        return self.completion_sum / self.done if self.done else None

    def added(self, other: CellTally) -> CellTally:
        """Both together."""
        return CellTally(
            self.planned + other.planned,
            self.done + other.done,
            self.running + other.running,
            self.unscored + other.unscored,
            self.completion_sum + other.completion_sum,
            self.tokens + other.tokens,
            self.usd + other.usd,
        )


@dataclass(slots=True)
class _Mark:
    """What is counted of one episode."""

    outcome: Outcome | None = None
    is_running: bool = False
    has_failed: bool = False


class Tally:
    """Counts a study's episodes."""

    def __init__(
        self,
        episodes: Iterable[Planned],
        outcomes: Mapping[str, Outcome],
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        """Start with what was done before.

        Args:
            episodes: Those that are to be played.
            outcomes: What came of some of them before.
            clock: Tells seconds.
        """
        self._cells = {one.key: one.cell for one in episodes}
        self._marks = {key: _Mark(outcomes.get(key)) for key in self._cells}
        self._clock = clock
        self._begun = clock()
        self._here = 0
        """Episodes that were scored since then."""

    def began(self, key: str) -> None:
        """An episode is played."""
        self._marks[key].is_running = True

    def ended(self, key: str, outcome: Outcome | None) -> None:
        """An episode is not played any more.

        Args:
            key: The episode's.
            outcome: None if nothing came of it.
        """
        mark = self._marks[key]
        mark.is_running = False
        mark.outcome = outcome or mark.outcome
        mark.has_failed = outcome is None
        self._here += outcome is not None and outcome.is_scored

    @property
    def cells(self) -> dict[CellKey, CellTally]:
        """By cell, in the order of the plan."""
        found: dict[CellKey, CellTally] = {}
        for key, cell in self._cells.items():
            tally, mark = found.setdefault(cell, CellTally()), self._marks[key]
            tally.planned += 1
            tally.running += mark.is_running
            outcome = mark.outcome
            if outcome is not None:
                tally.tokens += outcome.usage.total_tokens
                tally.usd += outcome.cost_usd or 0.0
            if outcome is not None and outcome.completion is not None:
                tally.done += 1
                tally.completion_sum += outcome.completion
            elif not mark.is_running:
                tally.unscored += mark.has_failed or outcome is not None
        return found

    @property
    def total(self) -> CellTally:
        """All cells together."""
        total = CellTally()
        for tally in self.cells.values():
            total = total.added(tally)
        return total

    @property
    def per_hour(self) -> float | None:
        """Episodes an hour since this command began; None before the first."""
        hours = (self._clock() - self._begun) / 3600
        return self._here / hours if self._here and hours > 0 else None

    @property
    def seconds_left(self) -> float | None:
        """Seconds until all is done, at the speed so far; None before the first episode."""
        rate, total = self.per_hour, self.total
        return None if rate is None else (total.planned - total.done) / rate * 3600
