"""What a reply is on every wire: a call, an answer, cut off, an unparsed call, empty, filtered."""

from __future__ import annotations

import time
from typing import Any

import pytest
from tests.dialects import DIALECTS, OUTPUT, Chat, Dialect
from tests.fake_provider import Canned
from tests.providers.dialect import Call
from tests.talk import NAMES, tell

from adamo_vh.errors import ProviderError
from adamo_vh.inference.model import Ending, Rung
from adamo_vh.inference.remote.endings import finish_reason, meaning, refused_call

every_wire = pytest.mark.parametrize("dialect", DIALECTS, ids=NAMES)
PICK: list[Call] = [("c1", "Pick", {"object": "Plate_57"})]
CUT = {
    "openai-chat": ("length", "model_length", "max_tokens", "abort"),
    "openai-responses": ("max_output_tokens",),
    "anthropic": ("max_tokens", "model_context_window_exceeded", "pause_turn"),
    "google": ("MAX_TOKENS", "OTHER"),
}
FILTERED = {
    "openai-chat": ("content_filter", "guardrail_intervened", "sensitive"),
    "openai-responses": ("content_filter",),
    "anthropic": ("refusal",),
    "google": ("SAFETY", "RECITATION", "BLOCKLIST", "PROHIBITED_CONTENT", "SPII"),
}
OWN = {
    "openai-chat": ("stop", "", "eos", "tool_calls"),
    "openai-responses": (),
    "anthropic": ("end_turn", "stop_sequence"),
    "google": ("STOP",),
}


@every_wire
def test_an_answer_that_was_cut_off_is_no_answer(dialect: Dialect) -> None:
    for reason in CUT[dialect.name]:
        for text in ("The plate is on the table. I will now pick", ""):
            reply = tell(dialect, [dialect.ended(reason, text)]).reply
            assert (reply.ending, reply.finish_reason) == (Ending.CUT_OFF, reason)
            assert reply.unreadable.startswith(f"was cut off after {OUTPUT} tokens ({reason})")
            assert reply.message.text == text


@every_wire
def test_a_call_that_may_be_cut_through_is_no_call(dialect: Dialect) -> None:
    for reason in CUT[dialect.name]:
        reply = tell(dialect, [dialect.ended(reason, "I take", PICK)]).reply
        assert reply.ending is Ending.CUT_OFF
        text = '<tool_call>{"name": "Pick", "arguments": {"object": "5"}}</tool_call>'
        assert tell(dialect, [dialect.ended(reason, text)]).reply.ending is Ending.CUT_OFF


@every_wire
def test_what_a_filter_stopped_is_no_answer(dialect: Dialect) -> None:
    for reason in FILTERED[dialect.name]:
        for text in ("The plate is", ""):
            reply = tell(dialect, [dialect.ended(reason, text)]).reply
            assert (reply.ending, reply.finish_reason) == (Ending.FILTERED, reason)
            assert "filter of the provider" in reply.unreadable and reason in reply.unreadable
    reply = tell(dialect, [dialect.refusal()]).reply
    assert reply.ending is Ending.FILTERED
    assert not reply.message.calls


@every_wire
def test_an_end_of_its_own_is_an_answer_or_nothing_at_all(dialect: Dialect) -> None:
    for reason in OWN[dialect.name]:
        reply = tell(dialect, [dialect.ended(reason, "Done.")]).reply
        assert (reply.ending, reply.finish_reason) == (Ending.ANSWER, reason)
        assert tell(dialect, [dialect.ended(reason)]).reply.ending is Ending.EMPTY
        assert tell(dialect, [dialect.ended(reason, "", PICK)]).reply.ending is Ending.CALL


@every_wire
def test_a_call_in_the_text_is_read_or_said_to_be_none(dialect: Dialect) -> None:
    text = "I take it.\n<tool_call><function=Pick><parameter=object>57</parameter></function>"
    reply = tell(dialect, [dialect.answer(text)]).reply
    assert (reply.ending, reply.rung) == (Ending.CALL, Rung.LEAKED)
    assert reply.message.text == "I take it."
    assert reply.message.calls[0].arguments == {"object": "57"}
    for broken in (text[:-40], "I call Pick(object='57') now.", '{"name": "Fly", "args": {}}'):
        reply = tell(dialect, [dialect.answer(broken)]).reply
        assert reply.ending is Ending.UNPARSED_CALL
        assert reply.message.text == broken
        assert "Make calls as tool calls" in reply.unreadable


@every_wire
def test_a_draft_in_the_reasoning_is_no_call(dialect: Dialect) -> None:
    draft = 'One could\n<tool_call>{"name": "Pick", "arguments": {"object": "12"}}</tool_call>\n'
    for tags in (("", "</think>"), ("<reasoning>", "</reasoning>"), ("[THINK]", "[/THINK]")):
        reply = tell(dialect, [dialect.answer(f"{tags[0]}{draft}{tags[1]}I am done.")]).reply
        assert (reply.ending, reply.message.text) == (Ending.ANSWER, "I am done.")
        reply = tell(dialect, [dialect.answer(f"{tags[0]}{draft}{tags[1]}")]).reply
        assert (reply.ending, reply.message.calls) == (Ending.UNPARSED_CALL, ())
        assert "inside its reasoning" in reply.unreadable


def test_google_tells_that_it_could_not_read_a_call() -> None:
    google = DIALECTS[NAMES.index("google")]
    for reason in ("MALFORMED_FUNCTION_CALL", "UNEXPECTED_TOOL_CALL"):
        body = {"candidates": [{"finishReason": reason, "index": 0}]}
        reply = tell(google, [Canned(body)]).reply
        assert (reply.ending, reply.finish_reason) == (Ending.UNPARSED_CALL, reason)
        assert reason in reply.unreadable


def test_a_call_of_the_old_kind_is_a_call() -> None:
    function = {"name": "Pick", "arguments": '{"object": "57"}'}
    reply = tell(Chat(), [Chat().answer(function_call=function)]).reply
    assert reply.ending is Ending.CALL
    assert reply.message.calls[0].arguments == {"object": "57"}


COMPLAINTS = [
    (400, {"message": "Failed to call a function.", "code": "tool_use_failed"}),
    (400, {"message": "Parsing failed.", "code": "output_parse_failed"}),
    (400, {"message": "tool call validation failed: attempted to call tool 'Fly'"}),
    (500, {"message": 'error parsing tool call: raw=\'{"object": "5\', err=unexpected end'}),
    (500, {"message": "Failed to parse input at pos 12: <tool_call>"}),
    (500, {"message": "Failed to parse tool call arguments as JSON: unexpected end of input"}),
    (500, {"message": "Model produced an invalid tool call"}),
    (422, {"message": "Could not parse function call in the model's output"}),
    (500, {"message": "The tool call could not be parsed"}),
    (400, {"message": "Tool choice is none, but model called a tool"}),
    (400, {"message": "Extra data: line 1 column 24 (char 23)"}),
    (400, {"message": "Unterminated string starting at: line 1 column 12 (char 11)"}),
    (500, {"message": "Expecting ',' delimiter: line 1 column 54 (char 53)"}),
    (400, {"message": "Model produced invalid sequence as part of ToolUse."}),
    (500, {"message": "Failed to generate a valid tool call"}),
]


@every_wire
@pytest.mark.parametrize(("status", "error"), COMPLAINTS)
def test_a_server_that_cannot_read_the_models_call_is_not_at_fault(
    dialect: Dialect, status: int, error: dict[str, str]
) -> None:
    told = tell(dialect, [Canned({"error": error}, status)])
    assert told.reply.ending is Ending.UNPARSED_CALL
    assert told.reply.unreadable.startswith("holds a call that the server could not read: ")
    assert (told.reply.requests, len(told.requests)) == (1, 1)


@every_wire
def test_what_the_model_wrote_is_read_out_of_the_complaint(dialect: Dialect) -> None:
    def ask(written: str) -> tuple[Ending, str, int]:
        error = {"message": "Failed to call a function.", "failed_generation": written}
        reply = tell(dialect, [Canned({"error": error}, 400)]).reply
        return reply.ending, reply.message.text, len(reply.message.calls)

    assert ask('I go.\n<function=Pick>{"object": "57"}</function>') == (Ending.CALL, "I go.", 1)
    broken = '<function=Pick>{"object": "57"</function>'
    assert ask(broken) == (Ending.UNPARSED_CALL, broken, 0)


@pytest.mark.parametrize(
    "message",
    [
        "Unexpected role 'user' after role 'tool'",
        "messages[3].tool_calls: could not parse function call arguments",
        "tool_call_id of a tool message is missing",
        "The model does not support tools",
        "Expecting value: line 1 column 1 (char 0)",
        "invalid character '<' looking for beginning of value",
        "",
    ],
)
def test_a_complaint_about_the_request_is_a_fault(message: str) -> None:
    with pytest.raises(ProviderError):
        tell(Chat(), [Canned({"error": {"message": message}}, 400)])


@pytest.mark.parametrize(
    ("word", "ending"),
    [
        ("MAX_OUTPUT_TOKENS", Ending.CUT_OFF),
        ("context_length_exceeded", Ending.CUT_OFF),
        ("incomplete", Ending.CUT_OFF),
        ("content_filtered", Ending.FILTERED),
        ("malformed_tool_use", Ending.UNPARSED_CALL),
        ("function_call", None),
        ("end_turn", None),
        ("COMPLETE", None),
        ("eos_token", None),
        ("", None),
    ],
)
def test_the_words_of_other_providers_are_understood(word: str, ending: Ending | None) -> None:
    assert meaning(word) is ending


def test_no_body_breaks_the_reading_of_its_end() -> None:
    odd: list[Any] = [None, [], "x", {}, {"choices": []}, {"choices": [None]}, {"choices": {}}]
    for body in odd:
        assert finish_reason(body) == ""
        assert refused_call(body, "") is None
    assert refused_call({"error": {"message": 5}}, "5") is None
    assert finish_reason({"choices": [{"finish_reason": "\ud800"}]}) == "?"


@pytest.mark.parametrize("piece", ["parsing ", "tool call ", "invalid ", "model ", "raw='", "{"])
def test_a_long_complaint_is_read_in_proportion_to_its_length(piece: str) -> None:
    text = piece * (600_000 // len(piece))
    begin = time.thread_time()
    refused_call({"error": {"message": text}}, text)
    meaning(text)
    assert time.thread_time() - begin < 1.0
