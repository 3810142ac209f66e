"""The baseline in the world: it solves the tabletop tasks that its eyes and rules are made for."""

from __future__ import annotations

from collections.abc import Sequence

import pytest
from tests.inference.baseline.rewordings import REWORDINGS

from adamo_vh.action import ToolSchema
from adamo_vh.benchmark.tasks import TASKS
from adamo_vh.inference.baseline import BaselineModel
from adamo_vh.inference.messages import HumanMessage, Message, TextPart
from adamo_vh.inference.model import Reply, Sampling
from adamo_vh.record.termination import TerminationReason
from adamo_vh.session.runs import run_episode

SMALL = (640, 360)
"""For what is told by names alone; looks need more pixels."""
PROMPT = {task.id: task.prompt for task in TASKS}
SEM = [f"T{n}" for n in range(1, 14)]


class Reworded(BaselineModel):
    """The baseline, told a task in other words, so that the task's checker scores it."""

    def __init__(self, words: str, other_words: str) -> None:
        super().__init__()
        self._words, self._other = words, other_words

    def complete(
        self, messages: Sequence[Message], tools: Sequence[ToolSchema], sampling: Sampling
    ) -> Reply:
        told = [self._reword(m) if isinstance(m, HumanMessage) else m for m in messages]
        return super().complete(told, tools, sampling)

    def _reword(self, message: HumanMessage) -> HumanMessage:
        own = TextPart(self._words)
        parts = tuple(TextPart(self._other) if p == own else p for p in message.parts)
        return HumanMessage(parts)


@pytest.mark.parametrize("task", SEM)
def test_semantic_tags(engine, task):
    result = run_episode(
        task=task, model="baseline", labeling="sem", engine=engine, resolution=SMALL
    )
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
    result = run_episode(
        task="T12", model="baseline", labeling="sem", k=k, engine=engine, resolution=SMALL
    )
    assert result.completion == 1.0


@pytest.mark.parametrize("task", ["T1", "T3", "T4", "T7", "T8", "T10", "T12"])
def test_rewordings_are_played_to_the_same_end(engine, task):
    player = Reworded(PROMPT[task], REWORDINGS[task][-1])
    result = run_episode(task=task, model=player, labeling="sem", engine=engine, resolution=SMALL)
    assert result.completion == 1.0, result.answer


def test_an_instruction_it_does_not_understand_ends_at_once(engine):
    result = run_episode("Sing a song", model="baseline", engine=engine)
    assert sum(result.calls.values()) == 0
    assert "sing" in result.answer
    assert result.termination is TerminationReason.ANSWERED


@pytest.mark.parametrize("labeling", ["sem", "opaq"])
@pytest.mark.parametrize("task", ["T3", "T8", "T10", "T14"])
def test_the_lean_profile_takes_fewer_calls_to_the_same_end(engine, task, labeling):
    result = run_episode(
        task=task, model="baseline", labeling=labeling, profile="lean", engine=engine
    )
    assert result.completion == 1.0, result.answer
    assert result.model_calls < result.steps + 1 or result.steps == 1
    assert result.missing_notes == 0
