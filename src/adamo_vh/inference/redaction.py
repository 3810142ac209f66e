"""Keep keys and passwords out of every message that people or files may see."""

from __future__ import annotations

import os
import re
from collections.abc import Callable, Iterator
from dataclasses import replace
from typing import Any

from adamo_vh.inference.messages import AIMessage

_NAMES = re.compile(r"KEY|TOKEN|SECRET|PASSWORD|CREDENTIAL", re.IGNORECASE)
_SHORTEST = 6
"""Shorter values are no keys, and redacting them would mangle ordinary words."""
_LONGEST_WORD = 15
"""A value of letters alone that is no longer is an ordinary word, e.g. of KEYBOARD=german."""

_SHAPES = re.compile(
    r"\b[rs]k-[\w*.\-]{4,}|\bAIza[\w*.\-]{4,}|\bya29\.[\w*.\-]{4,}|\bBearer\s++[^\s'\"]+"
)
"""What keys look like, also masked ones: servers quote part of a wrong key in their errors."""

_PASSWORD = re.compile(r"(?<=//)[^\s/?#]*@|(?<=@)[^\s/?#@:]*:[^\s/?#]*@(?!https?:)")
"""User and password of an address, with or without its scheme."""
_QUERY = re.compile(r"(?<=[?&])(\w*(?:key|token|secret|password)\w*=)[^&#\s'\"]+", re.IGNORECASE)


def redacted(text: str) -> str:
    """The text with every key of the environment, and all that looks like one, blacked out."""
    return _SHAPES.sub("[key]", public(without_keys_of_environment(text)))


def without_keys_of_environment(text: str) -> str:
    """The text with every key of the environment blacked out."""
    for secret in sorted(_secrets(), key=len, reverse=True):
        text = text.replace(secret, "[key]")
    return text


def public(text: str) -> str:
    """The text with the user, password and keys of every address blacked out."""
    return _QUERY.sub(r"\1[key]", _PASSWORD.sub("[key]@", text))


def clean_message(message: AIMessage, clean: Callable[[str], str] = redacted) -> AIMessage:
    """An answer with every text of it cleaned.

    Of what the provider wants back only the keys of the environment are taken out: it is signed,
    and what only looks like a key is a part of it.

    Args:
        message: What a model said; a server may echo the key that it was sent.
        clean: Cleans a text.
    """
    calls = tuple(
        replace(
            call,
            name=clean(call.name),
            arguments=None if call.arguments is None else cleaned(dict(call.arguments), clean),
            raw=clean(call.raw),
        )
        for call in message.calls
    )
    kept = without_keys_of_environment(message.kept)
    return replace(message, text=clean(message.text), calls=calls, kept=kept)


def cleaned(value: Any, clean: Callable[[str], str]) -> Any:
    """JSON data with every text in it cleaned."""
    if isinstance(value, str):
        return clean(value)
    if isinstance(value, dict):
        return {key: cleaned(item, clean) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [cleaned(item, clean) for item in value]
    return value


def _secrets() -> Iterator[str]:
    for name, value in os.environ.items():
        is_word = value.isalpha() and len(value) <= _LONGEST_WORD
        if _NAMES.search(name) and len(value) >= _SHORTEST and not is_word:
            yield value
