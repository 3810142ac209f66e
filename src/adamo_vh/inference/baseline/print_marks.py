"""Printed text: small upright strokes side by side, in rows, with strong contrast."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

_CONTRAST = 28
"""Least difference in brightness between ink and paper."""


def print_share(crop: NDArray[np.uint8], mask: NDArray[np.bool_]) -> float:
    """How much of an object is covered by rows of letters.

    Args:
        crop: (H, W, 3) BGR picture.
        mask: (H, W), the object's pixels.

    Returns:
        Share of the object, 0 to 1.
    """
    import cv2

    size = np.count_nonzero(mask)
    if size < 200:
        return 0.0
    grey = cv2.cvtColor(crop, cv2.COLOR_BGR2GRAY)
    inner = cv2.erode(mask.astype(np.uint8), np.ones((5, 5), np.uint8))
    kernel = cv2.getStructuringElement(cv2.MORPH_RECT, (7, 1))
    dark = cv2.morphologyEx(grey, cv2.MORPH_BLACKHAT, kernel)
    bright = cv2.morphologyEx(grey, cv2.MORPH_TOPHAT, kernel)
    strong = np.asarray(cv2.max(dark, bright)) > _CONTRAST
    strokes = (strong & np.asarray(inner, bool)).view(np.uint8)
    # Letters stand side by side: closing sideways joins them to words, single edges stay thin.
    words = cv2.morphologyEx(strokes, cv2.MORPH_CLOSE, np.ones((1, 9), np.uint8))
    words = cv2.morphologyEx(words, cv2.MORPH_OPEN, np.ones((2, 9), np.uint8))
    return float(np.count_nonzero(words) / size)
