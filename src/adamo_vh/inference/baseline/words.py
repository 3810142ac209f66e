"""Printed words: who reads them, and which kinds of things they name."""

from __future__ import annotations

from collections.abc import Mapping
from difflib import SequenceMatcher
from functools import cache
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from adamo_vh.inference.baseline.lexicon import class_words

_ALIKE = 0.72
"""Least similarity of a word read to the word that is meant; letters are often misread."""
_LEAST_LETTERS = 3
_NEXT_TO_BEST = 0.85
"""Names that were read much worse than the best one do not count."""
_WHOLE_LETTERS = 4
"""From this length on a part of a word counts as well."""


class WordReader(Protocol):
    """Finds printed words in a picture."""

    def words(self, picture: NDArray[np.uint8]) -> tuple[str, ...]:
        """The words, in any order.

        Args:
            picture: (H, W, 3) BGR.
        """
        ...


def named_kinds(words: tuple[str, ...]) -> Mapping[str, float]:
    """How much words speak for each class.

    Args:
        words: As read, whole or in part.

    Returns:
        By class, the share of a name's words that were read, 0 to 1; classes without any are left
        out.
    """
    read = [word.lower() for word in words if len(word) >= _LEAST_LETTERS]
    if not read:
        return {}
    found: dict[str, float] = {}
    for name, (classes, parts) in _names().items():
        hits = [max(_likeness(part, word) for word in read) for part in parts]
        share = sum(hit for hit in hits if hit >= _ALIKE) / len(parts)
        for kind in classes if share and name else ():
            found[kind] = max(found.get(kind, 0.0), share)
    best = max(found.values(), default=0.0)
    return {kind: share for kind, share in found.items() if share >= _NEXT_TO_BEST * best}


@cache
def _names() -> Mapping[str, tuple[tuple[str, ...], tuple[str, ...]]]:
    """Names that mean one class, with the words they are made of."""
    return {
        name: (tuple(value.split()), tuple(part for part in name.split() if part != "of"))
        for name, value in class_words().items()
        if len(value.split()) == 1
    }


def _likeness(name: str, word: str) -> float:
    if min(len(word), len(name)) >= _WHOLE_LETTERS and (word in name or name in word):
        return max(min(len(word), len(name)) / max(len(word), len(name)), _ALIKE)
    return SequenceMatcher(None, name, word).ratio()
