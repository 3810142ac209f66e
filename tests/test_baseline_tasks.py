"""The baseline in the world: it solves the tabletop tasks that its eyes and rules are made for."""

from __future__ import annotations

import pytest

from adamo.assemble import run_episode
from adamo.cognition.termination import TerminationReason

SEM = [f"T{n}" for n in range(1, 14)]


@pytest.mark.parametrize("task", SEM)
def test_semantic_tags(engine, task):
    result = run_episode(task=task, model="baseline", labeling="sem", engine=engine)
    assert (result.completion, result.strict) == (1.0, 1.0), result.answer
    assert result.missing_notes == 0


@pytest.mark.parametrize("labeling", ["sem", "opaq"])
@pytest.mark.parametrize("task", ["T14", "T15"])
def test_groups_told_by_their_looks(engine, task, labeling):
    result = run_episode(task=task, model="baseline", labeling=labeling, engine=engine)
    assert result.completion is not None
    assert result.completion >= 0.8, result.answer


@pytest.mark.parametrize("task", ["T1", "T2", "T3", "T5", "T6", "T7", "T9"])
def test_opaque_tags(engine, task):
    result = run_episode(task=task, model="baseline", labeling="opaq", engine=engine)
    assert result.completion == 1.0, result.answer


@pytest.mark.parametrize("k", [1, 4])
def test_a_short_memory(engine, k):
    result = run_episode(task="T12", model="baseline", labeling="sem", k=k, engine=engine)
    assert result.completion == 1.0


def test_an_instruction_it_does_not_understand_ends_at_once(engine):
    result = run_episode("Sing a song", model="baseline", engine=engine)
    assert sum(result.calls.values()) == 0
    assert "sing" in result.answer
    assert result.termination is TerminationReason.ANSWERED
