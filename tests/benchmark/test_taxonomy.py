"""The C-D taxonomy: unit costs, sums, and the paper's worked example."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from adamo_vh.benchmark.taxonomy import COSTS, Act, Difficulty, Ref, Rel, Unit

units = st.lists(st.sampled_from(sorted(COSTS)), max_size=30)


@pytest.mark.parametrize(
    ("unit", "cost"),
    [
        (Act.PICK, 1),
        (Act.DROP, 1),
        (Ref.ID, 0),
        (Ref.TAG, 1),
        (Ref.COLOR, 1),
        (Ref.SHAPE, 2),
        (Ref.GROUP_SIMPLE, 2),
        (Ref.PATTERN, 3),
        (Ref.SUPER_EXTREMUM, 3),
        (Rel.FLOOR, 1),
        (Rel.PROX, 2),
        (Rel.AREA, 4),
    ],
)
def test_unit_costs_are_the_papers(unit: Unit, cost: int) -> None:
    assert COSTS[unit] == cost


def test_every_unit_has_a_cost_and_a_name_of_its_own() -> None:
    every = [*Act, *Ref, *Rel]
    assert set(COSTS) == set(every)
    assert len({str(unit) for unit in every}) == len(every)


def test_costs_cannot_be_changed() -> None:
    with pytest.raises(TypeError):
        COSTS[Act.PICK] = 2  # type: ignore[index]


def test_worked_example_of_the_paper() -> None:
    """Pick the black object and place it near the spherical object: 2 + 3 + 2 = 7."""
    found = Difficulty.of([Act.PICK, Ref.COLOR, Act.DROP, Rel.PROX, Ref.SHAPE])
    assert found == Difficulty(act=2, ref=3, rel=2, total=7)


def test_no_units_no_difficulty() -> None:
    assert Difficulty.of([]) == Difficulty(0, 0, 0, 0)


@given(units)
def test_the_level_is_the_sum_of_the_costs(found: list[Unit]) -> None:
    difficulty = Difficulty.of(found)
    assert difficulty.total == sum(COSTS[unit] for unit in found)
    assert difficulty.total == difficulty.act + difficulty.ref + difficulty.rel


@given(units, units)
def test_difficulty_adds_up(first: list[Unit], second: list[Unit]) -> None:
    a, b, both = Difficulty.of(first), Difficulty.of(second), Difficulty.of(first + second)
    assert (both.act, both.ref, both.rel) == (a.act + b.act, a.ref + b.ref, a.rel + b.rel)


@given(units)
def test_the_order_of_units_does_not_matter(found: list[Unit]) -> None:
    assert Difficulty.of(found) == Difficulty.of(reversed(found))
