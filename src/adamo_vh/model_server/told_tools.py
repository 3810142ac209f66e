"""Tools that a prompt describes in words, read back into schemas."""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Any

from adamo_vh.action import ToolSchema
from adamo_vh.inference.ladder.steps import FINISH

_TITLE = "# The form of your answer\n"
_LIST = "\n## Tools\n"
_TOOL = re.compile(r"- (\w+) \{(.*?)\}: (.*)")
_ARGUMENT = re.compile(r'"(\w+)": (.+?)(, may be left out)?(?=, "\w+": |$)')
_ABOUT = re.compile(r"  (\w+): (.*)")
_RANGE = re.compile(r"(number|integer) from (\S+) to (\S+)")
_TYPES = ("number", "integer", "string", "boolean", "object")


def split_description(text: str) -> tuple[str, str, str]:
    """Find the part of a system prompt that tells the form of an answer and the tools.

    Args:
        text: A system prompt, in which several may have been merged.

    Returns:
        What stands before it, itself, and what stands behind it; the whole text first if there is
        no such part.
    """
    start = text.find(_TITLE)
    begin = text.find(_LIST, start)
    if start < 0 or begin < 0:
        return text, "", ""
    end = begin + len(_LIST)
    for line in text[end:].splitlines(keepends=True):
        if not line.startswith(("- ", "  ")):
            break
        end += len(line)
    return text[:start].rstrip(), text[start:end], text[end:].lstrip()


def told_tools(description: str) -> tuple[ToolSchema, ...]:
    """Read the tools of such a part.

    Args:
        description: The part as `split_description` found it.
    """
    tools: list[ToolSchema] = []
    for line in description.partition(_LIST)[2].splitlines():
        if found := _TOOL.fullmatch(line):
            tools.append(ToolSchema(found[1], found[3], _parameters(found[2])))
        elif tools and (about := _ABOUT.fullmatch(line)):
            argument = tools[-1].parameters["properties"].get(about[1], {})
            argument["description"] = about[2]
    return tuple(tools)


def schema_tools(schema: Mapping[str, Any]) -> tuple[ToolSchema, ...] | None:
    """Read the tools out of the schema of a step; None if it is another schema.

    Args:
        schema: What a reply must obey.
    """
    actions: Any = schema
    for key in ("properties", "action", "anyOf"):
        actions = actions.get(key) if isinstance(actions, dict) else None
    tools: list[ToolSchema] = []
    for entry in actions if isinstance(actions, list) else ():
        try:
            name, args = entry["properties"]["name"]["const"], entry["properties"]["args"]
        except (KeyError, TypeError):
            return None
        if name != FINISH:
            tools.append(ToolSchema(str(name), "", args if isinstance(args, dict) else {}))
    return tuple(tools) or None


def _parameters(written: str) -> dict[str, Any]:
    properties, required = {}, []
    for name, kind, optional in _ARGUMENT.findall(written):
        properties[name] = _typed(kind)
        if not optional:
            required.append(name)
    return {"type": "object", "properties": properties, "required": required}


def _typed(kind: str) -> dict[str, Any]:
    if found := _RANGE.fullmatch(kind):
        return {"type": found[1], "minimum": float(found[2]), "maximum": float(found[3])}
    return {"type": kind} if kind in _TYPES else {}
