"""Printed words: who reads them, and which kinds of things they name."""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Mapping
from difflib import SequenceMatcher
from functools import cache
from importlib.util import find_spec
from threading import Lock
from typing import TYPE_CHECKING, Protocol

import numpy as np
from numpy.typing import NDArray

from adamo_vh.inference.baseline.language.words import class_words

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


if TYPE_CHECKING:
    from rapidocr import RapidOCR

MISSING = "I cannot read print: rapidocr is missing (pip install 'adamo-vh[ocr]'). I go on without."
_LONGER_PX = 320
"""Crops are enlarged to this; small print is found and read best at about this size."""
_MOST_ENLARGED = 6.0
_LEAST_SCORE = 0.6
_KEPT = 256
_SETTINGS = {
    "Global.log_level": "error",
    "Det.limit_type": "min",
    "Det.limit_side_len": 192,
    # One thread, so that the same picture gives the same words on any machine.
    "EngineConfig.onnxruntime.intra_op_num_threads": 1,
    "EngineConfig.onnxruntime.inter_op_num_threads": 1,
}


def installed() -> bool:
    """Whether the extra is there."""
    return find_spec("rapidocr") is not None and find_spec("onnxruntime") is not None


class PrintReader:
    """Reads words in crops of frames; the engine starts with the first crop."""

    def __init__(self) -> None:
        """Start without the engine."""
        self._engine: RapidOCR | None = None
        self._known: OrderedDict[bytes, tuple[str, ...]] = OrderedDict()
        self._lock = Lock()

    def words(self, picture: NDArray[np.uint8]) -> tuple[str, ...]:
        """The words in a picture, upper and lower case as printed.

        Args:
            picture: (H, W, 3) BGR.
        """
        if min(picture.shape[:2]) < 4:
            return ()
        key = repr(picture.shape).encode() + picture.tobytes()
        with self._lock:
            if key not in self._known:
                self._known[key] = self._read(picture)
                if len(self._known) > _KEPT:
                    self._known.popitem(last=False)
            return self._known[key]

    def _read(self, picture: NDArray[np.uint8]) -> tuple[str, ...]:
        import cv2
        from rapidocr import RapidOCR
        from rapidocr.utils.output import RapidOCROutput

        if self._engine is None:
            self._engine = RapidOCR(params=dict(_SETTINGS))
        larger = min(max(1.0, _LONGER_PX / max(picture.shape[:2])), _MOST_ENLARGED)
        crop = cv2.resize(picture, None, fx=larger, fy=larger, interpolation=cv2.INTER_CUBIC)
        found = self._engine(crop, use_cls=False)
        if not isinstance(found, RapidOCROutput):
            return ()
        lines = zip(found.txts or (), found.scores or (), strict=True)
        return tuple(
            word for text, score in lines if score >= _LEAST_SCORE for word in str(text).split()
        )
