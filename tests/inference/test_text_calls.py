"""A call that was left in the text is read; what cannot be read is said; prose stays prose."""

from __future__ import annotations

import json
import time

import pytest
from hypothesis import given
from hypothesis import strategies as st

from adamo_vh.action import Drop, Look, Pick, Survey, Walk, tool_schema
from adamo_vh.inference.messages import AIMessage
from adamo_vh.inference.reasoning_text import split_reasoning
from adamo_vh.inference.text_calls import UnparsedCall, read_calls
from adamo_vh.inference.tool_names import fresh_id

TOOLS = [tool_schema(action) for action in (Look, Walk, Pick, Drop, Survey)]
ARGUMENTS = {"object": "Plate_57"}
ARGS = json.dumps(ARGUMENTS)
CALL = f'{{"name": "Pick", "arguments": {ARGS}}}'
XML = "<parameter=object>\nPlate_57\n</parameter>"
SEP, BEGIN, END = "<｜tool▁sep｜>", "<｜tool▁call▁begin｜>", "<｜tool▁call▁end｜>"

PLAIN = [
    CALL,
    f"  {CALL}\n",
    json.dumps(json.loads(CALL), indent=2),
    f"[{CALL}]",
    f"```json\n{CALL}\n```",
    f"```\n{CALL}\n```",
    f'{{"tool": "Pick", "args": {ARGS}}}',
    f'{{"name": "Pick", "parameters": {ARGS}}}',
    f'{{"action": "Pick", "action_input": {ARGS}}}',
    f'{{"type": "function", "name": "Pick", "arguments": {ARGS}}}',
    f'{{"type": "tool_use", "id": "x", "name": "Pick", "input": {ARGS}}}',
    f'{{"id": "1", "type": "function", "function": {CALL}}}',
    f'{{"tool_calls": [{CALL}]}}',
    f'{{"thought": "I see it.", "action": {{"name": "Pick", "args": {ARGS}}}}}',
    json.dumps({"name": "Pick", "arguments": ARGS}),
    CALL.replace("Pick", "pick"),
    CALL.replace("Pick", "functions.Pick"),
    f"Pick {ARGS}",
    f"Action: Pick\nAction Input: {ARGS}",
    '[Pick(object="Plate_57")]',
    "Pick(object='Plate_57')",
    'Pick("Plate_57")',
    f"functions.Pick({ARGS})",
    '```tool_code\nprint(default_api.Pick(object="Plate_57"))\n```',
]
MARKED = [
    f"<tool_call>\n{CALL}\n</tool_call>",
    f"<tool_call>{CALL}</tool_call><|im_end|>",
    f"<tool_call>\n{CALL}",
    f"<tool_call>\n<function=Pick>\n{XML}\n</function>\n</tool_call>",
    f"<function=Pick>{XML}",
    f"<seed:tool_call><function=Pick>{XML}</function></seed:tool_call>",
    f"<function=Pick>{ARGS}</function>",
    f'<function name="Pick">{ARGS}</function>',
    "<tool_call>Pick\n<arg_key>object</arg_key>\n<arg_value>Plate_57</arg_value>\n</tool_call>",
    '<tool_call>\nPick(object="Plate_57")\n</tool_call>',
    f'<tool_call>{{"Pick": {ARGS}}}</tool_call>',
    '<function_calls>\n<invoke name="Pick">\n<parameter name="object">Plate_57</parameter>\n'
    "</invoke>\n</function_calls>",
    '<｜DSML｜function_calls><｜DSML｜invoke name="Pick">'
    '<｜DSML｜parameter name="object" string="true">Plate_57</｜DSML｜parameter>'
    "</｜DSML｜invoke></｜DSML｜function_calls>",
    f"<TOOLCALL>[{CALL}]</TOOLCALL>",
    f"<tool_calls>[{CALL}]</tool_calls>",
    f"[TOOL_CALLS][{CALL}]",
    f"[TOOL_CALLS]Pick{ARGS}",
    f"[TOOL_CALLS]Pick[CALL_ID]abc123[ARGS]{ARGS}",
    f"<|python_tag|>{CALL}",
    '<|python_start|>[Pick(object="Plate_57")]<|python_end|>',
    '<|tool_call_start|>[Pick(object="Plate_57")]<|tool_call_end|>',
    f"<|tool_call|>[{CALL}]<|/tool_call|>",
    f"<|action_start|><|plugin|>\n{CALL}<|action_end|>",
    f"<start_function_call>call:Pick{ARGS}<end_function_call>",
    f'<|tools_prefix|>[{{"Pick": {ARGS}}}]<|tools_suffix|>',
    f"functools[{CALL}]",
    f"<｜tool▁calls▁begin｜>{BEGIN}function{SEP}Pick\n```json\n{ARGS}\n```{END}<｜tool▁calls▁end｜>",
    f"<｜tool▁calls▁begin｜>{BEGIN}Pick{SEP}{ARGS}{END}<｜tool▁calls▁end｜>",
    "<|tool_calls_section_begin|><|tool_call_begin|>functions.Pick:0"
    f"<|tool_call_argument_begin|>{ARGS}<|tool_call_end|><|tool_calls_section_end|>",
    f"<|channel|>commentary to=functions.Pick <|constrain|>json<|message|>{ARGS}<|call|>",
    f"<|start|>assistant to=functions.Pick<|channel|>commentary json<|message|>{ARGS}<|call|>",
]


@pytest.mark.parametrize("written", [*PLAIN, *MARKED])
@pytest.mark.parametrize("before", ["", "I see the plate.\n", "I see the plate.\n\n"])
@pytest.mark.parametrize("after", ["", "\nThen I go."])
def test_a_call_in_the_text_is_read_with_the_rest_as_its_note(
    before: str, written: str, after: str
) -> None:
    text, _ = split_reasoning(f"{before}{written}{after}")
    message = read_calls(text, TOOLS, ())
    assert isinstance(message, AIMessage)
    (call,) = message.calls
    assert (call.name, call.arguments) == ("Pick", ARGUMENTS)
    assert json.loads(call.raw) == ARGUMENTS
    assert message.text == f"{before.strip()}{after}".strip()


@pytest.mark.parametrize("written", MARKED[:9])
def test_marks_tell_a_call_also_behind_words(written: str) -> None:
    message = read_calls(f"I take it: {written}", TOOLS, ())
    assert isinstance(message, AIMessage)
    assert message.text == "I take it:"


@pytest.mark.parametrize(
    "text",
    [
        f"<tool_call>\n{CALL}\n</tool_call>\n<tool_call>\n{CALL}\n</tool_call>",
        f"First.\n<tool_call>{CALL}</tool_call>\nThen.\n<tool_call>{CALL}</tool_call>",
        f"{CALL}\n{CALL}",
        f"[TOOL_CALLS][{CALL}, {CALL}]",
        '[Pick(object="Plate_57"), Pick(object="Plate_57")]',
        f"<function=Pick>{XML}</function>\n<function=Pick>{XML}</function>",
    ],
)
def test_several_calls_stay_several_in_their_order(text: str) -> None:
    message = read_calls(text, TOOLS, ("a",))
    assert isinstance(message, AIMessage)
    assert [call.arguments for call in message.calls] == [ARGUMENTS, ARGUMENTS]
    assert len({call.id for call in message.calls}) == 2


def test_values_without_quotes_get_the_type_that_the_tool_wants() -> None:
    fields = {"object": "57", "x": "1.5", "y": "-2", "z": "0"}
    xml = "".join(f"<parameter={key}>{value}</parameter>" for key, value in fields.items())
    message = read_calls(f"<function=Drop>{xml}</function>", TOOLS, ())
    assert isinstance(message, AIMessage)
    assert message.calls[0].arguments == {"object": "57", "x": 1.5, "y": -2, "z": 0}


@pytest.mark.parametrize(
    "text",
    [
        "I would call Pick(object='Plate_57') now.",
        f"One could write {CALL} here.",
        f"The call {CALL}",
        f"{CALL} is what I did before.",
        f'{CALL}\n{{"x": 1}}',
        f"{CALL}\nBut no.\n{CALL}",
        f'{{"answer": {CALL}}}',
        '{"name": "Fly", "arguments": {"x": 1}}',
        '<tool_call>{"name": "Fly", "arguments": {}}</tool_call>',
        '{"name": "Pick"}',
        '{"name": "Pick", "arguments": ["Plate_57"]}',
        '{"name": "Pick", "arguments": "Plate_57"}',
        f'{{"name": "Pick", "arguments": {ARGS}, "status": "done"}}',
        CALL[:-1],
        CALL.replace('"', "'"),
        ARGS,
        f"```json\n{ARGS}\n```",
        "<tool_call>",
        "[TOOL_CALLS]",
        "<tool_call>Plate_57</tool_call>",
        f"<tool_call>{CALL[:-9]}",
        f"<function=Pick>{ARGS[:-1]}</function>",
        "<tool_call><function=Pick><parameter=object>Plate_57",
        '<pick object="Plate_57"/>',
        '[Pick(object="Plate_57"',
        "Action: Pick\nAction Input: Plate_57",
        f"to=functions.Pick json {ARGS[:-5]}",
        '<tool_call>{"name": "Look", "arguments": {"x": NaN}}</tool_call>',
        "name: Pick\narguments:\n  object: Plate_57",
        'Tool: Pick\nArguments: {"object": "Plate_57"}',
        "**Function:** `Pick`\n**Parameters:** object = Plate_57",
        'Calling tool Pick with {"object": "Plate_57"}',
        "Let me call the Pick tool with these: {object: Plate_57}",
        "/Pick Plate_57",
        "I take it.\n\n/pick Plate_57",
        "Pick Plate_57",
        "> Pick: Plate_57",
        "`Pick(Plate_57)`",
        '**Pick**(object="Plate_57")',
        "Pick[57]",
        "Pick plate 57",
        "Look at Plate_57",
        "/Walk 1 2 0",
        "Drop Plate_57 at (1.0, -0.5, 0)",
        "/Survey",
        "1. Pick Plate_57\n2. Drop Plate_57 at (1, 1, 0)",
        '{"Pick": "Plate_57"}',
        '<use_tool name="Pick"><object>Plate_57</object></use_tool>',
    ],
)
def test_what_looks_like_a_call_and_cannot_be_read_is_said(text: str) -> None:
    found = read_calls(text, TOOLS, ())
    assert isinstance(found, UnparsedCall)
    assert found.problem.startswith("holds ") and found.problem.endswith(".")


@pytest.mark.parametrize(
    "text",
    [
        "",
        "The plate is in my hand. I am done.",
        "My tools are Look(x, y, z), Walk(x, y, z), Pick and Drop.",
        "I looked: {nothing}. Look at P3 [57] (at the left).",
        "Done: [57] is on the table (Plate_57) at (0.3, 1.2, 0.8) [m].",
        "Action: none needed.",
        "```\nDone\n```",
        "<b>Done</b>, 2 < 3, and all functions and tools <tooltip> are fine.",
        '{"answer": "done"}',
        "[1, 2]",
        "{" * 5000,
        "Done.<|im_end|>",
        "<|channel|>final<|message|>Done.<|return|>",
        "I did it. Tools used: Pick and Drop.",
        "I used Walk and Pick. The plate is at x: 1.0, y: 2.0.",
        "Name: the plate. Function: to eat from.",
        "I will call Pick on Plate_57.",
        "Look: the plate is on the floor.",
        "What I did:\n1. Pick Plate_57\n2. Drop Plate_57 at (1, 1, 0)\nIt lies there.",
        "Done. I picked Plate_57 (Pick) and put it down (Drop).",
    ],
)
def test_prose_is_an_answer(text: str) -> None:
    assert read_calls(split_reasoning(text)[0], TOOLS, ()) is None


@given(st.text(alphabet=st.sampled_from('{}[]()=":, \n`abPick<>/_1|'), max_size=80))
def test_no_text_breaks_the_reader(text: str) -> None:
    found = read_calls(split_reasoning(text)[0], TOOLS, ())
    if isinstance(found, AIMessage):
        assert {call.name for call in found.calls} <= {tool.name for tool in TOOLS}


def test_ids_are_deterministic_and_differ_from_those_taken() -> None:
    first = fresh_id("text", ())
    assert first == fresh_id("text", ())
    assert len(first) == 9 and first.isalnum()
    assert fresh_id("text", {first}) not in ("", first)


HOSTILE = [
    "<tool_call>", "{", "[", '{"a":', '{"a":"', " ", "\n", "<function=a>", "<parameter=a>",
    "<function=a><parameter=b>", "[Pick(", "Pick(", "Pick(a=", "Pick {", "Action: Pick\n", "```",
    "```json ", "<", "<tool", "<|", "print(", "functions.", "[TOOL_CALLS]Pick", "[CALL_ID]",
    '{"name":"Pick","arguments":', "<arg_key>a</arg_key><arg_value>", "((", "[{", CALL, f"{CALL}\n",
    "to=functions.", "functools[", '{"action":', "<think>", "</think>", "<|channel|>",
    "<|im_end|> ", "Action: Pick Action Input: ", "<tool_call>a.",
]  # fmt: skip


@pytest.mark.parametrize("piece", HOSTILE)
def test_a_long_text_takes_time_in_proportion_to_its_length(piece: str) -> None:
    for text in (piece * (64_000 // len(piece)), f"{' ' * 64_000}{piece}{' ' * 64_000}"):
        begin = time.thread_time()
        read_calls(split_reasoning(text)[0], TOOLS, ())
        assert time.thread_time() - begin < 4.0
