"""The loop: one action a turn, a nudge, limits, and three kinds of failure kept apart."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

import pytest

from adamo_vh.action import Code, Outcome, ToolSchema
from adamo_vh.action_server import LocalActionServer
from adamo_vh.cognition.agent import Agent, AgentConfig
from adamo_vh.errors import ProviderError
from adamo_vh.inference.messages import (
    AIMessage,
    HumanMessage,
    ImagePart,
    Message,
    SystemMessage,
    ToolCall,
    ToolMessage,
)
from adamo_vh.inference.model import Model, ModelInfo, ModelKind, Reply, Sampling
from adamo_vh.inference.players.scripted import ScriptedModel
from adamo_vh.record.termination import Limits, TerminationReason
from adamo_vh.record.trajectory import Ended, Started, Trajectory
from adamo_vh.runtime.builtin import BuiltinEngine


class Recorder:
    """A model that keeps the prompts it is given and answers through a function."""

    info = ModelInfo("recorder", ModelKind.SCRIPTED)

    def __init__(self, answer: Callable[[int], Reply]) -> None:
        self.prompts: list[list[Message]] = []
        self._answer = answer

    def complete(
        self, messages: Sequence[Message], tools: Sequence[ToolSchema], sampling: Sampling
    ) -> Reply:
        self.prompts.append(list(messages))
        self.tools = [tool.name for tool in tools]
        return self._answer(len(self.prompts) - 1)


def says(text: str, *calls: tuple[str, Mapping[str, object] | None]) -> AIMessage:
    made = tuple(ToolCall(f"c{i}", name, args) for i, (name, args) in enumerate(calls))
    return AIMessage(text, made)


def run(
    engine: BuiltinEngine, model: Model, limits: Limits | None = None, k: int = 50
) -> tuple[Ended, Trajectory]:
    trajectory = Trajectory()
    server = LocalActionServer(engine, resolution=(480, 270))
    config = AgentConfig(k=k, limits=limits or Limits())
    agent = Agent(model, server, "rules", config, observers=[trajectory])
    return agent.run("Pick the plate"), trajectory


LOOK = ("Look", {"x": 0.0, "y": -1.0, "z": 0.8})
PICK = ("Pick", {"object": "57"})


def test_an_episode_runs_to_its_answer(engine: BuiltinEngine) -> None:
    model = ScriptedModel("s", [says("look", LOOK), says("pick", PICK), says("I hold it.")])
    ended, trajectory = run(engine, model)
    assert ended.reason is TerminationReason.ANSWERED
    assert (ended.answer, ended.steps) == ("I hold it.", 2)
    assert engine.body.said == ["I hold it."]
    assert engine.state().body.held == 57
    kinds = [event.type for event in trajectory.events]
    assert kinds == [
        "started", "observed", "thought", "acted", "observed", "thought", "acted", "thought",
        "ended",
    ]  # fmt: skip


def test_the_prompt_is_the_papers(engine: BuiltinEngine) -> None:
    answers = [says("look", LOOK), says("pick", PICK), says("done")]
    model = Recorder(lambda i: Reply(answers[i]))
    run(engine, model)
    first, second, third = model.prompts
    assert [type(m) for m in first] == [SystemMessage, SystemMessage, HumanMessage]
    assert [type(m) for m in second[3:]] == [AIMessage, ToolMessage, HumanMessage]
    assert [type(m) for m in third[6:]] == [AIMessage, ToolMessage]
    frames = [m for m in third if isinstance(m, HumanMessage)]
    assert all(isinstance(m.parts[-1], ImagePart) for m in frames)
    assert "hand: Plate_57" in third[1].text
    assert "hand: empty" in second[1].text
    assert model.tools == ["Look", "Walk", "Pick", "Drop"]


def test_the_text_describes_the_latest_frame(engine: BuiltinEngine) -> None:
    away = ("Look", {"x": -2.9, "y": -1.0, "z": 1.5})
    answers = [says("away", away), says("walk", ("Walk", {"x": -1, "y": -1, "z": 0})), says("x")]
    model = Recorder(lambda i: Reply(answers[i]))
    run(engine, model)
    states = [prompt[1].text for prompt in model.prompts]
    assert "Plate_57" in states[0]
    assert "## Visible objects\nnone" in states[1]
    assert "## Visible objects\nnone" in states[2]


def test_only_the_first_of_several_calls_is_executed(engine: BuiltinEngine) -> None:
    answers = [says("both", PICK, LOOK), says("done")]
    model = Recorder(lambda i: Reply(answers[i]))
    _, trajectory = run(engine, model)
    assert [act.name for act in trajectory.acts] == ["Pick"]
    results = [m for m in model.prompts[1] if isinstance(m, ToolMessage)]
    assert [m.call_id for m in results] == ["c0", "c1"]
    assert results[1].text == "Not executed: one action a turn."


@pytest.mark.parametrize(
    ("call", "code"),
    [
        (("Teleport", {"x": 1}), Code.UNKNOWN_TOOL),
        (("Look", {"x": "there"}), Code.BAD_ARGUMENT),
        (("Pick", None), Code.BAD_ARGUMENT),
        (("Pick", {"object": "Dragon_1"}), Code.UNKNOWN_TAG),
    ],
)
def test_mistakes_become_feedback_and_the_loop_goes_on(
    engine: BuiltinEngine, call: tuple[str, Mapping[str, object] | None], code: Code
) -> None:
    ended, trajectory = run(engine, ScriptedModel("s", [says("try", call), says("pick", PICK)]))
    assert trajectory.acts[0].feedback.outcome is Outcome.REFUSED
    assert trajectory.acts[0].feedback.code == code
    assert trajectory.acts[1].feedback.outcome is Outcome.DONE
    assert ended.reason is TerminationReason.ANSWERED


def test_an_empty_answer_is_nudged_once(engine: BuiltinEngine) -> None:
    answers = [says(""), says("now", PICK), says("done")]
    model = Recorder(lambda i: Reply(answers[i]))
    ended, _ = run(engine, model)
    nudge = model.prompts[1][-1]
    assert isinstance(nudge, HumanMessage)
    assert "Your last message was empty" in nudge.text
    assert ended.reason is TerminationReason.ANSWERED
    assert engine.state().body.held == 57


def test_two_empty_answers_end_the_episode(engine: BuiltinEngine) -> None:
    ended, trajectory = run(engine, Recorder(lambda _: Reply(says(" "))))
    assert ended.reason is TerminationReason.EMPTY_REPLY
    assert len(trajectory.thoughts) == 2


def test_the_step_limit_truncates(engine: BuiltinEngine) -> None:
    ended, _ = run(engine, Recorder(lambda _: Reply(says("x", PICK))), Limits(max_steps=4))
    assert (ended.reason, ended.steps) == (TerminationReason.STEP_LIMIT, 4)


def test_the_time_limit_truncates_but_waiting_does_not_count(engine: BuiltinEngine) -> None:
    ended, _ = run(engine, Recorder(lambda _: Reply(says("x", LOOK))), Limits(max_seconds=0.0))
    assert ended.reason is TerminationReason.TIME_LIMIT
    answers = [says("x", PICK), says("done")]
    waited = Recorder(lambda i: Reply(answers[i], waited_s=1e6))
    assert run(engine, waited, Limits(max_seconds=60))[0].reason is TerminationReason.ANSWERED


def test_a_provider_fault_breaks_the_episode_without_a_score(engine: BuiltinEngine) -> None:
    def fail(_: int) -> Reply:
        raise ProviderError("503 from the provider")

    ended, trajectory = run(engine, Recorder(fail))
    assert ended.reason is TerminationReason.BROKEN
    assert not ended.reason.is_scored
    assert "503" in ended.answer
    assert engine.body.said == []
    assert isinstance(trajectory.events[0], Started)


def test_a_short_memory_still_works(engine: BuiltinEngine) -> None:
    answers = [says(f"n{i}", PICK) for i in range(6)] + [says("done")]
    model = Recorder(lambda i: Reply(answers[i]))
    _, trajectory = run(engine, model, k=2)
    assert max(len(prompt) for prompt in model.prompts) == 3 + 2 * 2
    assert [thought.forgotten for thought in trajectory.thoughts] == [0, 0, 0, 1]
