"""Arguments of a tool call: from a model's own text to a JSON object, and back onto the wire."""

from __future__ import annotations

import json
from collections.abc import Mapping
from typing import Any, NoReturn

from adamo_vh.inference.messages import ToolCall
from adamo_vh.readable import encodable

UNREADABLE = "unreadable_arguments"
"""Key under which a model is shown arguments of its own that were no JSON object."""

_DEEPEST = 50
"""No tool takes arguments that are nested deeper, and records cannot hold what is much deeper."""


def clean_arguments(arguments: Mapping[str, Any]) -> dict[str, Any] | None:
    """Arguments as strict JSON without lone surrogates; None if they are none or too deep."""
    if _is_deeper(arguments, _DEEPEST):
        return None
    try:
        return _encodable(dict(arguments))
    except (TypeError, RecursionError):
        return None


def read_arguments(raw: str) -> dict[str, Any] | None:
    """Read the arguments as a model wrote them.

    Args:
        raw: JSON text. An empty one counts as no arguments: some servers send it for ``{}``.

    Returns:
        The arguments, or None if they are not one strict JSON object (NaN and Infinity are not
        JSON), or one that is nested beyond reason.
    """
    try:
        value = json.loads(raw, parse_constant=_refuse) if raw.strip() else {}
        if isinstance(value, str):
            # Some servers write the JSON of the arguments as JSON once more.
            value = json.loads(value, parse_constant=_refuse)
    except (ValueError, RecursionError):
        return None
    if not isinstance(value, dict) or _is_deeper(value, _DEEPEST):
        return None
    return _encodable(value)


def wire_arguments(call: ToolCall) -> dict[str, Any]:
    """The arguments of a call for its way back to a server, which is always valid JSON.

    Servers refuse a conversation, now and ever after, in which a call carries anything but a JSON
    object; so an unreadable text is shown to the model as a string in an object.
    """
    readable = None if call.arguments is None else clean_arguments(call.arguments)
    return {UNREADABLE: encodable(call.raw)} if readable is None else readable


def dump_arguments(arguments: Mapping[str, Any]) -> str:
    """Arguments as JSON text."""
    return json.dumps(dict(arguments), ensure_ascii=False)


def _is_deeper(value: Any, levels: int) -> bool:
    if not isinstance(value, Mapping | list | tuple):
        return False
    inner = value.values() if isinstance(value, Mapping) else value
    return levels == 0 or any(_is_deeper(item, levels - 1) for item in inner)


def _encodable(value: dict[str, Any]) -> dict[str, Any] | None:
    """The object without lone surrogates; None if a number in it overflows to infinity."""
    try:
        text = json.dumps(value, ensure_ascii=False, allow_nan=False)
    except ValueError:
        return None
    cleaned: dict[str, Any] = json.loads(encodable(text))
    return cleaned


def _refuse(constant: str) -> NoReturn:
    raise ValueError(f"{constant} is not JSON")
