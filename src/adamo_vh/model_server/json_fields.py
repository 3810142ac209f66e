"""Fields of a JSON body, read with errors that name the field and the fix."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from adamo_vh.readable import encodable

_LARGEST = 1e15
"""No setting is larger; whole numbers in JSON may be, without an end."""


class BadRequest(Exception):  # noqa: N818 - named like the HTTP status that it becomes
    """A field of a request is missing or wrong.

    Attributes:
        field: Where it is, e.g. "messages[2].content".
    """

    def __init__(self, field: str, problem: str) -> None:
        """Say where and what.

        Args:
            field: Where it is.
            problem: What is wrong with it and how to put it right.
        """
        super().__init__(f"{field}: {problem}")
        self.field = field


def mapping(value: Any, where: str) -> Mapping[str, Any]:
    """The value, which must be an object."""
    if not isinstance(value, dict):
        raise BadRequest(where, f"it must be an object, not {_kind(value)}.")
    return value


def items(entry: Mapping[str, Any], name: str) -> Sequence[Any]:
    """A list that must be there."""
    value = entry.get(name)
    if not isinstance(value, list):
        raise BadRequest(name, f"it must be a list, not {_kind(value)}.")
    return value


def child(entry: Mapping[str, Any], name: str, where: str = "") -> Iterator[tuple[Any, str]]:
    """The entries of a list that may be left out, each with its place."""
    if entry.get(name) is None:
        return
    place = f"{where}.{name}" if where else name
    if not isinstance(entry[name], list):
        raise BadRequest(place, f"it must be a list, not {_kind(entry[name])}.")
    for at, value in enumerate(entry[name]):
        yield value, f"{place}[{at}]"


def text(entry: Mapping[str, Any], name: str, where: str = "") -> str:
    """A text that must be there; lone surrogates, which JSON can spell, are replaced."""
    value = entry.get(name)
    if not isinstance(value, str):
        place = f"{where}.{name}" if where else name
        raise BadRequest(place, f"it must be a text, not {_kind(value)}.")
    return encodable(value)


def choice_of(entry: Mapping[str, Any], name: str, known: Sequence[str], where: str = "") -> str:
    """A text that must be one of a few."""
    value = entry.get(name)
    if not isinstance(value, str) or value not in known:
        place = f"{where}.{name}" if where else name
        raise BadRequest(place, f"{_shown(value)} is not known here; use {', '.join(known)}.")
    return value


def flag(entry: Mapping[str, Any], name: str, where: str = "") -> bool:
    """True or false; false if it is left out."""
    value = entry.get(name)
    if value is not None and not isinstance(value, bool):
        place = f"{where}.{name}" if where else name
        raise BadRequest(place, f"it must be true or false, not {_kind(value)}.")
    return value is True


def number(
    entry: Mapping[str, Any], name: str, least: float = -math.inf, most: float = math.inf
) -> float | None:
    """A number that may be left out."""
    value = entry.get(name)
    if value is None:
        return None
    if isinstance(value, bool) or not isinstance(value, int | float) or not abs(value) < _LARGEST:
        raise BadRequest(name, f"it must be a number, not {_kind(value)}.")
    if not least <= value <= most:
        limits = f"at least {least:g}" if most == math.inf else f"from {least:g} to {most:g}"
        raise BadRequest(name, f"{value:g} is out of range; use {limits}.")
    return value


def _kind(value: Any) -> str:
    names = {dict: "an object", list: "a list", str: "a text", bool: "true or false"}
    return "missing" if value is None else names.get(type(value), "a number")


def _shown(value: Any) -> str:
    return repr(value[:60]) if isinstance(value, str) else _kind(value)
