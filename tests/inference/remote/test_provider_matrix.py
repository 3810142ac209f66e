"""Every wire in every plain case: what arrives at the server, and what comes back from it."""

from __future__ import annotations

import pytest
from tests.dialects import CACHED, DIALECTS, INPUT, OUTPUT, REASONING, Dialect
from tests.providers.dialect import Call
from tests.talk import ASK, FIRST, NAMES, SECOND, TOOLS, calls, tell

from adamo_vh.action import ToolSchema
from adamo_vh.inference.messages import (
    AIMessage,
    HumanMessage,
    SystemMessage,
    TextPart,
    ToolCall,
    ToolMessage,
)
from adamo_vh.inference.model import Rung, Usage

pytestmark = pytest.mark.parametrize("dialect", DIALECTS, ids=NAMES)

PLATE = {"object": "Plate_57"}
STEP = ToolSchema(
    "step",
    "One step.",
    {
        "type": "object",
        "properties": {"thought": {"type": "string"}, "action": {"type": "string"}},
        "required": ["thought", "action"],
        "additionalProperties": False,
    },
)


def test_plain_text(dialect: Dialect) -> None:
    told = tell(dialect, [dialect.answer("Done.")])
    assert told.reply.message == AIMessage("Done.", kept=told.reply.message.kept)
    assert told.reply.rung is Rung.NATIVE
    assert told.reply.requests == 1
    assert 0 < told.reply.seconds < 5 and told.reply.waited_s < 0.1
    assert told.paths == [dialect.path]
    assert told.model.wire == dialect.name
    assert told.model.pictures_in_results is dialect.pictures_in_results


def test_the_prompt_arrives_in_its_roles_and_order(dialect: Dialect) -> None:
    told = tell(dialect, [dialect.answer("ok")])
    system = "\n\n".join(piece.text for piece in told.said() if piece.role == "system")
    assert system == "You live in a body.\n\nPlate_57 at (0.2, -1.0, 0.8)."
    text, picture = [piece for piece in told.said() if piece.role == "user"]
    assert (text.text, picture.data) == ("Pick the plate", FIRST.data)


def test_tools_arrive_with_their_own_schemas(dialect: Dialect) -> None:
    told = tell(dialect, [dialect.answer("ok")])
    arrived = dialect.tools(told.requests[0])
    assert list(arrived) == [tool.name for tool in TOOLS]
    for tool in TOOLS:
        assert arrived[tool.name]["properties"] == tool.parameters["properties"]
        assert arrived[tool.name]["required"] == tool.parameters["required"]


def test_one_call(dialect: Dialect) -> None:
    told = tell(dialect, [dialect.answer("I take it.", [("c1", "Pick", PLATE)])])
    message = told.reply.message
    assert (message.text, len(message.calls)) == ("I take it.", 1)
    found = message.calls[0]
    assert (found.id, found.name, found.arguments) == ("c1", "Pick", PLATE)


def test_two_calls(dialect: Dialect) -> None:
    two: list[Call] = [("c1", "Pick", PLATE), ("c2", "Look", {"x": 0})]
    told = tell(dialect, [dialect.answer(calls=two)])
    found = told.reply.message.calls
    assert [(c.id, c.name, c.arguments) for c in found] == [*two]


def test_every_call_gets_exactly_one_result_in_the_order_of_the_calls(dialect: Dialect) -> None:
    """Also where results are missing, come twice or out of order, or between other messages."""
    prompt = (
        *ASK,
        calls("a", "b", "c"),
        HumanMessage((SECOND,)),
        ToolMessage("b", "Look", "two"),
        ToolMessage("a", "Look", "one"),
        ToolMessage("a", "Look", "one again"),
    )
    told = tell(dialect, [dialect.answer("ok")], prompt)
    assert [p.id for p in told.said("call")] == ["a", "b", "c"]
    results = [(p.id, p.text) for p in told.said("result")]
    assert results == [("a", "one"), ("b", "two"), ("c", "Not executed.")]
    assert told.said()[-1].data == SECOND.data


def test_a_result_whose_call_is_gone_becomes_plain_text(dialect: Dialect) -> None:
    told = tell(dialect, [dialect.answer("ok")], (*ASK, ToolMessage("gone", "Look", "You look.")))
    assert not told.said("result")
    assert (told.said()[-1].role, told.said()[-1].text) == ("user", "Result of Look: You look.")


def test_a_frame_after_the_feedback_is_the_users(dialect: Dialect) -> None:
    prompt = (*ASK, calls("a"), ToolMessage("a", "Look", "You look."), HumanMessage((SECOND,)))
    told = tell(dialect, [dialect.answer("ok")], prompt)
    call, result, frame = told.said()[-3:]
    assert (call.kind, result.kind, frame.kind) == ("call", "result", "image")
    assert (frame.role, frame.data) == ("user", SECOND.data)


def test_pictures_of_a_result_are_in_it_or_right_behind_all_results(dialect: Dialect) -> None:
    prompt = (
        *ASK,
        calls("a", "b"),
        ToolMessage("a", "Inspect", "one", (FIRST, SECOND)),
        ToolMessage("b", "Survey", "two", (SECOND,)),
        HumanMessage((TextPart("Go on."),)),
    )
    told = tell(dialect, [dialect.answer("ok")], prompt)
    answered = [p for p in told.said() if p.kind == "call"][-1]
    after = told.said()[told.said().index(answered) + 1 :]
    pictures = [(p.role, p.id, p.data) for p in after if p.kind == "image"]
    if dialect.pictures_in_results:
        assert pictures == [
            ("tool", "a", FIRST.data),
            ("tool", "a", SECOND.data),
            ("tool", "b", SECOND.data),
        ]
        assert [p.text for p in after if p.kind != "image"] == ["one", "two", "Go on."]
        return
    assert [(p.role, p.kind, p.text) for p in after] == [
        ("tool", "result", "one"),
        ("tool", "result", "two"),
        ("user", "text", "Picture from Inspect (a):"),
        ("user", "image", ""),
        ("user", "image", ""),
        ("user", "text", "Picture from Survey (b):"),
        ("user", "image", ""),
        ("user", "text", "Go on."),
    ]


def test_late_system_text_stays_in_its_place(dialect: Dialect) -> None:
    late = SystemMessage("Now: Plate_57 in hand.")
    told = tell(dialect, [dialect.answer("ok")], (*ASK, calls("a"), late))
    assert told.said()[-1].text == late.text
    system = [p.text for p in told.said() if p.role == "system"][:1]
    assert system[0].startswith("You live in a body.")


def test_bad_arguments_come_back_as_none_and_go_out_as_valid_json(dialect: Dialect) -> None:
    raw = "{x: 1"
    if dialect.name in ("openai-chat", "openai-responses"):
        told = tell(dialect, [dialect.answer(calls=[("c1", "Look", raw)])])
        (bad,) = told.reply.message.calls
    else:
        bad = ToolCall("c1", "Look", None, raw)  # These wires carry objects alone.
    assert (bad.arguments, bad.raw) == (None, raw)
    result = ToolMessage("c1", "Look", "No JSON object.")
    told = tell(dialect, [dialect.answer("ok")], (*ASK, AIMessage("n", (bad,)), result))
    (sent,) = told.said("call")
    assert sent.value == {"unreadable_arguments": raw}


def test_ids_are_unique_in_the_conversation(dialect: Dialect) -> None:
    prompt = (*ASK, calls("a"), ToolMessage("a", "Look", "You look."))
    told = tell(dialect, [dialect.answer(calls=[("a", "Pick", PLATE)])], prompt)
    (again,) = told.reply.message.calls
    assert again.id != "a"
    echoed = (*prompt, told.reply.message, ToolMessage(again.id, "Pick", "ok"))
    told = tell(dialect, [dialect.answer("ok")], echoed)
    assert [p.id for p in told.said("call")] == [p.id for p in told.said("result")]
    assert [p.id for p in told.said("call")] == ["a", again.id]


def test_a_leaked_call(dialect: Dialect) -> None:
    leaked = 'I see it.\n```json\n{"name": "Pick", "arguments": {"object": "Plate_57"}}\n```'
    told = tell(dialect, [dialect.answer(leaked)])
    assert told.reply.rung is Rung.LEAKED
    assert told.reply.message.text == "I see it."
    assert told.reply.message.calls[0].arguments == PLATE
    call = told.reply.message.calls[0]
    echoed = (*ASK, told.reply.message, ToolMessage(call.id, "Pick", "ok"))
    told = tell(dialect, [dialect.answer("ok")], echoed)
    assert [(p.kind, p.text) for p in told.said("text", "call", "result")][-3:] == [
        ("text", "I see it."),
        ("call", "Pick"),
        ("result", "ok"),
    ]


def test_an_empty_reply_can_be_answered(dialect: Dialect) -> None:
    told = tell(dialect, [dialect.answer("")])
    assert (told.reply.message.text, told.reply.message.calls) == ("", ())
    nudge = HumanMessage((TextPart("Your answer was empty."),))
    told = tell(dialect, [dialect.answer("ok")], (*ASK, told.reply.message, nudge))
    assert told.said()[-1].text == "Your answer was empty."
    assert not [p for p in told.said() if p.role == "assistant"]


def test_usage_means_the_same_everywhere(dialect: Dialect) -> None:
    told = tell(dialect, [dialect.answer("ok")])
    assert told.reply.usage == Usage(INPUT, OUTPUT, CACHED, REASONING)


def test_json_of_a_schema(dialect: Dialect) -> None:
    step = '{"thought": "hm", "action": "Pick"}'
    told = tell(dialect, [dialect.answer(step)], tools=(), schema=STEP)
    assert told.reply.message.text == step
    assert "tools" not in told.requests[0]
    sent = dialect.schema(told.requests[0])
    assert sent is not None
    assert sent["properties"] == STEP.parameters["properties"]
    assert sent["required"] == STEP.parameters["required"]


def test_thinking_goes_back_as_it_came_and_is_no_text(dialect: Dialect) -> None:
    first = dialect.answer("I take it.", [("c1", "Pick", PLATE)], thinking="signed-3f9a")
    reply = tell(dialect, [first]).reply
    assert reply.message.text == "I take it."
    assert "signed-3f9a" in reply.message.kept or "c2lnbmVkLTNmOWE" in reply.message.kept
    echoed = (*ASK, reply.message, ToolMessage("c1", "Pick", "You hold it."))
    told = tell(dialect, [dialect.answer("ok")], echoed)
    assert [p.text for p in told.said("thinking")] == ["signed-3f9a"]
    kinds = [p.kind for p in told.said() if p.role in ("assistant", "tool")]
    google = ["text", "thinking", "call", "result"]
    assert kinds == (google if dialect.name == "google" else sorted(google, key=_first_thinking))


def _first_thinking(kind: str) -> int:
    return ["thinking", "text", "call", "result"].index(kind)


def test_what_another_model_kept_is_left_out(dialect: Dialect) -> None:
    first = dialect.answer("I take it.", [("c1", "Pick", PLATE)], thinking="signed-3f9a")
    kept = tell(dialect, [first]).reply.message.kept
    foreign = kept.replace(f"{dialect.name}:{dialect.model}", "other:model")
    for text in (foreign, "garbage", '{"from": 1}'):
        told = tell(dialect, [dialect.answer("ok")], (*ASK, calls("a", kept=text)))
        assert "signed-3f9a" not in [p.text for p in told.said("thinking")]
        assert [p.id for p in told.said("call")] == ["a"]


def test_the_message_has_the_last_word_on_what_was_kept(dialect: Dialect) -> None:
    first = dialect.answer("I take it.", [("c1", "Pick", PLATE)], thinking="signed-3f9a")
    kept = tell(dialect, [first]).reply.message.kept
    edited = AIMessage("Shorter.", calls("a", "b").calls, kept)
    told = tell(dialect, [dialect.answer("ok")], (*ASK, edited))
    assert [p.text for p in told.said("text") if p.role == "assistant"] == ["Shorter."]
    assert [(p.id, p.text) for p in told.said("call")] == [("a", "Look"), ("b", "Look")]
    assert [p.text for p in told.said("thinking")] == ["signed-3f9a"]
