"""The paper's figures: what is transcribed agrees with what the paper prints of the same data."""

from __future__ import annotations

from statistics import fmean
from typing import Any

import pytest

from adamo_vh.analysis.paper.printed import ABLATIONS, AVERAGES, BACKBONES, FAILURES
from adamo_vh.analysis.paper.published import (
    PublishedCell,
    chosen,
    published,
    published_figures,
)
from adamo_vh.analysis.ranks import rank_of
from adamo_vh.analysis.statistics import interval
from adamo_vh.benchmark.tasks import task


def test_every_cell_of_the_matrix_is_there_once() -> None:
    places = [(c.scene, c.labeling, c.model, c.task) for c in published()]
    assert len(places) == len(set(places)) == 120
    assert {c.scene for c in published()} == {"s1", "s2"}
    assert {c.labeling for c in published()} == {"sem", "opaq"}
    # The paper played 1,800 episodes and lost 12.
    assert sum(cell.n for cell in published()) == 1788


@pytest.mark.parametrize("row", AVERAGES, ids=lambda row: f"{row.model}-{row.labeling}-{row.scene}")
def test_printed_averages_are_those_of_the_published_cells(row) -> None:
    scenes = [row.scene] if row.scene else None
    (found,) = published_figures(chosen(scenes=scenes, labelings=[row.labeling], model=row.model))
    assert found.completion == pytest.approx(row.completion, abs=0.006)
    assert found.walk == pytest.approx(row.walk, abs=0.006)
    # The paper counts the first view among the Looks.
    assert found.look + 1 == pytest.approx(row.look, abs=0.011)
    if (row.model, row.scene) != ("S35", "s2"):  # Its printed total, 5.89, is a slip: 3.84.
        assert found.tool_calls == pytest.approx(row.total, abs=0.015)
    assert found.seconds_per_call == pytest.approx(row.seconds_per_call, rel=0.03)


@pytest.mark.parametrize("model", BACKBONES)
def test_printed_backbone_means_too(model: str) -> None:
    (found,) = published_figures(chosen(model=model))
    completion, seconds, calls = BACKBONES[model]
    assert found.completion == pytest.approx(completion, abs=0.006)
    assert found.seconds_per_call == pytest.approx(seconds, rel=0.03)
    assert found.tool_calls == pytest.approx(calls, abs=0.015)
    assert found.repeat.low < found.completion < found.repeat.high
    assert found.task is not None and found.task.low < found.repeat.low


def test_the_published_cells_give_a_weaker_correlation_than_is_printed() -> None:
    def rho(level: str, over: str) -> float:
        points = [
            (c.task, getattr(task(c.task), level).total, c.completion)
            for c in chosen(labelings=["sem"])
        ]
        found = rank_of(points, over)  # type: ignore[arg-type]
        assert found.rho is not None
        return round(found.rho, 2)

    assert (rho("printed", "cells"), rho("computed", "cells")) == (-0.39, -0.42)
    assert (rho("printed", "tasks"), rho("computed", "tasks")) == (-0.42, -0.44)


def test_the_baseline_of_every_ablation_is_the_same_study() -> None:
    baselines = {axis: rows for axis, rows in ABLATIONS.items()}
    assert [max(row.completion for row in rows) for rows in baselines.values()] == [0.93] * 4
    assert set(baselines) == {"k", "sampling", "grid", "resolution"}
    known = [share for row in FAILURES.values() for share in row.values() if share is not None]
    assert known == [0.835, 0.142, 0.658, 0.311]


def _repetitions(cell: PublishedCell) -> list[float]:
    """Episodes of a cell with one condition, whose mean and deviation are the published ones."""
    done = round(cell.completion * cell.n)
    return [1.0] * done + [0.0] * (cell.n - done)


def test_an_interval_from_deviations_is_that_of_the_episodes() -> None:
    # Tasks with a single condition can be told apart into their episodes.
    cells = chosen(tasks=["T1", "T2", "T3", "T4", "T5", "T6"], model="G4O", labelings=["opaq"])
    (found,) = published_figures(cells)
    groups = [_repetitions(cell) for cell in cells]
    known = interval(groups, found.completion)
    assert known is not None
    assert found.repeat.low == pytest.approx(known.low, abs=0.002)
    assert found.repeat.high == pytest.approx(known.high, abs=0.002)
    assert found.n == sum(map(len, groups))


def test_what_always_went_the_same_way_is_not_certain() -> None:
    (found,) = published_figures(
        chosen(tasks=["T1"], scenes=["s1"], labelings=["sem"], model="G4O")
    )
    assert (found.completion, found.repeat.high) == (1.0, 1.0)
    # The rule of three: of 15 that agreed.
    assert found.repeat.low == pytest.approx(0.05 ** (1 / 15))
    assert found.task is None


@pytest.mark.parametrize(
    ("wanted", "count"),
    [
        ({}, 120),
        ({"model": "G4O"}, 60),
        ({"scenes": ["s2"]}, 60),
        ({"labelings": ["sem"], "scenes": ["s1"]}, 30),
        ({"tasks": ["T1", "T99"]}, 8),
        ({"tasks": []}, 0),
        ({"labelings": ["names"]}, 0),
        ({"model": "G5"}, 0),
    ],
)
def test_cells_are_chosen_by_what_they_are(wanted: dict[str, Any], count: int) -> None:
    assert len(chosen(**wanted)) == count


def test_of_no_cells_there_are_no_figures() -> None:
    assert published_figures(chosen(tasks=[])) == ()


def test_the_paper_counts_each_cell_once_whatever_it_lost() -> None:
    (found,) = published_figures(chosen(scenes=["s1"], labelings=["opaq"], model="G4O"))
    cells = chosen(scenes=["s1"], labelings=["opaq"], model="G4O")
    assert {cell.n for cell in cells} != {15}
    assert found.completion == pytest.approx(fmean(cell.completion for cell in cells))
    assert found.tokens == pytest.approx(fmean(cell.tokens for cell in cells))


@pytest.mark.parametrize(
    "cell", published(), ids=lambda c: f"{c.scene}{c.labeling}{c.model}{c.task}"
)
def test_a_published_cell_agrees_with_itself(cell: PublishedCell) -> None:
    assert 13 <= cell.n <= 15
    assert 0.0 <= cell.completion <= 1.0 and 0.0 <= cell.deviation <= 0.6
    calls = cell.walk + cell.look + cell.pick + cell.drop
    assert calls == pytest.approx(cell.tool_calls, abs=0.02)
    assert cell.model_s == pytest.approx(cell.seconds_per_call * cell.model_calls, rel=0.35)
    assert cell.model_calls >= cell.tool_calls
    assert 10_000 < cell.tokens < 200_000 and cell.output_tokens < cell.tokens / 20
