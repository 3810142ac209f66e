"""Read an answer that is odd but whole, and mend what a client library would stumble over.

What was paid for and can be read must not be thrown away because a server counts its tokens in
fractions or gives no reason for an end. The record is made of the bytes as they came.
"""

from __future__ import annotations

import json
import math
from typing import Any

_LONGEST_INTEGER = 18
_MOST_TOKENS = 1e9
"""No answer takes more; such a count is none."""

_DETAILS = ("prompt_tokens_details", "completion_tokens_details")
_INNER = ("_details", "cache_creation", "server_tool_use")
"""Ends of the names under which more counts stand."""
_REASONS = ("stop", "length", "tool_calls", "content_filter", "function_call")
"""Words that OpenAI's library knows for an end."""


def read_json(text: str | bytes) -> Any:
    """A body as JSON, numbers without end and without a value included; None if it is no JSON."""
    try:
        return json.loads(text, parse_int=_integer, parse_constant=lambda _: None)
    except (ValueError, RecursionError):
        return None


def _integer(digits: str) -> int | None:
    return int(digits) if len(digits) <= _LONGEST_INTEGER else None


def count(value: Any) -> int | None:
    """A number of tokens, however it is written; None if it is none."""
    if isinstance(value, str):
        try:
            value = float(value)
        except ValueError:
            return None
    if isinstance(value, bool) or not isinstance(value, int | float):
        return None
    return round(value) if math.isfinite(value) and 0 <= value < _MOST_TOKENS else None


def mended(body: dict[str, Any]) -> dict[str, Any]:
    """The body of an answer, on any of the four wires, as its client library takes it.

    Args:
        body: As it came; it is left alone.
    """
    if isinstance(body.get("choices"), list):
        choices = [_choice(choice) for choice in body["choices"]]
        usage = _counts(body.get("usage"), ("prompt_tokens", "completion_tokens", "total_tokens"))
        return {**body, "choices": choices, "usage": usage}
    if "candidates" in body:
        return {**body, "usageMetadata": _counts(body.get("usageMetadata"), ())}
    if body.get("type") == "message":
        usage = _counts(body.get("usage"), ("input_tokens", "output_tokens"))
        return {**body, "usage": usage}
    if "output" in body:
        usage = _counts(body.get("usage"), ("input_tokens", "output_tokens", "total_tokens"))
        usage.setdefault("input_tokens_details", {"cached_tokens": 0})
        usage.setdefault("output_tokens_details", {"reasoning_tokens": 0})
        return {**body, "usage": usage}
    return body


def _choice(choice: Any) -> Any:
    if not isinstance(choice, dict):
        return choice
    reason = choice.get("finish_reason")
    return {**choice, "finish_reason": reason if reason in _REASONS else "stop"}


def _counts(usage: Any, needed: tuple[str, ...]) -> dict[str, Any]:
    """What of a usage is a count, and 0 for what must be there."""
    found: dict[str, Any] = dict.fromkeys(needed, 0)
    for name, value in (usage if isinstance(usage, dict) else {}).items():
        if isinstance(value, dict) and name.endswith(_INNER):
            inner = {key: number for key, one in value.items() if (number := count(one))}
            found[name] = inner if name in _DETAILS else {**dict.fromkeys(value, 0), **inner}
        elif (number := count(value)) is not None:
            found[name] = number
    return found
