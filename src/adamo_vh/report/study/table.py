"""A table of a report: what stands in it, and how it is written, whatever the format."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from itertools import groupby
from types import MappingProxyType
from typing import Literal

from adamo_vh.analysis.statistics import Interval

Form = Literal[
    "text", "count", "number", "tokens", "share", "percent", "seconds", "dollars", "metres", "p"
]
"""How a value is written."""
NOTHING = "–"
"""Stands where a value is unknown, which is not 0."""
_MINUS = "\u2212"


def _dollars(value: float) -> str:
    return f"${value:,.2f}" if value >= 1 or value == 0 else f"${value:.4f}"


def _p(value: float) -> str:
    return "< 0.001" if value < 0.001 else f"{value:.3f}"


_FORMS: Mapping[str, Callable[[float], str]] = MappingProxyType(
    {
        "count": lambda value: f"{value:,.0f}",
        "number": lambda value: f"{value:,.2f}",
        "tokens": lambda value: f"{value:,.0f}",
        "share": lambda value: f"{value:.2f}",
        "percent": lambda value: f"{100 * value:.1f} %",
        "seconds": lambda value: f"{value:,.2f}",
        "dollars": _dollars,
        "metres": lambda value: f"{value:.2f}",
        "p": _p,
    }
)

Value = str | int | float | Interval | None


@dataclass(frozen=True, slots=True)
class Cell:
    """One value, and where it leads."""

    value: Value
    form: Form = "text"
    signed: bool = False
    """Write a plus before what is not negative."""
    href: str = ""
    """Where its episodes are: on the page itself, or in a run folder."""
    why: str = ""
    """Why there is no value."""

    @property
    def text(self) -> str:
        """As people read it."""
        if self.value is None:
            return NOTHING
        if isinstance(self.value, Interval):
            return f"{self._number(self.value.low)} to {self._number(self.value.high)}"
        return self.value if isinstance(self.value, str) else self._number(self.value)

    @property
    def is_interval(self) -> bool:
        """Whether it says how sure another one is."""
        return isinstance(self.value, Interval)

    @property
    def is_number(self) -> bool:
        """Whether it is set to the right, among its like."""
        return self.form != "text"

    def _number(self, value: float) -> str:
        if not math.isfinite(value):
            return NOTHING
        written = _FORMS[self.form](abs(value))
        if not any(digit in written for digit in "123456789"):
            return written  # What rounds to nothing has no sign.
        return f"{_MINUS if value < 0 else '+' if self.signed else ''}{written}"


@dataclass(frozen=True, slots=True)
class Chip:
    """One episode beside a row: a small mark that leads to its page."""

    title: str
    """What came of it."""
    score: float | None
    """Completion; None if it is unscored."""
    href: str
    """Empty if there is no page to lead to."""

    @property
    def kind(self) -> str:
        """Of its colour: unscored, nothing, less than half, most, all."""
        if self.score is None:
            return "cu"
        return f"c{(self.score > 0) + (self.score >= 0.5) + (self.score >= 1)}"


@dataclass(frozen=True, slots=True)
class Row:
    """One line of a table."""

    cells: tuple[Cell, ...]
    is_paper: bool = False
    """Whether these are figures of the paper, set apart from ours."""
    anchor: str = ""
    """By which links find it."""
    chips: tuple[Chip, ...] = ()
    """The episodes that it is made of."""
    more: int = 0
    """Episodes that have no chip, because there are too many."""


@dataclass(frozen=True, slots=True)
class Table:
    """A table that can be read without the text around it."""

    name: str
    """Of its file and its anchor."""
    title: str
    caption: str
    """What a newcomer must know to read it."""
    columns: tuple[str, ...]
    rows: tuple[Row, ...]
    is_grouped: bool = False
    """Whether rows that are alike in the first column belong together."""
    anchors: tuple[str, ...] = ()
    """By which links find it."""

    @property
    def blocks(self) -> tuple[tuple[Row, ...], ...]:
        """Its rows as they belong together."""
        if not self.is_grouped:
            return (self.rows,) if self.rows else ()
        return tuple(tuple(rows) for _, rows in groupby(self.rows, lambda row: row.cells[0].text))

    @property
    def notes(self) -> Mapping[str, str]:
        """Why values are missing: a letter for each reason."""
        reasons: dict[str, str] = {}
        for row in self.rows:
            for cell in row.cells:
                if cell.value is None and cell.why and cell.why not in reasons:
                    reasons[cell.why] = _letter(len(reasons))
        return reasons

    @property
    def numbers(self) -> tuple[bool, ...]:
        """Which columns hold numbers."""
        return tuple(
            any(row.cells[at].is_number for row in self.rows) for at in range(len(self.columns))
        )

    @property
    def has_chips(self) -> bool:
        """Whether episodes stand beside its rows."""
        return any(row.chips for row in self.rows)


def _letter(number: int) -> str:
    return chr(ord("a") + number) if number < 26 else f"a{number}"


def text(value: object, href: str = "") -> Cell:
    """A cell of words."""
    return Cell(str(value), href=href)


def heads(line: str) -> tuple[str, ...]:
    """The names of columns, from one line with bars between them."""
    return tuple(name.strip() for name in line.split("|"))
