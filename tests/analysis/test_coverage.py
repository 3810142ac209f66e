"""The coverage benchmark draws what it says, and the intervals of a report hold."""

from __future__ import annotations

import numpy as np
import pytest
from benchmarks.coverage import SKILLS, counted, other_tasks, pair, skill, study

from adamo_vh.analysis.figures import figures
from adamo_vh.analysis.statistics import Interval
from adamo_vh.inference.model import ModelKind


def _draw() -> np.random.Generator:
    return np.random.default_rng(0)


def test_a_study_has_the_cells_and_means_that_it_was_asked_for() -> None:
    chances = np.array([[0.01, 0.01], [0.99, 0.99]])
    cells = study(_draw(), chances, 200, variations=2)
    assert [(cell[0].task, cell[0].scene) for cell in cells] == [
        ("T1", "s1"), ("T1", "s2"), ("T2", "s1"), ("T2", "s2"),
    ]  # fmt: skip
    assert {len(cell) for cell in cells} == {400}
    assert figures(cells).completion.mean == pytest.approx(0.5, abs=0.02)
    thirds = {o.completion for cell in study(_draw(), chances, 50, parts=3) for o in cell}
    assert thirds <= {0.0, 1 / 3, 2 / 3, 1.0}


def test_a_deterministic_agent_has_no_repetitions() -> None:
    cells = study(_draw(), skill("half done")[:, None], 1, variations=5, kind=ModelKind.RULE_BASED)
    found = figures(cells).completion
    assert (found.repeat, found.variation is None) == (None, False)


def test_other_tasks_have_the_mean_of_their_kind() -> None:
    for name in SKILLS:
        population = skill(name)
        drawn = np.mean([other_tasks(_draw(), population, 4)] * 3 + [
            other_tasks(np.random.default_rng(n), population, 4) for n in range(200)
        ])  # fmt: skip
        assert drawn == pytest.approx(population.mean(), abs=0.03)


def test_intervals_hold_as_often_as_they_promise() -> None:
    draw, chances = _draw(), skill("half done")[:5, None]

    def repeated() -> tuple[Interval | None, float]:
        return figures(study(draw, chances, 15)).completion.repeat, float(chances.mean())

    row = counted(("would it repeat", "half done", "5 tasks x 15"), 60, repeated)
    assert row.coverage >= 0.9
    assert 0.1 < row.width < 0.4


def test_an_interval_that_is_missing_is_no_success() -> None:
    with pytest.raises(ValueError, match="no interval"):
        counted(("q", "a", "d"), 1, lambda: (None, 0.0))


def test_two_agents_are_compared_on_the_same_tasks() -> None:
    better, worse = np.full((4, 1), 0.9), np.full((4, 1), 0.1)
    found = pair(_draw(), worse, better, 30)
    assert found.effect == pytest.approx(0.8, abs=0.1)
    assert found.repeat is not None and found.repeat.low > 0.5
