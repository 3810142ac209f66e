"""How completion goes with the difficulty of the tasks."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace
from math import fsum

from adamo_vh.analysis.cells import Setting
from adamo_vh.analysis.paper.printed import MODELS, SPEARMAN
from adamo_vh.analysis.paper.published import PublishedCell, chosen
from adamo_vh.analysis.ranks import ALL, Level, Over, RankRow, rank_of, ranks
from adamo_vh.analysis.statistics import Rank
from adamo_vh.benchmark import tasks as benchmark_tasks
from adamo_vh.report.study.chart import Axis, Chart, Mark, Panel, Series, shares
from adamo_vh.report.study.material import Material, names, shown_labeling
from adamo_vh.report.study.section import Section
from adamo_vh.report.study.table import Cell, Row, Table, text

_COLUMNS: tuple[tuple[Level, Over], ...] = (
    ("printed", "tasks"),
    ("printed", "cells"),
    ("computed", "tasks"),
    ("computed", "cells"),
)
_LEVELS: tuple[Level, ...] = ("printed", "computed")


def levels(material: Material) -> Section:
    """Completion against C-D level, with a line and Spearman's correlation."""
    return Section(
        "levels",
        "Difficulty and completion",
        "The C-D level of a task adds up what its prompt asks for. The paper finds that completion "
        "falls as it rises.",
        (_chart(material), _table(material)),
    )


def _chart(material: Material) -> Chart:
    panels = [
        _panel(material, labeling, level) for labeling in material.labelings for level in _LEVELS
    ]
    return Chart(
        "levels",
        "C-D level and completion",
        "Each point is a task’s mean completion over the scenes played, at its C-D level as the "
        "paper prints it (left) and as its rules give it (right); the line is the least-squares "
        "fit. Crosses are the mean of the paper’s two models in its published data.",
        panels=tuple(panel for panel in panels if any(s.marks for s in panel.series)),
    )


def _panel(material: Material, labeling: str, level: Level) -> Panel:
    series = []
    for setting in material.settings:
        points = _points(material, setting, labeling, level)
        name, tone = material.name(setting), material.tone(setting)
        marks = tuple(
            Mark(x, y, title=f"{task}, {name}: level {x}, completion {y:.2f}")
            for task, x, y in points
        )
        series.append(Series(name, tone, "points", marks, fit([(m.x, m.y) for m in marks])))
    paper = _means(_paper_points(material, [labeling], level))
    marks = tuple(
        Mark(x, y, title=f"{task}, the paper’s models: level {x}, completion {y:.2f}")
        for task, x, y in paper
    )
    series.append(Series("paper", -1, "points", marks, fit([(m.x, m.y) for m in marks])))
    highest = max([20.0, *(mark.x for one in series for mark in one.marks)])
    ticks = tuple((float(x), f"{x}") for x in range(0, int(highest) + 1, 5))
    axis = Axis(f"C-D level, {level}", 0.0, highest + 1, ticks)
    title = f"{shown_labeling(labeling)}, {level} level"
    return Panel(title, axis, shares("completion"), tuple(series))


Point = tuple[str, int, float]


def _points(material: Material, setting: Setting, labeling: str, level: Level) -> list[Point]:
    found = []
    for row in material.cells:
        if row.setting != setting or row.labeling != labeling:
            continue
        one = material.by_cell[setting, row.scene, labeling, row.task][0]
        known = one.printed_level if level == "printed" else one.computed_level
        if known is not None and row.figures.completion.mean is not None:
            found.append((row.task, known, row.figures.completion.mean))
    return _means(found)


def _means(points: Iterable[Point]) -> list[Point]:
    """One point for each task."""
    tasks: dict[tuple[str, int], list[float]] = {}
    for task, level, value in points:
        tasks.setdefault((task, level), []).append(value)
    return [(task, level, fsum(v) / len(v)) for (task, level), v in tasks.items()]


def fit(points: Sequence[tuple[float, float]]) -> tuple[tuple[float, float], ...]:
    """The ends of the least-squares line through some points; none if there is no such line."""
    if len({x for x, _ in points}) < 2:
        return ()
    middle_x = fsum(x for x, _ in points) / len(points)
    middle_y = fsum(y for _, y in points) / len(points)
    spread = fsum((x - middle_x) ** 2 for x, _ in points)
    slope = fsum((x - middle_x) * (y - middle_y) for x, y in points) / spread
    ends = (min(x for x, _ in points), max(x for x, _ in points))
    return tuple((x, middle_y + slope * (x - middle_x)) for x in ends)


def _paper_points(material: Material, labelings: Sequence[str], level: Level) -> list[Point]:
    cells = chosen(scenes=material.scenes, labelings=labelings, tasks=material.tasks)
    return [(cell.task, _level(cell, level), cell.completion) for cell in cells]


def _level(cell: PublishedCell, level: Level) -> int:
    found = benchmark_tasks.task(cell.task)
    return found.printed.total if level == "printed" else found.computed.total


def _table(material: Material) -> Table:
    found: dict[tuple[Setting, str], list[RankRow]] = {}
    for one in ranks(material.outcomes):
        if one.labeling == ALL and len(material.labelings) == 1:
            continue  # It says the same again.
        found.setdefault((one.setting, one.labeling), []).append(one)
    # Models that were put together are told apart by profile and axes, as all others are.
    together = {
        setting: replace(setting, model=f"all {setting.model_kind} models")
        for setting, _ in found
        if setting.model == ALL
    }
    called = names(tuple(dict.fromkeys(together.values())))
    rows = []
    for (setting, labeling), of in found.items():
        by = {(one.level, one.over): one.rank for one in of}
        pooled = together.get(setting)
        name = called[pooled] if pooled else material.name(setting)
        head = (text(name), text("all" if labeling == ALL else shown_labeling(labeling)))
        rows.append(Row((*head, *_ranks([by[column] for column in _COLUMNS]))))
    for labeling in (*([ALL] if len(material.labelings) > 1 else []), *material.labelings):
        used = material.labelings if labeling == ALL else [labeling]
        points = {level: _paper_points(material, used, level) for level in _LEVELS}
        if not points["printed"]:
            continue
        both = " and ".join(MODELS.values())
        head = (
            text(f"{both} (paper), published"),
            text("all" if labeling == ALL else shown_labeling(labeling)),
        )
        correlations = [rank_of(points[level], over) for level, over in _COLUMNS]
        rows.append(Row((*head, *_ranks(correlations)), is_paper=True))
    unsaid = Cell(None, why="the paper prints one correlation and does not say over what")
    printed = (Cell(SPEARMAN, "share"), text("< 0.05"))
    rows.append(
        Row((text("the paper, printed"), text("SEM"), *printed, *([unsaid] * 8)), is_paper=True)
    )
    columns = [
        name for level, over in _COLUMNS for name in (f"ρ: {level}, {over}", f"p: {level}, {over}")
    ]
    return Table(
        "spearman",
        "Rank correlation of C-D level and completion",
        "Spearman’s ρ from -1 (the harder, the worse) to 1, and how often chance alone gives one "
        "as strong. Each over the tasks’ means and over all cells, with the printed and with the "
        "computed level. The paper’s own figure stands in the first columns; its published data "
        "gives a weaker one.",
        ("model", "labeling", *columns, "tasks", "cells"),
        tuple(rows),
        is_grouped=True,
    )


def _ranks(found: Sequence[Rank]) -> list[Cell]:
    why = "fewer than 3 points, or one of the two does not vary"
    cells = []
    for rank in found:
        cells += [Cell(rank.rho, "share", why=why), Cell(rank.p, "p", why=why)]
    return [*cells, Cell(found[0].n, "count"), Cell(found[1].n, "count")]
