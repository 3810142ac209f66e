"""How often the intervals of a report hold: agents of known skill, whose true means are known.

    python benchmarks/coverage.py [--studies 100] [--seed 0] [--json]

Each row draws so many studies of an agent, lets the report's own functions make their intervals,
and counts in how many of them the true mean lies. 95 % is what they promise; more is on the safe
side.
The skills have the shapes of the paper's columns: how often an agent does each of the 15 tasks.
"""

from __future__ import annotations

import argparse
import json
from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass, replace

import numpy as np

from adamo_vh.analysis.comparison import Difference, compare
from adamo_vh.analysis.figures import figures
from adamo_vh.analysis.outcome import Outcome
from adamo_vh.analysis.statistics import Interval
from adamo_vh.geometry import Array
from adamo_vh.inference.model import ModelKind, Usage
from adamo_vh.record.termination import TerminationReason

SKILLS = {
    "nearly all done": (*(1.0,) * 13, 0.31, 0.64),
    "most done": (1, 1, 0.29, 1, 1, 0.93, 0.74, 1, 0.97, 0.97, 1, 0.93, 0.77, 0.21, 0.61),
    "half done": (1, 0.6, 0.6, 0.93, 1, 0.53, 0.05, 0.47, 0.6, 0.07, 0.5, 0.44, 0.32, 0.37, 0.6),
    "hardly any done": (0.5, 0.2, *(0.02,) * 13),
}
"""How often each task is done. No agent is perfect: 1.0 stands for 0.99."""
_LEAST, _MOST = 0.01, 0.99
_SPREAD = 8.0
"""How alike scenes and labelings are to their task; 8 lets one of 0.5 lie from 0.2 to 0.8."""
_PARTS = 3
"""Conditions of a task, where completion is no yes or no."""
_PLAIN = Outcome(
    "", "s1", 0, "sem", "agent", ModelKind.VLM, "paper", "T1", 1, 0, 1.0, 1.0,
    TerminationReason.ANSWERED, 1, 0, None, 3, {}, 3, 3, 0, 0, 0, 0, Usage(), None, 0.0, 0.0, 0.0,
    0.0, 0.0, None,
)  # fmt: skip


@dataclass(frozen=True, slots=True)
class Row:
    """What came of one kind of interval and one kind of agent."""

    question: str
    agent: str
    design: str
    coverage: float
    """Share of the studies whose interval holds the true value."""
    width: float
    """Mean width of the interval."""


Draw = np.random.Generator


def skill(name: str) -> Array:
    """How often each of the 15 tasks is done, (15,)."""
    return np.asarray(np.clip(np.asarray(SKILLS[name], dtype=float), _LEAST, _MOST))


def study(
    draw: Draw,
    chances: Array,
    repetitions: int,
    *,
    parts: int = 1,
    variations: int = 1,
    kind: ModelKind = ModelKind.VLM,
) -> list[list[Outcome]]:
    """The cells of one study.

    Args:
        draw: The lot.
        chances: How often each cell is done, (tasks, scenes and labelings).
        repetitions: Of each cell and variation.
        parts: Conditions, each done so often on its own.
        variations: Of each scene.
        kind: A rule-based agent is drawn once for each variation.
    """
    cells = []
    for task, row in enumerate(chances):
        for place, chance in enumerate(row):
            done = draw.binomial(parts, chance, (variations, repetitions)) / parts
            cells.append(
                [
                    replace(
                        _PLAIN,
                        task=f"T{task + 1}",
                        scene=f"s{place + 1}",
                        variation=v,
                        repetition=r + 1,
                        model_kind=kind,
                        completion=float(done[v, r]),
                        strict=float(done[v, r] == 1),
                    )
                    for v in range(variations)
                    for r in range(repetitions)
                ]
            )
    return cells


def counted(
    labels: tuple[str, str, str], studies: int, one: Callable[[], tuple[Interval | None, float]]
) -> Row:
    """A row: how often an interval holds the truth.

    Args:
        labels: Question, agent and design.
        studies: How many are drawn.
        one: Draws one: its interval, and the true value.
    """
    held, widths = 0, []
    for _ in range(studies):
        found, truth = one()
        if found is None:
            raise ValueError(f"{labels}: there is no interval")
        held += found.low <= truth <= found.high
        widths.append(found.high - found.low)
    return Row(*labels, held / studies, float(np.mean(widths)))


def repeat_rows(draw: Draw, studies: int) -> list[Row]:
    """Would it repeat? The tasks stand; the repetitions are drawn."""
    rows = []
    for name in SKILLS:
        chances = skill(name)[:, None]
        for repetitions, parts in ((15, 1), (15, _PARTS), (5, 1), (3, 1)):

            def one(
                n: int = repetitions, parts: int = parts, p: Array = chances
            ) -> tuple[Interval | None, float]:
                found = figures(study(draw, p, n, parts=parts))
                return found.completion.repeat, float(p.mean())

            design = f"15 tasks x {repetitions}" + (f", {parts} conditions" if parts > 1 else "")
            rows.append(counted(("would it repeat", name, design), studies, one))
    for chance in (0.5, 0.9, 0.99):
        alone = np.full((1, 1), chance)

        def of_cell(p: Array = alone) -> tuple[Interval | None, float]:
            return figures(study(draw, p, 15)).completion.repeat, float(p.mean())

        labels = ("would it repeat", f"{chance:.0%} done", "one cell x 15")
        rows.append(counted(labels, studies, of_cell))
    return rows


def task_rows(draw: Draw, studies: int) -> list[Row]:
    """Would it hold for other tasks? The tasks are drawn as well, with replacement."""
    rows = []
    for name in SKILLS:
        population = skill(name)
        for places in (1, 4):

            def one(
                places: int = places, population: Array = population
            ) -> tuple[Interval | None, float]:
                chances = other_tasks(draw, population, places)
                found = figures(study(draw, chances, 5))
                return found.completion.task, float(population.mean())

            design = "15 tasks x 5" if places == 1 else "15 tasks x 4 scenes, labelings x 5"
            rows.append(counted(("other tasks", name, design), studies, one))
    return rows


def other_tasks(draw: Draw, population: Array, places: int) -> Array:
    """How often 15 tasks of a kind are done, (15, places): alike within a task, not the same."""
    tasks = draw.choice(population, (15, 1))
    if places == 1:
        return np.asarray(tasks)
    return np.asarray(draw.beta(tasks * _SPREAD, (1 - tasks) * _SPREAD, (15, places)))


def layout_rows(draw: Draw, studies: int) -> list[Row]:
    """Would it hold for other layouts? A deterministic agent, once in each."""
    rows = []
    for name in SKILLS:
        chances = skill(name)[:, None]
        for count in (5, 10):

            def one(count: int = count, chances: Array = chances) -> tuple[Interval | None, float]:
                kind = ModelKind.RULE_BASED
                found = figures(study(draw, chances, 1, variations=count, kind=kind))
                return found.completion.variation, float(chances.mean())

            rows.append(counted(("other layouts", name, f"15 tasks x {count}"), studies, one))
    return rows


def pair(draw: Draw, first: Array, second: Array, repetitions: int = 15) -> Difference:
    """Two agents compared on the same tasks; both (tasks, 1)."""
    ours, theirs = (
        [outcome for cell in study(draw, p, repetitions) for outcome in cell]
        for p in (first, second)
    )
    found = compare(ours, theirs)
    if found is None:
        raise ValueError("nothing is shared")
    return found


def difference_rows(draw: Draw, studies: int) -> list[Row]:
    """The effect of two runs compared, by both intervals; and no effect that is taken for one."""
    studies = max(50, studies // 4)  # The permutation test takes its time.
    a, b = skill("most done"), skill("half done")
    rows = []
    for agents, first, second in (("most, half done", a, b), ("half, half done", b, b)):
        stand = [pair(draw, first[:, None], second[:, None]) for _ in range(studies)]
        truth = float((second - first).mean())
        label = ("difference: would it repeat", agents, "15 tasks x 15")
        rows.append(_of_pairs(label, [one.repeat for one in stand], truth))
        drawn = []
        for _ in range(studies):
            chosen = draw.integers(0, 15, 15)
            drawn.append(pair(draw, first[chosen, None], second[chosen, None]))
        label = ("difference: other tasks", agents, "15 tasks x 15")
        rows.append(_of_pairs(label, [one.task for one in drawn], truth))
        if agents.startswith("half"):
            rows.append(
                Row(
                    "no difference, and p is above 0.05",
                    agents,
                    "15 tasks x 15",
                    float(np.mean([one.p is not None and one.p > 0.05 for one in stand])),
                    0.0,
                )
            )
    return rows


def _of_pairs(labels: tuple[str, str, str], found: Sequence[Interval | None], truth: float) -> Row:
    known = iter(found)
    return counted(labels, len(found), lambda: (next(known), truth))


def measured(studies: int, seed: int) -> list[Row]:
    """All rows.

    Args:
        studies: How many are drawn for each.
        seed: Of the lot.
    """
    draw = np.random.default_rng(seed)
    kinds = (repeat_rows, task_rows, layout_rows, difference_rows)
    return [row for kind in kinds for row in kind(draw, studies)]


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--studies", type=int, default=100)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--json", action="store_true")
    given = parser.parse_args()
    rows = measured(given.studies, given.seed)
    if given.json:
        print(json.dumps({"studies": given.studies, "rows": [asdict(row) for row in rows]}))
        return
    print("| question | agent | design | coverage | mean width |\n|---|---|---|---|---|")
    for row in rows:
        width = f"{row.width:.2f}" if row.width else ""
        print(f"| {row.question} | {row.agent} | {row.design} | {row.coverage:.1%} | {width} |")


if __name__ == "__main__":
    main()
