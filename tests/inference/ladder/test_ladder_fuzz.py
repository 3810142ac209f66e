"""Whatever a model writes is read without a fault, and what ADAMO writes is read back."""

from __future__ import annotations

import json
import time

import pytest
from hypothesis import given
from hypothesis import strategies as st

from adamo_vh.action import Drop, Look, Pick, Survey, Walk, tool_schema
from adamo_vh.inference.ladder.json_form import JsonForm
from adamo_vh.inference.ladder.react_form import ReactForm
from adamo_vh.inference.ladder.steps import Form, Step, Unreadable

TOOLS = [tool_schema(action) for action in (Look, Walk, Pick, Drop, Survey)]
FORMS = [JsonForm(), ReactForm()]
SHREDS = (
    "Thought:", "Action:", "Action Input:", "Final Answer:", "Observation:", "\n", " ", "```json",
    "**", '{"thought": ', '"action": ', '{"name": "Pick"', '"args": ', '{"object": "a"}', "{}", "}",
    ", ", "Look", "Survey", "finish", "null", "NaN", "1e999", "[1]", '"\\ud800"', "\ud800", "é",
)  # fmt: skip
TEXTS = st.lists(st.sampled_from(SHREDS), max_size=14).map("".join)
SENTENCES = st.text(st.characters(codec="utf-8", categories=("L", "N", "Zs")), max_size=40)
VALUES = st.one_of(st.integers(-5, 5), st.floats(-5, 5), SENTENCES, st.booleans(), st.none())
STEPS = st.builds(
    Step,
    thought=SENTENCES.map(str.strip),
    action=st.sampled_from([tool.name for tool in TOOLS]),
    args=st.dictionaries(SENTENCES, VALUES, max_size=3),
)


@pytest.mark.parametrize("form", FORMS)
@given(text=TEXTS)
def test_anything_is_read_or_said_to_be_unreadable(form: Form, text: str) -> None:
    outcome = form.read(text, TOOLS)
    if isinstance(outcome, Unreadable):
        assert outcome.problem.endswith(".")
    else:
        json.dumps(dict(outcome.args), allow_nan=False).encode()


@pytest.mark.parametrize("form", FORMS)
@given(step=STEPS)
def test_a_step_survives_writing_and_reading(form: Form, step: Step) -> None:
    assert form.read(form.write(step), TOOLS) == step


@pytest.mark.parametrize("form", FORMS)
@given(thought=SENTENCES.map(str.strip), answer=SENTENCES.map(str.strip).filter(bool))
def test_an_answer_survives_writing_and_reading(form: Form, thought: str, answer: str) -> None:
    found = form.read(form.write(Step(thought, answer=answer)), TOOLS)
    assert found == Step(thought, answer=answer)


@pytest.mark.parametrize("form", FORMS)
@pytest.mark.parametrize("text", ['{"a":' * 5000, "{" * 10_000, " " * 10_000, "Action:" * 5000])
def test_long_garbage_is_no_trap(form: Form, text: str) -> None:
    form.read(text, TOOLS)


@pytest.mark.parametrize("form", FORMS)
@pytest.mark.parametrize(
    "piece",
    [
        " ",
        "\n",
        ",",
        "Thought: ",
        "Action: ",
        "Action: Look\n",
        "* ",
        "```\n",
        "{",
        '{"a":',
        "_",
        "Action Input:",
    ],
)
def test_a_long_text_is_read_in_proportion_to_its_length(form: Form, piece: str) -> None:
    for text in (
        piece * (64_000 // len(piece)),
        f"{' ' * 64_000}{{}}",
        f"Action: Look{',' * 64_000}x",
    ):
        begin = time.thread_time()
        form.read(text, TOOLS)
        assert time.thread_time() - begin < 2.0
