"""Find JSON in a text, in time that grows with its length alone."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator
from typing import Any, NoReturn

_EFFORT = 200
"""How often a text may be gone over at most, in failed tries."""
_LEAST_EFFORT = 1_000_000
_MAY_BEGIN = re.compile(r"\{\s*+[\"}]|\[|\"|[-\d]|true|false|null")
"""Most of what looks like the beginning of an object is none: seen here without a try."""


class JsonScan:
    """Reads JSON values out of one text.

    A failed try costs time; where a text makes too many of them, no more is found in it.
    """

    def __init__(self, text: str) -> None:
        """Prepare to read a text."""
        self.text = text
        self._effort = max(_EFFORT * len(text), _LEAST_EFFORT)

    def at(self, position: int) -> tuple[Any, int] | None:
        """The strict JSON value that begins at a position, and where it ends; None if none does.

        NaN and Infinity are no JSON, nor is a value that is nested or a number that is long beyond
        reason.
        """
        if self._effort <= 0 or not _MAY_BEGIN.match(self.text, position):
            return None
        try:
            return _DECODER.raw_decode(self.text, position)
        except json.JSONDecodeError as error:
            self._effort -= error.pos + 1  # The error counts all lines before it.
        except (ValueError, RecursionError):
            self._effort -= len(self.text)
        return None

    def objects(self) -> Iterator[tuple[int, int, dict[str, Any]]]:
        """The outermost JSON objects, each with where it starts and ends."""
        position = self.text.find("{")
        while position >= 0 and self._effort > 0:
            end = position + 1
            if found := self.at(position):
                value, end = found
                yield position, end, value
            position = self.text.find("{", end)


def whole_json(text: str) -> Any:
    """The JSON value that a text is, apart from blanks round it; None if it is none."""
    text = text.strip()
    found = JsonScan(text).at(0)
    return found[0] if found and found[1] == len(text) else None


def _refuse(constant: str) -> NoReturn:
    raise ValueError(f"{constant} is not JSON")


_DECODER = json.JSONDecoder(parse_constant=_refuse)
