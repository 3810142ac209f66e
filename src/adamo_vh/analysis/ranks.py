"""How completion goes with the C-D level of the tasks."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Literal

from adamo_vh.analysis.cells import Setting, episodes_of_cells, natural, setting_of
from adamo_vh.analysis.figures import Cell
from adamo_vh.analysis.outcome import Outcome
from adamo_vh.analysis.statistics import Rank, mean, rank_correlation

Level = Literal["printed", "computed"]
Over = Literal["tasks", "cells"]

ALL = "all"
"""Stands where models or labelings were put together."""


@dataclass(frozen=True, slots=True)
class RankRow:
    """Spearman's correlation of C-D level and completion."""

    setting: Setting
    """Its model is `ALL` where the models of a kind were put together, as in the paper."""
    labeling: str
    level: Level
    over: Over
    """Each task's mean, or each cell."""
    rank: Rank


def ranks(outcomes: Iterable[Outcome]) -> tuple[RankRow, ...]:
    """For each setting and labeling, and for all models of a kind together."""
    groups: dict[tuple[Setting, str], list[Cell]] = {}
    for cell in episodes_of_cells(outcome for outcome in outcomes if outcome.is_ranked):
        own = setting_of(cell[0])
        pooled = Setting(ALL, own.model_kind, own.profile, own.axes)
        for setting in (own, pooled):
            for labeling in (ALL, cell[0].labeling):
                groups.setdefault((setting, labeling), []).append(cell)
    return tuple(
        RankRow(setting, labeling, level, over, _correlation(group, level, over))
        for (setting, labeling), group in sorted(groups.items(), key=lambda i: natural(i[0]))
        if setting.model != ALL or len({cell[0].model for cell in group}) > 1
        for level in ("printed", "computed")
        for over in ("tasks", "cells")
    )


def _correlation(cells: Iterable[Cell], level: Level, over: Over) -> Rank:
    points: list[tuple[str, int, float]] = []
    for cell in cells:
        known = cell[0].printed_level if level == "printed" else cell[0].computed_level
        middle = mean([o.completion for o in cell if o.completion is not None])
        if known is not None and middle is not None:
            points.append((cell[0].task, known, middle))
    return rank_of(points, over)


def rank_of(points: Iterable[tuple[str, int, float]], over: Over) -> Rank:
    """The same of cells that are known by task, level and mean alone, as the paper's are."""
    cells = list(points)
    if over == "cells":
        return rank_correlation([level for _, level, _ in cells], [mean for *_, mean in cells])
    tasks: dict[tuple[str, int], list[float]] = {}
    for task, level, middle in cells:
        tasks.setdefault((task, level), []).append(middle)
    averages = [sum(found) / len(found) for found in tasks.values()]
    return rank_correlation([level for _, level in tasks], averages)
