"""The headline: how good each setting is, and how sure that is."""

from __future__ import annotations

from adamo_vh.analysis.paper.printed import MODELS
from adamo_vh.analysis.paper.published import PublishedFigures, chosen, published_figures
from adamo_vh.report.study.chart import Chart, Line, shares
from adamo_vh.report.study.material import Material
from adamo_vh.report.study.section import (
    INTERVALS,
    Section,
    blanks,
    published_sure,
    sure,
)
from adamo_vh.report.study.table import Cell, Row, Table, heads, text


def headline(material: Material) -> Section:
    """Completion and strict of every setting, beside the paper's models on the same cells."""
    paper = same_cells(material)
    return Section(
        "headline",
        "How good, and how sure",
        "Each task counts once, whatever number of episodes it has. Episodes that a fault of ours "
        "or of a provider ended are unscored: they are in no figure.",
        (_table(material, paper), _chart(material, paper)),
    )


def same_cells(material: Material) -> tuple[PublishedFigures, ...]:
    """The paper's models on the scenes, labelings and tasks that were played here."""
    return published_figures(
        chosen(scenes=material.scenes, labelings=material.labelings, tasks=material.tasks)
    )


def paper_name(model: str) -> str:
    """A model of the paper, told apart from ours."""
    return f"{MODELS[model]} (paper)"


def _table(material: Material, paper: tuple[PublishedFigures, ...]) -> Table:
    rows = []
    for setting in material.settings:
        row = material.mean(setting)
        assert row is not None
        found, link = row.figures, material.link(setting)
        hats = found.strict.pass_hat
        rows.append(
            Row(
                (
                    text(material.name(setting), href=link),
                    text(setting.model_kind),
                    *sure(found.completion, found.why, link),
                    *sure(found.strict, found.why, link),
                    Cell(hats[-1] if hats else None, "share"),
                    Cell(len(hats) if hats else None, "count"),
                    Cell(found.tasks, "count"),
                    Cell(found.n, "count", href=link),
                    Cell(found.unscored, "count"),
                )
            )
        )
    for model in paper:
        cells = (text(paper_name(model.model)), text("vlm"), *published_sure(model), *blanks(5))
        tasks = len(set(material.tasks))
        counts = (Cell(tasks, "count"), Cell(model.n, "count"), *blanks(1))
        rows.append(Row((*cells, *counts), is_paper=True))
    return Table(
        "headline",
        "Completion and strict score",
        "Completion is the mean fraction of a task’s conditions that hold at the end, as in the "
        "paper. Strict counts an episode only if all conditions hold and nothing else was moved, "
        f"overlaps or floats. {INTERVALS} pass^k is how likely k episodes of a cell are all strict "
        "successes, for the largest k that every cell was played. n counts scored episodes. "
        "Rows of the paper are means of its published data over the same scenes, labelings and "
        "tasks.",
        heads(
            "model | kind | completion | would it repeat? | other tasks? | strict | "
            "strict: would it repeat? | strict: other tasks? | pass^k | k | tasks | "
            "n | unscored"
        ),
        tuple(rows),
    )


def _chart(material: Material, paper: tuple[PublishedFigures, ...]) -> Chart:
    lines = []
    for setting in material.settings:
        row = material.mean(setting)
        assert row is not None
        score = row.figures.completion
        lines.append(
            Line(
                material.name(setting),
                material.tone(setting),
                score.mean,
                score.repeat,
                score.task,
                href=material.link(setting),
            )
        )
    for model in paper:
        tone = paper_tone(model.model)
        name = paper_name(model.model)
        lines.append(Line(name, tone, model.completion, model.repeat, model.task))
    return Chart(
        "headline",
        "Completion with both intervals",
        "The dot is the mean completion. The thick line says where it would lie if the same "
        "episodes were played again; the thin line, on other tasks like these. Without a thick "
        "line a model is deterministic, or something was played only once.",
        lines=tuple(lines),
        axis=shares("completion"),
    )


def paper_tone(model: str) -> int:
    """The colour of one of the paper's models."""
    return -1 - list(MODELS).index(model)
