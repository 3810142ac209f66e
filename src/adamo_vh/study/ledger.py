"""The budget of a whole study, shared by all processes that spend it.

What a call may cost is reserved before it is made, and set right when its answer is there. So the
cap is passed by no more than the error of the estimate, however many episodes are in flight. A call
whose process was killed counts with all that was reserved for it: the provider may have served it.
"""

from __future__ import annotations

import os
import socket
import sqlite3
import time
from collections.abc import Iterable, Iterator, Sequence
from contextlib import closing, contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Protocol

from adamo_vh.action import ToolSchema
from adamo_vh.analysis.outcome import Outcome
from adamo_vh.cognition.budget import Budget
from adamo_vh.errors import BudgetError, ConfigError, FileError, ModelError
from adamo_vh.inference.cost.prices import cost_usd
from adamo_vh.inference.cost.tokens import estimate_request, rule_for
from adamo_vh.inference.messages import Message
from adamo_vh.inference.model import Model, Reply, Sampling, Usage
from adamo_vh.inference.players.wrapper import Ask, Wrapped

LEDGER = "budget.sqlite"
"""Name of the file in a study's folder."""
_POLL_S = 0.2
_LOST_S = 1800.0
"""Seconds after which a call counts as lost whose end nobody told."""
_SCHEMA = """
CREATE TABLE IF NOT EXISTS calls (
    number INTEGER PRIMARY KEY, episode TEXT NOT NULL, host TEXT NOT NULL, pid INTEGER NOT NULL,
    begun REAL NOT NULL, is_open INTEGER NOT NULL, calls INTEGER NOT NULL, tokens INTEGER NOT NULL,
    usd REAL NOT NULL
)
"""


@dataclass(frozen=True, slots=True)
class Amount:
    """What is spent, or may be."""

    calls: int = 0
    tokens: int = 0
    usd: float = 0.0

    def __add__(self, other: Amount) -> Amount:
        return Amount(self.calls + other.calls, self.tokens + other.tokens, self.usd + other.usd)


def check_caps(budget: Budget) -> None:
    """Make sure that a budget can be that of a study.

    Raises:
        ConfigError: It caps the time, of which many episodes spend the same.
    """
    if budget.seconds is not None:
        raise ConfigError(
            "A study has no budget of seconds: cap tokens, usd or calls, or each episode by "
            "--set budget.seconds=..."
        )


class Purse(Protocol):
    """Is asked before a study spends anything."""

    def reserve(self, episode: str, most: Amount) -> int:
        """Reserve what a call may take; see `StudyLedger.reserve`."""
        ...

    def settle(self, number: int, took: Amount) -> None:
        """Put what a call took in place of what was reserved for it."""
        ...


class StudyLedger:
    """Reserves and counts what a study spends; any number of processes may share one file."""

    def __init__(self, folder: Path, budget: Budget | None = None) -> None:
        """Name the file.

        Args:
            folder: The study's.
            budget: The caps.
        """
        self._path = folder / LEDGER
        self._budget = budget or Budget()
        self._host = socket.gethostname()

    def begin(self, outcomes: Iterable[Outcome]) -> None:
        """Make the file, if there is none: with what earlier episodes have taken.

        Raises:
            FileError: It cannot be written.
        """
        if self._path.exists():
            return
        known = list(outcomes)
        before = Amount(
            sum(one.model_calls for one in known if one.cost_usd is not None),
            sum(one.usage.total_tokens for one in known),
            sum(one.cost_usd or 0.0 for one in known),
        )
        with self._changing() as database:
            if before.calls or before.tokens:
                self._insert(database, "before", before, is_open=False)

    @property
    def spent(self) -> Amount:
        """All so far, with what is reserved for calls that were lost."""
        with self._changing() as database:
            return self._sum(database, is_open=False)

    def reserve(self, episode: str, most: Amount) -> int:
        """Reserve what a call may take; waits for other calls if it fits only without theirs.

        Args:
            episode: Key of the episode.
            most: What the call may take.

        Returns:
            The number of the reservation, for `settle`.

        Raises:
            BudgetError: It does not fit any more; nothing may be asked.
            FileError: The file cannot be written.
        """
        while True:
            with self._changing() as database:
                self._close_lost(database)
                spent = self._sum(database, is_open=False)
                if why := self._beyond(spent, most):
                    raise BudgetError(f"The budget of the whole study is used up: {why}.")
                if not self._beyond(spent + self._sum(database, is_open=True), most):
                    return self._insert(database, episode, most, is_open=True)
            time.sleep(_POLL_S)

    def settle(self, number: int, took: Amount) -> None:
        """Put what a call took in place of what was reserved for it."""
        with self._changing() as database:
            database.execute(
                "UPDATE calls SET is_open = 0, calls = ?, tokens = ?, usd = ? WHERE number = ?",
                (took.calls, took.tokens, took.usd, number),
            )

    def _beyond(self, spent: Amount, most: Amount) -> str:
        """Why a call does not fit beside what is spent; empty if it does."""
        caps, total = self._budget, spent + most
        if caps.calls is not None and total.calls > caps.calls:
            return f"{spent.calls} of {caps.calls} model calls are used"
        if caps.tokens is not None and total.tokens > caps.tokens:
            return (
                f"{spent.tokens:,} of {caps.tokens:,} tokens are used, and the next call may take "
                f"{most.tokens:,}"
            )
        if caps.usd is not None and total.usd > caps.usd:
            return (
                f"{spent.usd:.4f} of {caps.usd:g} US dollars are used, and the next call may cost "
                f"{most.usd:.4f}"
            )
        return ""

    def _insert(
        self, database: sqlite3.Connection, episode: str, amount: Amount, *, is_open: bool
    ) -> int:
        row = database.execute(
            "INSERT INTO calls (episode, host, pid, begun, is_open, calls, tokens, usd) "
            "VALUES (?, ?, ?, ?, ?, ?, ?, ?)",
            (
                *(episode, self._host, os.getpid(), time.time(), is_open),
                *(amount.calls, amount.tokens, amount.usd),
            ),
        )
        return row.lastrowid or 0

    def _sum(self, database: sqlite3.Connection, *, is_open: bool) -> Amount:
        calls, tokens, usd = database.execute(
            "SELECT total(calls), total(tokens), total(usd) FROM calls WHERE is_open = ?",
            (is_open,),
        ).fetchone()
        return Amount(int(calls), int(tokens), usd)

    def _close_lost(self, database: sqlite3.Connection) -> None:
        """Count what is reserved for calls whose process is gone as spent."""
        rows = database.execute(
            "SELECT number, host, pid, begun FROM calls WHERE is_open"
        ).fetchall()
        for number, host, pid, begun in rows:
            dead = host == self._host and not _is_alive(pid)
            if dead or time.time() - begun > _LOST_S:
                database.execute("UPDATE calls SET is_open = 0 WHERE number = ?", (number,))

    @contextmanager
    def _changing(self) -> Iterator[sqlite3.Connection]:
        """The database, changed by nobody else meanwhile."""
        try:
            with closing(
                sqlite3.connect(self._path, timeout=60.0, isolation_level=None)
            ) as database:
                database.execute(_SCHEMA)
                database.execute("BEGIN IMMEDIATE")
                yield database
                database.execute("COMMIT")
        except sqlite3.Error as error:
            raise FileError(
                f"{self._path}, which holds what the study has spent, cannot be used: {error}. "
                "Make room on the disk; if it is damaged, move it away, and what the episodes have "
                "taken is counted anew."
            ) from error


def _is_alive(pid: int) -> bool:
    try:
        os.kill(pid, 0)
    except ProcessLookupError:
        return False
    except PermissionError:
        return True
    return True


def budgeted(model: Model, uri: str, episode: str, ledger: Purse) -> Model:
    """A model that asks a ledger before every call, and is not asked if the call does not fit.

    Args:
        model: Who answers.
        uri: Its URI, for prices and pictures.
        episode: Key of the episode.
        ledger: Of the study.
    """
    rule = rule_for(uri)

    def asked(
        ask: Ask, messages: Sequence[Message], tools: Sequence[ToolSchema], sampling: Sampling
    ) -> Reply:
        most = Usage(estimate_request(messages, tools, rule), sampling.max_tokens)
        expected = Amount(1, most.total_tokens, cost_usd(uri, most) or 0.0)
        number = ledger.reserve(episode, expected)
        try:
            reply = ask(messages, tools, sampling)
        except ModelError as error:
            lost = error.spent
            took = (
                Amount()
                if lost is None
                else Amount(1, lost.usage.total_tokens, lost.cost_usd or 0.0)
            )
            ledger.settle(number, took)
            raise
        ledger.settle(number, Amount(1, reply.usage.total_tokens, reply.cost_usd or 0.0))
        return reply

    return Wrapped(model, asked)
