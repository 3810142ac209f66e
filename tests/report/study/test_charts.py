"""What the charts show is what stands in the tables."""

from __future__ import annotations

from statistics import fmean

import pytest
from tests.outcomes import repeated
from tests.report.study.material import TASKS, baseline, episodes, material, source

from adamo_vh.analysis.paper.published import chosen
from adamo_vh.benchmark.tasks import task
from adamo_vh.report.study.chart import Chart, Panel, Series
from adamo_vh.report.study.contents import sections
from adamo_vh.report.study.material import Material


def charts(of: Material) -> dict[str, Chart]:
    return {chart.name: chart for section in sections(of) for chart in section.charts}


@pytest.fixture(scope="module")
def of() -> Material:
    return material(source("mine", episodes(), baseline()))


@pytest.fixture(scope="module")
def found(of: Material) -> dict[str, Chart]:
    return charts(of)


def named(panel: Panel, name: str) -> Series:
    (series,) = [one for one in panel.series if one.name == name]
    return series


def completion(of: Material, **where: str) -> float:
    """Mean over the cells of the mean over the episodes, told the long way."""
    cells: dict[tuple[str, str, str], list[float]] = {}
    for one in of.outcomes:
        if all(getattr(one, name) == value for name, value in where.items()):
            assert one.completion is not None
            cells.setdefault((one.scene, one.labeling, one.task), []).append(one.completion)
    return fmean(fmean(values) for values in cells.values())


def test_every_scene_and_labeling_has_its_panel(found: dict[str, Chart]) -> None:
    titles = [panel.title for panel in found["tasks"].panels]
    assert titles == ["OPAQ, S1", "OPAQ, S2", "SEM, S1", "SEM, S2"]


@pytest.mark.parametrize("model", ["baseline", "openai:gpt-4o"])
def test_a_bar_is_the_mean_of_its_cell(of: Material, found: dict[str, Chart], model: str) -> None:
    for panel in found["tasks"].panels:
        labeling, scene = panel.title.lower().split(", ")
        for mark in named(panel, model).marks:
            name = panel.x.ticks[int(mark.x)][1]
            assert mark.y == completion(of, model=model, labeling=labeling, scene=scene, task=name)
            assert mark.href.startswith("#e") and f"{name}, {model}" in mark.title


def test_the_papers_marks_are_its_published_cells(found: dict[str, Chart]) -> None:
    panel = found["tasks"].panels[2]
    marks = named(panel, "GPT-4o (paper)").marks
    cells = {c.task: c.completion for c in chosen(scenes=["s1"], labelings=["sem"], model="G4O")}
    assert [mark.y for mark in marks] == [cells[name] for name in TASKS]


def test_many_settings_share_the_panels_out() -> None:
    groups = [episodes(f"m{number}", repetitions=1, tasks=("T1",)) for number in range(8)]
    panels = charts(material(source("mine", *groups)))["tasks"].panels
    assert len(panels) == 4 * 2
    bars = [len([one for one in panel.series if one.style == "bars"]) for panel in panels]
    assert sorted(set(bars)) == [2, 6]


def test_a_scene_that_was_not_played_has_no_panel() -> None:
    only = material(source("mine", (o for o in episodes() if o.scene == "s2")))
    assert [panel.title for panel in charts(only)["tasks"].panels] == ["OPAQ, S2", "SEM, S2"]


def test_points_stand_at_their_level_and_mean(of: Material, found: dict[str, Chart]) -> None:
    panels = {panel.title: panel for panel in found["levels"].panels}
    assert list(panels) == [
        f"{labeling}, {level} level"
        for labeling in ("OPAQ", "SEM")
        for level in ("printed", "computed")
    ]
    for level in ("printed", "computed"):
        marks = named(panels[f"SEM, {level} level"], "openai:gpt-4o").marks
        assert {(mark.x, round(mark.y, 9)) for mark in marks} == {
            (
                getattr(task(name), level).total,
                round(completion(of, model="openai:gpt-4o", labeling="sem", task=name), 9),
            )
            for name in TASKS
        }


def test_the_papers_cross_is_the_mean_of_its_models(found: dict[str, Chart]) -> None:
    marks = named(found["levels"].panels[2], "paper").marks
    cells = [c.completion for c in chosen(labelings=["sem"], tasks=["T14"])]
    assert [mark.y for mark in marks if mark.x == 15] == [pytest.approx(fmean(cells))]


def test_differences_between_labelings_are_those_of_the_tasks(
    of: Material, found: dict[str, Chart]
) -> None:
    (panel,) = found["labelings"].panels
    for mark, name in zip(named(panel, "baseline").marks, TASKS, strict=True):
        with_names = completion(of, model="baseline", labeling="sem", task=name)
        without = completion(of, model="baseline", labeling="opaq", task=name)
        assert mark.y == pytest.approx(with_names - without)
    paper = {mark.x: mark.y for mark in named(panel, "GPT-4o (paper)").marks}
    cells = chosen(tasks=["T8"], model="G4O")
    gain = fmean(c.completion for c in cells if c.labeling == "sem") - fmean(
        c.completion for c in cells if c.labeling == "opaq"
    )
    assert paper[TASKS.index("T8")] == pytest.approx(gain)


def test_differences_between_settings_are_those_of_the_tasks(
    of: Material, found: dict[str, Chart]
) -> None:
    (panel,) = found["comparison"].panels
    assert panel.title == "openai:gpt-4o less baseline"
    for mark, name in zip(panel.series[0].marks, TASKS, strict=True):
        second = completion(of, model="openai:gpt-4o", task=name)
        assert mark.y == pytest.approx(second - completion(of, model="baseline", task=name))


def test_parts_of_a_bar_fill_it(found: dict[str, Chart]) -> None:
    for line in found["failure-classes"].lines:
        assert sum(part.share for part in line.parts) == pytest.approx(1.0)
    paper = {line.label: line for line in found["failure-classes"].lines}["OPAQ: paper"]
    shares = {part.name: part.share for part in paper.parts}
    assert (shares["perceptual"], shares["execution"]) == (0.835, 0.142)


def test_pass_k_falls_from_the_strict_score() -> None:
    some = [*repeated("T1", 1.0, 1.0, 1.0, 1.0), *repeated("T2", 1.0, 0.0, 1.0, 0.0)]
    (panel,) = charts(material(source("mine", iter(some))))["pass-k"].panels
    values = [round(mark.y, 4) for mark in panel.series[0].marks]
    # T1 always; T2 in 2 of 4: 1/2, 1/6, 0, 0.
    assert values == [0.75, round((1 + 1 / 6) / 2, 4), 0.5, 0.5]


def test_what_was_played_once_has_no_curve_of_luck() -> None:
    assert "pass-k" not in charts(material(source("mine", baseline())))


def test_headline_rows_are_ours_and_then_the_papers(found: dict[str, Chart]) -> None:
    labels = [line.label for line in found["headline"].lines]
    assert labels == ["baseline", "openai:gpt-4o", "GPT-4o (paper)", "Claude 3.5 Sonnet (paper)"]
    for line in found["headline"].lines:
        assert line.value is not None and line.outer is not None
        assert line.outer.low <= line.value <= line.outer.high


def test_every_chart_and_table_says_what_it_is(of: Material) -> None:
    for section in sections(of):
        for block in section.blocks:
            assert block.title and block.caption.endswith("."), block.name
            assert len(block.caption) > 40, block.name
