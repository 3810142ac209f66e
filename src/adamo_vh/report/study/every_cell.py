"""Every cell with its episodes: where all other numbers of a report lead."""

from __future__ import annotations

from dataclasses import dataclass

from adamo_vh.analysis.cells import CellRow, Setting, spelled
from adamo_vh.report.study.material import Material, shown_labeling, shown_scene
from adamo_vh.report.study.section import REPEAT, Section
from adamo_vh.report.study.table import Cell, Row, Table, text


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
        (
            "task",
            "completion",
            REPEAT,
            "strict",
            "model calls",
            "tokens",
            "variations",
            "n",
            "unscored",
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


def cell_rows(material: Material) -> Table:
    """All cells in one table, for programs."""
    rows = []
    for row in material.cells:
        found = row.figures
        rows.append(
            Row(
                (
                    text(row.setting.model),
                    text(row.setting.profile),
                    text(", ".join(f"{name}={value}" for name, value in row.setting.axes)),
                    text(row.scene),
                    text(row.labeling),
                    text(row.task),
                    text(spelled(row.variations)),
                    Cell(found.n, "count"),
                    Cell(found.unscored, "count"),
                    Cell(found.completion.mean, "share"),
                    Cell(found.completion.repeat, "share", why=found.why.repeat),
                    Cell(found.strict.mean, "share"),
                    Cell(found.strict.repeat, "share", why=found.why.repeat),
                    Cell(found.model_calls, "number"),
                    Cell(found.tokens, "tokens"),
                )
            )
        )
    return Table(
        "cells",
        "All cells",
        "Every cell of the study: all episodes that are alike but for repetition and variation.",
        (
            "model",
            "profile",
            "axes",
            "scene",
            "labeling",
            "task",
            "variations",
            "n",
            "unscored",
            "completion",
            REPEAT,
            "strict",
            f"strict: {REPEAT}",
            "model calls",
            "tokens",
        ),
        tuple(rows),
    )


def episode_rows(material: Material) -> Table:
    """All episodes in one table, for programs; each with where its record is."""
    rows = [
        Row(
            (
                text(one.key),
                text(one.model),
                text(one.profile),
                text(one.scene),
                text(one.labeling),
                text(one.task),
                Cell(one.variation, "count"),
                Cell(one.repetition, "count"),
                Cell(one.completion, "share"),
                Cell(one.strict, "share"),
                text(one.termination),
                text(one.diagnosis),
                text(one.diagnosis_code),
                Cell(one.steps, "count"),
                Cell(one.model_calls, "count"),
                Cell(one.usage.total_tokens, "tokens"),
                Cell(one.cost_usd, "dollars"),
                Cell(one.model_s, "seconds"),
                text(one.run),
            )
        )
        for one in material.outcomes
    ]
    return Table(
        "episodes",
        "All episodes",
        "One line for each episode.",
        (
            "episode",
            "model",
            "profile",
            "scene",
            "labeling",
            "task",
            "variation",
            "repetition",
            "completion",
            "strict",
            "ended by",
            "class",
            "code",
            "tool calls",
            "model calls",
            "tokens",
            "cost",
            "model s",
            "record",
        ),
        tuple(rows),
    )
