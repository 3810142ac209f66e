"""From episodes to a study's rows: its cells, and the means over them."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from typing import TypeVar

from adamo_vh.analysis.figures import Cell, Figures, figures
from adamo_vh.analysis.outcome import Outcome
from adamo_vh.errors import RecordError

_K = TypeVar("_K")
_T = TypeVar("_T")

GROUPINGS: tuple[tuple[str, ...], ...] = (
    (),
    ("scene",),
    ("labeling",),
    ("scene", "labeling"),
    ("family",),
    ("labeling", "family"),
    ("scene", "labeling", "family"),
)
"""What means are told apart by, within a setting; the first is the paper's backbone mean."""


@dataclass(frozen=True, slots=True)
class Setting:
    """What is never averaged over: a model under a profile, with the study's further axes."""

    model: str
    model_kind: str
    profile: str
    axes: tuple[tuple[str, str], ...] = ()


@dataclass(frozen=True, slots=True)
class CellRow:
    """All episodes that are alike but for repetition and variation."""

    setting: Setting
    scene: str
    labeling: str
    task: str
    variations: tuple[int, ...]
    figures: Figures


@dataclass(frozen=True, slots=True)
class MeanRow:
    """A mean over cells of one setting."""

    setting: Setting
    by: tuple[str, ...]
    """One of `GROUPINGS`."""
    values: tuple[str, ...]
    """The scene, labeling or family that it is the mean of, in the order of `by`."""
    variations: tuple[int, ...]
    figures: Figures

    def of(self, name: str) -> str | None:
        """Its scene, labeling or family; None if it was averaged over."""
        return dict(zip(self.by, self.values, strict=True)).get(name)


def in_order(outcomes: Iterable[Outcome]) -> tuple[Outcome, ...]:
    """Each episode once, in the order of the keys, with numbers counted (T2 before T10).

    Raises:
        RecordError: Two different episodes have the same key.
    """
    found: dict[str, Outcome] = {}
    for outcome in outcomes:
        if found.setdefault(outcome.key, outcome) != outcome:
            raise RecordError(
                f"Two different episodes are called {outcome.key}: these are several runs; "
                "report them side by side instead of as one."
            )
    return tuple(sorted(found.values(), key=lambda outcome: natural(outcome.key)))


def episodes_of_cells(outcomes: Iterable[Outcome]) -> tuple[tuple[Outcome, ...], ...]:
    """The episodes of each cell: by model, profile, axes, labeling, scene and task."""

    def cell(o: Outcome) -> tuple[Setting, str, str, str]:
        return setting_of(o), o.labeling, o.scene, o.task

    return tuple(tuple(group) for _, group in _grouped(in_order(outcomes), cell))


def cells(outcomes: Iterable[Outcome]) -> tuple[CellRow, ...]:
    """The figures of every cell."""
    return tuple(
        CellRow(
            setting_of(cell[0]),
            cell[0].scene,
            cell[0].labeling,
            cell[0].task,
            _variations([cell]),
            figures([cell]),
        )
        for cell in episodes_of_cells(outcomes)
    )


def means(outcomes: Iterable[Outcome]) -> tuple[MeanRow, ...]:
    """The figures of every setting as a whole, then by scene, labeling and task family."""
    found = episodes_of_cells(outcomes)
    rows = []
    for by in GROUPINGS:

        def place(cell: Cell, by: tuple[str, ...] = by) -> tuple[Setting, tuple[str, ...]]:
            return setting_of(cell[0]), tuple(getattr(cell[0], name) for name in by)

        for (setting, values), group in _grouped(found, place):
            rows.append(MeanRow(setting, by, values, _variations(group), figures(group)))
    return tuple(rows)


def setting_of(outcome: Outcome) -> Setting:
    """What an episode is never averaged over."""
    axes = tuple(sorted(outcome.axes.items(), key=lambda axis: natural(axis[0])))
    return Setting(outcome.model, str(outcome.model_kind), outcome.profile, axes)


def natural(text: object) -> tuple[tuple[int, int, str], ...]:
    """A sort key that counts the numbers in a text."""
    parts = re.findall(r"[0-9]+|[^0-9]+", str(text))
    return tuple((0, int(p), p) if p.isdecimal() else (1, 0, p) for p in parts)


def spelled(variations: Sequence[int]) -> str:
    """Variations as the command line takes them, e.g. "0-4,7"."""
    runs: list[list[int]] = []
    for number in sorted(set(variations)):
        if runs and number == runs[-1][-1] + 1:
            runs[-1].append(number)
        else:
            runs.append([number])
    return ",".join(str(r[0]) if len(r) == 1 else f"{r[0]}-{r[-1]}" for r in runs)


def _grouped(things: Iterable[_T], place: Callable[[_T], _K]) -> list[tuple[_K, list[_T]]]:
    """Things by what they share, in a natural order."""
    groups: dict[_K, list[_T]] = {}
    for thing in things:
        groups.setdefault(place(thing), []).append(thing)
    return sorted(groups.items(), key=lambda item: natural(item[0]))


def _variations(group: Iterable[Cell]) -> tuple[int, ...]:
    return tuple(sorted({outcome.variation for cell in group for outcome in cell}))
