"""Every task of every scene can be done, is not done at the start, and scores in parts."""

from __future__ import annotations

import pytest
from tests.benchmark.half_plan import first_half

from adamo_vh.benchmark.tasks import TASKS, Task
from adamo_vh.benchmark.verify import play_oracle, verify_tasks
from adamo_vh.perception import Labeling
from adamo_vh.runtime.builtin import BuiltinEngine

ids = [task.id for task in TASKS]


@pytest.mark.parametrize("labeling", list(Labeling))
@pytest.mark.parametrize("task", TASKS, ids=ids)
def test_the_oracle_solves_it_and_idling_does_not(
    engine: BuiltinEngine, task: Task, labeling: Labeling
) -> None:
    [row] = verify_tasks(engine, labeling, [task])
    assert (row.oracle, row.oracle_strict, row.idle) == (1.0, 1.0, 0.0)
    assert row.is_sound


@pytest.mark.parametrize("task", [t for t in TASKS if len(t.conditions) > 1], ids=lambda t: t.id)
def test_half_a_plan_scores_its_fraction(engine: BuiltinEngine, task: Task) -> None:
    half = first_half(task.conditions)
    done = sum(condition in task.conditions for condition in half)
    played, _ = play_oracle(engine, Labeling.SEM, task, half)
    assert played.completion == pytest.approx(done / len(task.conditions))
    assert played.strict == 0.0
