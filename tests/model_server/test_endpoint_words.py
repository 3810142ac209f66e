"""The words of the served endpoint: any request is read or refused, answers say the same."""

from __future__ import annotations

import copy
import json
from collections.abc import Iterator
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from adamo_vh.inference.cost.tokens import estimate_reply
from adamo_vh.inference.messages import AIMessage, ToolCall
from adamo_vh.inference.model import Usage
from adamo_vh.model_server.fault_rules import Rule, Style, What
from adamo_vh.model_server.injected_faults import error_message, is_as_it_is, spoiled
from adamo_vh.model_server.json_fields import BadRequest
from adamo_vh.model_server.openai_messages import read_request
from adamo_vh.model_server.openai_replies import (
    Answer,
    completion_body,
    completion_events,
    fitted,
)

PICTURE = (
    "data:image/png;base64,iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR4nGNgYGD4DwABBAEA"
    "wS2OUAAAAABJRU5ErkJggg=="
)
BODY: dict[str, Any] = {
    "model": "baseline",
    "messages": [
        {"role": "system", "content": "You are the mind."},
        {"role": "user", "content": [
            {"type": "text", "text": "Pick the cup"},
            {"type": "image_url", "image_url": {"url": PICTURE}}]},
        {"role": "assistant", "content": None, "tool_calls": [
            {"id": "c1", "type": "function",
             "function": {"name": "Pick", "arguments": '{"object": "Cup_45"}'}}]},
        {"role": "tool", "tool_call_id": "c1", "content": "Done: Cup_45 is in your hand."},
    ],
    "tools": [{"type": "function", "function": {
        "name": "Pick", "description": "Take it.", "parameters": {"type": "object"}}}],
    "tool_choice": "auto",
    "temperature": 0.5, "top_p": 1, "max_tokens": 100, "n": 1, "stream": False,
    "stream_options": {"include_usage": True},
    "response_format": {"type": "json_schema", "json_schema": {"name": "s", "schema": {}}},
}  # fmt: skip
json_values = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=8)
    | st.sampled_from(["user", "tool", "function", "c1", "Pick", PICTURE, PICTURE[:30]]),
    lambda inner: st.lists(inner, max_size=3)
    | st.dictionaries(st.sampled_from(["type", "role", "content", "text", "name"]), inner),
    max_leaves=5,
)  # fmt: skip


def places(value: Any, path: tuple[Any, ...] = ()) -> Iterator[tuple[Any, ...]]:
    """The ways to all values in a body."""
    if path:
        yield path
    if isinstance(value, dict | list):
        for key, inner in value.items() if isinstance(value, dict) else enumerate(value):
            yield from places(inner, (*path, key))


PLACES = list(places(BODY))


def changed(path: tuple[Any, ...], value: Any, leave_out: bool) -> dict[str, Any]:
    body = copy.deepcopy(BODY)
    at: Any = body
    for key in path[:-1]:
        at = at[key]
    if leave_out:
        del at[path[-1]]
    else:
        at[path[-1]] = value
    return body


def test_a_whole_request_is_read() -> None:
    asked = read_request(BODY)
    assert [message.role for message in asked.messages] == ["system", "human", "ai", "tool"]
    assert [tool.name for tool in asked.tools] == ["Pick"]
    assert (asked.sampling.temperature, asked.sampling.top_p, asked.most_tokens) == (0.5, 1, 100)
    assert (asked.stream, asked.stream_usage, asked.schema) == (False, True, {})
    assert {"image_url", "temperature"} <= asked.parameters


@settings(max_examples=300, deadline=None)
@given(st.sampled_from(PLACES), json_values, st.booleans())
def test_with_any_one_field_otherwise_it_is_read_or_refused_by_field(
    path: tuple[Any, ...], value: Any, leave_out: bool
) -> None:
    refused: BadRequest | None = None
    try:
        asked = read_request(changed(path, value, leave_out))
    except BadRequest as fault:
        refused = fault
    if refused is None:
        assert asked.messages
    else:
        assert str(refused).startswith(f"{refused.field}: ")
        assert str(refused).endswith(".")


@given(json_values)
def test_any_body_is_read_or_refused(body: Any) -> None:
    with pytest.raises(BadRequest):
        read_request(body)


# --- answers --------------------------------------------------------------------------------

texts = st.text(st.characters(codec="utf-8"), max_size=30)
arguments = st.dictionaries(texts, texts | st.integers(-999, 999), max_size=3)
messages = st.builds(
    AIMessage,
    texts,
    st.lists(st.builds(ToolCall, texts, texts, arguments), max_size=3).map(tuple),
)
usages = st.builds(Usage, *[st.integers(0, 9999)] * 4)


def streamed(answer: Answer, with_usage: bool) -> tuple[dict[str, Any], Any, str]:
    """Message, token counts and reason, put together from the events of a stream."""
    events = [
        event.removeprefix("data: ").strip() for event in completion_events(answer, with_usage)
    ]
    assert events[-1] == "[DONE]"
    message: dict[str, Any] = {"content": ""}
    usage, reason = None, ""
    for event in map(json.loads, events[:-1]):
        usage = event.get("usage") or usage
        for choice in event["choices"]:
            delta = choice["delta"]
            message["role"] = delta.get("role", message.get("role"))
            message["content"] += delta.get("content") or ""
            for call in delta.get("tool_calls", []):
                whole = {key: value for key, value in call.items() if key != "index"}
                assert call["index"] == len(message.setdefault("tool_calls", []))
                message["tool_calls"].append(whole)
            reason = choice["finish_reason"] or reason
    return message, usage, reason


@settings(deadline=None)
@given(messages, usages, st.booleans(), st.booleans())
def test_a_stream_says_what_one_piece_says(
    message: AIMessage, usage: Usage, cut: bool, with_usage: bool
) -> None:
    answer = Answer(3, "m", message, usage, cut)
    body = json.loads(json.dumps(completion_body(answer)))
    (choice,) = body["choices"]
    told, counted, reason = streamed(answer, with_usage)
    assert {**choice["message"], "content": choice["message"]["content"] or ""} == told
    assert choice["finish_reason"] == reason
    assert counted == (body["usage"] if with_usage else None)
    calls = choice["message"].get("tool_calls", [])
    assert [json.loads(c["function"]["arguments"]) for c in calls] == [
        call.arguments for call in message.calls
    ]


@settings(deadline=None)
@given(messages, st.none() | st.integers(1, 60))
def test_a_limit_cuts_the_text_and_never_through_a_call(
    message: AIMessage, most: int | None
) -> None:
    left, is_cut = fitted(message, most)
    if not is_cut:
        assert left == message
        return
    assert most is not None
    assert estimate_reply(left) <= most < estimate_reply(message)
    assert left.calls == ()
    assert message.text.startswith(left.text)


# --- faults on purpose ----------------------------------------------------------------------

CALL = ToolCall("c1", "Pick", {"object": "Cup_45"})
SAID = AIMessage("I take it.", (CALL,))


def spoilt(what: What, style: Style | None = None) -> AIMessage:
    return spoiled(SAID, Rule(what=what, every=1, style=style))


def test_each_fault_spoils_what_it_names_and_nothing_else() -> None:
    assert spoilt(What.EMPTY_REPLY) == AIMessage("")
    unknown = spoilt(What.UNKNOWN_TOOL)
    assert (unknown.text, unknown.calls[0].arguments) == (SAID.text, CALL.arguments)
    assert unknown.calls[0].name != "Pick"
    wrong = spoilt(What.WRONG_ARGUMENTS).calls[0]
    assert wrong.name == "Pick" and wrong.arguments != CALL.arguments
    assert json.loads(wrong.raw) == wrong.arguments
    broken = spoilt(What.BROKEN_ARGUMENTS).calls[0]
    with pytest.raises(json.JSONDecodeError):
        json.loads(broken.raw)
    assert [call.id for call in spoilt(What.TWO_CALLS).calls] == ["c1", "c1_2"]


@pytest.mark.parametrize("style", Style)
def test_a_leaked_call_is_all_in_the_text(style: Style) -> None:
    leaked = spoilt(What.LEAKED_CALL, style)
    assert leaked.calls == ()
    assert leaked.text.startswith("I take it.\n")
    written = leaked.text[leaked.text.index("{") : leaked.text.rindex("}") + 1]
    assert json.loads(written) == {"name": "Pick", "arguments": {"object": "Cup_45"}}


@pytest.mark.parametrize("what", [w for w in What if w is not What.EMPTY_REPLY])
def test_an_answer_without_a_call_has_none_to_spoil(what: What) -> None:
    rule, said = Rule(what=what, every=1), AIMessage("I am done.")
    assert spoiled(said, rule) == said
    assert not is_as_it_is(said, rule)


def test_an_error_says_what_a_real_server_would() -> None:
    assert error_message(Rule(what=What.ERROR, status=429, every=1)) == "Rate limit reached."
    own = Rule(what=What.ERROR, status=500, message="Out of order.", every=1)
    assert error_message(own) == "Out of order."
    refused = Rule(what=What.REFUSED_PARAMETER, parameter="top_p", every=1)
    assert "'top_p'" in error_message(refused)
