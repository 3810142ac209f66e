"""Proof of own tasks: what is sound, and what is said of what is not."""

from __future__ import annotations

from dataclasses import replace

import pytest

from adamo_vh.benchmark.conditions import (
    Beside,
    Condition,
    Holds,
    InArea,
    Near,
    Not,
    NothingElseMoved,
    On,
    Once,
    OnFloor,
    Or,
    Ordered,
    Stays,
)
from adamo_vh.benchmark.tasks import Task, task
from adamo_vh.errors import ConfigError
from adamo_vh.runtime.builtin import BuiltinEngine
from adamo_vh.session.proving import Proof, prove, prove_in


def asking(*conditions: Condition) -> Task:
    return replace(task("T4"), id="OWN", conditions=conditions)


def proved(engine: BuiltinEngine, *conditions: Condition) -> Proof:
    first, second = prove_in(engine, asking(*conditions), 0)
    assert replace(first.found, labeling=second.found.labeling) == second.found
    return first


@pytest.mark.parametrize(
    "conditions",
    [
        (Beside(34, 57, "left"),),
        (Near(45, 57), Beside(45, 57, "right")),
        (Ordered((OnFloor(57), OnFloor(45))),),
        (Ordered((Once(OnFloor(57)), On(57, "table"))),),
        (Or((On(45, "attic"), Near(45, 57))),),
        (Not(On(57, "table")),),
        (OnFloor(57), Not(InArea(57)), NothingElseMoved((57,))),
        (Ordered((OnFloor(4), Near(37, 57), InArea(2))), Not(Near(4, 2)), Stays(34)),
        (Once(Holds(45)), OnFloor(57)),
    ],
    ids=lambda conditions: "; ".join(map(str, conditions)),
)
def test_the_oracle_does_whatever_can_be_asked(
    engine: BuiltinEngine, conditions: tuple[Condition, ...]
) -> None:
    proof = proved(engine, *conditions)
    assert (proof.found.oracle, proof.found.oracle_strict, proof.found.idle) == (1.0, 1.0, 0.0)
    assert proof.is_sound and not proof.problems


@pytest.mark.parametrize(
    ("conditions", "problem"),
    [
        ((On(57, "table"),), "is so at the start: 57 on table"),
        ((Stays(57),), "is so at the start: 57 where it was"),
        ((Ordered((OnFloor(57), On(57, "table"))),), "the oracle cannot do it: first 57 on floor"),
        ((OnFloor(57), Stays(57)), "the oracle cannot do it: 57 where it was"),
    ],
    ids=str,
)
def test_what_is_wrong_is_said(
    engine: BuiltinEngine, conditions: tuple[Condition, ...], problem: str
) -> None:
    proof = proved(engine, *conditions)
    assert not proof.is_sound
    assert problem in proof.problems


def test_what_luck_does_is_no_task(engine: BuiltinEngine) -> None:
    anything = Or(tuple(OnFloor(number) for number in engine.object_names))
    proof = next(iter(prove_in(engine, asking(anything), 6)))
    assert proof.random is not None and proof.random >= 0.2
    assert "too much of it comes about by lot" in proof.problems[0]
    assert next(iter(prove_in(engine, asking(OnFloor(57), OnFloor(36)), 4))).is_sound


def test_a_task_that_fits_nowhere_is_refused_with_the_reason() -> None:
    with pytest.raises(ConfigError, match=r"OWN needs object 999, which scene 's1' does not have"):
        list(prove(asking(OnFloor(999)), "s1", 0))
    with pytest.raises(ConfigError, match=r"for scene s2, not for 's1'"):
        list(prove(replace(asking(OnFloor(57)), scenes=("s2",)), "s1", 0))
