"""What a further setting changes: one curve for each, beside the paper's ablation."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from adamo_vh.analysis.cells import Setting, natural
from adamo_vh.analysis.figures import Figures
from adamo_vh.analysis.paper.printed import ABLATIONS, Ablated
from adamo_vh.report.study.chart import Axis, Chart, Mark, Panel, Series, places, scale, shares
from adamo_vh.report.study.material import STUDY_AXIS, Material, names
from adamo_vh.report.study.section import OTHER_TASKS, REPEAT, Section, sure
from adamo_vh.report.study.table import Cell, Form, Row, Table, text

_WHAT: dict[str, str] = {
    "k": "how much the short-term memory holds: steps, or the original’s blocks",
    "switches.buffer_unit": "what k counts: whole steps, or the original’s blocks, where a picture "
    "counts beside its step",
    "sampling": "how freely the model draws its words",
    "grid": "how many reference points stand along each side of the picture",
    "resolution": "the size of the picture",
}
_SHORT_FORM = " T is the temperature, p is top-p."
Measure = tuple[str, Form, Callable[[Figures], float | None], Callable[[Ablated], float | None]]
_MEASURES: tuple[Measure, ...] = (
    ("Look + first", "number", lambda f: _plus(f.calls["Look"]), lambda p: p.look),
    ("model calls", "number", lambda f: f.model_calls, lambda p: p.model_calls),
    ("s/call", "seconds", lambda f: f.seconds_per_call, lambda p: p.seconds_per_call),
    ("tokens", "tokens", lambda f: f.tokens, lambda p: p.tokens),
    ("cut prompts", "number", lambda f: f.cut_prompts, lambda p: None),
)


def ablations(material: Material) -> Section | None:
    """A table and a chart for every axis that the study varies; None without any."""
    axes = axes_of(material)
    if not axes:
        return None
    blocks = [block for axis in axes for block in (_chart(material, axis), _table(material, axis))]
    return Section(
        "ablations",
        "What settings change",
        "One setting is varied at a time; all else stays as it is. The paper’s ablations are "
        "GPT-4o in S1 under SEM, with k = 50, 6 × 6 points, 1920 × 1080 and greedy decoding "
        "where nothing else is said.",
        tuple(blocks),
    )


def axes_of(material: Material) -> tuple[str, ...]:
    """The axes with more than one value."""
    values: dict[str, set[str]] = {}
    for setting in material.settings:
        for axis, value in setting.axes:
            if axis != STUDY_AXIS:
                values.setdefault(axis, set()).add(value)
    return tuple(axis for axis, found in sorted(values.items()) if len(found) > 1)


def _plus(look: float | None) -> float | None:
    return None if look is None else look + 1


def _value(setting: Setting, axis: str) -> str:
    return dict(setting.axes).get(axis, "")


def _groups(material: Material, axis: str) -> dict[str, list[Setting]]:
    """The settings that differ in this axis alone, by what they share."""
    rest = {
        setting: Setting(
            setting.model,
            setting.model_kind,
            setting.profile,
            tuple(item for item in setting.axes if item[0] != axis),
        )
        for setting in material.settings
        if _value(setting, axis)
    }
    called = names(tuple(dict.fromkeys(rest.values())))
    found: dict[str, list[Setting]] = {}
    for setting in sorted(rest, key=lambda s: natural(_value(s, axis))):
        found.setdefault(called[rest[setting]], []).append(setting)
    return found


def _values(material: Material, axis: str) -> list[str]:
    ours = {_value(setting, axis) for setting in material.settings} - {""}
    paper = {row.value for row in ABLATIONS.get(axis, ())}
    return sorted(ours | paper, key=natural)


def _table(material: Material, axis: str) -> Table:
    rows = []
    for name, settings in _groups(material, axis).items():
        for setting in settings:
            mean = material.mean(setting)
            if mean is None:
                continue
            found, link = mean.figures, material.link(setting)
            rows.append(
                Row(
                    (
                        text(name),
                        text(_value(setting, axis), href=link),
                        *sure(found.completion, found.why, link),
                        *(
                            Cell(of(found), form, why="nobody knows")
                            for _, form, of, _ in _MEASURES
                        ),
                        Cell(found.n, "count", href=link),
                    )
                )
            )
    unsaid = "the paper does not print it"
    for row in ABLATIONS.get(axis, ()):
        blank = Cell(None, why=unsaid)
        measures = (Cell(of(row), form, why=unsaid) for _, form, _, of in _MEASURES)
        cells = (Cell(row.completion, "share"), blank, blank, *measures, blank)
        rows.append(Row((text("GPT-4o (paper)"), text(row.value), *cells), is_paper=True))
    return Table(
        f"ablation-{axis}",
        f"Varied: {axis}",
        f"{axis} is {_WHAT.get(axis, 'a setting of the episode')}. Means over all episodes with "
        "each value, with both intervals of completion; the first view is counted in “Look + "
        "first”, as in the paper. Cut prompts no longer held every reply before.",
        (
            "model",
            axis,
            "completion",
            REPEAT,
            OTHER_TASKS,
            *(name for name, *_ in _MEASURES),
            "n",
        ),
        tuple(rows),
    )


def _chart(material: Material, axis: str) -> Chart:
    values, groups = _values(material, axis), _groups(material, axis)
    panels = [
        _panel(material, axis, values, groups, "completion"),
        *(_panel(material, axis, values, groups, name) for name, *_ in _MEASURES[1:]),
    ]
    return Chart(
        f"ablation-{axis}",
        f"Varied: {axis}",
        "Means over all episodes with each value; the lines on the points of completion are the "
        "95 % intervals of “would it repeat?”. Hollow marks are the paper’s."
        f"{_SHORT_FORM if axis == 'sampling' else ''}",
        panels=(panels[0], *(p for p in panels[1:] if _is_told(p))),
    )


def _is_told(panel: Panel) -> bool:
    """Whether a panel has anything to show: a model without tokens takes none with any setting."""
    return any(mark.y for one in panel.series for mark in one.marks)


def _short(value: str) -> str:
    """A value as there is room for it under a chart."""
    return value.replace("temperature=", "T=").replace("top_p=", "p=")


def _panel(
    material: Material,
    axis: str,
    values: Sequence[str],
    groups: dict[str, list[Setting]],
    what: str,
) -> Panel:
    series = []
    for tone, (name, settings) in enumerate(groups.items()):
        marks = [_mark(material, axis, values, setting, what) for setting in settings]
        series.append(Series(name, tone, "line", tuple(m for m in marks if m is not None)))
    paper = []
    for row in ABLATIONS.get(axis, ()):
        known = row.completion if what == "completion" else _measure(what)[3](row)
        if known is not None:
            title = f"{axis} {row.value}, GPT-4o (paper): {known:,.2f}"
            paper.append(Mark(values.index(row.value), known, title=title))
    series.append(Series("GPT-4o (paper)", -1, "marks", tuple(paper)))
    y = _axis(what, [mark.y for one in series for mark in one.marks])
    return Panel(what, places(map(_short, values), axis), y, tuple(series))


def _axis(what: str, values: Sequence[float]) -> Axis:
    return shares(what) if what == "completion" else scale(what, values)


def _mark(
    material: Material, axis: str, values: Sequence[str], setting: Setting, what: str
) -> Mark | None:
    row = material.mean(setting)
    if row is None:
        return None
    score = row.figures.completion
    found = score.mean if what == "completion" else _measure(what)[2](row.figures)
    if found is None:
        return None
    value = _value(setting, axis)
    title = f"{axis} {value}, {material.name(setting)}: {found:,.2f}"
    interval = score.repeat if what == "completion" else None
    return Mark(values.index(value), found, interval, title, material.link(setting))


def _measure(name: str) -> Measure:
    return next(measure for measure in _MEASURES if measure[0] == name)
