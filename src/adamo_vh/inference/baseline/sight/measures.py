"""Names of colours: which share of an object's pixels a person would call red, blue, white..."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

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
COLOURS = (*dict.fromkeys(name for _, name in _HUES), "brown", "black", "grey", "white")
"""All names."""
_CODE = {name: code for code, name in enumerate(COLOURS)}
_CODE_OF_HUE = np.array(
    [_CODE[next(name for end, name in _HUES if min(hue, 180) < end)] for hue in range(256)],
    np.uint8,
)
_BLACK_BELOW = 55
_PALE = 42
"""Saturation below which a colour has no hue."""
_CREAM = 75
"""Saturation up to which a bright yellowish colour is cream, so white."""
_WHITE_FROM = (145, 165)
"""White is at least this bright, and need not be brighter: in between the light decides."""
_SHADE = 0.68
"""Brightness of white in the shade, as a share of white in the light."""
_BROWN_BELOW = 140
_ENOUGH_PX = 150
_SEE_THROUGH = 0.5
_RIVAL_SHARE = 0.2
_VIVID_SHARE, _PLAIN_SHARE = 0.45, 0.5
"""Share from which on a colour is said to be that of a thing."""
_PLAIN = ("brown", "black", "grey", "white")
"""Colours that wood, shadows and highlights have as well."""
_ON_EVERYTHING = 0.2
"""Share of black, grey and white that shadows and highlights make."""
_SAMPLES = 8000
"""Pixels that are enough to tell the light."""


def white_level(picture: NDArray[np.uint8], things: NDArray[np.bool_]) -> float:
    """From which brightness on a colourless pixel is white, in the light of this picture.

    Args:
        picture: (H, W, 3) BGR.
        things: (H, W), pixels of objects; the brightest colourless ones tell the light.
    """
    places = np.flatnonzero(things)
    if not len(places):
        return float(_WHITE_FROM[1])
    rows, columns = np.divmod(places[:: 1 + len(places) // _SAMPLES], things.shape[1])
    blue, green, red = picture[rows, columns].astype(np.int16).T
    high = np.maximum(np.maximum(blue, green), red)
    low = np.minimum(np.minimum(blue, green), red)
    pale = high[(high - low) * 255 < _PALE * high]
    brightest = float(np.percentile(pale, 97)) if len(pale) > 50 else 255.0
    return float(np.clip(_SHADE * brightest, *_WHITE_FROM))


def shares(
    crop: NDArray[np.uint8], mask: NDArray[np.bool_], white_from: float = _WHITE_FROM[1]
) -> Mapping[str, float]:
    """The share of each named colour.

    Args:
        crop: (H, W, 3) BGR picture.
        mask: (H, W), which pixels count.
        white_from: Least brightness of white, see `white_level`.

    Returns:
        Shares that sum to 1, by name; colours that do not occur are left out.
    """
    import cv2

    if not mask.any():
        return {}
    hue, saturation, value = (
        np.asarray(channel)[mask] for channel in cv2.split(cv2.cvtColor(crop, cv2.COLOR_BGR2HSV))
    )
    codes = _CODE_OF_HUE[hue]
    warm = (codes == _CODE["orange"]) | (codes == _CODE["yellow"])
    codes[warm & (value < _BROWN_BELOW)] = _CODE["brown"]
    pale = saturation < _PALE
    codes[pale] = _CODE["grey"]
    cream = (saturation < _CREAM) & (hue >= 10) & (hue < 40)
    codes[(pale | cream) & (value >= white_from)] = _CODE["white"]
    codes[(value < _BLACK_BELOW) | (pale & (value < _BLACK_BELOW + 15))] = _CODE["black"]
    counts = np.bincount(codes, minlength=len(COLOURS))
    return {
        name: float(count) / len(codes)
        for name, count in zip(COLOURS, counts, strict=True)
        if count
    }


@dataclass(frozen=True, slots=True)
class Sight:
    """Measurements inside an object's box in the frame."""

    pixels: int
    """Pixels taken to show the object."""
    colours: Mapping[str, float] = field(default_factory=dict)
    """Share of those pixels by colour name; black, grey and white included."""
    text: float = 0.0
    """Share of the object that looks like rows of letters, 0 to 1."""
    roundness: float = 0.0
    """How well an ellipse fits the silhouette, 0 to 1."""
    clear: float = 0.0
    """How much the object looks like what is behind it, 0 to 1."""
    misfits: Mapping[str, float] = field(default_factory=dict)
    """How badly each class of things would fill the box, see `silhouettes.misfits`; empty if the
    place of the eyes is not known."""
    words: tuple[str, ...] = ()
    """Printed words that were read on it."""
    cut: bool = False
    """Whether the box touches the edge of the frame."""
    height_m: float | None = None
    """How high it is, if a point tells how high the surface below it is."""

    def share(self, colour: str) -> float:
        """Share of one colour."""
        return self.colours.get(colour, 0.0)


def colour_words(sight: Sight) -> str:
    """The main colour in words, e.g. "orange"; empty if none can be told for sure."""
    if sight.pixels < _ENOUGH_PX or sight.clear > _SEE_THROUGH:
        return ""
    shares = {
        name: share - (_ON_EVERYTHING if name in ("grey", "black", "white") else 0.0)
        for name, share in sight.colours.items()
    }
    ordered = sorted(shares, key=lambda name: (-shares[name], name))
    if not ordered or shares[ordered[0]] < (_PLAIN_SHARE if ordered[0] in _PLAIN else _VIVID_SHARE):
        return ""
    rival = shares[ordered[1]] if len(ordered) > 1 else 0.0
    if rival < _RIVAL_SHARE:
        return ordered[0]
    third = shares[ordered[2]] if len(ordered) > 2 else 0.0
    # Brown is what orange and yellow look like in the shade.
    shaded = ordered[1] == "brown" and ordered[0] in ("orange", "yellow")
    return f"{ordered[0]} and brown" if shaded and third < _RIVAL_SHARE else ""
