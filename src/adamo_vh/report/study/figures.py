"""Draws charts with matplotlib, as PDF and SVG for a paper."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from importlib.util import find_spec
from pathlib import Path
from typing import Any

from adamo_vh.errors import ConfigError
from adamo_vh.files import make_folder, naming
from adamo_vh.readable import readable
from adamo_vh.report.study.chart import Axis, Chart, Line, Panel, Series

_WIDTH_IN = 7.0
"""Of a page with two columns."""
_TONES = (
    "#1f5fbf", "#c8500e", "#0e7f5c", "#8a3ea8", "#8f6b00", "#b3235e", "#2a7f9e", "#5b6470",
)  # fmt: skip
_PAPER = "#333333"
_STYLE: Any = {
    "font.family": "sans-serif",
    "font.size": 7.5,
    "axes.titlesize": 8,
    "axes.titleweight": "bold",
    "axes.titlelocation": "left",
    "axes.labelsize": 7.5,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.linewidth": 0.6,
    "axes.axisbelow": True,
    "axes.grid": True,
    "axes.grid.axis": "y",
    "grid.color": "#dddddd",
    "grid.linewidth": 0.5,
    "legend.frameon": False,
    "legend.fontsize": 7.5,
    "pdf.fonttype": 42,
    "svg.fonttype": "none",
    "svg.hashsalt": "adamo",
}


def check_plotting() -> None:
    """Make sure that figures can be drawn.

    Raises:
        ConfigError: matplotlib is not installed; says how to get it.
    """
    if find_spec("matplotlib") is None:
        raise ConfigError(
            "Figures for a paper need matplotlib: pip install 'adamo-vh[figures]'. The page of a "
            "report has its charts without it."
        )


def write_figures(charts: Iterable[Chart], folder: Path) -> list[Path]:
    """Draw charts into a folder, each as NAME.pdf and NAME.svg.

    Raises:
        ConfigError: matplotlib is not installed.
        FileError: A file cannot be written.
    """
    check_plotting()
    import matplotlib as mpl

    make_folder(folder)
    written = []
    with mpl.rc_context(_STYLE):
        for chart in charts:
            figure = _drawn(chart)
            for kind, nothing in (("pdf", {"CreationDate": None}), ("svg", {"Date": None})):
                path = folder / f"{chart.name}.{kind}"
                with naming("written", path):
                    figure.savefig(path, format=kind, metadata=nothing)
                written.append(path)
    return written


def _drawn(chart: Chart) -> Any:
    """A chart as a figure."""
    from matplotlib.figure import Figure

    if chart.lines:
        figure = Figure(figsize=(_WIDTH_IN, 0.75 + 0.27 * len(chart.lines)), layout="constrained")
        _lines(figure.subplots(), chart)
    else:
        columns = min(2, len(chart.panels))
        rows = -(-len(chart.panels) // columns)
        figure = Figure(figsize=(_WIDTH_IN, 0.4 + 1.95 * rows), layout="constrained")
        axes = figure.subplots(rows, columns, squeeze=False).ravel()
        for panel, at in zip(chart.panels, axes, strict=False):
            _panel(at, panel)
        for at in axes[len(chart.panels) :]:
            at.set_visible(False)
    _legend(figure, chart)
    return figure


def _legend(figure: Any, chart: Chart) -> None:
    from matplotlib.lines import Line2D
    from matplotlib.patches import Patch

    handles: list[Any] = []
    for name, tone, style in chart.legend:
        colour, label = _colour(tone), _plain(name)
        if style == "bars":
            handles.append(Patch(color=colour, label=label))
        elif style == "line":
            handles.append(Line2D([], [], color=colour, marker="o", markersize=3, label=label))
        else:
            handles.append(Line2D([], [], linestyle="", label=label, **_marker(tone, style)))
    if len(handles) > 1:
        figure.legend(handles=handles, loc="outside lower center", ncols=min(4, len(handles)))


def _plain(text: str) -> str:
    """A text that is no formula, whatever dollar signs stand in it."""
    return readable(text).replace("$", r"\$")


def _colour(tone: int) -> str:
    return _PAPER if tone < 0 else _TONES[tone % len(_TONES)]


def _marker(tone: int, style: str) -> dict[str, Any]:
    colour = _colour(tone)
    if style == "points" and tone < 0:
        return {"marker": "x", "color": colour, "markersize": 4}
    if style == "points":
        return {"marker": "o", "color": colour, "markersize": 4, "alpha": 0.8}
    shape = "D" if tone == -1 else "o"
    return {
        "marker": shape,
        "markersize": 3.5,
        "markerfacecolor": "white",
        "markeredgecolor": colour,
        "markeredgewidth": 0.8,
    }


def _panel(at: Any, panel: Panel) -> None:
    if panel.title:
        at.set_title(_plain(panel.title))
    _scale(at, "x", panel.x)
    _scale(at, "y", panel.y)
    if panel.y.low < 0:
        at.axhline(0, color="#888888", linewidth=0.6)
    bars = [one for one in panel.series if one.style == "bars"]
    marks = [one for one in panel.series if one.style == "marks"]
    for series in panel.series:
        if not series.marks:
            continue
        if series.style == "bars":
            _bars(at, series, bars.index(series), len(bars))
        elif series.style == "line":
            _line(at, series)
        else:
            shift = 0.24 * (marks.index(series) - (len(marks) - 1) / 2) if series in marks else 0.0
            xs = [mark.x + shift for mark in series.marks]
            ys = [mark.y for mark in series.marks]
            at.plot(xs, ys, linestyle="", clip_on=False, **_marker(series.tone, series.style))
        if series.fit:
            ends = list(zip(*series.fit, strict=True))
            at.plot(*ends, color=_colour(series.tone), linewidth=1, linestyle=(0, (4, 2)))


def _scale(at: Any, which: str, axis: Axis) -> None:
    setter = {"x": (at.set_xlim, at.set_xticks, at.set_xlabel)}.get(
        which, (at.set_ylim, at.set_yticks, at.set_ylabel)
    )
    setter[0](axis.low, axis.high)
    many = len(axis.ticks) > 8
    names = [
        _plain(name.removeprefix("T") if many and which == "x" else name) for _, name in axis.ticks
    ]
    setter[1]([value for value, _ in axis.ticks], names)
    setter[2](_plain(axis.label or ("task" if which == "x" else "")))


def _bars(at: Any, series: Series, place: int, count: int) -> None:
    wide = 0.78 / count
    xs = [mark.x - 0.39 + wide * (place + 0.5) for mark in series.marks]
    at.bar(xs, [mark.y for mark in series.marks], wide * 0.92, color=_colour(series.tone))
    for x, mark in zip(xs, series.marks, strict=True):
        if mark.interval is not None:
            at.vlines(x, mark.interval.low, mark.interval.high, color="black", linewidth=0.6)


def _line(at: Any, series: Series) -> None:
    xs, ys = [mark.x for mark in series.marks], [mark.y for mark in series.marks]
    size = 1.5 if len(xs) > 12 else 3
    colour = _colour(series.tone)
    at.plot(xs, ys, color=colour, linewidth=1.2, marker="o", markersize=size, clip_on=False)
    for mark in series.marks:
        if mark.interval is not None:
            at.vlines(mark.x, mark.interval.low, mark.interval.high, color=colour, linewidth=0.8)


def _lines(at: Any, chart: Chart) -> None:
    assert chart.axis is not None
    _scale(at, "x", chart.axis)
    at.grid(visible=True, axis="x")
    at.grid(visible=False, axis="y")
    at.set_ylim(len(chart.lines) - 0.4, -0.6)
    at.set_yticks(range(len(chart.lines)), [_plain(line.label) for line in chart.lines])
    at.tick_params(axis="y", length=0)
    for y, line in enumerate(chart.lines):
        if line.parts:
            _divided(at, y, line)
            continue
        colour = _colour(line.tone)
        for interval, width in ((line.outer, 0.8), (line.inner, 4.0)):
            if interval is not None:
                at.hlines(y, interval.low, interval.high, color=colour, linewidth=width,
                          alpha=1 if width < 1 else 0.45)  # fmt: skip
        if line.value is not None:
            style = _marker(line.tone, "points" if line.tone >= 0 else "marks")
            at.plot([line.value], [y], linestyle="", clip_on=False, **style)


def _divided(at: Any, y: int, line: Line) -> None:
    done = 0.0
    parts: Sequence[Any] = line.parts
    for part in parts:
        at.barh(y, part.share, 0.62, left=done, color=_colour(part.tone))
        if part.share > 0.06:
            at.text(done + part.share / 2, y, f"{100 * part.share:.0f} %", color="white",
                    ha="center", va="center", fontsize=6.5)  # fmt: skip
        done += part.share
