"""Tools as plain text, for models that are not given them through an API."""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from adamo_vh.action import ToolSchema
from adamo_vh.inference.ladder.steps import own_parameters


def describe_tools(tools: Iterable[ToolSchema]) -> str:
    """Each tool with the object of its arguments, what it does, and what the arguments mean."""
    return "\n".join(line for tool in tools for line in _lines(tool))


def _lines(tool: ToolSchema) -> list[str]:
    parameters = own_parameters(tool)
    required, properties = parameters["required"], parameters["properties"]
    types = [
        f'"{name}": {type_name(schema)}{"" if name in required else ", may be left out"}'
        for name, schema in properties.items()
    ]
    about = [
        f"  {name}: {schema['description']}"
        for name, schema in properties.items()
        if schema.get("description")
    ]
    return [f"- {tool.name} {{{', '.join(types)}}}: {tool.description}", *about]


def type_name(schema: Mapping[str, Any]) -> str:
    """The type that a schema allows, in words."""
    if "const" in schema:
        return json.dumps(schema["const"])
    choices: Sequence[Any] | None = schema.get("enum")
    if choices is not None:
        return " or ".join(json.dumps(choice) for choice in choices)
    options = schema.get("anyOf") or schema.get("oneOf")
    if options:
        return " or ".join(type_name(option) for option in options)
    kind = schema.get("type", "object" if "$ref" in schema else "any value")
    if isinstance(kind, list):
        return " or ".join(kind)
    if kind == "array":
        return f"list of {type_name(schema.get('items', {}))}"
    low, high = schema.get("minimum"), schema.get("maximum")
    return f"{kind} from {low} to {high}" if None not in (low, high) else str(kind)
