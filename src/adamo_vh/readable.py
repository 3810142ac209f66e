"""Text that people may read safely, whoever wrote it: the one sink for what models and files say.

A terminal obeys control characters; a reader is misled by marks that turn the direction of writing
or take no room. Nothing that comes from outside is shown before it went through here.
"""

from __future__ import annotations

import re

_BREAKS = re.compile(r"[\t\n\v\f\r\x85\u2028\u2029]+")
_BREAKS_BUT_LINES = re.compile(r"[\v\f\r\x85\u2028\u2029]+")

_JOINED = (
    r"(?<=[\u2600-\u27bf\ufe0f\U0001f000-\U0001faff])\u200d(?=[\u2190-\u2bff\U0001f000-\U0001faff])"
)
"""The joiner inside a picture of several, a family or a flag: the one that is meant to be there."""

_HIDDEN = re.compile(
    rf"{_JOINED}|"
    r"([\0-\x08\x0e-\x1f\x7f-\x9f"  # controls: escape and the rest of C0, delete, C1
    r"\xad\u034f\u061c\u070f\u115f\u1160\u17b4\u17b5\u180b-\u180f"  # take no room
    r"\u200b-\u200f\u202a-\u202e\u2060-\u206f"  # zero width, bidi marks, overrides and isolates
    r"\u3164\ufe00-\ufe0e\ufeff\uffa0\ufff9-\ufffb\U0001bca0-\U0001bca3\U0001d173-\U0001d17a"
    r"\U000e0000-\U000e0fff"  # tags and selectors, which carry text that nobody sees
    r"\ud800-\udfff\ufdd0-\ufdef\ufffe\uffff])"  # no characters at all
)
_PILED = re.compile(
    r"([\u0300-\u036f\u0483-\u0489\u1ab0-\u1aff\u1dc0-\u1dff\u20d0-\u20ff]{4})"
    r"[\u0300-\u036f\u0483-\u0489\u1ab0-\u1aff\u1dc0-\u1dff\u20d0-\u20ff]+"
)
"""More marks on one letter than any language sets climb over the lines above."""


def readable(text: str, *, lines: bool = False) -> str:
    """The text without what steers a terminal, turns the direction of writing or hides in it.

    Letters, signs and pictures of every language stay.

    Args:
        text: From anywhere.
        lines: Keep line feeds and tabs, which become a blank otherwise. A carriage return, with
            which a line overwrites itself, never stays.
    """
    if text.isascii() and text.isprintable():
        return text
    spaced = (_BREAKS_BUT_LINES if lines else _BREAKS).sub(" ", text.replace("\r\n", "\n"))
    return _PILED.sub(r"\1", _HIDDEN.sub(lambda found: "" if found[1] else found[0], spaced))


def encodable(text: str) -> str:
    """The text without lone surrogates, which JSON and command lines can spell and UTF-8 cannot."""
    return text.encode("utf-8", "replace").decode("utf-8")
