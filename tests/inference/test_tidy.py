"""Whatever a model gives, its reply can be recorded and sent, and goes to the tool it means."""

from __future__ import annotations

import json
from typing import Any

import pytest

from adamo_vh import run_episode
from adamo_vh.action import Look, Pick, tool_schema
from adamo_vh.inference.messages import AIMessage, ToolCall
from adamo_vh.inference.model import Reply
from adamo_vh.inference.players.scripted import ScriptedModel
from adamo_vh.inference.tidy import tidied
from adamo_vh.record.termination import TerminationReason
from adamo_vh.record.trajectory import Trajectory
from adamo_vh.runtime.builtin import BuiltinEngine

TOOLS = [tool_schema(action) for action in (Look, Pick)]


def deep(levels: int) -> dict[str, Any]:
    value: Any = 1
    for _ in range(levels):
        value = [value]
    return {"x": value}


ODD: list[Any] = [
    {"x": float("nan")},
    {"x": float("inf"), "y": 0, "z": 0},
    {"x": 10**6000},
    {"x": {1, 2}},
    {"x": b"bytes"},
    {"x": object()},
    deep(60),
    deep(500),
    deep(100_000),
]


@pytest.mark.parametrize("arguments", ODD, ids=range(len(ODD)))
def test_arguments_that_are_no_json_are_unreadable(arguments: Any) -> None:
    (call,) = tidied(Reply(AIMessage("", (ToolCall("a", "Look", arguments),))), TOOLS).message.calls
    assert call.arguments is None
    assert len(call.raw) <= 2000


def test_lone_surrogates_are_replaced_wherever_they_stand() -> None:
    call = ToolCall("\udfff", "P\ud800", {"object": "\ud800", "\ud801": 1}, "\ud802")
    said = Reply(AIMessage("a \ud83d b", (call,)), unreadable="\ud800", finish_reason="\ud800")
    reply = tidied(said, TOOLS)
    assert reply.message.text == "a ? b"
    assert reply.message.calls == (ToolCall("?", "P?", {"object": "?", "?": 1}, "?"),)
    assert (reply.unreadable, reply.finish_reason) == ("?", "?")


def test_a_name_is_read_as_that_of_the_tool_it_means_and_kept_as_written() -> None:
    calls = tuple(ToolCall("a", name, {}) for name in ("Pick", "functions.pick", "Fly"))
    read = tidied(Reply(AIMessage("", calls)), TOOLS).message.calls
    assert [(c.name, c.written_name) for c in read] == [
        ("Pick", ""),
        ("Pick", "functions.pick"),
        ("Fly", ""),
    ]


def test_odd_replies_neither_break_an_episode_nor_its_record(
    engine: BuiltinEngine, tmp_path: Any
) -> None:
    replies = [
        AIMessage("bad \ud800", (ToolCall("a", "Look", ODD[7]),)),
        AIMessage("n", (ToolCall("b", "look", ODD[0]),)),
        AIMessage("n", (ToolCall("c", "Pick", {"object": "\ud800"}),)),
        AIMessage("answer \udfff"),
    ]
    trajectory = Trajectory()
    result = run_episode(
        "Pick object 57.",
        model=ScriptedModel("s", replies),
        engine=engine,
        resolution=(640, 360),
        observers=[trajectory],
        out=tmp_path / "run",
    )
    assert result.termination is TerminationReason.ANSWERED
    assert (result.answer, result.steps) == ("answer ?", 3)
    assert all(act.feedback.text.startswith("Refused: ") for act in trajectory.acts)
    lines = (tmp_path / "run" / "events.jsonl").read_text(encoding="utf-8").splitlines()
    assert all(json.loads(line) for line in lines)
    assert '"written_name":"look"' in "\n".join(lines)
