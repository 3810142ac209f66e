"""Cells and means: what they count, what they leave out, and in which order."""

from __future__ import annotations

import random
from dataclasses import replace

import pytest
from tests.outcomes import made, repeated

from adamo_vh.analysis.cells import cells, in_order, means, natural, spelled
from adamo_vh.errors import RecordError
from adamo_vh.inference.model import ModelKind, Usage


def test_a_cell_counts_its_episodes_and_those_without_a_score_apart() -> None:
    (cell,) = cells(repeated("T8", 1.0, 0.5, None, 0.0))
    assert (cell.figures.n, cell.figures.unscored) == (3, 1)
    assert cell.figures.completion.mean == pytest.approx(0.5)
    assert cell.figures.strict.mean == pytest.approx(1 / 3)
    assert cell.figures.completion.task is None and cell.figures.why.task == "a single task"
    assert cell.figures.completion.repeat is not None and cell.figures.why.repeat == ""


def test_a_cell_with_no_score_has_no_figures() -> None:
    (cell,) = cells(repeated("T8", None, None))
    assert (cell.figures.n, cell.figures.unscored) == (0, 2)
    assert cell.figures.completion.mean is None and cell.figures.tokens is None
    assert cell.figures.why.repeat == cell.figures.why.task == "nothing is scored"


def test_each_task_counts_once_however_often_it_was_played() -> None:
    rows = means([*repeated("T1", *[1.0] * 9), *repeated("T2", 0.0, None)])
    assert rows[0].figures.completion.mean == pytest.approx(0.5)
    assert (rows[0].figures.n, rows[0].figures.unscored) == (10, 1)


def test_a_deterministic_cell_has_no_repeat_interval_and_says_why() -> None:
    outcomes = [
        made("T8", value, variation=number, model="baseline", model_kind=ModelKind.RULE_BASED)
        for number, value in enumerate([1.0, 0.5, 1.0, 1.0, 0.0])
    ]
    (cell,) = cells(outcomes)
    assert cell.figures.n == 5 and cell.variations == (0, 1, 2, 3, 4)
    assert cell.figures.completion.repeat is None and cell.figures.strict.repeat is None
    assert "deterministic" in cell.figures.why.repeat
    assert cell.figures.completion.variation is not None


def test_layouts_are_told_apart_from_repetitions_where_both_vary() -> None:
    outcomes = [
        made("T8", completion, variation=layout, repetition=number)
        for layout, completion in ((0, 1.0), (1, 0.0))
        for number in range(1, 16)
    ]
    (cell,) = cells(outcomes)
    found = cell.figures.completion
    assert found.repeat is not None and found.variation is not None
    assert found.repeat.high - found.repeat.low < 0.2
    assert (found.variation.low, found.variation.high) == (0.0, 1.0)


def test_layouts_played_once_each_stand_for_repetitions_and_say_so() -> None:
    (cell,) = cells(made("T8", 1.0, variation=layout) for layout in range(5))
    assert cell.figures.completion.repeat is not None
    assert "layouts" in cell.figures.why.repeat


def test_means_are_made_by_scene_labeling_and_family() -> None:
    outcomes = [
        made(task_id, completion, scene=scene, labeling=labeling)
        for task_id, completion in (("T1", 1.0), ("T15", 0.0))
        for scene in ("s1", "s2")
        for labeling in ("sem", "opaq")
    ]
    rows = means(outcomes)
    found = {(row.by, row.values): row.figures.completion.mean for row in rows}
    assert found[(), ()] == 0.5
    assert found[("scene",), ("s2",)] == 0.5
    assert found[("family",), ("single object",)] == 1.0
    assert found[("scene", "labeling"), ("s1", "opaq")] == 0.5
    row = next(row for row in rows if row.by == ("scene", "labeling"))
    assert (row.of("scene"), row.of("labeling"), row.of("family")) == ("s1", "opaq", None)


def test_models_profiles_and_axes_are_never_averaged_over() -> None:
    outcomes = [
        made("T1", 1.0),
        made("T1", 0.0, model="random", model_kind=ModelKind.RANDOM),
        made("T1", 0.0, profile="lean"),
        made("T1", 0.5, axes={"k": "4"}),
        made("T1", 0.7, axes={"k": "10"}),
    ]
    rows = [row for row in means(outcomes) if row.by == ()]
    assert len(rows) == len(cells(outcomes)) == 5
    assert sorted(row.figures.completion.mean or 0 for row in rows) == [0.0, 0.0, 0.5, 0.7, 1.0]


def test_calls_are_counted_by_kind_and_added_tools_too() -> None:
    (cell,) = cells(
        [
            made("T1", calls={"Pick": 1, "Look": 2}, steps=3),
            made("T1", calls={"Pick": 1, "Wave": 4}, steps=5, repetition=2),
        ]
    )
    assert cell.figures.calls == {
        "Walk": 0, "Look": 1, "Pick": 1, "Drop": 0, "Wave": 2, "total": 4
    }  # fmt: skip


def test_an_unknown_price_makes_the_cost_unknown_not_smaller() -> None:
    known = cells([made("T1", cost_usd=0.1), made("T1", 0.0, cost_usd=0.3, repetition=2)])
    assert known[0].figures.cost_usd == pytest.approx(0.2)
    assert known[0].figures.cost_per_solved_usd == pytest.approx(0.4)
    unknown = cells([made("T1", cost_usd=0.1), made("T1", cost_usd=None, repetition=2)])
    assert unknown[0].figures.cost_usd is None and unknown[0].figures.cost_per_solved_usd is None


def test_nothing_solved_has_no_cost_for_each_solved() -> None:
    (cell,) = cells([made("T1", 0.0)])
    assert cell.figures.cost_per_solved_usd is None and cell.figures.tokens_per_solved is None


def test_ways_are_compared_with_the_shortest_where_all_was_done() -> None:
    (cell,) = cells(
        [
            made("T1", walked_m=3.0, shortest_m=2.0),
            made("T1", 0.0, walked_m=50.0, repetition=2),
        ]
    )
    assert cell.figures.path_ratio == pytest.approx(1.5)
    (unknown,) = cells([made("T1", shortest_m=None)])
    assert unknown.figures.path_ratio is None
    (still,) = cells([made("T1", walked_m=0.0, shortest_m=0.0)])
    assert still.figures.path_ratio is None


def test_seconds_a_call_are_not_asked_of_who_made_none() -> None:
    (cell,) = cells([made("T1", 0.0, model_calls=0), made("T1", repetition=2)])
    assert cell.figures.seconds_per_call == pytest.approx(2.0)


def test_estimated_tokens_are_said_to_be() -> None:
    (cell,) = cells([made("T1", usage=Usage(10, 1, estimated=True)), made("T1", repetition=2)])
    assert cell.figures.tokens_estimated


def test_the_order_is_natural_and_does_not_depend_on_the_input() -> None:
    outcomes = [made(f"T{n}", 1.0, scene=s) for n in range(1, 16) for s in ("s1", "s2")]
    shuffled = outcomes.copy()
    random.Random(0).shuffle(shuffled)
    assert cells(shuffled) == cells(outcomes) and means(shuffled) == means(outcomes)
    assert [row.task for row in cells(shuffled)][:15] == [f"T{n}" for n in range(1, 16)]
    assert natural("T2") < natural("T10") < natural("T10a")


def test_the_same_episode_counts_once_and_two_of_one_name_are_refused() -> None:
    one = made("T1")
    assert in_order([one, one]) == (one,)
    with pytest.raises(RecordError, match="several runs"):
        in_order([one, replace(one, completion=0.0)])


def test_variations_are_spelled_as_the_command_line_takes_them() -> None:
    assert spelled([3, 1, 2, 0, 7]) == "0-3,7"
    assert spelled([5]) == "5"
