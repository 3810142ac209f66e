"""The same model reaches the same completion on every rung, with a real socket in between."""

from __future__ import annotations

from dataclasses import asdict
from pathlib import Path

import pytest
from tests.brain import Brain, Step
from tests.fake_provider import Canned, FakeProvider, Json, completion

import adamo_vh
from adamo_vh.action import action_name
from adamo_vh.action_server import LocalActionServer
from adamo_vh.benchmark.oracle import Oracle
from adamo_vh.benchmark.tasks import task as find_task
from adamo_vh.inference.ladder import Ladder
from adamo_vh.inference.model import Rung
from adamo_vh.inference.registry import create_model
from adamo_vh.inference.remote.provider import ProviderModel
from adamo_vh.inference.remote.retry import RetryPolicy
from adamo_vh.perception import Labeling, PerceptionConfig
from adamo_vh.record.termination import TerminationReason
from adamo_vh.record.trajectory import Trajectory
from adamo_vh.runtime.builtin import BuiltinEngine

QUICK = RetryPolicy(max_tries=2, max_wait_s=2.0, base_s=0.01, timeout_s=10.0)
SIZE = (960, 540)
TASKS = ("T1", "T4", "T8")


def oracle_steps(engine: BuiltinEngine, task: str) -> list[Step]:
    """The oracle's calls for a task."""
    engine.reset(0)
    perception = PerceptionConfig(labeling=Labeling.SEM)
    server = LocalActionServer(engine, perception=perception, resolution=SIZE)
    oracle = Oracle(find_task(task).conditions, server.tag, server.body.info)
    server.observe()
    steps: list[Step] = []
    while (action := oracle.next_action(engine.state(), server.seen)) is not None:
        server.execute(action)
        steps.append((action_name(type(action)), asdict(action)))
    engine.reset(0)
    return steps


@pytest.mark.parametrize("task", TASKS)
def test_every_rung_reaches_the_same_completion(engine: BuiltinEngine, task: str) -> None:
    steps = oracle_steps(engine, task)
    ends = set()
    for rung in Rung:
        brain = Brain(steps, tools="leaked" if rung is Rung.LEAKED else "native")
        trajectory = Trajectory()
        with FakeProvider(brain) as server:
            model = Ladder(ProviderModel(server.uri(), QUICK), rung)
            result = adamo_vh.run_episode(
                task=task, model=model, engine=engine, resolution=SIZE, observers=[trajectory]
            )
            model.info.close()
        assert (result.completion, result.strict) == (1.0, 1.0), rung
        assert result.termination is TerminationReason.ANSWERED
        assert result.answer == brain.answer
        assert [(act.name, act.arguments) for act in trajectory.acts] == steps
        assert {thought.reply.rung for thought in trajectory.thoughts[:-1]} == {rung}
        offered = ["tools" in request for request in brain.asked]
        assert set(offered) == {rung in (Rung.NATIVE, Rung.LEAKED)}
        assert all("response_format" in r for r in brain.asked) is (rung is Rung.SCHEMA)
        ends.add(result.state_hash)
    assert len(ends) == 1


@pytest.mark.parametrize(
    ("tools", "schema", "rung"),
    [
        ("native", "obeyed", Rung.NATIVE),
        ("leaked", "obeyed", Rung.LEAKED),
        ("400", "obeyed", Rung.SCHEMA),
        ("500", "obeyed", Rung.SCHEMA),
        ("none", "obeyed", Rung.SCHEMA),
        ("400", "400", Rung.REACT),
        ("500", "ignored", Rung.REACT),
        ("none", "ignored", Rung.REACT),
    ],
)
def test_the_probe_finds_the_rung_on_which_the_model_succeeds(
    engine: BuiltinEngine,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    tools: str,
    schema: str,
    rung: Rung,
) -> None:
    monkeypatch.setenv("ADAMO_VH_CACHE_DIR", str(tmp_path))
    brain = Brain(oracle_steps(engine, "T1"), tools=tools, schema=schema)
    with FakeProvider(brain) as server:
        model = create_model(server.uri(), QUICK)
        assert isinstance(model, Ladder)
        assert model.info.rung is rung
        result = adamo_vh.run_episode(task="T1", model=model, engine=engine, resolution=SIZE)
        model.info.close()
    assert result.completion == 1.0


@pytest.mark.parametrize("rung", [Rung.SCHEMA, Rung.REACT])
def test_the_lean_profile_works_without_tool_calls(engine: BuiltinEngine, rung: Rung) -> None:
    """Notes come from the thoughts, and the tool Finish is the one way to end."""
    sure: Json = {"confidence": 0.9}
    steps = [(name, {**sure, **args}) for name, args in oracle_steps(engine, "T4")]
    last = {**sure, "asked": "a", "verified": "v", "unseen": "u", "answer": "It is there."}
    brain = Brain([*steps, ("Finish", last)])
    trajectory = Trajectory()
    with FakeProvider(brain) as server:
        model = Ladder(ProviderModel(server.uri(), QUICK), rung)
        result = adamo_vh.run_episode(
            task="T4",
            model=model,
            engine=engine,
            resolution=SIZE,
            profile="lean",
            observers=[trajectory],
        )
        model.info.close()
    assert (result.completion, result.answer) == (1.0, "It is there.")
    assert result.missing_notes == 0
    calls = [call for thought in trajectory.thoughts for call in thought.reply.message.calls]
    assert all((call.arguments or {})["note"] == f"Now I {call.name}." for call in calls)
    assert len(brain.asked) == len(steps) + 1


def test_every_request_of_a_rung_without_tools_has_plain_turns(engine: BuiltinEngine) -> None:
    brain = Brain(oracle_steps(engine, "T4"))
    with FakeProvider(brain) as server:
        model = Ladder(ProviderModel(server.uri(), QUICK), Rung.REACT)
        adamo_vh.run_episode(task="T4", model=model, engine=engine, resolution=SIZE)
        model.info.close()
    for number, request in enumerate(brain.asked):
        roles = [message["role"] for message in request["messages"]]
        assert roles == ["system", *["user", "assistant"] * number, "user"]


def test_garbage_is_counted_and_not_scored_as_an_answer(engine: BuiltinEngine) -> None:
    steps = oracle_steps(engine, "T1")
    brain = Brain(steps)
    garbage = [completion("Hmm?"), completion("Hmm, hmm.")]

    def answer(request: Json) -> Canned:
        return garbage.pop(0) if garbage else brain(request)

    trajectory = Trajectory()
    with FakeProvider(answer) as server:
        model = Ladder(ProviderModel(server.uri(), QUICK), Rung.REACT)
        adamo_vh.run_episode(
            task="T1", model=model, engine=engine, resolution=SIZE, observers=[trajectory]
        )
        model.info.close()
    first, second, *_ = trajectory.thoughts
    assert "Action:" in first.reply.unreadable
    assert first.reply.requests == 2
    assert second.reply.unreadable == ""
