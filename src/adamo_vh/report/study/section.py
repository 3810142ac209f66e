"""A part of a report: a heading, what it is about, and tables and charts."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from adamo_vh.analysis.figures import Scored, Why
from adamo_vh.analysis.paper.published import PublishedFigures
from adamo_vh.report.study.chart import Chart
from adamo_vh.report.study.table import Cell, Table


@dataclass(frozen=True, slots=True)
class Section:
    """One part of a report."""

    name: str
    """Of its anchor."""
    title: str
    lead: str
    """What question it answers."""
    blocks: tuple[Table | Chart, ...]
    remark: str = ""
    """Said instead, where there is nothing to show."""

    @property
    def tables(self) -> tuple[Table, ...]:
        """Its tables."""
        return tuple(block for block in self.blocks if isinstance(block, Table))

    @property
    def charts(self) -> tuple[Chart, ...]:
        """Its charts."""
        return tuple(block for block in self.blocks if isinstance(block, Chart))


REPEAT = "would it repeat?"
OTHER_TASKS = "other tasks?"
"""The two questions, and how columns are named after them."""
INTERVALS = (
    "Two 95 % intervals answer two questions. “Would it repeat?”: where the mean lies if the same "
    "episodes were played again. “Other tasks?”: where it would lie on other tasks like these."
)


def sure(score: Scored, why: Why, href: str = "") -> tuple[Cell, Cell, Cell]:
    """A mean and its two intervals, as cells."""
    return (
        Cell(score.mean, "share", href=href),
        Cell(score.repeat, "share", why=why.repeat),
        Cell(score.task, "share", why=why.task),
    )


def published_sure(found: PublishedFigures) -> tuple[Cell, Cell, Cell]:
    """The same of the paper's published cells."""
    return (
        Cell(found.completion, "share"),
        Cell(found.repeat, "share"),
        Cell(found.task, "share", why="a single task"),
    )


def blanks(count: int) -> Sequence[Cell]:
    """Cells of what the paper does not tell."""
    return [Cell(None, why="the paper does not tell")] * count
