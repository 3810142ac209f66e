"""Looking at a close-up: one object large in the middle, below a strip with its tag."""

from __future__ import annotations

import numpy as np

from adamo_vh.inference.baseline.sight.looking import decoded, own_pixels, roundness
from adamo_vh.inference.baseline.sight.marks import (
    Mask,
    Picture,
    PixelBox,
    brightest,
    clipped,
    print_share,
)
from adamo_vh.inference.baseline.sight.measures import Sight, shares, white_level
from adamo_vh.inference.baseline.sight.printed import WordReader
from adamo_vh.inference.messages import ImagePart

_STRIP_DARK = 50
_FILLED = 0.86
"""Share of the longer side that the object takes."""


def closeup_sight(
    image: ImagePart, slimness: float | None = None, reader: WordReader | None = None
) -> Sight | None:
    """Measure what a close-up shows.

    Args:
        image: Of one object.
        slimness: Width over height of the object in the view, if known.
        reader: Reads printed words; None to do without.

    Returns:
        Colours, print and outline; None if the picture cannot be read.
    """
    whole = decoded(image.data)
    if whole is None:
        return None
    picture = whole[_strip_px(whole) :]
    if min(picture.shape[:2]) < 16:
        return None
    box = _middle(picture, slimness)
    drawn: Mask = np.zeros(picture.shape[:2], bool)
    mask, clear = own_pixels(picture, brightest(picture), drawn, box)
    if not mask.any():
        return None
    area = clipped(box, picture)
    everything = np.zeros(picture.shape[:2], bool)
    everything[area] = mask
    crop = picture[area]
    return Sight(
        pixels=int(mask.sum()),
        colours=shares(crop, mask, white_level(picture, everything)),
        text=print_share(crop, mask),
        roundness=roundness(mask),
        clear=clear,
        words=reader.words(picture) if reader else (),
    )


def _strip_px(picture: Picture) -> int:
    """Height of the dark strip above the picture."""
    rows = np.median(picture, axis=1).max(axis=1)
    bright = np.flatnonzero(rows > _STRIP_DARK)
    strip = int(bright[0]) if len(bright) else 0
    return strip if strip < len(rows) / 3 else 0


def _middle(picture: Picture, slimness: float | None) -> PixelBox:
    height, width = picture.shape[:2]
    wide, tall = _FILLED * width, _FILLED * height
    if slimness:
        wide, tall = min(wide, tall * slimness), min(tall, wide / slimness)
    left, top = round((width - wide) / 2), round((height - tall) / 2)
    return left, top, left + round(wide), top + round(tall)
