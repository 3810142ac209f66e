"""Printed words read by rapidocr, whose weights come with its wheel: the optional extra `ocr`."""

from __future__ import annotations

from collections import OrderedDict
from importlib.util import find_spec
from threading import Lock
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

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
