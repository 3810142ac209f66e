"""One pace for all processes of a machine that ask the same provider.

A provider counts the requests of an account, not those of a process. So every request takes leave
in one small SQLite file: so many at once, so many a minute, so many tokens a minute. How many at
once is also learned: a provider that answers "too many requests" is asked by half as many from then
on, and by slowly more again while it does not complain. What it says about when to come back holds
for everybody. A process that was killed holds nothing for long.

Libraries for rate limits know fixed rates alone: neither what is in flight, nor what a request took
in the end, nor what a provider asks for.
"""

from __future__ import annotations

import os
import random
import socket
import sqlite3
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

from adamo_vh.errors import ConfigError, FileError
from adamo_vh.inference.remote.gate import Ticket
from adamo_vh.inference.remote.retry import Failure

LIMITS = "limits.sqlite"
"""Name of the file in a study's folder."""
_WINDOW_S = 60.0
_MOST = 256.0
"""Requests at once, where nobody says."""
_LOST_S = 900.0
"""Seconds after which a request counts as ended whose end nobody told."""
_POLL_S = 0.1, 1.0
"""Least and most seconds between two looks."""
_TOO_MANY = frozenset({429, 503, 529})
"""HTTP statuses by which a provider says that it is asked too much."""
_SCHEMA = """
CREATE TABLE IF NOT EXISTS providers (
    provider TEXT PRIMARY KEY, allowed REAL NOT NULL, cut REAL NOT NULL, back REAL NOT NULL
);
CREATE TABLE IF NOT EXISTS requests (
    number INTEGER PRIMARY KEY, provider TEXT NOT NULL, host TEXT NOT NULL, pid INTEGER NOT NULL,
    begun REAL NOT NULL, ended REAL, tokens INTEGER NOT NULL
);
"""


@dataclass(frozen=True, slots=True)
class Rates:
    """How much each provider may be asked, by all processes together; None is no limit."""

    concurrent: int | None = None
    """Requests at once."""
    requests: int | None = None
    """Requests a minute."""
    tokens: int | None = None
    """Tokens a minute, input and output together."""

    def __post_init__(self) -> None:
        """Refuse what nothing could ever go through."""
        for name in ("concurrent", "requests", "tokens"):
            value = getattr(self, name)
            if value is not None and value < 1:
                raise ConfigError(f"the limit of {name} is {value}: use a whole number from 1.")


class Limiter:
    """Gives leave to ask a provider. Implements `adamo_vh.inference.remote.gate.Gate`.

    Any number of threads and processes may share one file.
    """

    def __init__(self, path: Path, rates: Rates | None = None) -> None:
        """Name the file that processes share; it is made when the first request is.

        Args:
            path: On a disk of this machine.
            rates: The limits; what a provider says about itself is heeded in any case.
        """
        self._path = path
        self._rates = rates or Rates()
        self._most = float(self._rates.concurrent or _MOST)
        self._host = socket.gethostname()
        self._lock = threading.Lock()
        self._database: sqlite3.Connection | None = None

    def acquire(self, provider: str, tokens: int) -> Ticket:
        """Wait for leave to make a request; see `Gate`.

        Raises:
            FileError: The file cannot be written, or is another one.
        """
        asked = time.monotonic()
        while True:
            with self._changing() as database:
                now = time.time()
                pause_s = self._pause_s(database, provider, tokens, now)
                if pause_s <= 0:
                    number = database.execute(
                        "INSERT INTO requests (provider, host, pid, begun, tokens) "
                        "VALUES (?, ?, ?, ?, ?)",
                        (provider, self._host, os.getpid(), now, tokens),
                    ).lastrowid
                    return Ticket(number or 0, provider, time.monotonic() - asked)
            # Who waits for the same moment must not come at the same moment.
            least, most = _POLL_S
            time.sleep(min(max(pause_s, least), most) * random.uniform(0.5, 1.0))

    def settle(self, ticket: Ticket, tokens: int, failure: Failure | None = None) -> None:
        """Say that a request has ended; see `Gate`."""
        with self._changing() as database:
            now = time.time()
            row = database.execute(
                "SELECT begun FROM requests WHERE number = ?", (ticket.number,)
            ).fetchone()
            database.execute(
                "UPDATE requests SET ended = ?, tokens = ? WHERE number = ?",
                (now, tokens, ticket.number),
            )
            allowed, cut, back = self._pace(database, ticket.provider)
            if failure is None:
                allowed += 1.0 / allowed
            elif failure.status in _TOO_MANY:
                back = max(back, now + (failure.retry_after_s or 0.0))
                # Those that were on their way at the last cut say nothing about the pace since.
                if row is not None and row[0] > cut:
                    at_once = 1 + self._count(database, ticket.provider)
                    allowed, cut = min(allowed, at_once) / 2, now
            database.execute(
                "INSERT OR REPLACE INTO providers VALUES (?, ?, ?, ?)",
                (ticket.provider, min(max(allowed, 1.0), self._most), cut, back),
            )

    def allowed(self, provider: str) -> int:
        """How many requests a provider may get at once now."""
        with self._changing() as database:
            return int(self._pace(database, provider)[0])

    def close(self) -> None:
        """Close the file."""
        with self._lock:
            if self._database is not None:
                self._database.close()
                self._database = None

    def _pause_s(
        self, database: sqlite3.Connection, provider: str, tokens: int, now: float
    ) -> float:
        """Seconds until there may be leave; 0 if there is."""
        self._forget(database, now)
        allowed, _, back = self._pace(database, provider)
        if back > now:
            return back - now
        if self._count(database, provider) >= int(allowed):
            return _POLL_S[0]
        begun, count, taken = database.execute(
            "SELECT min(begun), count(*), total(tokens) FROM requests "
            "WHERE provider = ? AND begun > ?",
            (provider, now - _WINDOW_S),
        ).fetchone()
        most, most_tokens = self._rates.requests, self._rates.tokens
        too_many = most is not None and count >= most
        # A request that is larger than the limit has to go some time: alone.
        too_much = most_tokens is not None and count > 0 and taken + tokens > most_tokens
        return float(begun + _WINDOW_S - now) if too_many or too_much else 0.0

    def _pace(self, database: sqlite3.Connection, provider: str) -> tuple[float, float, float]:
        """Requests at once, when that was cut, and when the provider may be asked again."""
        row = database.execute(
            "SELECT allowed, cut, back FROM providers WHERE provider = ?", (provider,)
        ).fetchone()
        return (self._most, 0.0, 0.0) if row is None else (min(row[0], self._most), row[1], row[2])

    def _count(self, database: sqlite3.Connection, provider: str) -> int:
        """Requests on their way."""
        found = database.execute(
            "SELECT count(*) FROM requests WHERE provider = ? AND ended IS NULL", (provider,)
        ).fetchone()
        return int(found[0])

    def _forget(self, database: sqlite3.Connection, now: float) -> None:
        """Drop what is long ago, and end what a process left that is gone."""
        database.execute(
            "DELETE FROM requests WHERE ended IS NOT NULL AND begun <= ?", (now - _WINDOW_S,)
        )
        open_ = database.execute(
            "SELECT number, host, pid, begun FROM requests WHERE ended IS NULL"
        ).fetchall()
        lost = [
            (now, number)
            for number, host, pid, begun in open_
            if now - begun > _LOST_S or (host == self._host and not _is_alive(pid))
        ]
        database.executemany("UPDATE requests SET ended = ? WHERE number = ?", lost)

    @contextmanager
    def _changing(self) -> Iterator[sqlite3.Connection]:
        """The database, changed by nobody else meanwhile."""
        with self._lock, self._faults():
            if self._database is None:
                self._database = self._opened()
            self._database.execute("BEGIN IMMEDIATE")
            try:
                yield self._database
            finally:
                self._database.execute("COMMIT")

    def _opened(self) -> sqlite3.Connection:
        # Threads take turns at it.
        database = sqlite3.connect(
            self._path, timeout=60.0, isolation_level=None, check_same_thread=False
        )
        # What is in it is worth nothing after a crash of the machine.
        database.execute("PRAGMA synchronous = OFF")
        database.executescript(_SCHEMA)
        return database

    @contextmanager
    def _faults(self) -> Iterator[None]:
        try:
            yield
        except sqlite3.Error as error:
            raise FileError(
                f"{self._path}, by which processes share a provider's limits, cannot be used: "
                f"{error}. It may be deleted while nothing runs."
            ) from error


def _is_alive(pid: int) -> bool:
    try:
        os.kill(pid, 0)
    except ProcessLookupError:
        return False
    except PermissionError:
        return True
    return True
