"""Draws charts as SVG for the page: colours come from its style sheet, so that they turn dark.

Every chart is drawn for two widths, because text in a picture that shrinks cannot be read.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass

from markupsafe import Markup, escape

from adamo_vh.analysis.statistics import Interval
from adamo_vh.readable import readable
from adamo_vh.report.study.chart import Axis, Chart, Line, Panel, Series

_TONES = 8
_TOP_PX, _PLOT_PX = 12.0, 190.0
_LINE_PX = 30.0
_LETTER_PX = 6.4
"""Of a label, on average."""


def tone_class(tone: int) -> str:
    """The class of the style sheet that gives a colour."""
    return f"p{-1 - tone}" if tone < 0 else f"t{tone % _TONES}"


def drawn(chart: Chart, width_px: float) -> tuple[Markup, ...]:
    """A chart as SVG pictures: one for each panel, or one for all of its lines.

    Args:
        chart: The chart.
        width_px: Of each picture; it can be shown a little smaller or larger.
    """
    if chart.lines:
        return (_lines(chart, width_px),)
    return tuple(_panel(panel, width_px) for panel in chart.panels)


def _tag(name: str, *inside: Markup, **attributes: str | float) -> Markup:
    """An element; numbers are rounded to a tenth of a pixel."""
    written = Markup("").join(
        Markup(' {}="{}"').format(
            Markup(key.strip("_").replace("_", "-")),
            f"{value:.1f}" if isinstance(value, float) else readable(str(value)),
        )
        for key, value in attributes.items()
    )
    return Markup("<{0}{1}>{2}</{0}>").format(Markup(name), written, Markup("").join(inside))


def _text(words: str, x: float, y: float, kind: str, anchor: str = "middle") -> Markup:
    return _tag("text", escape(readable(words)), x=x, y=y, class_=kind, text_anchor=anchor)


def _titled(shape: Markup, title: str, href: str) -> Markup:
    """A shape that says what it is, and leads somewhere."""
    inside = (_tag("title", escape(readable(title))), shape) if title else (shape,)
    return _tag("a", *inside, href=href) if href else _tag("g", *inside)


def _picture(width: float, height: float, label: str, parts: Iterable[Markup]) -> Markup:
    box = f"0 0 {width:g} {height:g}"
    return _tag("svg", *parts, viewBox=box, width=width, height=height, role="img",
                aria_label=label)  # fmt: skip


@dataclass(frozen=True, slots=True)
class _Frame:
    """Where the axes of a panel stand, in pixels."""

    panel: Panel
    left: float
    right: float
    top: float
    bottom: float

    def x(self, value: float) -> float:
        return _on(self.panel.x, value, self.left, self.right)

    def y(self, value: float) -> float:
        return _on(self.panel.y, value, self.bottom, self.top)


def _on(axis: Axis, value: float, start: float, end: float) -> float:
    share = (value - axis.low) / (axis.high - axis.low)
    return start + min(max(share, 0.0), 1.0) * (end - start)


def _panel(panel: Panel, width: float) -> Markup:
    widest = max((len(name) for _, name in panel.y.ticks), default=1)
    left = 24.0 + _LETTER_PX * widest + 10.0
    frame = _Frame(panel, left, width - 8.0, _TOP_PX, _TOP_PX + _PLOT_PX)
    parts = [*_axes(frame), *_series(frame)]
    label = f"{panel.title or panel.y.label}: {panel.y.label} by {panel.x.label or 'task'}"
    return _picture(width, frame.bottom + (42.0 if panel.x.label else 24.0), label, parts)


def _axes(frame: _Frame) -> Iterator[Markup]:
    x, y = frame.panel.x, frame.panel.y
    for value, name in y.ticks:
        at = frame.y(value)
        kind = "zero" if value == 0 else "grid"
        yield _tag("line", x1=frame.left, x2=frame.right, y1=at, y2=at, class_=kind)
        yield _text(name, frame.left - 6.0, at + 4.0, "tick", "end")
    names = _fitting(x, frame.right - frame.left)
    for value, name in names:
        at = frame.x(value)
        if not x.is_places:
            yield _tag("line", x1=at, x2=at, y1=frame.bottom, y2=frame.bottom + 4, class_="grid")
        yield _text(name, at, frame.bottom + 17.0, "tick")
    middle = (frame.top + frame.bottom) / 2
    turn = f"rotate(-90 12 {middle:.1f})"
    yield _tag("text", escape(readable(y.label)), x=12.0, y=middle, class_="axis",
               text_anchor="middle", transform=turn)  # fmt: skip
    if x.label:
        yield _text(x.label, (frame.left + frame.right) / 2, frame.bottom + 36.0, "axis")


def _fitting(axis: Axis, room: float) -> list[tuple[float, str]]:
    """The ticks that have room: shorter where they begin alike, else every second, third, ..."""
    ticks = list(axis.ticks)
    if len(ticks) < 2:
        return ticks
    step = room * abs(ticks[1][0] - ticks[0][0]) / (axis.high - axis.low)
    if _LETTER_PX * max(len(name) for _, name in ticks) + 4 <= step:
        return ticks
    shown = max(1, round(step / _LETTER_PX))
    if all(name[:1] == "T" and name[1:].isdecimal() for _, name in ticks):
        ticks = [(value, name[1:]) for value, name in ticks]
    widest = _LETTER_PX * max(len(name) for _, name in ticks) + 4
    every = 1
    while every * step < widest and every < len(ticks) and every * step < room / 3:
        every += 1
    cut = max(shown * every, 3)
    return [(v, n if len(n) <= cut + 2 else f"{n[:cut]}…") for v, n in ticks[::every]]


def _series(frame: _Frame) -> Iterator[Markup]:
    series = frame.panel.series
    bars = [one for one in series if one.style == "bars"]
    for one in series:
        if one.style == "bars":
            yield _group(one, _bars(frame, one, bars.index(one), len(bars)))
        elif one.style == "marks":
            others = [s for s in series if s.style == "marks"]
            shift = (others.index(one) - (len(others) - 1) / 2) * 0.24
            yield _group(one, _marks(frame, one, shift))
        elif one.style == "line":
            yield _group(one, _line(frame, one))
        else:
            yield _group(one, _points(frame, one))


def _group(series: Series, shapes: Iterable[Markup]) -> Markup:
    return _tag("g", *shapes, class_=f"{series.style} {tone_class(series.tone)}")


def _bars(frame: _Frame, series: Series, place: int, count: int) -> Iterator[Markup]:
    room = (frame.x(1.0) - frame.x(0.0)) * 0.78
    wide = room / count
    for mark in series.marks:
        left = frame.x(mark.x) - room / 2 + place * wide
        zero, end = frame.y(0.0), frame.y(mark.y)
        top, tall = min(zero, end), max(abs(zero - end), 1.5)
        if zero - end >= 0 and tall == 1.5:
            top = zero - 1.5
        bar = _tag("rect", x=left + 0.5, y=top, width=max(wide - 1.0, 1.0), height=tall)
        whisker = _whisker(frame, left + wide / 2, mark.interval)
        yield _titled(bar + whisker, mark.title, mark.href)


def _whisker(frame: _Frame, x: float, interval: Interval | None) -> Markup:
    if interval is None:
        return Markup("")
    low, high = frame.y(interval.low), frame.y(interval.high)
    return _tag("line", x1=x, x2=x, y1=low, y2=high, class_="whisker")


def _marks(frame: _Frame, series: Series, shift: float) -> Iterator[Markup]:
    for mark in series.marks:
        x, y = frame.x(mark.x + shift), frame.y(mark.y)
        yield _titled(_shape(series.tone, x, y), mark.title, mark.href)


def _shape(tone: int, x: float, y: float) -> Markup:
    """The paper's first model is a diamond, its second a ring."""
    if tone == -1:
        return _tag("path", d=f"M{x:.1f} {y - 4.5:.1f}l4.5 4.5l-4.5 4.5l-4.5 -4.5z")
    return _tag("circle", cx=x, cy=y, r=3.6)


def _line(frame: _Frame, series: Series) -> Iterator[Markup]:
    points = [(frame.x(mark.x), frame.y(mark.y)) for mark in series.marks]
    if len(points) > 1:
        yield _tag("polyline", points=" ".join(f"{x:.1f},{y:.1f}" for x, y in points))
    small = len(points) > 12
    for mark, (x, y) in zip(series.marks, points, strict=True):
        whisker = _whisker(frame, x, mark.interval)
        dot = _tag("circle", cx=x, cy=y, r=2.2 if small else 4.0)
        yield _titled(whisker + dot, mark.title, mark.href)


def _points(frame: _Frame, series: Series) -> Iterator[Markup]:
    if series.fit:
        (x1, y1), (x2, y2) = series.fit
        yield _tag("line", x1=frame.x(x1), y1=frame.y(y1), x2=frame.x(x2), y2=frame.y(y2),
                   class_="fit")  # fmt: skip
    for mark in series.marks:
        x, y = frame.x(mark.x), frame.y(mark.y)
        yield _titled(_point(series.tone, x, y), mark.title, mark.href)


def _point(tone: int, x: float, y: float) -> Markup:
    if tone < 0:
        return _tag("path", d=f"M{x - 3.5:.1f} {y - 3.5:.1f}l7 7m0 -7l-7 7", class_="cross")
    return _tag("circle", cx=x, cy=y, r=4.2)


def _lines(chart: Chart, width: float) -> Markup:
    axis = chart.axis
    assert axis is not None
    longest = max(len(line.label) for line in chart.lines)
    beside = longest * _LETTER_PX + 14 <= 0.38 * width
    left = longest * _LETTER_PX + 14.0 if beside else 8.0
    step = _LINE_PX if beside else _LINE_PX + 18.0
    right, bottom = width - 18.0, 10.0 + step * len(chart.lines)

    def place(value: float) -> float:
        return _on(axis, value, left, right)

    parts = []
    for value, name in axis.ticks:
        at = place(value)
        parts.append(_tag("line", x1=at, x2=at, y1=6.0, y2=bottom, class_="grid"))
        parts.append(_text(name, at, bottom + 16.0, "tick"))
    parts.append(_text(axis.label, (left + right) / 2, bottom + 34.0, "axis"))
    for number, line in enumerate(chart.lines):
        y = 10.0 + step * (number + 1) - _LINE_PX / 2
        if beside:
            parts.append(_text(line.label, left - 10.0, y + 4.0, "name", "end"))
        else:
            cut = int((width - 16) / _LETTER_PX)
            label = line.label if len(line.label) <= cut else f"{line.label[: cut - 1]}…"
            parts.append(_text(label, left, y - 15.0, "name", "start"))
        parts.append(_divided(line, y, place) if line.parts else _span(line, y, place))
    return _picture(width, bottom + 42.0, chart.title, parts)


def _span(line: Line, y: float, place: Callable[[float], float]) -> Markup:
    shapes = []
    for interval, kind in ((line.outer, "outer"), (line.inner, "inner")):
        if interval is not None:
            ends = {"x1": place(interval.low), "x2": place(interval.high)}
            shapes.append(_tag("line", **ends, y1=y, y2=y, class_=kind))
    if line.value is not None:
        x = place(line.value)
        dot = _tag("circle", cx=x, cy=y, r=5.5) if line.tone >= 0 else _shape(line.tone, x, y)
        shapes.append(_titled(dot, f"{line.label}: {line.value:.2f}", line.href))
    return _tag("g", *shapes, class_=f"span {tone_class(line.tone)}")


def _divided(line: Line, y: float, place: Callable[[float], float]) -> Markup:
    shapes, done = [], 0.0
    for part in line.parts:
        left, right = place(done), place(done + part.share)
        done += part.share
        bar = _tag("rect", x=left, y=y - 9.0, width=max(right - left - 1.0, 0.8), height=18.0)
        words = f"{100 * part.share:.0f} %"
        wide = right - left > _LETTER_PX * len(words) + 4
        label = _text(words, (left + right) / 2, y + 4.0, "inside") if wide else Markup("")
        shape = _titled(bar + label, part.title, part.href)
        shapes.append(_tag("g", shape, class_=f"part {tone_class(part.tone)}"))
    return _tag("g", *shapes, class_="divided")
