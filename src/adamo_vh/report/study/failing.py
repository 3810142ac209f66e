"""Why episodes failed: the paper's classes, finer codes, and how far from done they stayed."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from itertools import chain
from math import fsum

from adamo_vh.analysis.cells import Setting
from adamo_vh.analysis.diagnosis.finding import CODES
from adamo_vh.analysis.failures import PAPER_CLASSES, UNDIAGNOSED, failures, shares
from adamo_vh.analysis.outcome import Outcome
from adamo_vh.analysis.paper.printed import FAILURES
from adamo_vh.report.study.chart import Axis, Chart, Line, Mark, Panel, Part, Series, scale
from adamo_vh.report.study.material import Material, shown_labeling
from adamo_vh.report.study.section import Section
from adamo_vh.report.study.table import Cell, Row, Table, text

_CLASSES = (*PAPER_CLASSES, "protocol", UNDIAGNOSED)
_MOST_STEPS = 30


def failing(material: Material) -> Section:
    """Failures by class and code, and the way to done of those that failed."""
    title, failed = "Why episodes failed", failures(material.outcomes)
    if not failed:
        return Section("failures", title, "", (), "No scored episode failed.")
    return Section(
        "failures",
        title,
        "Every scored episode below 1.0 has a diagnosis, made from the simulator’s truth: the "
        "paper’s class, and a finer code. The paper’s percentages are over its three classes; "
        "failures to give a valid call (protocol) stand apart.",
        tuple(
            block
            for block in (
                _chart(material),
                _class_table(material),
                *_code_tables(material, failed),
                _curves(material),
            )
            if block is not None
        ),
    )


def _groups(material: Material, labeling: str) -> Iterable[tuple[str, str, tuple[Outcome, ...]]]:
    """Name, link and episodes of what is told of a labeling: all of a kind together, and each."""
    for kind, settings in _kinds(material).items():
        parts = {
            setting: tuple(o for o in material.episodes(setting) if o.labeling == labeling)
            for setting in settings
        }
        if sum(bool(part) for part in parts.values()) > 1:
            yield f"all {kind} models", "", tuple(chain.from_iterable(parts.values()))
        for setting, part in parts.items():
            if part:
                yield material.name(setting), material.link(setting), part


def _kinds(material: Material) -> dict[str, list[Setting]]:
    """The settings by the kind of their player: kinds are never put together."""
    found: dict[str, list[Setting]] = {}
    for setting in material.settings:
        found.setdefault(setting.model_kind, []).append(setting)
    return found


def _counted(outcomes: Iterable[Outcome]) -> dict[str, tuple[int, float | None]]:
    """Count and share of each class."""
    return {
        row.class_: (row.count, row.share)
        for row in shares(outcomes)
        if row.model is None and row.code is None
    }


def _class_table(material: Material) -> Table:
    rows = []
    for labeling in material.labelings:
        rows += [
            _class_row(labeling, name, link, here)
            for name, link, here in _groups(material, labeling)
        ]
        if labeling in FAILURES:
            rows.append(_printed_row(labeling))
    return Table(
        "failure-classes",
        "Failures by class",
        "Perceptual: the wrong object or place, or one never found. Execution: the right intent, "
        "but refused, misplaced or ended too early. Reasoning: wrong order, something not asked, a "
        "goal forgotten, a loop. Percentages are of these three together, as in the paper. "
        "Protocol counts episodes without a valid call, undiagnosed those that nobody has "
        "explained.",
        (
            "labeling",
            "model",
            "scored",
            "failed",
            *PAPER_CLASSES,
            "protocol (count)",
            "undiagnosed (count)",
        ),
        tuple(rows),
        is_grouped=True,
    )


def _class_row(labeling: str, name: str, link: str, here: Sequence[Outcome]) -> Row:
    found = _counted(here)
    count = sum(number for number, _ in found.values())
    none = "no failure is of the paper’s three classes" if count else "nothing failed"

    def of(kind: str) -> tuple[int, float | None]:
        return found.get(kind, (0, None))

    return Row(
        (
            text(shown_labeling(labeling)),
            text(name, href=link),
            Cell(sum(o.is_scored for o in here), "count"),
            Cell(count, "count", href=link),
            *(Cell(of(kind)[1], "percent", why=none) for kind in PAPER_CLASSES),
            *(Cell(of(kind)[0], "count") for kind in ("protocol", UNDIAGNOSED)),
        )
    )


def _printed_row(labeling: str) -> Row:
    unsaid = Cell(None, why="the paper says 2 to 3 % of reasoning, and no counts")
    printed = FAILURES[labeling]
    shares_of = (Cell(printed[kind], "percent", why=unsaid.why) for kind in PAPER_CLASSES)
    head = (text(shown_labeling(labeling)), text("both models (paper), printed"))
    return Row((*head, unsaid, unsaid, *shares_of, unsaid, unsaid), is_paper=True)


def _chart(material: Material) -> Chart:
    lines = []
    for labeling in material.labelings:
        for name, link, here in _groups(material, labeling):
            if parts := _parts(here, link):
                count = sum(not o.is_complete for o in here if o.is_scored)
                lines.append(Line(f"{shown_labeling(labeling)}: {name} ({count})", parts=parts))
        if labeling in FAILURES:
            lines.append(Line(f"{shown_labeling(labeling)}: paper", parts=_printed_parts(labeling)))
    ticks = tuple((share, f"{100 * share:.0f} %") for share in (0.0, 0.25, 0.5, 0.75, 1.0))
    return Chart(
        "failure-classes",
        "Failures by class",
        "Share of the failed episodes of each labeling and model; their number stands in brackets. "
        "In the paper’s bars, reasoning is what its two other classes leave.",
        lines=tuple(lines),
        axis=Axis("share of failures", 0.0, 1.0, ticks),
    )


def _parts(here: Sequence[Outcome], link: str) -> tuple[Part, ...]:
    found = _counted(here)
    count = sum(number for number, _ in found.values())
    return tuple(
        Part(kind, tone, found[kind][0] / count, f"{kind}: {found[kind][0]} of {count}", link)
        for tone, kind in enumerate(_CLASSES)
        if found.get(kind, (0, None))[0]
    )


def _printed_parts(labeling: str) -> tuple[Part, ...]:
    known = {kind: share for kind, share in FAILURES[labeling].items() if share is not None}
    known["reasoning"] = 1.0 - fsum(known.values())
    return tuple(
        Part(kind, _CLASSES.index(kind), share, f"{kind}: {100 * share:.1f} %")
        for kind, share in known.items()
    )


def _code_tables(material: Material, failed: Sequence[Outcome]) -> Iterable[Table]:
    """One table for each kind of player."""
    for kind in _kinds(material):
        here = [o for o in failed if o.model_kind == kind]
        if here:
            yield _code_table(material, here, kind)


def _code_table(material: Material, failed: Sequence[Outcome], kind_of_model: str) -> Table:
    groups: dict[tuple[str, str], list[Outcome]] = {}
    for one in failed:
        groups.setdefault((one.diagnosis or UNDIAGNOSED, one.diagnosis_code), []).append(one)
    order = {kind: place for place, kind in enumerate(_CLASSES)}
    rows = []
    for (kind, code), here in sorted(
        groups.items(), key=lambda item: (order.get(item[0][0], 9), -len(item[1]), item[0][1])
    ):
        chips, more = material.chips(here)
        rows.append(
            Row(
                (
                    text(kind),
                    text(code.replace("_", " ") or "–"),
                    text(_meaning(code)),
                    *(
                        Cell(sum(o.labeling == labeling for o in here), "count")
                        for labeling in material.labelings
                    ),
                    Cell(len(here), "count"),
                    Cell(len(here) / len(failed), "percent"),
                ),
                chips=chips,
                more=more,
            )
        )
    return Table(
        f"failure-codes-{kind_of_model}",
        f"Failures by code: {kind_of_model} models",
        "What exactly went wrong first, over all models of a kind, with the number of failed "
        "episodes under each labeling and the share of all failures.",
        (
            "class",
            "code",
            "what it means",
            *map(shown_labeling, material.labelings),
            "all",
            "share",
        ),
        tuple(rows),
        is_grouped=True,
    )


def _meaning(code: str) -> str:
    known = {str(name): meaning for codes in CODES.values() for name, meaning in codes.items()}
    return known.get(code, "")


def _curves(material: Material) -> Chart | None:
    """How far from done failed episodes stayed."""
    panels = []
    for labeling in material.labelings:
        series = []
        for setting in material.settings:
            here = [
                material.distances[o.key]
                for o in material.episodes(setting)
                if o.labeling == labeling and o.key in material.distances
            ]
            name, tone = material.name(setting), material.tone(setting)
            series.append(Series(name, tone, "line", _left(here)))
        if any(one.marks for one in series):
            steps = [mark.x for one in series for mark in one.marks]
            highest = max([1.0, *(mark.y for one in series for mark in one.marks)])
            y = scale("calls left, of those at the start", [highest])
            panels.append(Panel(shown_labeling(labeling), _steps(steps), y, tuple(series)))
    if not panels:
        return None
    return Chart(
        "distance",
        "Distance to done in failed episodes",
        "How many calls the oracle would still need after each step, as a share of those at the "
        "start: the mean over failed episodes. At 1 nothing was gained; above it the agent made "
        "more work than there was. An episode that has ended keeps its last value.",
        panels=tuple(panels),
    )


def _left(curves: Sequence[Sequence[int]]) -> tuple[Mark, ...]:
    """The mean of some curves; those that end early go on as they ended."""
    found = [curve for curve in curves if curve and curve[0] > 0]
    if not found:
        return ()
    last = min(max(map(len, found)), _MOST_STEPS + 1)
    return tuple(
        Mark(
            step,
            (value := fsum(c[min(step, len(c) - 1)] / c[0] for c in found) / len(found)),
            title=f"after {step} steps: {value:.2f}, {len(found)} episodes",
        )
        for step in range(last)
    )


def _steps(values: Iterable[float]) -> Axis:
    axis = scale("step", values)
    return Axis(axis.label, 0.0, max(values, default=1.0) or 1.0, axis.ticks)
