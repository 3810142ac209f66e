"""The rung below tool calls: a step is one JSON object, held to a schema by the server.

The schema stays within what strict decoders share (OpenAI, vLLM, llama.cpp): an object at the root,
one alternative a tool below it, every object closed, and no bounds on strings or numbers.
"""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from typing import Any

from adamo_vh.action import ToolSchema
from adamo_vh.inference.arguments import dump_arguments, read_arguments
from adamo_vh.inference.json_scan import JsonScan
from adamo_vh.inference.ladder.labels import without_thoughts
from adamo_vh.inference.ladder.steps import (
    FINISH,
    Step,
    Unreadable,
    action_step,
    ends_by_answer,
    own_parameters,
)
from adamo_vh.inference.model import Rung
from adamo_vh.readable import encodable

_KEPT = ("type", "description", "enum", "const")
_NESTED = ("items", "additionalProperties")
_LISTS = ("anyOf", "oneOf")
_ANSWER = {
    "type": "object",
    "properties": {"answer": {"type": "string", "description": "The final answer."}},
    "required": ["answer"],
}


class JsonForm:
    """Steps as ``{"thought": ..., "action": {"name": ..., "args": {...}}}``."""

    rung = Rung.SCHEMA
    name = "schema"
    result_label = "Result"

    def schema(self, tools: Sequence[ToolSchema]) -> ToolSchema:
        """One alternative a tool, and one for the final answer."""
        actions, definitions = [], {}
        for tool in tools:
            parameters = own_parameters(tool)
            actions.append(_action(tool.name, _plain(parameters, tool.name)))
            for name, schema in parameters.get("$defs", {}).items():
                definitions[f"{tool.name}_{name}"] = _plain(schema, tool.name)
        if ends_by_answer(tools):
            actions.append(_action(FINISH, _plain(_ANSWER, FINISH)))
        properties = {"thought": {"type": "string"}, "action": {"anyOf": actions}}
        step = _closed(properties)
        return ToolSchema(
            "step", "A thought and one action.", {**step, **_definitions(definitions)}
        )

    def write(self, step: Step) -> str:
        """The object on one line."""
        name, args = step.action, dict(step.args)
        if name is None:
            name, args = FINISH, {"answer": step.answer}
        written = {"thought": step.thought, "action": {"name": name, "args": args}}
        return json.dumps(written, ensure_ascii=False)

    def read(self, text: str, tools: Sequence[ToolSchema]) -> Step | Unreadable:
        """The first object of the text that is a step; flat ones count too.

        One in the middle of a sentence, or one that is followed by other words and another step,
        may be a draft.
        """
        problem = "there is no complete JSON object in it."
        text = without_thoughts(text)
        found: list[tuple[int, int, Step]] = []
        for start, end, value in JsonScan(text).objects():
            outcome = _read(value, tools)
            if isinstance(outcome, Step):
                found.append((start, end, outcome))
            else:
                problem = outcome.problem
        if not found:
            return Unreadable(problem)
        _, end, step = found[0]
        if _words(text[end:].partition("\n")[0]):
            return Unreadable("its JSON object stands in the middle of other text.")
        if any(other != step and _words(text[end:start]) for start, _, other in found[1:]):
            return Unreadable("it holds several JSON objects with other text between them.")
        return step


def _words(text: str) -> bool:
    """Whether there is more in a text than the marks of a code fence."""
    return any(letter.isalnum() for letter in text.replace("```json", ""))


def _read(value: Mapping[str, Any], tools: Sequence[ToolSchema]) -> Step | Unreadable:
    thought, action = value.get("thought"), value.get("action")
    holder = action if isinstance(action, dict) else value
    if isinstance(action, dict):
        action = action.get("name")
    if not isinstance(action, str) or not action.strip():
        return Unreadable('its JSON object has no "action" with the name of a tool.')
    name, args = encodable(action).strip(), holder.get("args", holder.get("arguments"))
    if isinstance(args, dict):
        args = dump_arguments(args)
    readable = read_arguments(args or "") if isinstance(args, str | None) else None
    if readable is None:
        return Unreadable(f'the "args" of {name[:60]} are no JSON object.')
    said = encodable(thought).strip() if isinstance(thought, str) else ""
    return action_step(said, name, readable, tools)


def _action(name: str, arguments: Mapping[str, Any]) -> dict[str, Any]:
    return _closed({"name": {"type": "string", "const": name}, "args": arguments})


def _closed(properties: Mapping[str, Any]) -> dict[str, Any]:
    return {
        "type": "object",
        "properties": dict(properties),
        "required": list(properties),
        "additionalProperties": False,
    }


def _definitions(found: Mapping[str, Any]) -> dict[str, Any]:
    return {"$defs": dict(found)} if found else {}


def _plain(schema: Mapping[str, Any], tool: str) -> dict[str, Any]:
    """A schema with nothing but what strict decoders know; its definitions are named anew."""
    plain: dict[str, Any] = {key: schema[key] for key in _KEPT if key in schema}
    if "$ref" in schema:
        plain["$ref"] = f"#/$defs/{tool}_{schema['$ref'].rpartition('/')[2]}"
    for key in _NESTED:
        if isinstance(schema.get(key), dict):
            plain[key] = _plain(schema[key], tool)
    for key in _LISTS:
        if key in schema:
            plain["anyOf"] = [_plain(option, tool) for option in schema[key]]
    if "properties" in schema:
        inner = {name: _plain(value, tool) for name, value in schema["properties"].items()}
        plain |= _closed(inner) | {"required": list(schema.get("required", ()))}
    return plain
