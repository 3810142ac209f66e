"""Task by task: the paper's figure and what is behind it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from adamo_vh.analysis.cells import Setting
from adamo_vh.analysis.outcome import Outcome
from adamo_vh.analysis.paper.printed import MODELS
from adamo_vh.analysis.paper.published import chosen
from adamo_vh.benchmark.taxonomy import COSTS, Act, Ref, Rel, Unit
from adamo_vh.report.study.chart import Chart, Mark, Panel, Series, places, shares
from adamo_vh.report.study.headline import paper_name, paper_tone
from adamo_vh.report.study.material import Material, builtin_task, shown_labeling, shown_scene
from adamo_vh.report.study.section import REPEAT, Section
from adamo_vh.report.study.table import Cell, Row, Table, heads, text

_MOST_BARS = 6
"""Settings that stand side by side in one panel."""


def per_task(material: Material) -> Section:
    """Completion of every task, by scene, labeling and setting, beside the paper's."""
    tables = [
        _table(material, labeling, scene)
        for labeling in material.labelings
        for scene in material.scenes
    ]
    return Section(
        "tasks",
        "Task by task",
        "Which tasks are done, and in which scene and under which labeling they are not.",
        (_chart(material), *(table for table in tables if table.rows)),
    )


def _chart(material: Material) -> Chart:
    several = [
        material.settings[at : at + _MOST_BARS]
        for at in range(0, len(material.settings), _MOST_BARS)
    ]
    panels = [
        _panel(material, labeling, scene, group)
        for labeling in material.labelings
        for scene in material.scenes
        for group in several
    ]
    return Chart(
        "tasks",
        "Completion of every task",
        "A bar is the mean completion of a task’s episodes; the line on it is the 95 % interval of "
        "“would it repeat?”. Hollow marks are the paper’s models. Tasks stand in the order of the "
        "paper, from C-D level 1 to 20.",
        panels=tuple(panel for panel in panels if any(s.marks for s in panel.series)),
    )


def _panel(material: Material, labeling: str, scene: str, group: Sequence[Setting]) -> Panel:
    series = []
    for setting in group:
        marks = []
        for place, task in enumerate(material.tasks):
            row = material.cell(setting, scene, labeling, task)
            if row is None or row.figures.completion.mean is None:
                continue
            score = row.figures.completion
            assert score.mean is not None
            link = material.link(setting, scene, labeling, task)
            title = f"{task}, {material.name(setting)}: {score.mean:.2f}"
            marks.append(Mark(place, score.mean, score.repeat, title, link))
        name, tone = material.name(setting), material.tone(setting)
        series.append(Series(name, tone, "bars", tuple(marks)))
    if any(one.marks for one in series):
        series += _paper_series(material, labeling, scene)
    title = f"{shown_labeling(labeling)}, {shown_scene(scene)}"
    return Panel(title, places(material.tasks), shares("completion"), tuple(series))


def _paper_series(material: Material, labeling: str, scene: str) -> list[Series]:
    found = []
    for model in MODELS:
        cells = {
            cell.task: cell.completion
            for cell in chosen(scenes=[scene], labelings=[labeling], model=model)
        }
        marks = [
            Mark(place, cells[task], title=f"{task}, {paper_name(model)}: {cells[task]:.2f}")
            for place, task in enumerate(material.tasks)
            if task in cells
        ]
        found.append(Series(paper_name(model), paper_tone(model), "marks", tuple(marks)))
    return found


def _table(material: Material, labeling: str, scene: str) -> Table:
    settings = [
        setting
        for setting in material.settings
        if any(material.cell(setting, scene, labeling, task) for task in material.tasks)
    ]
    paper = {
        model: {c.task: c for c in chosen(scenes=[scene], labelings=[labeling], model=model)}
        for model in MODELS
    }
    known = [model for model in MODELS if any(task in paper[model] for task in material.tasks)]
    rows = []
    for task in material.tasks if settings else ():
        cells = [text(task), *levels(_one(material, task))]
        for setting in settings:
            row = material.cell(setting, scene, labeling, task)
            link = material.link(setting, scene, labeling, task)
            score = row.figures.completion if row else None
            cells.append(Cell(score.mean if score else None, "share", href=link if row else ""))
            why = row.figures.why.repeat if row else "not played"
            cells.append(Cell(score.repeat if score else None, "share", why=why))
        for model in known:
            cell = paper[model].get(task)
            cells.append(Cell(cell.completion if cell else None, "share"))
        rows.append(Row(tuple(cells)))
    columns = ["task", "C-D printed", "C-D computed"]
    for setting in settings:
        columns += [material.name(setting), REPEAT]
    where = f"{shown_labeling(labeling)}, {shown_scene(scene)}"
    return Table(
        f"tasks-{material.short(labeling, scene)}",
        f"Completion by task: {where}",
        "Mean completion of each task’s episodes, with the 95 % interval of its repetitions. The "
        "C-D level says how hard a task is: as the paper prints it, and as its own rules give it.",
        (*columns, *map(paper_name, known)),
        tuple(rows),
    )


def _one(material: Material, task: str) -> Outcome:
    """Any episode of a task."""
    return next(outcome for outcome in material.outcomes if outcome.task == task)


def levels(outcome: Outcome) -> tuple[Cell, Cell]:
    """The C-D level of its task, as printed and as computed."""
    return (
        Cell(outcome.printed_level, "count", why="none of the paper’s tasks"),
        Cell(outcome.computed_level, "count", why="its units are unknown"),
    )


def what_is_asked(material: Material) -> Section:
    """The paper's table of tasks and its taxonomy."""
    return Section(
        "prompts",
        "What was asked",
        "",
        (_asked(material), _taxonomy()),
    )


def _asked(material: Material) -> Table:
    """What each task asks for, and how hard that is."""
    rows = []
    for name in material.tasks:
        one, task = _one(material, name), builtin_task(name)
        printed = task.printed if task else None
        rows.append(
            Row(
                (
                    text(name),
                    text(task.prompt if task else ""),
                    text(one.family),
                    Cell(len(task.conditions) if task else one.conditions or None, "count"),
                    Cell(printed.act if printed else None, "count"),
                    Cell(printed.ref if printed else None, "count"),
                    Cell(printed.rel if printed else None, "count"),
                    *levels(one),
                )
            )
        )
    return Table(
        "prompts",
        "The tasks and their C-D levels",
        "What the agent is told, and the Capability-Difficulty level: the sum of what the prompt "
        "asks for in actions (ACT), references (REF) and relations (REL). Three of the paper’s "
        "sums do not add up, and two references break its own rules, so the level that its rules "
        "give stands beside the printed one.",
        heads("task | prompt | family | conditions | ACT | REF | REL | C-D printed | C-D computed"),
        tuple(rows),
    )


_UNITS: Mapping[Unit, str] = {
    Act.PICK: "pick an object",
    Act.DROP: "release or place an object",
    Ref.ID: "a number, unique in the scene",
    Ref.TAG: "a semantic tag or name",
    Ref.COLOR: "a colour",
    Ref.SHAPE: "a shape",
    Ref.GROUP_SIMPLE: "a group, filtered by one criterion",
    Ref.PATTERN: "a pattern",
    Ref.SUPER_EXTREMUM: "a superlative: least or most of an attribute",
    Rel.FLOOR: "on the floor",
    Rel.PROX: "near another object",
    Rel.AREA: "within a designated area",
}


def _taxonomy() -> Table:
    rows = tuple(
        Row((text(type(unit).__name__.upper()), text(unit), text(what), Cell(COSTS[unit], "count")))
        for unit, what in _UNITS.items()
    )
    return Table(
        "taxonomy",
        "The C-D taxonomy",
        "What each unit of a prompt adds to its level. Walking and looking are not counted.",
        ("dimension", "unit", "what it asks for", "level"),
        rows,
    )
