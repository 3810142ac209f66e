"""The index of a study: one row an episode, so that nobody has to read thousands of folders.

It holds nothing that the run folders do not: it can be deleted and made again.
"""

from __future__ import annotations

import sqlite3
from collections.abc import Iterable, Iterator
from contextlib import closing, contextmanager
from pathlib import Path

from adamo_vh.analysis.outcome import Outcome, outcome_json, read_outcome
from adamo_vh.errors import FileError, RecordError
from adamo_vh.files import cannot

INDEX = "index.sqlite"
_FORMAT = 1
_SCHEMA = """
CREATE TABLE IF NOT EXISTS outcomes (
    key TEXT PRIMARY KEY, scored INTEGER NOT NULL, outcome TEXT NOT NULL
) WITHOUT ROWID
"""


class Index:
    """The rows of a study's episodes, by key."""

    def __init__(self, folder: Path) -> None:
        """Name its place; nothing is opened before it is needed.

        Args:
            folder: The study's.
        """
        self.path = folder / INDEX

    def read(self) -> dict[str, Outcome]:
        """All rows; none if there is no index yet.

        Raises:
            RecordError: The file is damaged, or of another version; names what helps.
        """
        if not self.path.exists():
            return {}
        with self._opened(write=False) as database:
            rows = database.execute("SELECT key, outcome FROM outcomes ORDER BY key").fetchall()
        return {key: self._outcome(text) for key, text in rows}

    def put(self, outcomes: Iterable[Outcome]) -> None:
        """Add rows, or replace them; all of them or none.

        Raises:
            FileError: They cannot be written, e.g. because the disk is full.
        """
        rows = [(one.key, int(one.is_scored), outcome_json(one)) for one in outcomes]
        with self._opened(write=True) as database:
            database.executemany("INSERT OR REPLACE INTO outcomes VALUES (?, ?, ?)", rows)

    def drop(self, keys: Iterable[str]) -> None:
        """Take rows out."""
        with self._opened(write=True) as database:
            database.executemany("DELETE FROM outcomes WHERE key = ?", [(key,) for key in keys])

    def replace(self, outcomes: Iterable[Outcome]) -> None:
        """Make the index anew, whatever stands there; the old one stays if that fails.

        Raises:
            FileError: It cannot be written.
        """
        fresh = Index(self.path.parent)
        fresh.path = self.path.with_name(f".{INDEX}.part")
        fresh._remove()
        fresh.put(outcomes)
        self._remove(with_file=False)
        try:
            fresh.path.replace(self.path)
        except OSError as error:
            raise cannot("written", self.path, error) from error

    def _remove(self, *, with_file: bool = True) -> None:
        """Remove the file and what an interrupted write left beside it."""
        for suffix in (*([""] if with_file else []), "-journal"):
            try:
                self.path.with_name(self.path.name + suffix).unlink(missing_ok=True)
            except OSError as error:
                raise cannot("written", self.path, error) from error

    @contextmanager
    def _opened(self, *, write: bool) -> Iterator[sqlite3.Connection]:
        mode = "rwc" if write else "ro"
        try:
            target = f"{self.path.absolute().as_uri()}?mode={mode}"
            with closing(sqlite3.connect(target, uri=True, timeout=30)) as database, database:
                found = database.execute("PRAGMA user_version").fetchone()[0]
                if write and found == 0:
                    database.execute(_SCHEMA)
                    database.execute(f"PRAGMA user_version = {_FORMAT}")
                elif found != _FORMAT:
                    raise RecordError(
                        f"{self.path} is of another version (format {found}). {self._again}"
                    )
                yield database
        except sqlite3.OperationalError as error:
            if write or not _is_damage(error):
                raise FileError(
                    f"{self.path} cannot be {'written' if write else 'read'}: {error}. Make room "
                    "on the disk and see that the folder can be written; nothing is lost."
                ) from error
            raise self._damaged(error) from error
        except sqlite3.DatabaseError as error:
            raise self._damaged(error) from error

    def _outcome(self, text: str) -> Outcome:
        try:
            return read_outcome(text)
        except RecordError as error:
            raise self._damaged(error) from error

    def _damaged(self, error: Exception) -> RecordError:
        return RecordError(f"{self.path} is damaged ({str(error).rstrip('.')}). {self._again}")

    @property
    def _again(self) -> str:
        return (
            f"No episode is lost: it is made again from the run folders by adamo-vh reindex "
            f"{self.path.parent}"
        )


def _is_damage(error: sqlite3.OperationalError) -> bool:
    """Whether an error of the database means its content: a table that is not there."""
    return "no such table" in str(error) or "malformed" in str(error)
