"""The last rung: Thought, Action and Action Input as text, which every model can write."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence

from adamo_vh.action import ToolSchema
from adamo_vh.inference.arguments import dump_arguments, read_arguments
from adamo_vh.inference.ladder.steps import (
    FINISH,
    Step,
    Unreadable,
    action_step,
    ends_by_answer,
    json_objects,
    known_tool,
    own_parameters,
)
from adamo_vh.inference.model import Rung

_LABEL = re.compile(
    r"^[ \t>*_#`-]*(thought|action[ _]?input|action|observation|final[ _]?answer)[ \t*_`]*:[ \t*]*",
    re.IGNORECASE | re.MULTILINE,
)
_INPUT_ON_THE_SAME_LINE = re.compile(r"(?<=\S)[ \t,;]+(?=action[ _]?input[ \t*]*:)", re.IGNORECASE)
_NAME = re.compile(r"[\s`*\"'\[(<]*([^\W\d]\w*)")
_FENCE = re.compile(r"^\s*```\w*\s*$", re.MULTILINE)
_NOTHING = frozenset({"", "none", "null", "n/a", "()", "no input", "no arguments"})


class ReactForm:
    """Steps as lines of text."""

    rung = Rung.REACT
    name = "react"
    result_label = "Observation"

    def schema(self, tools: Sequence[ToolSchema]) -> None:
        """None: the server is asked for plain text."""

    def write(self, step: Step) -> str:
        """The two or three lines."""
        if step.action is None:
            lines = [f"Final Answer: {step.answer}"]
        else:
            lines = [f"Action: {step.action}", f"Action Input: {dump_arguments(step.args)}"]
        return "\n".join([f"Thought: {step.thought}", *lines] if step.thought else lines)

    def read(self, text: str, tools: Sequence[ToolSchema]) -> Step | Unreadable:
        """The first action or final answer of the text.

        What comes after it is left out: models like to go on with results that they make up.
        """
        thoughts: list[str] = []
        sections = _sections(_INPUT_ON_THE_SAME_LINE.sub("\n", text))
        for label, content in sections:
            if label == "action":
                following, given = next(sections, ("", ""))
                given = given if following == "actioninput" else ""
                return _act(" ".join(thoughts), content, given, tools)
            if label == "finalanswer":
                return Step(" ".join(thoughts), answer=_bare(content))
            if label in ("", "thought") and (thought := _bare(content)):
                thoughts.append(thought)
        if not text.strip():
            return Unreadable("it was empty.")
        offered = ends_by_answer(tools)
        return Unreadable(
            'there is neither "Action:" nor "Final Answer:" in it.'
            if offered
            else 'there is no "Action:" in it.'
        )


def _sections(text: str) -> Iterator[tuple[str, str]]:
    """Labels in small letters without spaces, with what follows each; "" before the first."""
    label, begin = "", 0
    for found in _LABEL.finditer(text):
        yield label, text[begin : found.start()]
        label, begin = re.sub(r"[ _]", "", found[1]).lower(), found.end()
    yield label, text[begin:]


def _act(thought: str, content: str, given: str, tools: Sequence[ToolSchema]) -> Step | Unreadable:
    found = _NAME.match(content)
    if found is None:
        return Unreadable('there is no name of a tool after "Action:".')
    name = found[1]
    # Some write the arguments right behind the name: Look {"x": 0} or Look({"x": 0}).
    source = given or content[found.end() :]
    tool = known_tool(name, tools)
    objects = list(json_objects(source))
    if objects:
        args = read_arguments(dump_arguments(objects[0]))
        if args is not None:
            return action_step(thought, name, args, tools)
    elif _bare(source).lower() in _NOTHING and not (tool and own_parameters(tool)["required"]):
        return action_step(thought, name, {}, tools)
    elif tool is None and name.casefold() == FINISH:
        return Step(thought, answer=_bare(source))
    return Unreadable(f'the "Action Input:" of {name[:60]} is no complete JSON object.')


def _bare(text: str) -> str:
    """The text without code fences and what marks it as bold."""
    return _FENCE.sub("", text).strip().strip("`*").strip()
