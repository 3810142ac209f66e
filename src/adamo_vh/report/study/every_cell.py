"""Every cell with its episodes: where all other numbers of a report lead."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from adamo_vh.analysis.cells import CellRow, Setting, spelled
from adamo_vh.analysis.outcome import Outcome
from adamo_vh.report.study.material import Material, shown_labeling, shown_scene
from adamo_vh.report.study.section import REPEAT, Section
from adamo_vh.report.study.table import Cell, Row, Table, heads, text


@dataclass(frozen=True, slots=True)
class _Group:
    """The cells of a setting in one scene under one labeling."""

    setting: Setting
    scene: str
    labeling: str


def every_cell(material: Material) -> Section:
    """One table for each setting, scene and labeling, with a mark for each episode."""
    played = {(row.setting, row.scene, row.labeling) for row in material.cells}
    tables = []
    for setting in material.settings:
        groups = [
            _Group(setting, scene, labeling)
            for labeling in material.labelings
            for scene in material.scenes
            if (setting, scene, labeling) in played
        ]
        tables += [_table(material, group, is_first=group is groups[0]) for group in groups]
    return Section(
        "cells",
        "Every cell and its episodes",
        "A cell is all episodes that are alike but for repetition and variation. Each small square "
        "is one episode, coloured by its completion from red (0) to green (1), grey if unscored; "
        "it leads to its page where one was made, else to its record.",
        tuple(tables),
    )


def _table(material: Material, group: _Group, *, is_first: bool) -> Table:
    rows = [
        _row(material, row)
        for task in material.tasks
        if (row := material.cell(group.setting, group.scene, group.labeling, task)) is not None
    ]
    anchors = [material.anchor(group.setting, group.scene, group.labeling)]
    if is_first:
        anchors.append(material.anchor(group.setting))
    what = (
        material.name(group.setting),
        shown_labeling(group.labeling),
        shown_scene(group.scene),
    )
    return Table(
        f"cells-{anchors[0]}",
        ", ".join(what),
        "Completion and strict score of each task, with the interval of its repetitions.",
        heads(
            "task | completion | would it repeat? | strict | model calls | tokens | "
            "variations | n | unscored"
        ),
        tuple(rows),
        anchors=tuple(anchors),
    )


def _row(material: Material, row: CellRow) -> Row:
    found = row.figures
    place = (row.setting, row.scene, row.labeling, row.task)
    chips, more = material.chips(material.by_cell[place])
    return Row(
        (
            text(row.task),
            Cell(found.completion.mean, "share", why="nothing is scored"),
            Cell(found.completion.repeat, "share", why=found.why.repeat),
            Cell(found.strict.mean, "share", why="nothing is scored"),
            Cell(found.model_calls, "number", why="nothing is scored"),
            Cell(found.tokens, "tokens", why="nothing is scored"),
            text(spelled(row.variations)),
            Cell(found.n, "count"),
            Cell(found.unscored, "count"),
        ),
        anchor=material.anchor(*place),
        chips=chips,
        more=more,
    )


_CELLS: tuple[tuple[str, Callable[[CellRow], Cell]], ...] = (
    ("model", lambda row: text(row.setting.model)),
    ("profile", lambda row: text(row.setting.profile)),
    ("axes", lambda row: text(", ".join(f"{n}={value}" for n, value in row.setting.axes))),
    ("scene", lambda row: text(row.scene)),
    ("labeling", lambda row: text(row.labeling)),
    ("task", lambda row: text(row.task)),
    ("variations", lambda row: text(spelled(row.variations))),
    ("n", lambda row: Cell(row.figures.n, "count")),
    ("unscored", lambda row: Cell(row.figures.unscored, "count")),
    ("completion", lambda row: Cell(row.figures.completion.mean, "share")),
    (REPEAT, lambda row: Cell(row.figures.completion.repeat, "share")),
    ("strict", lambda row: Cell(row.figures.strict.mean, "share")),
    (f"strict: {REPEAT}", lambda row: Cell(row.figures.strict.repeat, "share")),
    ("model calls", lambda row: Cell(row.figures.model_calls, "number")),
    ("tokens", lambda row: Cell(row.figures.tokens, "tokens")),
)
_EPISODES: tuple[tuple[str, Callable[[Outcome], Cell]], ...] = (
    ("episode", lambda one: text(one.key)),
    ("model", lambda one: text(one.model)),
    ("profile", lambda one: text(one.profile)),
    ("scene", lambda one: text(one.scene)),
    ("labeling", lambda one: text(one.labeling)),
    ("task", lambda one: text(one.task)),
    ("variation", lambda one: Cell(one.variation, "count")),
    ("repetition", lambda one: Cell(one.repetition, "count")),
    ("completion", lambda one: Cell(one.completion, "share")),
    ("strict", lambda one: Cell(one.strict, "share")),
    ("ended by", lambda one: text(one.termination)),
    ("class", lambda one: text(one.diagnosis)),
    ("code", lambda one: text(one.diagnosis_code)),
    ("tool calls", lambda one: Cell(one.steps, "count")),
    ("model calls", lambda one: Cell(one.model_calls, "count")),
    ("tokens", lambda one: Cell(one.usage.total_tokens, "tokens")),
    ("cost", lambda one: Cell(one.cost_usd, "dollars")),
    ("model s", lambda one: Cell(one.model_s, "seconds")),
    ("record", lambda one: text(one.run)),
)


def cell_rows(material: Material) -> Table:
    """All cells in one table, for programs."""
    rows = tuple(Row(tuple(of(row) for _, of in _CELLS)) for row in material.cells)
    caption = "All episodes that are alike but for repetition and variation."
    return Table("cells", "All cells", caption, tuple(name for name, _ in _CELLS), rows)


def episode_rows(material: Material) -> Table:
    """All episodes in one table, for programs; each with where its record is."""
    rows = tuple(Row(tuple(of(one) for _, of in _EPISODES)) for one in material.outcomes)
    caption = "One line for each episode."
    return Table("episodes", "All episodes", caption, tuple(name for name, _ in _EPISODES), rows)
