"""How far the oracle walks: the table says what it does."""

from __future__ import annotations

import pytest

from adamo_vh.benchmark.tasks import TASKS, task
from adamo_vh.benchmark.verify import verify_tasks
from adamo_vh.benchmark.ways import way_m, ways
from adamo_vh.perception import Labeling
from adamo_vh.runtime.builtin import BuiltinEngine
from adamo_vh.runtime.scenes import scene_names
from adamo_vh.session.variations import FIRST, built_in_engine


def test_every_task_of_every_scene_is_in_the_table() -> None:
    assert set(ways()) == set(scene_names())
    every = {one.id for one in TASKS}
    for variations in ways().values():
        first = {start + i for start in FIRST.values() for i in range(20)}
        assert {int(number) for number in variations} == {0, *first}
        assert all(set(known) == every for known in variations.values())


@pytest.mark.parametrize("number", [1, 9])
def test_the_oracle_walks_what_the_table_says(engine: BuiltinEngine, number: int) -> None:
    [row] = verify_tasks(engine, Labeling.OPAQ, [task(f"T{number}")])
    assert way_m("s1", 0, f"T{number}") == pytest.approx(row.walked_m, abs=0.01)


def test_a_variation_has_a_way_of_its_own() -> None:
    engine = built_in_engine("s1", "mara", 1001)
    [row] = verify_tasks(engine, Labeling.SEM, [task("T5")])
    engine.close()
    assert way_m("s1", 1001, "T5") == pytest.approx(row.walked_m, abs=0.01)


def test_what_nobody_has_measured_is_unknown() -> None:
    assert way_m("s1", 999, "T1") is None
    assert way_m("my_room.toml", 0, "T1") is None
    assert way_m("s1", 0, None) is None
    assert way_m("s1", 0, "my_task.toml") is None
