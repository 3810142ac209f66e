"""The last rung: Thought, Action and Action Input as text, which every model can write."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence

from adamo_vh.action import ToolSchema
from adamo_vh.inference.arguments import dump_arguments, read_arguments
from adamo_vh.inference.json_scan import JsonScan
from adamo_vh.inference.ladder.labels import (
    ACTION,
    ANSWER,
    INPUT,
    OBSERVATION,
    THOUGHT,
    sections,
)
from adamo_vh.inference.ladder.steps import (
    FINISH,
    Step,
    Unreadable,
    action_step,
    ends_by_answer,
    known_tool,
    own_parameters,
)
from adamo_vh.inference.model import Rung

_NAME = re.compile(r"[\s`*\"'\[(<]*+((?:functions?\.)?[^\W\d]\w*)")
_FENCE = re.compile(r"^[ \t]*+```\w*+[ \t\r]*+$", re.MULTILINE)
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

        What comes after it is left out: models like to go on with results that they make up. An
        action that is taken back in words, with another one behind it, is none.
        """
        thoughts: list[str] = []
        found = sections(text)
        for label, content in found:
            if label == ACTION:
                following, given = next(found, ("", ""))
                given = given if following == INPUT else ""
                step = _act(" ".join(thoughts), content, given, tools)
                if _taken_back(given, found):
                    return Unreadable("it holds several actions with other text between them.")
                return step
            if label == ANSWER:
                return Step(" ".join(thoughts), answer=_bare(content))
            if label in ("", THOUGHT) and (thought := _bare(content)):
                thoughts.append(thought)
        if not text.strip():
            return Unreadable("it was empty.")
        offered = ends_by_answer(tools)
        return Unreadable(
            'there is neither "Action:" nor "Final Answer:" in it.'
            if offered
            else 'there is no "Action:" in it.'
        )


def _act(thought: str, content: str, given: str, tools: Sequence[ToolSchema]) -> Step | Unreadable:
    found = _NAME.match(content)
    if found is None:
        return Unreadable('there is no name of a tool after "Action:".')
    name = found[1]
    # Some write the arguments right behind the name: Look {"x": 0} or Look({"x": 0}).
    source = given or content[found.end() :]
    tool = known_tool(name, tools)
    objects = list(JsonScan(source).objects())
    if objects:
        args = read_arguments(dump_arguments(objects[0][2]))
        if args is not None:
            return action_step(thought, name, args, tools)
    elif _bare(source).lower() in _NOTHING and not (tool and own_parameters(tool)["required"]):
        return action_step(thought, name, {}, tools, is_whole=False)
    elif tool is None and name.casefold() == FINISH:
        return Step(thought, answer=_bare(source))
    return Unreadable(f'the "Action Input:" of {name[:60]} is no complete JSON object.')


def _taken_back(given: str, following: Iterator[tuple[str, str]]) -> bool:
    """Whether there are words behind the arguments of an action, and then another action."""
    ends = [end for _, end, _ in JsonScan(given).objects()]
    if not ends or not any(letter.isalnum() for letter in given[ends[0] :]):
        return False
    return next((label for label, _ in following if label in (ACTION, OBSERVATION)), "") == ACTION


def _bare(text: str) -> str:
    """The text without code fences and what marks it as bold."""
    return _FENCE.sub("", text).strip().strip("`*").strip()
