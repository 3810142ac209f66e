"""Settings and studies side by side: how they differ, and how sure that is."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from itertools import combinations

from adamo_vh.analysis.cells import Setting
from adamo_vh.analysis.comparison import MEASURES, Difference, compare
from adamo_vh.analysis.outcome import Outcome
from adamo_vh.report.study.chart import Axis, Chart, Mark, Panel, Series, places, shares
from adamo_vh.report.study.material import Material
from adamo_vh.report.study.section import Section
from adamo_vh.report.study.table import Cell, Form, Row, Table, heads, text

_ALL_PAIRS = 4
"""With more settings, each is compared with the first alone."""
_FORMS: Mapping[str, Form] = {
    "completion": "share",
    "strict": "share",
    "early_stops": "share",
    "false_claims": "share",
    "tool_calls": "number",
    "model_calls": "number",
    "tokens": "tokens",
    "cost_usd": "dollars",
    "seconds_per_call": "seconds",
}
_SCORES = ("completion", "strict")

Pair = tuple[Setting, Setting]


def comparing(material: Material) -> Section | None:
    """The differences between settings; None with a single one."""
    if len(material.settings) < 2:
        return None
    pairs = _pairs(material.settings)
    found = _differences(material, pairs)
    title = "Side by side"
    if not any(found.values()):
        remark = "The settings share no scene, labeling, task and variation to be compared on."
        return Section("comparison", title, "", (), remark)
    others = [name for name in MEASURES if name not in _SCORES]
    return Section(
        "comparison",
        title,
        "Settings are compared where both have played: same scene, labeling, task and variation. "
        "The difference is that of the second less the first.",
        (
            _table(material, found, "comparison", "Differences in the scores", _SCORES),
            *([_chart(material, found)] if len(pairs) <= _ALL_PAIRS + 2 else []),
            _table(material, found, "comparison-more", "Further differences", others),
        ),
    )


def _pairs(settings: tuple[Setting, ...]) -> list[Pair]:
    if len(settings) <= _ALL_PAIRS:
        return list(combinations(settings, 2))
    return [(settings[0], other) for other in settings[1:]]


def _differences(material: Material, pairs: Iterable[Pair]) -> dict[Pair, dict[str, Difference]]:
    episodes: dict[Setting, tuple[Outcome, ...]] = {
        setting: material.episodes(setting) for setting in material.settings
    }
    return {
        (first, second): {
            measure: difference
            for measure in MEASURES
            if (difference := compare(episodes[first], episodes[second], measure)) is not None
        }
        for first, second in pairs
    }


def _table(
    material: Material,
    found: Mapping[Pair, Mapping[str, Difference]],
    name: str,
    title: str,
    measures: Iterable[str],
) -> Table:
    rows = tuple(
        _row(material, pair, differences[measure])
        for measure in measures
        for pair, differences in found.items()
        if measure in differences and _says_something(differences[measure])
    )
    return Table(
        name,
        title,
        "The two 95 % intervals of each difference: of a repetition of the same episodes, and on "
        "other tasks like these. p is how often chance alone gives the tasks’ differences such a "
        "mean (permutation test on the differences of the tasks; with few tasks it cannot get "
        "small). Could have seen: the smallest true difference that so many episodes show with "
        "80 % power; for the same tasks, and for tasks like these.",
        heads(
            "measure | second less first | first’s mean | second’s mean | difference | "
            "would it repeat? | other tasks? | p | could have seen: same tasks | "
            "could have seen: other tasks | tasks | first’s n | second’s n"
        ),
        rows,
        is_grouped=True,
    )


def _says_something(found: Difference) -> bool:
    """Whether there is anything on either side: models without tokens differ in none."""
    return found.measure in _SCORES or bool(found.first or found.second)


def _row(material: Material, pair: Pair, found: Difference) -> Row:
    form = _FORMS[found.measure]
    first, second = pair
    repeat = "both deterministic, or something was played only once"
    single = "a single task"
    return Row(
        (
            text(found.measure.replace("_usd", ", $").replace("_", " ")),
            text(f"{material.name(second)} less {material.name(first)}", material.link(second)),
            Cell(found.first, form),
            Cell(found.second, form),
            Cell(found.effect, form, signed=True),
            Cell(found.repeat, form, signed=True, why=repeat),
            Cell(found.task, form, signed=True, why=single),
            Cell(found.p, "p", why=single),
            Cell(found.detectable_repeat, form, why=repeat),
            Cell(found.detectable_task, form, why=single),
            Cell(len(found.tasks), "count"),
            Cell(found.n[0], "count"),
            Cell(found.n[1], "count"),
        )
    )


def _chart(material: Material, found: Mapping[Pair, Mapping[str, Difference]]) -> Chart:
    panels = []
    for (first, second), differences in found.items():
        if "completion" not in differences:
            continue
        difference = differences["completion"]
        title = f"{material.name(second)} less {material.name(first)}"
        marks = tuple(
            Mark(place, difference.tasks[task], title=f"{task}: {difference.tasks[task]:+.2f}")
            for place, task in enumerate(material.tasks)
            if task in difference.tasks
        )
        series = Series(material.name(second), material.tone(second), "bars", marks)
        panels.append(Panel(title, places(material.tasks), _around_zero(), (series,)))
    return Chart(
        "comparison",
        "The difference of every task",
        "Completion of the second less that of the first. Bars that all point the same way say "
        "that the difference holds for tasks in general; bars up and down, that it depends on the "
        "task.",
        panels=tuple(panels),
    )


def _around_zero() -> Axis:
    return shares("difference in completion", -1.0)
