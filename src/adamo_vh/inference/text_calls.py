"""Recognise a tool call that a model wrote into its text instead of calling the tool.

Small and local models often answer with the JSON of a call, in a code fence or in ``<tool_call>``
tags. Only the plain case counts: exactly one JSON object in the text, on lines of its own, in the
shape of a call, naming a tool on offer. Everything else stays text.
"""

from __future__ import annotations

import hashlib
import json
import re
from collections.abc import Collection, Iterator
from typing import Any

from adamo_vh.inference.arguments import dump_arguments, encodable_text, read_arguments
from adamo_vh.inference.messages import AIMessage, ToolCall

_SHAPES = (
    ("name", "arguments"),
    ("name", "parameters"),
    ("name", "args"),
    ("tool", "args"),
    ("tool", "arguments"),
    ("function", "arguments"),
)
"""Pairs of keys under which models write the tool and its arguments."""

_IGNORED = frozenset({"id", "type"})

_BEFORE = re.compile(r"(?:\A|\n)[ \t]*(?:```\w*|<tool_call>)?\s*\Z")
_AFTER = re.compile(r"\A[ \t]*\s*(?:```|</tool_call>)?[ \t]*(?=\n|\Z)")
_DECODER = json.JSONDecoder()


def recognise_call(text: str, tools: Collection[str], taken: Collection[str]) -> AIMessage | None:
    """Read a call that leaked into the text.

    Args:
        text: Text of an answer without a native call.
        tools: Names of the tools on offer.
        taken: Call ids of the conversation, which the new id must differ from.

    Returns:
        The call, with the rest of the text as its note; None if the text is not plainly a call.
    """
    found = list(_objects(text))
    if len(found) != 1:
        return None
    ((start, end, value),) = found
    before, after = _BEFORE.search(text[:start]), _AFTER.match(text[end:])
    call = _read(value, tools)
    if before is None or after is None or call is None:
        return None
    head, tail = text[: before.start()].strip(), text[end + after.end() :].strip()
    note = "\n".join(part for part in (head, tail) if part)
    name, arguments = call
    return AIMessage(note, (ToolCall(fresh_id(text, taken), name, arguments, text[start:end]),))


def fresh_id(seed: str, taken: Collection[str]) -> str:
    """A call id that follows from a text: nine letters and digits, which every server accepts."""
    number = 0
    while True:
        digest = hashlib.sha256(f"{number} {encodable_text(seed)}".encode()).hexdigest()[:9]
        if digest not in taken:
            return digest
        number += 1


def _objects(text: str) -> Iterator[tuple[int, int, dict[str, Any]]]:
    """Outermost JSON objects of a text, with where they start and end."""
    position = text.find("{")
    while position >= 0:
        try:
            value, end = _DECODER.raw_decode(text, position)
        except (ValueError, RecursionError):
            end = position + 1
        else:
            yield position, end, value
        position = text.find("{", end)


def _read(value: dict[str, Any], tools: Collection[str]) -> tuple[str, dict[str, Any]] | None:
    inner = value.get("function")
    if isinstance(inner, dict) and value.keys() - _IGNORED == {"function"}:
        value = inner
    keys = value.keys() - _IGNORED
    for name_key, arguments_key in _SHAPES:
        if keys != {name_key, arguments_key}:
            continue
        name, arguments = value[name_key], value[arguments_key]
        if not isinstance(name, str) or name not in tools:
            return None
        if isinstance(arguments, dict):
            arguments = dump_arguments(arguments)
        readable = read_arguments(arguments) if isinstance(arguments, str) else None
        return None if readable is None else (name, readable)
    return None
