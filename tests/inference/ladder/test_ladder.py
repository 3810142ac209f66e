"""Without tool calls: what a model is told, how it is read, and one repair."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Annotated, Any

import pytest
from pydantic import Field

from adamo_vh.action import Drop, Look, Pick, Survey, ToolSchema, Walk, tool_schema
from adamo_vh.inference.ladder import Ladder
from adamo_vh.inference.ladder.json_form import JsonForm
from adamo_vh.inference.messages import (
    AIMessage,
    HumanMessage,
    ImagePart,
    Message,
    SystemMessage,
    TextPart,
    ToolCall,
    ToolMessage,
)
from adamo_vh.inference.model import ModelInfo, ModelKind, Reply, Rung, Sampling, Usage

TOOLS = [tool_schema(action) for action in (Look, Walk, Pick, Drop, Survey)]
FRAME = ImagePart(b"first", "image/jpeg", 1920, 1080)
CLOSE = ImagePart(b"close", "image/jpeg", 640, 640)
ASK: tuple[Message, ...] = (
    SystemMessage("You live in a body."),
    SystemMessage("Plate_57 at (0.2, -1.0, 0.8)."),
    HumanMessage((TextPart("Pick the plate"), FRAME)),
)
PICK = {"object": "Plate_57"}


@dataclass
class Where:
    """A place."""

    x: Annotated[float, Field(ge=0)]


@dataclass
class Put:
    """Put it."""

    where: Where
    how: list[str] | None = None


def noted(tool: ToolSchema) -> ToolSchema:
    """A tool with a note and a confidence as its first arguments."""
    given = tool.parameters
    extra = {"note": {"type": "string"}, "confidence": {"type": "number", "minimum": 0}}
    return ToolSchema(
        tool.name,
        tool.description,
        {
            **given,
            "properties": {**extra, **given.get("properties", {})},
            "required": ["note", "confidence", *given.get("required", [])],
        },
    )


class Wire:
    """A model that says what it is given and keeps what it was asked."""

    info = ModelInfo("wire", ModelKind.VLM)

    def __init__(self, *said: str | Reply) -> None:
        self._said = [Reply(AIMessage(one)) if isinstance(one, str) else one for one in said]
        self.prompts: list[list[Message]] = []
        self.schemas: list[ToolSchema | None] = []

    def complete(
        self,
        messages: Sequence[Message],
        tools: Sequence[ToolSchema],
        sampling: Sampling,
        *,
        schema: ToolSchema | None = None,
    ) -> Reply:
        self.prompts.append(list(messages))
        self.schemas.append(schema)
        self.tools = list(tools)
        return self._said.pop(0)


def ask(
    rung: Rung,
    *said: str | Reply,
    messages: Sequence[Message] = ASK,
    tools: Sequence[ToolSchema] = TOOLS,
) -> tuple[Reply, Wire]:
    wire = Wire(*said)
    return Ladder(wire, rung).complete(messages, tools, Sampling()), wire


def called(reply: Reply) -> tuple[str, Any]:
    (call,) = reply.message.calls
    return call.name, call.arguments


@pytest.mark.parametrize(
    "text",
    [
        'Thought: I see it.\nAction: Pick\nAction Input: {"object": "Plate_57"}',
        'thought: I see it.\n\naction: pick\naction input:\n{"object": "Plate_57"}',
        '**Thought:** I see it.\n**Action:** `Pick`\n**Action Input:** {"object": "Plate_57"}',
        '```\nThought: I see it.\nAction: Pick\nAction Input: {"object": "Plate_57"}\n```',
        'I see it.\nAction: Pick\nAction Input:\n```json\n{\n "object": "Plate_57"\n}\n```',
        'Thought: I see it.\nAction: Pick({"object": "Plate_57"})',
        'Thought: I see it.\nAction: Pick Action Input: {"object": "Plate_57"}',
        'Thought: I see it.\nAction: Pick.\nAction_Input: {"object": "Plate_57"} and so on',
        'Thought: I see it.\nAction: Pick\nAction Input: {"object": "Plate_57"}\n'
        "Observation: Done.\nThought: Good.\nFinal Answer: I hold it.",
        '{"thought": "I see it.", "action": {"name": "Pick", "args": {"object": "Plate_57"}}}',
        'I see it.\n{"name": "Pick", "arguments": {"object": "Plate_57"}}',
    ],
)
def test_react_is_read_generously(text: str) -> None:
    reply, _ = ask(Rung.REACT, text)
    assert reply.message.text == "I see it."
    assert called(reply) == ("Pick", PICK)
    assert (reply.rung, reply.requests, reply.unreadable) == (Rung.REACT, 1, "")


@pytest.mark.parametrize(
    "text",
    [
        '{"thought": "I see it.", "action": {"name": "Pick", "args": {"object": "Plate_57"}}}',
        '```json\n{"thought": "I see it.", "action": {"name": "pick", "args": {"object": '
        '"Plate_57"}}}\n```',
        '{"thought": "I see it.", "action": "Pick", "args": {"object": "Plate_57"}}',
        '{"thought": "I see it.", "action": "Pick", "args": "{\\"object\\": \\"Plate_57\\"}"}',
        'Thought: I see it.\nAction: Pick\nAction Input: {"object": "Plate_57"}',
    ],
)
def test_a_json_step_is_read(text: str) -> None:
    reply, wire = ask(Rung.SCHEMA, text)
    assert reply.message.text == "I see it."
    assert called(reply) == ("Pick", PICK)
    assert reply.rung is Rung.SCHEMA
    assert wire.tools == []


@pytest.mark.parametrize(
    ("rung", "text"),
    [
        (Rung.REACT, "Thought: All done.\nFinal Answer: I hold it."),
        (Rung.REACT, "Final Answer:\n\nI hold it."),
        (Rung.REACT, 'Thought: x\nAction: finish\nAction Input: {"answer": "I hold it."}'),
        (Rung.REACT, "Thought: x\nAction: Finish\nAction Input: I hold it."),
        (Rung.SCHEMA, '{"thought": "x", "action": {"name": "finish", "args": '
                      '{"answer": "I hold it."}}}'),
    ],
)  # fmt: skip
def test_a_final_answer_is_text_without_a_call(rung: Rung, text: str) -> None:
    reply, _ = ask(rung, text)
    assert reply.message == AIMessage("I hold it.")
    assert reply.unreadable == ""


@pytest.mark.parametrize("given", ["", "{}", "None", "()"])
def test_a_tool_without_arguments_needs_none(given: str) -> None:
    reply, _ = ask(Rung.REACT, f"Thought: t\nAction: Survey\nAction Input: {given}")
    assert called(reply) == ("Survey", {})


def test_an_unknown_tool_is_a_call_and_the_agents_business() -> None:
    reply, wire = ask(Rung.REACT, 'Action: Fly\nAction Input: {"to": "moon"}')
    assert called(reply) == ("Fly", {"to": "moon"})
    assert len(wire.prompts) == 1


@pytest.mark.parametrize(
    ("text", "problem"),
    [
        ("I would pick the plate.", '"Action:"'),
        ("Thought: t\nAction: Pick", '"Action Input:" of Pick'),
        ('Action: Pick\nAction Input: {"object": "Plate_57"', '"Action Input:" of Pick'),
        ('Action: Look\nAction Input: {"x": NaN}', '"Action Input:" of Look'),
        ("Action: \nAction Input: {}", "name of a tool"),
        ("", "empty"),
    ],
)
def test_react_garbage_is_asked_for_again_once(text: str, problem: str) -> None:
    good = 'Thought: t\nAction: Pick\nAction Input: {"object": "Plate_57"}'
    reply, wire = ask(Rung.REACT, text, good)
    assert called(reply) == ("Pick", PICK)
    assert (reply.requests, reply.unreadable) == (2, "")
    last = wire.prompts[1][-1]
    assert isinstance(last, HumanMessage)
    assert problem in last.text
    assert len(wire.prompts[1]) == len(wire.prompts[0]) + (2 if text else 0)
    reply, wire = ask(Rung.REACT, text, text)
    assert problem in reply.unreadable
    assert reply.message.text == text
    assert reply.message.calls == ()
    assert reply.requests == len(wire.prompts) == 2


@pytest.mark.parametrize(
    ("text", "problem"),
    [
        ("I pick it.", "no complete JSON object"),
        ('{"thought": "t"}', '"action"'),
        ('{"thought": "t", "action": {"name": "Pick", "args": "the plate"}}', '"args" of Pick'),
        ('{"thought": "t", "action": {"name": "Look", "args": {"x": 1e999}}}', '"args" of Look'),
    ],
)
def test_an_ignored_schema_is_repaired(text: str, problem: str) -> None:
    good = json.dumps({"thought": "t", "action": {"name": "Pick", "args": PICK}})
    reply, wire = ask(Rung.SCHEMA, text, good)
    assert called(reply) == ("Pick", PICK)
    assert reply.requests == 2
    assert wire.schemas[0] == wire.schemas[1] is not None
    assert wire.prompts[1][-2] == AIMessage(text)
    assert problem in str(wire.prompts[1][-1])
    assert problem in ask(Rung.SCHEMA, text, text)[0].unreadable


def test_what_a_repair_takes_is_added_up() -> None:
    bad = Reply(AIMessage("?"), Usage(10, 2, 3, 1), 1.0, 0.5, 2, 0.25, {"top_p": 0.5})
    good = replace(bad, message=AIMessage("Final Answer: ok"), settings={})
    reply, _ = ask(Rung.REACT, bad, good)
    assert reply.usage == Usage(20, 4, 6, 2)
    assert (reply.seconds, reply.waited_s, reply.requests) == (2.0, 1.0, 4)
    assert reply.cost_usd == 0.5
    assert reply.settings == {}
    reply, _ = ask(Rung.REACT, bad, replace(good, cost_usd=None))
    assert reply.cost_usd is None


def test_a_thought_is_the_note_where_a_tool_wants_one() -> None:
    tools = [noted(tool) for tool in TOOLS]
    text = 'Thought: I see it.\nAction: Pick\nAction Input: {"confidence": 0.9, "object": "a"}'
    reply, wire = ask(Rung.REACT, text, tools=tools)
    assert reply.message.text == "I see it."
    assert called(reply) == ("Pick", {"confidence": 0.9, "object": "a", "note": "I see it."})
    system = wire.prompts[0][0]
    assert isinstance(system, SystemMessage)
    assert '"confidence": number' in system.text
    assert '"note"' not in system.text
    feedback = ToolMessage(reply.message.calls[0].id, "Pick", "Done.")
    _, wire = ask(Rung.REACT, text, messages=(*ASK, reply.message, feedback), tools=tools)
    assert wire.prompts[0][2] == AIMessage(text)


def test_a_tool_that_ends_the_episode_leaves_no_other_end_on_offer() -> None:
    finish = ToolSchema("Finish", "End.", {"properties": {"answer": {"type": "string"}}})
    for rung in (Rung.SCHEMA, Rung.REACT):
        said = 'Action: finish\nAction Input: {"answer": "ok"}'
        reply, wire = ask(rung, said, tools=[*TOOLS, finish])
        assert called(reply) == ("Finish", {"answer": "ok"})
        told = str(wire.prompts[0])
        assert "Final Answer" not in told and '"finish"' not in told
        assert json.dumps(wire.schemas[0] and wire.schemas[0].parameters).count("inish") <= 1


def test_the_conversation_is_told_in_the_models_own_words() -> None:
    step = (
        AIMessage("Two at once.", (ToolCall("a", "Look", {"x": 1}), ToolCall("b", "Pick", PICK))),
        ToolMessage("a", "Look", "You look.", (CLOSE,)),
        ToolMessage("b", "Pick", "Not executed."),
        HumanMessage((TextPart("New view."), FRAME)),
        AIMessage("Bad.", (ToolCall("c", "Look", None, "{x: 1"),)),
        ToolMessage("c", "Look", "Refused."),
    )
    _, wire = ask(Rung.REACT, "Final Answer: ok", messages=(*ASK, *step))
    (prompt,) = wire.prompts
    assert [type(message) for message in prompt] == [
        SystemMessage, HumanMessage, AIMessage, HumanMessage, AIMessage, HumanMessage, AIMessage,
        HumanMessage,
    ]  # fmt: skip
    assert prompt[2] == AIMessage('Thought: Two at once.\nAction: Look\nAction Input: {"x": 1}')
    assert prompt[3] == HumanMessage((TextPart("Observation: You look."), CLOSE))
    assert prompt[4] == AIMessage('Action: Pick\nAction Input: {"object": "Plate_57"}')
    parts = (TextPart("Observation: Not executed."), TextPart("New view."), FRAME)
    assert prompt[5] == HumanMessage(parts)
    assert "unreadable_arguments" in prompt[6].text


def test_tools_are_described_once_between_instructions_and_state() -> None:
    for rung in (Rung.SCHEMA, Rung.REACT):
        _, wire = ask(rung, "Final Answer: ok")
        system = wire.prompts[0][0]
        assert isinstance(system, SystemMessage)
        places = [
            system.text.index(text)
            for text in (
                "You live in a body.",
                "# The form of your answer",
                "- Look {",
                "at (0.2",
            )
        ]
        assert places == sorted(places)
        assert all(system.text.count(f"\n- {tool.name} {{") == 1 for tool in TOOLS)


def test_what_no_one_could_read_goes_back_as_it_was() -> None:
    reply, _ = ask(Rung.SCHEMA, "Hm.", "Hm, hm.")
    nudge = HumanMessage((TextPart("Try again."),))
    _, wire = ask(Rung.SCHEMA, "Final Answer: ok", messages=(*ASK, reply.message, nudge))
    assert wire.prompts[0][-2:] == [AIMessage("Hm, hm."), nudge]
    answered = AIMessage("I hold it.")
    _, wire = ask(Rung.SCHEMA, "Final Answer: ok", messages=(*ASK, answered, nudge))
    assert '"finish"' in str(wire.prompts[0][-2])


def test_a_schema_stays_within_what_strict_decoders_know() -> None:
    schema = JsonForm().schema([tool_schema(Look), tool_schema(Put), noted(TOOLS[2])]).parameters
    text = json.dumps(schema)
    assert not [key for key in ("minimum", "maxLength", "default", "title", "note") if key in text]
    assert schema["$defs"]["Put_Where"]["additionalProperties"] is False
    assert '"#/$defs/Put_Where"' in text
    look, _, _, finish = schema["properties"]["action"]["anyOf"]
    assert look["properties"]["name"] == {"type": "string", "const": "Look"}
    assert look["properties"]["args"]["required"] == ["x", "y", "z"]
    assert finish["properties"]["args"]["required"] == ["answer"]


def test_the_upper_rungs_pass_everything_on() -> None:
    said = Reply(AIMessage("n", (ToolCall("a", "Pick", PICK),)), rung=Rung.NATIVE)
    reply, wire = ask(Rung.NATIVE, said)
    assert reply == said
    assert wire.prompts == [list(ASK)]
    assert wire.tools == TOOLS


def test_call_ids_never_repeat() -> None:
    text = 'Thought: t\nAction: Pick\nAction Input: {"object": "Plate_57"}'
    messages = list(ASK)
    for _ in range(3):
        reply, _ = ask(Rung.REACT, text, messages=messages)
        (call,) = reply.message.calls
        messages += [reply.message, ToolMessage(call.id, call.name, "Refused.")]
    ids = [
        call.id for message in messages if isinstance(message, AIMessage) for call in message.calls
    ]
    assert len(set(ids)) == 3
