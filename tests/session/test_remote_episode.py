"""Whole episodes with a remote model over a real socket: good answers, bad ones, none at all."""

from __future__ import annotations

from typing import Any

import pytest
from tests.fake_provider import Canned, FakeProvider, call, completion, fault

import adamo_vh
from adamo_vh.action import Code
from adamo_vh.inference.model import ModelKind
from adamo_vh.inference.remote.provider import ProviderModel
from adamo_vh.inference.remote.retry import RetryPolicy
from adamo_vh.record.termination import Limits, TerminationReason
from adamo_vh.record.trajectory import Observed, Trajectory
from adamo_vh.runtime.builtin import BuiltinEngine

QUICK = RetryPolicy(max_tries=2, max_wait_s=2.0, base_s=0.01, timeout_s=5.0)
PICK = call("Pick", {"object": "34"})


def run(engine: BuiltinEngine, *answers: Canned) -> tuple[adamo_vh.EpisodeResult, Trajectory, Any]:
    trajectory = Trajectory()
    with FakeProvider(answers) as server:
        model = ProviderModel(server.uri(), QUICK)
        result = adamo_vh.run_episode(
            task="T1",
            model=model,
            engine=engine,
            resolution=(1280, 720),
            observers=[trajectory],
            limits=Limits(max_steps=5),
        )
        return result, trajectory, server.requests


def test_an_openai_compatible_server_finishes_t1(engine: BuiltinEngine) -> None:
    look = call("Look", {"x": 0, "y": -1, "z": 0.8})
    result, trajectory, requests = run(
        engine,
        completion("I look for 34.", [look]),
        completion("It is there.", [PICK]),
        completion("I hold object 34."),
    )
    assert (result.completion, result.strict) == (1.0, 1.0)
    assert result.model_kind is ModelKind.VLM
    assert result.termination is TerminationReason.ANSWERED
    assert result.tokens == 3 * 1234
    assert result.answer == "I hold object 34."
    assert len([e for e in trajectory.events if isinstance(e, Observed)]) == 2
    roles = [message["role"] for message in requests[2]["messages"]]
    assert roles == ["system", "system", "user", "assistant", "tool", "user", "assistant", "tool"]


@pytest.mark.parametrize(
    ("answer", "code"),
    [
        (completion("Hm.", [call("Fly", {"x": 1})]), Code.UNKNOWN_TOOL),
        (completion("Hm.", [call("Pick", "{not json")]), Code.BAD_ARGUMENT),
        (completion("Hm.", [call("Pick", {"thing": 34})]), Code.BAD_ARGUMENT),
        (completion("Hm.", [call("Pick", {"object": "Ghost_99"})]), Code.UNKNOWN_TAG),
    ],
)
def test_mistakes_of_the_model_are_answered_and_the_loop_goes_on(
    engine: BuiltinEngine, answer: Canned, code: Code
) -> None:
    result, trajectory, _ = run(engine, answer, completion("", [PICK]), completion("Done."))
    assert trajectory.acts[0].feedback.code == code
    assert result.completion == 1.0
    assert result.missing_notes == 1


def test_of_two_calls_at_once_the_first_is_executed(engine: BuiltinEngine) -> None:
    both = completion("Both.", [PICK, call("Walk", {"x": 0, "y": 2, "z": 0}, "call_b")])
    result, _, requests = run(engine, both, completion("Done."))
    assert result.calls == {"Pick": 1}
    results = [m for m in requests[1]["messages"] if m["role"] == "tool"]
    assert [m["tool_call_id"] for m in results] == ["call_a", "call_b"]
    assert results[1]["content"] == "Not executed: one action a turn."


def test_nothing_at_all_is_nudged_and_then_ends(engine: BuiltinEngine) -> None:
    result, _, requests = run(engine, completion(""), completion(None))
    assert result.termination is TerminationReason.EMPTY_REPLY
    assert result.completion == 0.0
    assert "empty" in str(requests[1]["messages"][-1]["content"])


def test_prose_is_the_final_answer(engine: BuiltinEngine) -> None:
    result, _, _ = run(engine, completion("Sorry, I cannot do that."))
    assert result.termination is TerminationReason.ANSWERED
    assert result.completion == 0.0


@pytest.mark.parametrize(
    "answer", [Canned(b"<html>garbage</html>"), fault(500), fault(401, "bad key"), Canned(cut=True)]
)
def test_a_fault_of_the_provider_is_unscored_and_never_zero(
    engine: BuiltinEngine, answer: Canned
) -> None:
    result, _, _ = run(engine, *[answer] * 4)
    assert result.termination is TerminationReason.BROKEN
    assert result.completion is None
    assert result.strict is None


def test_waiting_for_retries_is_left_out_of_the_time(engine: BuiltinEngine) -> None:
    slow = fault(429, headers={"Retry-After": "1"})
    result, trajectory, _ = run(engine, slow, completion("x", [PICK]), completion("Done."))
    assert result.completion == 1.0
    assert trajectory.thoughts[0].reply.waited_s >= 0.9
    assert trajectory.ended is not None
    assert trajectory.thoughts[0].reply.seconds < trajectory.thoughts[0].reply.waited_s
