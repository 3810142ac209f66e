"""How tags look: a dark rounded plate, light text, and an edge in the colour of the box.

Everything is drawn from Pillow's embedded scalable font, so that a frame's bytes do not depend on
the fonts of the machine.
"""

from __future__ import annotations

import re
import zlib
from functools import lru_cache
from typing import cast

from PIL import Image, ImageDraw, ImageFont

Colour = tuple[int, int, int]

PALETTE: tuple[Colour, ...] = (
    (255, 160, 64),
    (255, 92, 208),
    (150, 255, 70),
    (255, 236, 64),
    (255, 140, 170),
    (240, 215, 120),
    (30, 240, 150),
    (255, 120, 120),
    (190, 255, 60),
    (205, 110, 255),
    (214, 255, 160),
    (255, 185, 230),
    (140, 245, 225),
    (255, 205, 120),
)
"""Bright enough to stand out on wood, and far from its brown. None is blue or white: instructions
ask for blue things and white parts, and a drawn line must not pass for either."""

INK: Colour = (16, 18, 22)
"""Of plates and of the casing of lines."""
POINT: Colour = (255, 255, 255)
"""Of reference points."""

_TEXT: Colour = (250, 250, 250)
_SMOOTH = 4
"""Corners are drawn this much larger and scaled down."""


def tag_colour(tag: str) -> Colour:
    """The colour of an object's box and tag: the same in every frame and under every labeling."""
    number = re.search(r"\d+$", tag)
    key = int(number.group()) if number else zlib.crc32(tag.encode())
    # Multiplying by an odd constant first spreads ids that lie in regular steps (Knuth).
    return PALETTE[(key * 2654435761 >> 11) % len(PALETTE)]


@lru_cache(maxsize=16)
def font(size_px: int) -> ImageFont.FreeTypeFont:
    """Pillow's embedded scalable font."""
    # With a size, Pillow returns a FreeType font or raises.
    return cast(ImageFont.FreeTypeFont, ImageFont.load_default(size_px))


@lru_cache(maxsize=1024)
def plate(text: str, size_px: int, colour: Colour | None) -> Image.Image:
    """Draw a tag.

    Args:
        text: What it says.
        size_px: Font size.
        colour: Colour of the edge; None for a plain plate.

    Returns:
        An RGBA picture, shared between callers: not to be drawn on.
    """
    face = font(size_px)
    edge = 1 if colour is None else max(1, round(size_px * 0.1))
    pad = edge + max(1, round(size_px * 0.2))
    width = 2 * pad + round(face.getlength(text))
    height = round(size_px * 1.3) + 2 * edge
    radius = size_px * 0.25
    drawn = Image.new("RGBA", (width, height), colour or INK)
    drawn.paste(INK, mask=_rounded(width, height, radius, edge))
    draw = ImageDraw.Draw(drawn)
    # A capital reaches about 0.7 of the font size above the baseline.
    baseline = round(height / 2 + size_px * 0.35)
    draw.text((pad, baseline), text, fill=_TEXT, font=face, anchor="ls")
    drawn.putalpha(_rounded(width, height, radius, 0))
    return drawn


def _rounded(width: int, height: int, radius: float, inset: int) -> Image.Image:
    """A smooth rounded rectangle as a mask."""
    large = Image.new("L", (width * _SMOOTH, height * _SMOOTH), 0)
    low, right, bottom = inset * _SMOOTH, (width - inset) * _SMOOTH, (height - inset) * _SMOOTH
    ImageDraw.Draw(large).rounded_rectangle(
        (low, low, right - 1, bottom - 1), max(0.0, radius - inset) * _SMOOTH, 255
    )
    return large.resize((width, height), Image.Resampling.BOX)
