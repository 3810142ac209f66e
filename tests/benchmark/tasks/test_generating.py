"""Generated tasks: deterministic, over all levels, plainly worded, and no task in two splits."""

from __future__ import annotations

from collections import Counter

import pytest
from tests.tabletop import tabletop

from adamo_vh.benchmark.conditions import Holds, OnFloor, Or, Stays, atoms, holds
from adamo_vh.benchmark.tasks import Task, builtin_tasks
from adamo_vh.benchmark.tasks.generating import LEVELS, SPLITS, Drawer, levels_in_turn, split_of
from adamo_vh.benchmark.tasks.phrases import groups_of, names_of, spoken
from adamo_vh.benchmark.tasks.reading import parse_task
from adamo_vh.benchmark.tasks.writing import task_text
from adamo_vh.runtime.builtin import BuiltinEngine

WORLD = tabletop()


def _drawn(world: object = None, seed: int = 1, split: str = "dev", count: int = 40) -> list[Task]:
    drawer = Drawer(world or WORLD, seed, split, builtin_tasks())  # type: ignore[arg-type]
    found = []
    for number, level in zip(range(count), levels_in_turn(seed, split), strict=False):
        task = drawer.draw(level, f"G-{number}")
        if task is not None:
            assert task.computed.total == level
            found.append(task)
    return found


def _asked(task: Task) -> tuple[str, ...]:
    return tuple(sorted(map(str, task.conditions)))


def test_the_same_seed_draws_the_same_and_a_larger_count_draws_on() -> None:
    assert _drawn() == _drawn()
    assert _drawn()[:5] == _drawn(count=5)
    assert {_asked(t) for t in _drawn()} != {_asked(t) for t in _drawn(seed=2)}


def test_every_level_comes_before_any_comes_again(engine: BuiltinEngine) -> None:
    levels = levels_in_turn(3, "dev")
    assert sorted(next(levels) for _ in LEVELS) == list(LEVELS)
    tasks = _drawn(engine.state(), count=20)
    assert Counter(task.computed.total for task in tasks) == Counter(LEVELS)


@pytest.mark.parametrize("seeds", [(1, 2), (5, 5)])
def test_no_task_is_in_both_splits_whatever_the_seeds(seeds: tuple[int, int]) -> None:
    dev = {_asked(task) for task in _drawn(seed=seeds[0], split="dev")}
    test = {_asked(task) for task in _drawn(seed=seeds[1], split="test")}
    assert dev and test and not dev & test
    assert all(split_of(task.conditions) == "dev" for task in _drawn(seed=seeds[0]))


def test_the_order_of_what_is_asked_changes_no_split() -> None:
    parts = (OnFloor(1), OnFloor(2))
    assert split_of(parts) == split_of(parts[::-1]) and split_of(parts) in SPLITS


def test_no_task_comes_twice_or_is_built_in_or_begun(engine: BuiltinEngine) -> None:
    world = engine.state()
    tasks = _drawn(world, count=80)
    asked = [_asked(task) for task in tasks]
    assert len(set(asked)) == len(asked)
    assert not set(asked) & {_asked(task) for task in builtin_tasks()}
    for task in tasks:
        begun = [one for one in atoms(task.conditions) if holds(one, world)]
        assert all(isinstance(one, Stays) for one in begun)
        assert not all(isinstance(one, Stays) for one in atoms(task.conditions))


def test_no_two_clauses_are_about_one_object_and_the_hand_is_filled_last() -> None:
    for task in _drawn(count=80):
        said = [object_ for c in task.conditions for object_ in c.objects]
        assert len(said) == len(set(said)) or any(isinstance(c, Or) for c in task.conditions)
        done = [atom for atom in atoms(task.conditions) if not isinstance(atom, Stays)]
        held = [isinstance(atom, Holds) for atom in done]
        assert not any(held[:-1])


def test_a_drawn_task_is_a_task_file(engine: BuiltinEngine) -> None:
    for task in _drawn(engine.state(), count=40):
        assert parse_task(task_text(task), "own.toml") == task
        assert task.prompt.isascii() and "  " not in task.prompt


def test_names_mean_one_object_each(engine: BuiltinEngine) -> None:
    world = engine.state()
    names = names_of(world)
    meant: dict[str, set[int]] = {}
    for name in names:
        meant.setdefault(name.text, set()).add(name.id)
    assert all(len(ids) == 1 for ids in meant.values())
    texts = set(meant)
    assert {"the plate", "the smaller battery", "the larger lock", "the smallest object"} <= texts
    assert "the battery" not in texts
    assert {group.text for group in groups_of(world)} == {"all batteries", "all locks"}
    assert {name.them for name in names if name.text == "the pills"} == {"them"}


def test_classes_are_said_in_words() -> None:
    assert [spoken(name) for name in ("PeanutButter", "Key", "USBStick", "Mug2")] == [
        "peanut butter", "key", "usb stick", "mug 2",
    ]  # fmt: skip
