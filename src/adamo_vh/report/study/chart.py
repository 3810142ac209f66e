"""A chart of a report as data: drawn into the page as SVG, and by matplotlib for a paper."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Literal

from adamo_vh.analysis.statistics import Interval

Style = Literal["bars", "points", "line", "marks"]
"""Bars side by side; loose points; points on a line; a mark beside the bars, for comparison."""


@dataclass(frozen=True, slots=True)
class Mark:
    """One value."""

    x: float
    """Along the axis; the number of a place, where the axis has places."""
    y: float
    interval: Interval | None = None
    title: str = ""
    """What it is, in words."""
    href: str = ""


@dataclass(frozen=True, slots=True)
class Series:
    """Values that belong together."""

    name: str
    tone: int
    """Number of its colour; below 0 for the paper's."""
    style: Style
    marks: tuple[Mark, ...]
    fit: tuple[tuple[float, float], ...] = ()
    """Ends of a straight line through them."""


@dataclass(frozen=True, slots=True)
class Axis:
    """One direction of a chart."""

    label: str
    low: float
    high: float
    ticks: tuple[tuple[float, str], ...]
    is_places: bool = False
    """Whether its ticks are places side by side, and not a scale."""


@dataclass(frozen=True, slots=True)
class Panel:
    """One pair of axes."""

    title: str
    x: Axis
    y: Axis
    series: tuple[Series, ...]


@dataclass(frozen=True, slots=True)
class Part:
    """One piece of a bar that is divided."""

    name: str
    tone: int
    share: float
    title: str = ""
    href: str = ""


@dataclass(frozen=True, slots=True)
class Line:
    """One line of a chart of rows: a value with its intervals, or a divided bar."""

    label: str
    tone: int = 0
    value: float | None = None
    inner: Interval | None = None
    """Drawn thick: would it repeat?"""
    outer: Interval | None = None
    """Drawn thin: would it hold for other tasks?"""
    parts: tuple[Part, ...] = ()
    href: str = ""


@dataclass(frozen=True, slots=True)
class Chart:
    """A chart that can be read without the text around it: panels, or rows on one axis."""

    name: str
    """Of its files and its anchor."""
    title: str
    caption: str
    panels: tuple[Panel, ...] = ()
    lines: tuple[Line, ...] = ()
    axis: Axis | None = None
    """Of the lines."""

    @property
    def legend(self) -> tuple[tuple[str, int, Style], ...]:
        """Name, tone and style of each series or part, once."""
        series = [(s.name, s.tone, s.style) for p in self.panels for s in p.series if s.marks]
        parts: list[tuple[str, int, Style]] = [
            (part.name, part.tone, "bars") for line in self.lines for part in line.parts
        ]
        return tuple(dict.fromkeys([*series, *parts]))


def places(labels: Iterable[str], label: str = "") -> Axis:
    """An axis of places side by side."""
    ticks = tuple((float(number), name) for number, name in enumerate(labels))
    return Axis(label, -0.5, max(len(ticks), 1) - 0.5, ticks, is_places=True)


def shares(label: str, low: float = 0.0) -> Axis:
    """An axis from 0 to 1, or from below."""
    ticks = [-1.0, -0.75, -0.5, -0.25, 0.0, 0.25, 0.5, 0.75, 1.0]
    shown = tuple((tick, f"{tick:g}".replace("-", "\u2212")) for tick in ticks if tick >= low)
    return Axis(label, low, 1.0, shown)


def scale(label: str, values: Iterable[float], *, from_zero: bool = True) -> Axis:
    """An axis that holds some values, with round ticks."""
    found = [0.0, *values] if from_zero else list(values)
    low, high = min(found, default=0.0), max(found, default=1.0)
    if high <= low:
        high = low + 1.0
    step = _round_step((high - low) / 4)
    first, last = int(low // step), -int(-high // step)
    ticks = tuple((n * step, _number(n * step)) for n in range(first, last + 1))
    return Axis(label, first * step, last * step, ticks)


def _round_step(rough: float) -> float:
    """The next of 1, 2 and 5 times a power of ten."""
    power = 1.0
    while power > rough:
        power /= 10
    while power * 10 <= rough:
        power *= 10
    return next(power * times for times in (1, 2, 5, 10) if power * times >= rough)


def _number(value: float) -> str:
    if abs(value) >= 10_000:
        return f"{value / 1000:,.0f}k"
    return f"{value:,.6g}".replace("-", "\u2212")
