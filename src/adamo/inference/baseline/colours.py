"""Names of colours: which share of an object's pixels a person would call red, blue, white..."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

_HUES: tuple[tuple[int, str], ...] = (
    (8, "red"),
    (19, "orange"),
    (34, "yellow"),
    (86, "green"),
    (131, "blue"),
    (150, "purple"),
    (172, "pink"),
    (181, "red"),
)
"""Upper ends of the hues (0 to 180) of each name."""
_BLACK_BELOW = 55
_PALE = 42
"""Saturation below which a colour has no hue."""
_CREAM = 75
"""Saturation up to which a bright yellowish colour is cream, so white."""
_WHITE_FROM = 165
_BROWN_BELOW = 140


def shares(crop: NDArray[np.uint8], mask: NDArray[np.bool_]) -> Mapping[str, float]:
    """The share of each named colour.

    Args:
        crop: (H, W, 3) BGR picture.
        mask: (H, W), which pixels count.

    Returns:
        Shares that sum to 1, by name; colours that do not occur are left out.
    """
    import cv2

    if not mask.any():
        return {}
    hsv = cv2.cvtColor(crop, cv2.COLOR_BGR2HSV)[mask].astype(np.int16)
    hue, saturation, value = hsv[:, 0], hsv[:, 1], hsv[:, 2]
    edges = np.array([edge for edge, _ in _HUES])
    names = np.array([name for _, name in _HUES], dtype=object)[
        np.searchsorted(edges, hue, side="right")
    ]
    warm = (names == "orange") | (names == "yellow") | (names == "red")
    names[warm & (names != "red") & (value < _BROWN_BELOW)] = "brown"
    pale = saturation < _PALE
    names[pale] = "grey"
    cream = (saturation < _CREAM) & (hue >= 10) & (hue < 40)
    names[(pale | cream) & (value >= _WHITE_FROM)] = "white"
    names[(value < _BLACK_BELOW) | (pale & (value < _BLACK_BELOW + 15))] = "black"
    found, counts = np.unique(names.astype(str), return_counts=True)
    return {str(name): float(count) / len(names) for name, count in zip(found, counts, strict=True)}
