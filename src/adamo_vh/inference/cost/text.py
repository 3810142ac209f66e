"""Estimate how many tokens a text has, without a tokenizer.

The text is split as OpenAI's o200k_base splits it before it merges bytes: a word with the one sign
before it, digits in groups of up to three, a run of signs, white space. Nearly every piece of our
prompts is one token; only long, capitalised and foreign words are more. `docs/tokens.md` states the
rule and its measured error.
"""

from __future__ import annotations

import math
import re
from functools import lru_cache

_UPPER = "A-ZÀ-ÖØ-Þ"
_PIECE = re.compile(
    rf"""
    (?P<before>[^\w\r\n]|_)?(?P<word>[{_UPPER}]*[^\W\d_{_UPPER}]+|[{_UPPER}]+)
    |(?P<digits>\d{{1,3}})
    |(?P<signs>[ ]?(?:[^\s\w]|_)+[\r\n/]*)
    |[^\S\r\n]*[\r\n]+|\s+(?!\S)|\s+
    """,
    re.VERBOSE,
)

_PLAIN_LETTERS, _NAME_LETTERS, _GLUED_LETTERS, _CAPITALS = 13.0, 9.0, 5.0, 2.5
"""Letters that make a token: in a plain word, in one that starts with a capital, in one glued to a
sign (as in a path), and among capitals."""
_SIGNS = 6
"""Signs that make a token where they come in a row."""
_PICTOGRAPHS, _PER_PICTOGRAPH = 0x3000, 2
"""From this code on a sign is so many tokens by itself."""


@lru_cache(maxsize=4096)
def estimate_text(text: str) -> int:
    """Tokens of a text, near to o200k_base.

    A longer text never has fewer: text that is added never lowers the estimate.
    """
    return sum(_tokens(piece) for piece in _PIECE.finditer(text))


def _tokens(piece: re.Match[str]) -> int:
    if piece["word"]:
        return _word_tokens(piece["word"], piece["before"] or "")
    if piece["signs"]:
        pictographs = sum(ord(sign) >= _PICTOGRAPHS for sign in piece["signs"])
        plain = len(piece["signs"]) - pictographs
        return max(1, _whole(plain / _SIGNS) + pictographs * _PER_PICTOGRAPH)
    return 1


def _word_tokens(word: str, before: str) -> int:
    weight = len(word) if word.isascii() else sum(map(_weight, word))
    capitals = sum(letter.isupper() for letter in word)
    if before.strip():
        parts = weight / _GLUED_LETTERS
    elif capitals:
        parts = weight / _NAME_LETTERS
    else:
        parts = weight / _PLAIN_LETTERS
    own = _PER_PICTOGRAPH if before and ord(before) >= _PICTOGRAPHS else 0
    return own + max(1, _whole(parts), _whole(capitals / _CAPITALS))


def _weight(letter: str) -> float:
    """How many plain letters a letter counts for."""
    code = ord(letter)
    if code < 0x80:
        return 1.0
    return 3.0 if code < 0x2E80 else 9.0


def _whole(parts: float) -> int:
    return math.ceil(parts)
