"""What names of objects are worth: the same tasks under two labelings."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

from adamo_vh.analysis.cells import Setting
from adamo_vh.analysis.comparison import Difference, compare
from adamo_vh.analysis.outcome import Outcome
from adamo_vh.analysis.paper.printed import AVERAGES, MODELS
from adamo_vh.analysis.paper.published import chosen
from adamo_vh.report.study.chart import Chart, Mark, Panel, Series, places, shares
from adamo_vh.report.study.headline import paper_name, paper_tone
from adamo_vh.report.study.material import Material
from adamo_vh.report.study.section import Section, blanks
from adamo_vh.report.study.table import Cell, Row, Table, heads, text

WITHOUT, WITH = "opaq", "sem"
_NO_REPEAT = "deterministic, or something was played only once"


def labelings(material: Material) -> Section:
    """The gain from OPAQ to SEM, for every setting that was played under both."""
    found = {
        setting: difference
        for setting in material.settings
        if (difference := _difference(material.episodes(setting))) is not None
    }
    title = "What labels are worth"
    if not found:
        remark = "Only one of the paper’s two labelings was played, so there is nothing to compare."
        return Section("labelings", title, "", (), remark)
    return Section(
        "labelings",
        title,
        "SEM tags say what an object is (“Plate_57”), OPAQ tags only number it (“57”), so that an "
        "agent must recognise it in the picture.",
        (_table(material, found), _chart(material, found)),
    )


def _difference(outcomes: Iterable[Outcome], measure: str = "completion") -> Difference | None:
    episodes = tuple(outcomes)

    def under(labeling: str) -> list[Outcome]:
        return [replace(o, labeling="") for o in episodes if o.labeling == labeling]

    return compare(under(WITHOUT), under(WITH), measure)


def _table(material: Material, found: dict[Setting, Difference]) -> Table:
    rows = []
    for setting, difference in found.items():
        looks = _looks(material, setting)
        rows.append(
            Row(
                (
                    text(material.name(setting), href=material.link(setting)),
                    Cell(difference.first, "share"),
                    Cell(difference.second, "share"),
                    Cell(difference.effect, "share", signed=True),
                    Cell(difference.repeat, "share", signed=True, why=_NO_REPEAT),
                    Cell(difference.task, "share", signed=True, why="a single task"),
                    Cell(difference.p, "p", why="a single task"),
                    _gain(difference.first, difference.second),
                    looks,
                )
            )
        )
    for model in MODELS:
        printed = {r.labeling: r for r in AVERAGES if r.model == model and r.scene is None}
        first, second = printed[WITHOUT], printed[WITH]
        rows.append(
            Row(
                (
                    text(f"{paper_name(model)}, printed"),
                    Cell(first.completion, "share"),
                    Cell(second.completion, "share"),
                    Cell(second.completion - first.completion, "share", signed=True),
                    *blanks(3),
                    _gain(first.completion, second.completion),
                    _gain(first.look, second.look),
                ),
                is_paper=True,
            )
        )
    return Table(
        "labelings",
        "From OPAQ to SEM",
        "Completion on the tasks that were played under both labelings, and the difference with "
        "its 95 % intervals. p is how often chance alone gives the tasks’ differences such a mean "
        "(permutation test). Gain is the difference in per cent of OPAQ; Looks is how the number "
        "of views changes, the first one counted, as in the paper.",
        heads(
            "model | OPAQ | SEM | difference | would it repeat? | other tasks? | p | gain | Looks"
        ),
        tuple(rows),
    )


def _looks(material: Material, setting: Setting) -> Cell:
    """How the number of views changes, with the first."""
    rows = [material.mean(setting, labeling=name) for name in (WITHOUT, WITH)]
    looks = [row.figures.calls["Look"] if row else None for row in rows]
    first, second = looks
    return Cell(None) if first is None or second is None else _gain(first + 1, second + 1)


def _gain(first: float, second: float) -> Cell:
    gain = second / first - 1 if first else None
    return Cell(gain, "percent", signed=True, why="nothing was completed under OPAQ")


def _chart(material: Material, found: dict[Setting, Difference]) -> Chart:
    series = []
    for setting, difference in found.items():
        marks = [
            Mark(
                material.tasks.index(task),
                value,
                title=f"{task}, {material.name(setting)}: {value:+.2f}",
            )
            for task, value in difference.tasks.items()
        ]
        name, tone = material.name(setting), material.tone(setting)
        series.append(Series(name, tone, "bars", tuple(marks)))
    for model in MODELS:
        series.append(_paper_series(material, model))
    panel = Panel(
        "", places(material.tasks), shares("completion, SEM less OPAQ", -1.0), tuple(series)
    )
    return Chart(
        "labelings",
        "The difference of every task",
        "Completion under SEM less completion under OPAQ, over the scenes that were played. Above "
        "0 the names helped. Hollow marks are the paper’s models, from its published data.",
        panels=(panel,),
    )


def _paper_series(material: Material, model: str) -> Series:
    values: dict[str, list[float]] = {}
    for cell in chosen(scenes=material.scenes, tasks=material.tasks, model=model):
        sign = 1 if cell.labeling == WITH else -1
        values.setdefault(cell.task, []).append(sign * cell.completion)
    marks = [
        Mark(
            material.tasks.index(task),
            (value := 2 * sum(found) / len(found)),
            title=f"{task}, {paper_name(model)}: {value:+.2f}",
        )
        for task, found in values.items()
    ]
    return Series(paper_name(model), paper_tone(model), "marks", tuple(marks))
