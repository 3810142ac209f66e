"""The published data of the paper's authors: the means of all 120 cells, and means over them."""

from __future__ import annotations

import csv
import math
from collections.abc import Callable, Collection, Iterable, Sequence
from dataclasses import dataclass
from functools import cache
from importlib import resources
from math import fsum

from adamo_vh.analysis.statistics import Interval, agreement, around, interval, quantile


@dataclass(frozen=True, slots=True)
class PublishedCell:
    """One cell of the paper: the means of its repetitions."""

    scene: str
    labeling: str
    model: str
    """Short name: G4O or S35."""
    task: str
    n: int
    completion: float
    deviation: float
    """Standard deviation of completion over the repetitions."""
    walk: float
    look: float
    """Without the first view."""
    pick: float
    drop: float
    tool_calls: float
    model_calls: float
    seconds_per_call: float
    model_s: float
    tokens: float
    output_tokens: float


@dataclass(frozen=True, slots=True)
class PublishedFigures:
    """Means over some cells of one of the paper's models."""

    model: str
    n: int
    """Episodes."""
    completion: float
    repeat: Interval
    """Would it repeat? By the published deviations of each cell."""
    task: Interval | None
    """Would it hold for other tasks?"""
    walk: float
    look: float
    pick: float
    drop: float
    tool_calls: float
    model_calls: float
    seconds_per_call: float
    model_s: float
    tokens: float
    output_tokens: float


@cache
def published() -> tuple[PublishedCell, ...]:
    """All cells."""
    text = (resources.files(__package__) / "cells.csv").read_text(encoding="utf-8")
    rows = csv.DictReader(line for line in text.splitlines() if not line.startswith("#"))
    return tuple(
        PublishedCell(
            scene=row["scene"].lower(),
            labeling=row["labeling"].lower(),
            model=row["model"],
            task=row["task"],
            n=int(row["n_reps"]),
            completion=float(row["completion_mean"]),
            deviation=float(row["completion_std"]),
            walk=float(row["walk"]),
            look=float(row["look"]),
            pick=float(row["pick"]),
            drop=float(row["drop"]),
            tool_calls=float(row["tools_count"]),
            model_calls=float(row["model_calls"]),
            seconds_per_call=float(row["gen_ms_per_call"]) / 1000,
            model_s=float(row["gen_ms_total"]) / 1000,
            tokens=float(row["total_tokens"]),
            output_tokens=float(row["output_tokens"]),
        )
        for row in rows
    )


def chosen(
    *,
    scenes: Collection[str] | None = None,
    labelings: Collection[str] | None = None,
    tasks: Collection[str] | None = None,
    model: str | None = None,
) -> tuple[PublishedCell, ...]:
    """The cells of some scenes, labelings, tasks and one model; of all where nothing is said."""

    def among(value: str, allowed: Collection[str] | None) -> bool:
        return allowed is None or value in allowed

    return tuple(
        cell
        for cell in published()
        if among(cell.scene, scenes)
        and among(cell.labeling, labelings)
        and among(cell.task, tasks)
        and model in (None, cell.model)
    )


def published_figures(cells: Iterable[PublishedCell]) -> tuple[PublishedFigures, ...]:
    """The means of each model over its cells, each cell counted once."""
    found = tuple(cells)
    models = sorted({cell.model for cell in found})
    return tuple(_figures(model, [c for c in found if c.model == model]) for model in models)


def _figures(model: str, cells: Sequence[PublishedCell]) -> PublishedFigures:
    def mean(of: Callable[[PublishedCell], float]) -> float:
        return fsum(map(of, cells)) / len(cells)

    completion = mean(lambda cell: cell.completion)
    return PublishedFigures(
        model=model,
        n=sum(cell.n for cell in cells),
        completion=completion,
        repeat=_repeat(cells, completion),
        task=interval([_by_task(cells)], completion),
        walk=mean(lambda cell: cell.walk),
        look=mean(lambda cell: cell.look),
        pick=mean(lambda cell: cell.pick),
        drop=mean(lambda cell: cell.drop),
        tool_calls=mean(lambda cell: cell.tool_calls),
        model_calls=mean(lambda cell: cell.model_calls),
        seconds_per_call=mean(lambda cell: cell.seconds_per_call),
        model_s=mean(lambda cell: cell.model_s),
        tokens=mean(lambda cell: cell.tokens),
        output_tokens=mean(lambda cell: cell.output_tokens),
    )


def _by_task(cells: Iterable[PublishedCell]) -> list[float]:
    tasks: dict[str, list[float]] = {}
    for cell in cells:
        tasks.setdefault(cell.task, []).append(cell.completion)
    return [fsum(means) / len(means) for means in tasks.values()]


def _repeat(cells: Sequence[PublishedCell], centre: float) -> Interval:
    """As `statistics.interval` makes it, from deviations in place of the values."""
    error = math.sqrt(fsum(c.deviation**2 / c.n for c in cells)) / len(cells)
    degrees = min(cell.n for cell in cells) - 1
    half = max(quantile(degrees) * error, agreement(sum(cell.n for cell in cells)))
    return around(centre, half, 0.0, 1.0)
