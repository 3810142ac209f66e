"""How many tokens an answer took, from its bytes: the words of every wire for it."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from adamo_vh.inference.model import Usage
from adamo_vh.inference.remote.mended import count


def counted(body: Any) -> Usage | None:
    """The tokens that a body counts.

    Args:
        body: JSON of an answer; anything.

    Returns:
        Its usage, with 0 for what it does not say; None if it says nothing.
    """
    if not isinstance(body, dict):
        return None
    if isinstance(google := body.get("usageMetadata"), dict):
        return _google(google)
    usage = body.get("usage")
    return _other(usage) if isinstance(usage, dict) else None


def _google(usage: Mapping[str, Any]) -> Usage:
    thoughts = _first(usage, "thoughtsTokenCount")
    read = _first(usage, "promptTokenCount") + _first(usage, "toolUsePromptTokenCount")
    cached = min(read, _first(usage, "cachedContentTokenCount"))
    return Usage(read, _first(usage, "candidatesTokenCount") + thoughts, cached, thoughts)


def _other(usage: Mapping[str, Any]) -> Usage:
    """OpenAI's two wires, those that are like them, and Anthropic's."""
    read_again = _first(usage, "cache_read_input_tokens")
    written = _first(usage, "cache_creation_input_tokens")
    read = _first(usage, "prompt_tokens", "input_tokens") + read_again + written
    said = _first(usage, "completion_tokens", "output_tokens")
    total = _first(usage, "total_tokens")
    # One of the two follows from the other and the sum.
    read, said = read or max(0, total - said if said else 0), said or max(0, total - read)
    cached = read_again or _inner(usage, "cached_tokens", "prompt", "input")
    cached = cached or _first(usage, "prompt_cache_hit_tokens")
    reasoning = _inner(usage, "reasoning_tokens", "completion", "output")
    reasoning = reasoning or _inner(usage, "thinking_tokens", "output")
    return Usage(read, said if read else 0, min(cached, read), min(reasoning, said))


def _first(usage: Mapping[str, Any], *names: str) -> int:
    return next((number for name in names if (number := count(usage.get(name)))), 0)


def _inner(usage: Mapping[str, Any], name: str, *sides: str) -> int:
    for side in sides:
        details = usage.get(f"{side}_tokens_details")
        if isinstance(details, dict) and (number := count(details.get(name))):
            return number
    return 0
