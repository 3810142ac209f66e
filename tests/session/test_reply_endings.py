"""No reply ends an episode silently: what is neither a call nor an answer is told and counted."""

from __future__ import annotations

import json
from collections.abc import Sequence
from typing import Any

import pytest
from tests.dialects import DIALECTS, OUTPUT, Chat, Dialect, uri
from tests.fake_provider import Canned, FakeProvider, Json
from tests.talk import QUICK

import adamo_vh
from adamo_vh.episode.result import EpisodeResult
from adamo_vh.inference.ladder import Ladder
from adamo_vh.inference.model import Ending, Rung
from adamo_vh.inference.remote.provider import ProviderModel
from adamo_vh.record.termination import Limits, TerminationReason
from adamo_vh.record.trajectory import Trajectory
from adamo_vh.runtime.builtin import BuiltinEngine

CUT_OFF = {
    "openai-chat": "length",
    "openai-responses": "max_output_tokens",
    "anthropic": "max_tokens",
    "google": "MAX_TOKENS",
}
FILTERED = {
    "openai-chat": "content_filter",
    "openai-responses": "content_filter",
    "anthropic": "refusal",
    "google": "SAFETY",
}
ANSWERS = {
    Rung.NATIVE: "Done.",
    Rung.SCHEMA: '{"thought": "", "action": {"name": "finish", "args": {"answer": "Done."}}}',
    Rung.REACT: "Final Answer: Done.",
}
every_way = pytest.mark.parametrize(
    ("dialect", "rung"),
    [pytest.param(d, rung, id=f"{d.name}-{rung}") for d in DIALECTS for rung in ANSWERS],
)


def play(
    dialect: Dialect, rung: Rung, answers: Sequence[Canned], engine: BuiltinEngine, **more: Any
) -> tuple[EpisodeResult, Trajectory, list[Json]]:
    trajectory = Trajectory()
    with FakeProvider(answers) as server, ProviderModel(uri(dialect, server), QUICK) as model:
        result = adamo_vh.run_episode(
            "Pick object 57.",
            model=Ladder(model, rung),
            engine=engine,
            resolution=(640, 360),
            observers=[trajectory],
            limits=Limits(max_steps=4),
            **more,
        )
    return result, trajectory, server.requests


def endings(trajectory: Trajectory) -> list[Ending | None]:
    return [thought.reply.ending for thought in trajectory.thoughts]


@every_way
def test_a_cut_off_answer_is_told_so_and_counted(
    dialect: Dialect, rung: Rung, engine: BuiltinEngine
) -> None:
    cut = dialect.ended(CUT_OFF[dialect.name], "The plate is on the table. I will now pick")
    tries = 1 if rung is Rung.NATIVE else 2
    done = dialect.answer(ANSWERS[rung])
    result, trajectory, requests = play(dialect, rung, [cut] * tries + [done], engine)
    assert result.termination is TerminationReason.ANSWERED
    assert (result.answer, result.unreadable) == ("Done.", 1)
    assert endings(trajectory) == [Ending.CUT_OFF, Ending.ANSWER]
    assert trajectory.thoughts[0].reply.finish_reason == CUT_OFF[dialect.name]
    assert f"cut off after {OUTPUT} tokens" in json.dumps(requests[-1])
    result, trajectory, _ = play(dialect, rung, [cut] * 3 * tries, engine)
    assert result.termination is TerminationReason.PROTOCOL
    assert endings(trajectory) == [Ending.CUT_OFF] * 3


@every_way
def test_what_a_filter_refused_does_not_go_back(
    dialect: Dialect, rung: Rung, engine: BuiltinEngine
) -> None:
    stopped = dialect.ended(FILTERED[dialect.name], "Something unspeakable")
    done = dialect.answer(ANSWERS[rung])
    result, trajectory, requests = play(dialect, rung, [stopped, done], engine)
    assert result.answer == "Done."
    assert endings(trajectory) == [Ending.FILTERED, Ending.ANSWER]
    assert trajectory.thoughts[0].turn.note == "Something unspeakable"
    told = json.dumps(requests[-1])
    assert "filter of the provider" in told and "unspeakable" not in told


@every_way
def test_a_broken_call_never_ends_an_episode_as_answered(
    dialect: Dialect, rung: Rung, engine: BuiltinEngine
) -> None:
    broken = dialect.answer('<tool_call>\n{"name": "Pick", "arguments": {"object": "57"}')
    result, trajectory, _ = play(dialect, rung, [broken] * 6, engine)
    assert result.termination is TerminationReason.PROTOCOL
    assert endings(trajectory) == [Ending.UNPARSED_CALL] * 3
    assert result.completion is None or result.completion == 0.0


@every_way
def test_a_server_that_refuses_the_models_call_does_not_break_the_episode(
    dialect: Dialect, rung: Rung, engine: BuiltinEngine
) -> None:
    error = {"message": 'error parsing tool call: raw=\'{"object": "57\', err=unexpected end'}
    tries = 1 if rung is Rung.NATIVE else 2
    refused = [Canned({"error": error}, 500)] * tries
    done = dialect.answer(ANSWERS[rung])
    result, trajectory, _ = play(dialect, rung, [*refused, done], engine)
    assert result.termination is TerminationReason.ANSWERED
    assert endings(trajectory) == [Ending.UNPARSED_CALL, Ending.ANSWER]


def test_a_cut_off_call_is_not_carried_out(engine: BuiltinEngine) -> None:
    chat = Chat()
    look: list[tuple[str, str, Json | str]] = [("c1", "Look", {"x": 1, "y": 1, "z": 1})]
    answers = [chat.ended("length", "I look", look), chat.answer("Done.")]
    result, _, requests = play(chat, Rung.NATIVE, answers, engine)
    assert (result.steps, result.answer) == (0, "Done.")
    results = [piece for piece in chat.read(requests[-1]) if piece.kind == "result"]
    assert [piece.id for piece in results] == ["c1"]
    assert "cut off" in results[0].text


def test_a_step_that_goes_on_to_the_limit_is_carried_out(engine: BuiltinEngine) -> None:
    chat = Chat()
    made_up = (
        'Thought: I look.\nAction: Look\nAction Input: {"x": 1, "y": 1, "z": 1}\n'
        "Observation: You hold it.\nThought: Good.\nFinal Ans"
    )
    answers = [chat.ended("length", made_up), chat.answer(ANSWERS[Rung.REACT])]
    result, trajectory, _ = play(chat, Rung.REACT, answers, engine)
    assert (result.steps, result.answer) == (1, "Done.")
    assert [t.reply.finish_reason for t in trajectory.thoughts] == ["length", "stop"]


DRAFTS = {
    Rung.SCHEMA: (
        'I could answer {"thought": "", "action": {"name": "Pick", "args": {"object": "12"}}} no.',
        '{"thought": "", "action": {"name": "Look", "args": {"x": 1, "y": 1, "z": 1}}}',
    ),
    Rung.REACT: (
        'One option is\nAction: Pick\nAction Input: {"object": "12"}\nbut no.',
        'Thought: t\nAction: Look\nAction Input: {"x": 1, "y": 1, "z": 1}',
    ),
    Rung.NATIVE: (
        '<tool_call>{"name": "Pick", "arguments": {"object": "12"}}</tool_call>',
        '<tool_call>{"name": "Look", "arguments": {"x": 1, "y": 1, "z": 1}}</tool_call>',
    ),
}


@pytest.mark.parametrize("close", ["</think>", "</reasoning>", "[/THINK]"])
@pytest.mark.parametrize("rung", DRAFTS)
def test_a_draft_before_the_end_of_reasoning_is_not_carried_out(
    rung: Rung, close: str, engine: BuiltinEngine
) -> None:
    draft, meant = DRAFTS[rung]
    chat = Chat()
    answers = [chat.answer(f"{draft}\n{close}\n\n{meant}"), chat.answer(ANSWERS[rung])]
    result, trajectory, _ = play(chat, rung, answers, engine)
    assert [act.name for act in trajectory.acts] == ["Look"]
    assert result.answer == "Done."


@pytest.mark.parametrize("rung", [Rung.SCHEMA, Rung.REACT])
def test_an_ambiguous_step_is_asked_for_again(rung: Rung, engine: BuiltinEngine) -> None:
    draft, meant = DRAFTS[rung]
    chat = Chat()
    both = chat.answer(f"{draft}\n\n{meant}")
    answers = [both, chat.answer(meant), chat.answer(ANSWERS[rung])]
    _, trajectory, requests = play(chat, rung, answers, engine)
    assert [act.name for act in trajectory.acts] == ["Look"]
    assert "could not be read" in json.dumps(requests[1])
