"""The supervisor: sends the episodes of a study to an executor until each has a score."""

from __future__ import annotations

from collections import Counter, deque
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Protocol

from adamo_vh.analysis.outcome import Outcome
from adamo_vh.errors import EngineError, FileError
from adamo_vh.record.termination import TerminationReason
from adamo_vh.study.executor import Executor, Failed, Finished, Lost, Noted, Report
from adamo_vh.study.plan import Planned
from adamo_vh.study.store import Store
from adamo_vh.study.tally import Tally

RETRIES = 3
"""Further tries of an episode that is unscored through no fault of the agent."""
_DEATHS = 5
"""How often what plays an episode alone may die of it."""
_DEATHS_IN_A_ROW = 20
"""How many may die, one after the other, without a single episode coming to its end."""
_TICK_S = 0.5


class Watcher(Protocol):
    """Is told what happens to a study: shows it, or passes it on."""

    def began(self, planned: Planned) -> None:
        """An episode is played."""
        ...

    def ended(self, planned: Planned, outcome: Outcome | None, why: str, *, again: bool) -> None:
        """An episode is not played any more.

        Args:
            planned: The episode.
            outcome: What came of it; None if nothing did.
            why: Why it has no score; empty if it has one.
            again: Whether it will be tried again later.
        """
        ...

    def noted(self, text: str) -> None:
        """Something that people should know."""
        ...

    def tick(self) -> None:
        """Time has passed."""
        ...

    def close(self) -> None:
        """Nothing more happens."""
        ...


@dataclass(frozen=True, slots=True)
class Verdict:
    """How a study stands when its command ends."""

    stopped: bool
    """Whether it was asked to stop before all was done."""
    budget_spent: str
    """Why no more could be paid for; empty if that was not the reason."""
    problems: Mapping[str, str]
    """Why episodes have no score, by key."""


class Supervisor:
    """Plays a study; its state is gone when it ends, and the store's is what counts."""

    def __init__(self, store: Store, executor: Executor, tally: Tally) -> None:
        """Bring the parts together.

        Args:
            store: Open.
            executor: Ready.
            tally: Of the episodes that are to be played.
        """
        self._store, self._executor, self._tally = store, executor, tally
        self._watcher: Watcher
        self._waiting: deque[Planned] = deque()
        self._suspects: deque[Planned] = deque()
        """What was lost with others: one of them may have been the reason, so each is now played
        alone."""
        self._playing: dict[str, Planned] = {}
        self._alone: set[str] = set()
        self._tries: Counter[str] = Counter()
        self._deaths: Counter[str] = Counter()
        self._in_a_row = 0
        self._problems: dict[str, str] = {}
        self._budget_spent = ""
        self._stopping = False

    def stop(self) -> None:
        """Begin nothing more; what is being played is played to its end."""
        self._stopping = True

    def run(self, episodes: Iterable[Planned], watcher: Watcher) -> Verdict:
        """Play episodes until each has a score, or no further try would help.

        Args:
            episodes: What has no score yet, in the order in which it is begun.
            watcher: Is told what happens.

        Raises:
            FileError: The folder cannot be written any more; what was begun has come to its end,
                or is gone on with by the next command.
            EngineError: Whatever plays episodes dies again and again.
        """
        self._watcher = watcher
        self._problems |= self._store.damaged
        self._waiting.extend(episodes)
        while self._playing or (not self._holds_back and (self._waiting or self._suspects)):
            self._start()
            for report in self._executor.wait(_TICK_S):
                self._hear(report)
            watcher.tick()
        return Verdict(self._stopping, self._budget_spent, dict(self._problems))

    @property
    def _holds_back(self) -> bool:
        return self._stopping or bool(self._budget_spent)

    def _start(self) -> None:
        """Give the executor what it can take; suspects when all others are on their way."""
        while not self._holds_back:
            alone = not self._waiting
            queue = self._suspects if alone else self._waiting
            if not queue or not self._executor.can_take(alone=alone):
                return
            planned = queue.popleft()
            self._playing[planned.key] = planned
            if alone:
                self._alone.add(planned.key)
            self._executor.start(planned, alone=alone)
            self._tally.began(planned.key)
            self._watcher.began(planned)

    def _hear(self, report: Report) -> None:
        match report:
            case Finished():
                self._in_a_row = 0
                self._finished(self._taken(report.key), report.outcome)
            case Failed():
                if report.fatal:
                    raise FileError(f"{report.key}: {report.why}")
                self._unscored(self._taken(report.key), None, report.why, again=report.again)
            case Lost():
                self._lost(report)
            case Noted():
                self._watcher.noted(report.text)

    def _taken(self, key: str) -> Planned:
        self._alone.discard(key)
        return self._playing.pop(key)

    def _finished(self, planned: Planned, outcome: Outcome) -> None:
        self._store.add(outcome)
        if outcome.is_scored:
            self._end(planned, outcome, "", again=False)
            return
        why = outcome.why or outcome.answer or str(outcome.termination)
        is_budget = outcome.termination is TerminationReason.RUN_BUDGET
        if is_budget:
            self._budget_spent = why
        self._unscored(planned, outcome, why, again=not is_budget)

    def _unscored(
        self, planned: Planned, outcome: Outcome | None, why: str, *, again: bool
    ) -> None:
        again = again and self._tries[planned.key] < RETRIES
        if again:
            self._tries[planned.key] += 1
            self._waiting.append(planned)
        self._end(planned, outcome, why, again=again)

    def _lost(self, report: Lost) -> None:
        self._in_a_row += 1
        if self._in_a_row >= _DEATHS_IN_A_ROW:
            raise EngineError(
                f"{self._in_a_row} workers ended one after the other before an episode did "
                f"({report.why}); adamo-vh doctor may know why. Nothing is lost."
            )
        for key in report.keys:
            if key in self._alone:
                self._deaths[key] += 1
            planned = self._taken(key)
            again = self._deaths[key] < _DEATHS
            if again:
                self._suspects.append(planned)
            self._end(planned, None, report.why, again=again)

    def _end(self, planned: Planned, outcome: Outcome | None, why: str, *, again: bool) -> None:
        if why:
            self._problems[planned.key] = why
        else:
            self._problems.pop(planned.key, None)
        self._tally.ended(planned.key, outcome)
        self._watcher.ended(planned, outcome, why, again=again)
