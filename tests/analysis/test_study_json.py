"""The JSON of a report: its names, its order, and what it says without the clock."""

from __future__ import annotations

import json
import random
from dataclasses import replace

import pytest
from tests.outcomes import made, repeated

from adamo_vh.analysis.failures import shares
from adamo_vh.analysis.outcome import Outcome
from adamo_vh.analysis.ranks import ranks
from adamo_vh.analysis.study_json import study_json
from adamo_vh.inference.model import ModelKind


def study() -> list[Outcome]:
    lots = random.Random(1)
    return [
        outcome
        for n in range(1, 16)
        for labeling in ("sem", "opaq")
        for outcome in repeated(
            f"T{n}", *(float(lots.random() < 0.7) for _ in range(3)), labeling=labeling
        )
    ]


def test_the_names_are_those_that_were_agreed() -> None:
    found = study_json(study())
    assert {"cells", "means", "failures", "spearman"} <= found.keys()
    names = "model scene labeling task n unscored completion strict repeat_interval task_interval"
    assert {*names.split(), "variation"} <= found["cells"][0].keys()
    assert {"class", "code", "episode"} <= found["failures"][0].keys()
    json.dumps(found, allow_nan=False)


def test_without_timings_the_clock_leaves_no_trace() -> None:
    outcomes = study()
    later = [replace(o, model_s=9.9, world_s=8.8, waited_s=7.7) for o in reversed(outcomes)]
    first = json.dumps(study_json(outcomes, timings=False))
    assert json.dumps(study_json(later, timings=False)) == first
    assert json.dumps(study_json(outcomes)) != json.dumps(study_json(later))
    assert "seconds_per_call" in json.dumps(study_json(outcomes))


def test_an_empty_study_is_one() -> None:
    found = study_json([])
    assert found["cells"] == found["means"] == found["failures"] == found["spearman"] == []


def test_one_variation_is_a_number_and_several_are_a_text() -> None:
    (cell,) = study_json([made("T1", variation=3)])["cells"]
    assert cell["variation"] == 3
    (cell,) = study_json(made("T1", variation=n) for n in range(5))["cells"]
    assert cell["variation"] == "0-4"


def test_deterministic_cells_say_why_there_is_no_interval() -> None:
    (cell,) = study_json([made("T1", model_kind=ModelKind.RULE_BASED)])["cells"]
    assert cell["repeat_interval"] is None and "deterministic" in cell["repeat_reason"]


def test_failures_are_the_scored_episodes_below_one() -> None:
    outcomes = [
        made("T8", 0.5, diagnosis="perceptual", diagnosis_code="wrong_object"),
        made("T8", 1.0, repetition=2),
        made("T8", None, repetition=3),
        made("T8", 0.0, repetition=4),
    ]
    found = study_json(outcomes)["failures"]
    assert [(f["class"], f["code"], f["completion"]) for f in found] == [
        ("perceptual", "wrong_object", 0.5),
        (None, None, 0.0),
    ]
    assert found[0]["episode"] == outcomes[0].key


def test_percentages_are_taken_over_the_papers_three_classes() -> None:
    kinds = ["perceptual"] * 6 + ["execution"] * 3 + ["reasoning", "protocol", "protocol"]
    outcomes = [
        made("T8", 0.0, diagnosis=kind, diagnosis_code=f"{kind}_x", repetition=n)
        for n, kind in enumerate(kinds, start=1)
    ]
    found = {(s.model, s.class_, s.code): s for s in shares(outcomes)}
    assert found[None, "perceptual", None].share == pytest.approx(0.6)
    assert found[None, "execution", "execution_x"].share == pytest.approx(0.3)
    assert found["openai:gpt-4o", "reasoning", None].share == pytest.approx(0.1)
    protocol = found[None, "protocol", None]
    assert (protocol.count, protocol.share) == (2, None)


def test_what_was_not_diagnosed_is_counted_as_such() -> None:
    found = {s.class_: s.count for s in shares([made("T8", 0.0)]) if s.model is None}
    assert found["undiagnosed"] == 1 and found["perceptual"] == 0


def rank(outcomes, level, over):
    """The correlation over all labelings, of the one model or player."""
    rows = ranks(outcomes)
    return next(r.rank for r in rows if (r.labeling, r.level, r.over) == ("all", level, over))


def test_levels_and_completion_are_correlated_over_tasks_and_cells() -> None:
    outcomes = [
        made(f"T{n}", (16 - n) / 15, scene=scene) for n in range(1, 16) for scene in ("s1", "s2")
    ]
    tasks = rank(outcomes, "printed", "tasks")
    assert tasks.n == 15 and tasks.rho == pytest.approx(-1.0, abs=0.01)
    assert rank(outcomes, "computed", "cells").n == 30
    rows = ranks(outcomes)
    assert {row.labeling for row in rows} == {"all", "sem"} and len(rows) == 8


def test_models_of_a_kind_are_put_together_too() -> None:
    outcomes = [
        made(f"T{n}", n % 2, model=model)
        for n in range(1, 16)
        for model in ("openai:gpt-4o", "anthropic:claude-sonnet-4-5")
    ]
    outcomes.append(made("T1", 0.0, model="random", model_kind=ModelKind.RANDOM))
    models = {(row.setting.model, row.setting.model_kind) for row in ranks(outcomes)}
    assert ("all", "vlm") in models and ("all", "random") not in models


def test_tasks_without_a_level_are_left_out() -> None:
    outcomes = [made("T1", 1.0, printed_level=None, computed_level=None)]
    assert rank(outcomes, "printed", "cells").n == 0
