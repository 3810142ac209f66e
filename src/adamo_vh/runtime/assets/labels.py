"""Printed product labels that wrap around a jar, a can or a bottle.

A label is drawn once as a panel and repeated around the circumference. Its words stay within the
arc that faces a person, so that one panel can be read from any side. The font is the one embedded
in Pillow: no system font is needed and every machine draws the same letters.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from adamo_vh.runtime.assets.paint import Colour, Picture

if TYPE_CHECKING:
    from PIL.Image import Image
    from PIL.ImageDraw import ImageDraw

WORDS_ARC_DEG = 74.0
"""Widest arc that words may cover: what a person in front can read without turning the thing.

Well below a quarter turn, so that four prints fit around with a gap between them: then one of them
faces a person in front, behind or at either side.
"""

PAPER: Colour = (214, 213, 206)
"""White of a label. Lit, it must not be lighter than the light itself."""

_OVERSAMPLING = 2


@dataclass(frozen=True, slots=True)
class Line:
    """One line of print, stretched to fill its place."""

    text: str
    v: tuple[float, float]
    """Lower and upper edge of its letters, as a share of the label's height."""
    ink: Colour
    width: float = 1.0
    """Share of the readable arc that it fills."""


@dataclass(frozen=True, slots=True)
class Band:
    """A stripe of colour all around."""

    v: tuple[float, float]
    """Lower and upper edge, as a share of the label's height."""
    colour: Colour


@dataclass(frozen=True, slots=True)
class Motif:
    """A small picture in the middle of every panel."""

    draw: Callable[[ImageDraw, float, float, float], None]
    """Called with the canvas, the centre in pixels and the motif's height in pixels."""
    v: tuple[float, float]
    """Lower and upper edge, as a share of the label's height."""


@dataclass(frozen=True, slots=True)
class Label:
    """What is printed on one product."""

    ground: Colour
    lines: tuple[Line, ...]
    bands: tuple[Band, ...] = ()
    motifs: tuple[Motif, ...] = ()
    panels: int = 4
    """Times the print is repeated around."""


def wrap(label: Label, girth_m: float, height_m: float, pixels_per_m: float = 6000.0) -> Picture:
    """Draw a label for the whole way around.

    Args:
        label: What to print.
        girth_m: Length around.
        height_m: Height of the label.
        pixels_per_m: Resolution.

    Returns:
        Picture with one of its panels centred at u = 0.5.
    """
    from PIL import Image, ImageDraw

    width = round(girth_m / label.panels * pixels_per_m) * _OVERSAMPLING
    height = round(height_m * pixels_per_m) * _OVERSAMPLING
    panel = Image.new("RGB", (width, height), label.ground)
    canvas = ImageDraw.Draw(panel)
    for band in label.bands:
        low, high = _rows(band.v, height)
        canvas.rectangle((0, high, width, low), fill=band.colour)
    for motif in label.motifs:
        low, high = _rows(motif.v, height)
        motif.draw(canvas, width / 2, (low + high) / 2, low - high)
    readable = width * label.panels * WORDS_ARC_DEG / 360.0
    for line in label.lines:
        low, high = _rows(line.v, height)
        _print(panel, line, round(readable * line.width), (high, low))
    small = panel.resize((width // _OVERSAMPLING, height // _OVERSAMPLING), Image.Resampling.BOX)
    around = np.tile(np.asarray(small, dtype=np.uint8), (1, label.panels, 1))
    return np.roll(around, 0 if label.panels % 2 else small.width // 2, axis=1)


def _rows(v: tuple[float, float], height: int) -> tuple[int, int]:
    """Pixel rows of a span given from the bottom up: (low, high), low being the larger row."""
    return round((1.0 - v[0]) * height), round((1.0 - v[1]) * height)


def _print(panel: Image, line: Line, width: int, rows: tuple[int, int]) -> None:
    """Set one line in the middle of the panel, stretched to its place.

    Letters are spaced: set as close as usual, they melt into each other across a room.
    """
    from PIL import Image, ImageDraw, ImageFont

    font = ImageFont.load_default(size=160)
    bold, space = 7, 15
    canvas = Image.new("L", (200 * len(line.text), 320), 0)
    pen = ImageDraw.Draw(canvas)
    x = 20.0
    for letter in line.text:
        pen.text((x, 40), letter, font=font, fill=255, stroke_width=bold)
        x += font.getlength(letter) + space
    mask = canvas.crop(canvas.getbbox())
    mask = mask.resize((width, rows[1] - rows[0]), Image.Resampling.LANCZOS)
    panel.paste(line.ink, ((panel.width - width) // 2, rows[0]), mask)


def tomato(canvas: ImageDraw, x: float, y: float, size: float) -> None:
    """A red tomato with green leaves."""
    r, green = size / 2, (44, 112, 38)
    canvas.ellipse((x - 1.08 * r, y - 0.75 * r, x + 1.08 * r, y + r), fill=(200, 36, 26))
    canvas.ellipse((x - 0.75 * r, y - 0.45 * r, x - 0.35 * r, y - 0.05 * r), fill=(226, 84, 62))
    top = y - 0.68 * r
    for angle in np.deg2rad((-12, 32, 90, 148, 192)):
        along = np.array((np.cos(angle), 0.6 * np.sin(angle)))
        across = 0.16 * r * np.array((-along[1], along[0])) / np.hypot(*along)
        tip, middle = 0.62 * r * along, 0.25 * r * along
        leaf = [(0.0, 0.0), middle + across, tip, middle - across]
        canvas.polygon([(x + dx, top + dy) for dx, dy in leaf], fill=green)
    canvas.rectangle((x - 0.06 * r, y - r, x + 0.06 * r, top), fill=green)


def peanut(canvas: ImageDraw, x: float, y: float, size: float) -> None:
    """A peanut in its shell, lying."""
    shell, line = (206, 142, 66), (128, 78, 30)
    along = np.linspace(-1.0, 1.0, 48)
    ends = np.sqrt(1.0 - np.abs(along) ** 3.2)
    half = size / 2 * ends * (1.0 - 0.42 * np.exp(-((along / 0.3) ** 2)))
    outline = [*zip(along, half, strict=True), *zip(along[::-1], -half[::-1], strict=True)]
    points = [(x + 1.05 * size * u, y + v) for u, v in outline]
    canvas.polygon(points, fill=shell)
    pen = max(1, round(size / 22))
    for share in (-0.5, 0.0, 0.5):
        ridge = [(x + 1.05 * size * u, y + share * v) for u, v in zip(along, half, strict=True)]
        canvas.line(ridge, line, pen)
    for i in range(7, 43, 5):
        cx, reach = x + 1.05 * size * along[i], 0.8 * half[i]
        canvas.line((cx, y - reach, cx, y + reach), line, pen)


def grapes(canvas: ImageDraw, x: float, y: float, size: float) -> None:
    """A bunch of dark red grapes."""
    r = size / 9
    for row, count in enumerate((4, 3, 2, 1)):
        cy = y - size / 2 + (2.6 + 1.7 * row) * r
        for i in range(count):
            cx = x + (i - (count - 1) / 2) * 1.9 * r
            canvas.ellipse((cx - r, cy - r, cx + r, cy + r), fill=(112, 22, 50))
            shine = (cx - 0.5 * r, cy - 0.6 * r, cx - 0.1 * r, cy - 0.2 * r)
            canvas.ellipse(shine, fill=(168, 76, 100))
    stalk = (x - 0.2 * r, y - size / 2, x + 0.2 * r, y - size / 2 + 2 * r)
    canvas.rectangle(stalk, fill=(84, 108, 40))


def cross(canvas: ImageDraw, x: float, y: float, size: float) -> None:
    """The red cross of a medicine."""
    arm, half = size / 6, size / 2
    red = (196, 30, 36)
    canvas.rectangle((x - half, y - arm, x + half, y + arm), fill=red)
    canvas.rectangle((x - arm, y - half, x + arm, y + half), fill=red)


def capsule(canvas: ImageDraw, x: float, y: float, size: float) -> None:
    """A two-coloured capsule, lying."""
    half, long = size / 2, size * 1.1
    box = (x - long, y - half, x + long, y + half)
    canvas.rounded_rectangle(box, radius=half, fill=(200, 48, 40))
    canvas.pieslice((x - long, y - half, x - long + size, y + half), 90, 270, fill=(232, 160, 40))
    canvas.rectangle((x - long + half, y - half, x, y + half), fill=(232, 160, 40))
