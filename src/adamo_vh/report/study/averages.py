"""The paper's table of averages: by labeling, by scene, and by task family."""

from __future__ import annotations

from collections.abc import Iterable

from adamo_vh.analysis.cells import MeanRow, Setting, natural
from adamo_vh.analysis.paper.printed import AVERAGES, BACKBONES
from adamo_vh.analysis.paper.published import chosen, published_figures
from adamo_vh.report.study.headline import paper_name
from adamo_vh.report.study.material import Material, shown_labeling, shown_scene
from adamo_vh.report.study.section import Section, published_sure, sure
from adamo_vh.report.study.table import Cell, Row, Table, heads, text

_NOT_PRINTED = "the paper does not print it"


def averages(material: Material) -> Section:
    """Means by labeling and scene as in the paper, and by task family."""
    return Section(
        "averages",
        "Averages, as in the paper",
        "The paper’s table of averages for the models played here, with the paper’s own rows: as "
        "it prints them, and as the data that its authors published gives them.",
        (_table(material), _families(material)),
    )


def _blocks(material: Material) -> Iterable[tuple[str, str]]:
    """Labeling and scene of each block of the table; empty is all."""
    if len(material.labelings) > 1:
        yield "", ""
    for labeling in material.labelings:
        yield labeling, ""
    if len(material.scenes) > 1:
        for labeling in material.labelings:
            for scene in material.scenes:
                yield labeling, scene


def _table(material: Material) -> Table:
    rows: list[Row] = []
    for labeling, scene in _blocks(material):
        where = {"scene": scene, "labeling": labeling}
        named = {name: value for name, value in where.items() if value}
        what = ", ".join(
            [
                shown_labeling(labeling) if labeling else "all labelings",
                *([shown_scene(scene)] if scene else []),
            ]
        )
        for setting in material.settings:
            mean = material.mean(setting, **named)
            if mean is not None:
                rows.append(_ours(material, setting, what, mean))
        rows += _published(material, what, labeling, scene)
        rows += _printed(what, labeling, scene)
    return Table(
        "averages",
        "Averages by labeling and scene",
        "Means over tasks and episodes. Tool calls are per episode; the first view, which nobody "
        "asks for, is left out of Look and Total, and counted in “Look + first”, as the paper "
        "prints it. Rows “published” are means of the cells that its authors published, over the "
        "scenes and tasks of this study; rows “printed” stand in the paper, over all of its tasks.",
        heads(
            "cells | model | completion | would it repeat? | other tasks? | s/call | "
            "Walk | Look | Look + first | Pick | Drop | Total | n"
        ),
        tuple(rows),
        is_grouped=True,
    )


def _ours(material: Material, setting: Setting, what: str, mean: MeanRow) -> Row:
    found = mean.figures
    link = material.link(setting, mean.of("scene") or "", mean.of("labeling") or "")
    calls = found.calls
    return Row(
        (
            text(what),
            text(material.name(setting), href=link),
            *sure(found.completion, found.why, link),
            Cell(found.seconds_per_call, "seconds"),
            *_calls(calls["Walk"], calls["Look"], calls["Pick"], calls["Drop"], calls["total"]),
            Cell(found.n, "count", href=link),
        )
    )


def _calls(
    walk: float | None,
    look: float | None,
    pick: float | None,
    drop: float | None,
    total: float | None,
) -> tuple[Cell, ...]:
    """Tool calls an episode; Look once more with the first view, which nobody asks for."""
    with_first = None if look is None else look + 1
    return tuple(Cell(count, "number") for count in (walk, look, with_first, pick, drop, total))


def _published(material: Material, what: str, labeling: str, scene: str) -> list[Row]:
    cells = chosen(
        scenes=[scene] if scene else material.scenes,
        labelings=[labeling] if labeling else material.labelings,
        tasks=material.tasks,
    )
    return [
        Row(
            (
                text(what),
                text(f"{paper_name(found.model)}, published"),
                *published_sure(found),
                Cell(found.seconds_per_call, "seconds"),
                *_calls(found.walk, found.look, found.pick, found.drop, found.tool_calls),
                Cell(found.n, "count"),
            ),
            is_paper=True,
        )
        for found in published_figures(cells)
    ]


def _printed(what: str, labeling: str, scene: str) -> list[Row]:
    blank = Cell(None, why=_NOT_PRINTED)
    if not labeling and not scene:
        return [
            Row(
                (
                    text(what),
                    text(f"{paper_name(model)}, printed"),
                    *(Cell(completion, "share"), blank, blank),
                    Cell(seconds, "seconds"),
                    *([blank] * 5),
                    Cell(total, "number"),
                    blank,
                ),
                is_paper=True,
            )
            for model, (completion, seconds, total) in BACKBONES.items()
        ]
    return [
        Row(
            (
                text(what),
                text(f"{paper_name(row.model)}, printed"),
                *(Cell(row.completion, "share"), blank, blank),
                Cell(row.seconds_per_call, "seconds"),
                Cell(row.walk, "number"),
                blank,
                Cell(row.look, "number"),
                *(blank, blank),
                Cell(row.total, "number"),
                blank,
            ),
            is_paper=True,
        )
        for row in AVERAGES
        if row.labeling == labeling and (row.scene or "") == scene
    ]


def _families(material: Material) -> Table:
    tasks: dict[str, set[str]] = {}
    for outcome in material.outcomes:
        if outcome.family:
            tasks.setdefault(outcome.family, set()).add(outcome.task)
    rows: list[Row] = []
    for family in sorted(tasks, key=lambda name: min(map(natural, tasks[name]))):
        for setting in material.settings:
            mean = material.mean(setting, family=family)
            if mean is None:
                continue
            found, link = mean.figures, material.link(setting)
            head = (text(family), text(material.name(setting), href=link))
            scores = (
                *sure(found.completion, found.why, link),
                Cell(found.strict.mean, "share"),
                Cell(found.model_calls, "number"),
                Cell(found.tokens, "tokens"),
                Cell(found.n, "count"),
            )
            rows.append(Row((*head, *scores)))
        cells = chosen(scenes=material.scenes, labelings=material.labelings, tasks=tasks[family])
        for model in published_figures(cells):
            head = (text(family), text(paper_name(model.model)))
            known = (Cell(model.model_calls, "number"), Cell(model.tokens, "tokens"))
            blank = Cell(None, why="the paper has no strict score")
            counts = (blank, *known, Cell(model.n, "count"))
            rows.append(Row((*head, *published_sure(model), *counts), is_paper=True))
    return Table(
        "families",
        "Averages by task family",
        "The paper’s families of tasks, from picking a single object to long tasks that need "
        "attributes. Over all scenes and labelings of this study; model calls and tokens are per "
        "episode.",
        heads(
            "family | model | completion | would it repeat? | other tasks? | strict | "
            "model calls | tokens | n"
        ),
        tuple(rows),
        is_grouped=True,
    )
