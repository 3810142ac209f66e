"""Two runs compared, task by task: the effect, how sure it is, and what could have been seen."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from math import fsum
from types import MappingProxyType

from adamo_vh.analysis.cells import natural
from adamo_vh.analysis.figures import Cell, is_deterministic, repeated
from adamo_vh.analysis.outcome import Outcome
from adamo_vh.analysis.statistics import (
    Interval,
    agreement,
    around,
    freedom,
    quantile,
    standard_error,
)

POWER = 0.8
"""How likely a difference as large as the smallest detectable one is found."""
_RESAMPLES = 99_999
"""Sign flips that are tried; up to 16 tasks all there are."""

Measure = Callable[[Outcome], float | None]


@dataclass(frozen=True, slots=True)
class Measured:
    """What is compared."""

    of: Measure
    most: float = math.inf
    """No value is larger; 1 for shares."""


MEASURES: Mapping[str, Measured] = MappingProxyType(
    {
        "completion": Measured(lambda o: o.completion, 1.0),
        "strict": Measured(lambda o: o.strict, 1.0),
        "early_stops": Measured(lambda o: float(o.is_early_stop), 1.0),
        "false_claims": Measured(lambda o: float(o.is_false_claim), 1.0),
        "tool_calls": Measured(lambda o: float(o.steps)),
        "model_calls": Measured(lambda o: float(o.model_calls)),
        "tokens": Measured(lambda o: float(o.usage.total_tokens)),
        "cost_usd": Measured(lambda o: o.cost_usd),
        "seconds_per_call": Measured(
            lambda o: o.model_s / o.model_calls if o.model_calls else None
        ),
    }
)
"""What runs can be compared in."""


@dataclass(frozen=True, slots=True)
class Difference:
    """How the second of two runs differs from the first in one measure."""

    measure: str
    first: float
    """Mean of the first over the shared tasks."""
    second: float
    effect: float
    """Second less first: the mean of the tasks' differences."""
    repeat: Interval | None
    """Would this difference repeat? From the spread of the repetitions; None if both runs are
    deterministic (it would), or something was played only once."""
    task: Interval | None
    """Would it hold for other tasks? From the spread of the tasks' differences."""
    p: float | None
    """How often chance gives the tasks' differences such a mean, if it were as likely to change
    the sign of each; None with fewer than 2 tasks."""
    least_p: float | None
    """The smallest p that so many tasks can give."""
    detectable_repeat: float | None
    """The smallest true difference on these tasks that so many repetitions show with `POWER`."""
    detectable_task: float | None
    """The same over all tasks of the kind that these stand for."""
    tasks: Mapping[str, float]
    """The difference of each task."""
    n: tuple[int, int]
    """Scored episodes of either run that went into it."""


def compare(
    first: Iterable[Outcome], second: Iterable[Outcome], measure: str = "completion"
) -> Difference | None:
    """Compare two runs where both have played: same scene, labeling, task and variation.

    Args:
        first: Episodes of one model and profile.
        second: Of another, or of the same at another time.
        measure: One of `MEASURES`.

    Returns:
        None if there is nothing that both have a figure for.
    """
    asked = MEASURES[measure]
    ours, theirs = _places(first, asked.of), _places(second, asked.of)
    shared = sorted(ours.keys() & theirs.keys(), key=natural)
    if not shared:
        return None
    by_task: dict[str, list[tuple[float, float]]] = {}
    for place in shared:
        pair = _mean(ours[place], asked.of), _mean(theirs[place], asked.of)
        by_task.setdefault(place[2], []).append(pair)
    tasks = {
        name: fsum(b - a for a, b in pairs) / len(pairs)
        for name, pairs in sorted(by_task.items(), key=lambda item: natural(item[0]))
    }
    differences = list(tasks.values())
    effect = fsum(differences) / len(differences)
    sides = [_cells(side[place] for place in shared) for side in (ours, theirs)]
    by_repeat = _error_of_repeats(sides, asked)
    by_task_error = _error_of_tasks(differences, asked)
    return Difference(
        measure=measure,
        first=fsum(_middle(pairs, 0) for pairs in by_task.values()) / len(by_task),
        second=fsum(_middle(pairs, 1) for pairs in by_task.values()) / len(by_task),
        effect=effect,
        repeat=None if by_repeat is None else by_repeat.about(effect, asked),
        task=None if by_task_error is None else by_task_error.about(effect, asked),
        p=_p(differences),
        least_p=min(1.0, 2.0 / 2 ** len(differences)) if len(differences) > 1 else None,
        detectable_repeat=None if by_repeat is None else by_repeat.detectable,
        detectable_task=None if by_task_error is None else by_task_error.detectable,
        tasks=tasks,
        n=(sum(map(len, sides[0])), sum(map(len, sides[1]))),
    )


@dataclass(frozen=True, slots=True)
class _Error:
    """The standard error of an effect."""

    error: float
    degrees: float
    least: float
    """No half width is smaller."""

    def about(self, effect: float, measured: Measured) -> Interval:
        half = max(quantile(self.degrees) * self.error, self.least)
        return around(effect, half, -measured.most, measured.most)

    @property
    def detectable(self) -> float:
        found = (quantile(self.degrees) + quantile(self.degrees, POWER)) * self.error
        return max(found, self.least)


def _error_of_repeats(sides: Sequence[Sequence[Cell]], measured: Measured) -> _Error | None:
    """By the spread of the repetitions of both sides; a deterministic one has none."""
    varied = [repeated(side) for side in sides if not is_deterministic(side)]
    groups = [[_values(cell, measured.of) for cell in side] for side in varied]
    errors = [standard_error(side) for side in groups]
    known = [error for error in errors if error is not None]
    if not known or len(known) < len(errors):
        return None
    counts = [sum(map(len, side)) for side in groups]
    return _Error(math.hypot(*known), min(map(freedom, groups)), _least(min(counts), measured))


def _error_of_tasks(differences: Sequence[float], measured: Measured) -> _Error | None:
    error = standard_error([differences])
    if error is None:
        return None
    return _Error(error, len(differences) - 1, _least(len(differences), measured))


def _least(count: int, measured: Measured) -> float:
    """The half width of perfect agreement; where values have no bound, it says nothing."""
    return agreement(count) * measured.most if math.isfinite(measured.most) else 0.0


def _p(differences: Sequence[float]) -> float | None:
    if len(differences) < 2:
        return None
    if not any(differences):
        return 1.0
    import numpy as np
    from scipy import stats

    found = stats.permutation_test(
        (np.asarray(differences),),
        lambda values, axis: np.mean(values, axis=axis),
        permutation_type="samples",
        n_resamples=_RESAMPLES,
        vectorized=True,
        rng=np.random.default_rng(0),
    )
    return float(found.pvalue)


Place = tuple[str, str, str, int]


def _places(outcomes: Iterable[Outcome], of: Measure) -> dict[Place, list[Outcome]]:
    """Episodes that count and have the figure, by scene, labeling, task and variation."""
    found: dict[Place, list[Outcome]] = {}
    for o in outcomes:
        if o.is_scored and o.is_ranked and of(o) is not None:
            found.setdefault((o.scene, o.labeling, o.task, o.variation), []).append(o)
    return found


def _cells(parts: Iterable[Sequence[Outcome]]) -> list[Cell]:
    """The parts of a cell, one for each variation, put together again."""
    found: dict[tuple[str, str, str], list[Outcome]] = {}
    for part in parts:
        found.setdefault((part[0].scene, part[0].labeling, part[0].task), []).extend(part)
    return list(found.values())


def _values(cell: Iterable[Outcome], of: Measure) -> list[float]:
    return [value for value in map(of, cell) if value is not None]


def _mean(cell: Sequence[Outcome], of: Measure) -> float:
    return fsum(_values(cell, of)) / len(cell)


def _middle(pairs: Sequence[tuple[float, float]], side: int) -> float:
    return fsum(pair[side] for pair in pairs) / len(pairs)
