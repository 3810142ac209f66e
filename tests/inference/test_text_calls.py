"""A call that leaked into the text is recognised; prose never becomes a call."""

from __future__ import annotations

import json

import pytest
from hypothesis import given
from hypothesis import strategies as st

from adamo_vh.inference.arguments import UNREADABLE, read_arguments, wire_arguments
from adamo_vh.inference.messages import ToolCall
from adamo_vh.inference.text_calls import fresh_id, recognise_call

TOOLS = ("Look", "Walk", "Pick", "Drop")
CALL = '{"name": "Pick", "arguments": {"object": "Plate_57"}}'
ARGUMENTS = {"object": "Plate_57"}


@pytest.mark.parametrize(
    ("text", "note"),
    [
        (CALL, ""),
        (f"  {CALL}\n", ""),
        (f"I see the plate.\n{CALL}", "I see the plate."),
        (f"I see the plate.\n\n```json\n{CALL}\n```", "I see the plate."),
        (f"```\n{CALL}\n```\nThis takes the plate.", "This takes the plate."),
        (f"First.\n<tool_call>\n{CALL}\n</tool_call>\nThen.", "First.\nThen."),
        (f"<tool_call>{CALL}</tool_call>", ""),
        (f"<tool_call>\n{CALL}", ""),
        ('{"tool": "Pick", "args": {"object": "Plate_57"}}', ""),
        ('{"name": "Pick", "parameters": {"object": "Plate_57"}}', ""),
        ('{"type": "function", "name": "Pick", "arguments": {"object": "Plate_57"}}', ""),
        ('{"id": "1", "type": "function", "function": ' + CALL + "}", ""),
        (json.dumps({"name": "Pick", "arguments": json.dumps(ARGUMENTS)}), ""),
        (json.dumps(json.loads(CALL), indent=2), ""),
    ],
)
def test_a_leaked_call_is_recognised_with_the_rest_as_its_note(text: str, note: str) -> None:
    message = recognise_call(text, TOOLS, ())
    assert message is not None
    assert message.text == note
    (call,) = message.calls
    assert (call.name, call.arguments) == ("Pick", ARGUMENTS)
    assert json.loads(call.raw)


@pytest.mark.parametrize(
    "text",
    [
        "",
        "The plate is in my hand. I am done.",
        "I would call Pick(object='Plate_57') now.",
        f"One could write {CALL} here.",
        f"The call {CALL}",
        f"{CALL} is what I did before.",
        f"{CALL}\n{CALL}",
        f'{CALL}\n{{"x": 1}}',
        f"[{CALL}]",
        f'{{"answer": {CALL}}}',
        '{"name": "Fly", "arguments": {"x": 1}}',
        '{"name": "pick", "arguments": {"object": "Plate_57"}}',
        '{"name": "Pick"}',
        '{"name": "Pick", "arguments": ["Plate_57"]}',
        '{"name": "Pick", "arguments": "Plate_57"}',
        '{"name": ["Pick"], "arguments": {}}',
        '{"name": "Pick", "arguments": {"object": "Plate_57"}, "status": "done"}',
        '{"name": "Pick", "arguments": {"object": "Plate_57"}',
        '{"object": "Plate_57"}',
        "{" * 5000,
    ],
)
def test_anything_else_stays_text(text: str) -> None:
    assert recognise_call(text, TOOLS, ()) is None


@given(st.text(alphabet=st.sampled_from('{}[]":, \n`abPick<>/_1'), max_size=60))
def test_no_text_breaks_the_recogniser(text: str) -> None:
    message = recognise_call(text, TOOLS, ())
    assert message is None or message.calls[0].name in TOOLS


def test_ids_are_deterministic_and_differ_from_those_taken() -> None:
    first = fresh_id("text", ())
    assert first == fresh_id("text", ())
    assert len(first) == 9 and first.isalnum()
    assert fresh_id("text", {first}) not in ("", first)


@pytest.mark.parametrize(
    ("raw", "arguments"),
    [
        ('{"x": 1, "y": -2.5}', {"x": 1, "y": -2.5}),
        ("", {}),
        ("{}", {}),
        ('{"object": "caf\\u00e9"}', {"object": "café"}),
        ('{"object": "\\ud800"}', {"object": "?"}),
        ("{x: 1}", None),
        ('{"x": 1', None),
        ("[1, 2]", None),
        ('"Plate_57"', None),
        ("null", None),
        ('{"x": NaN}', None),
        ('{"x": 1e999}', None),
        ("[" * 100_000, None),
        ('{"x": ' + "9" * 5000 + "}", None),
    ],
)
def test_arguments_are_one_strict_json_object_or_none(
    raw: str, arguments: dict[str, object] | None
) -> None:
    assert read_arguments(raw) == arguments


@given(st.text(max_size=40))
def test_whatever_a_model_wrote_goes_back_as_a_valid_json_object(raw: str) -> None:
    call = ToolCall("a", "Look", read_arguments(raw), raw)
    sent = wire_arguments(call)
    assert json.loads(json.dumps(sent, allow_nan=False).encode()) == sent
    assert call.arguments is not None or UNREADABLE in sent
