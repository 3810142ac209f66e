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

from adamo.runtime.assets.paint import Colour, Picture

if TYPE_CHECKING:
    from PIL.Image import Image
    from PIL.ImageDraw import ImageDraw

WORDS_ARC_DEG = 86.0
"""Widest arc that words may cover: what a person in front can read without turning the thing."""

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
    panels: int = 3
    """Times the print is repeated around."""


def wrap(label: Label, girth_m: float, height_m: float, pixels_per_m: float = 9000.0) -> Picture:
    """Draw a label for the whole way around.

    Args:
        label: What to print.
        girth_m: Length around.
        height_m: Height of the label.
        pixels_per_m: Resolution.

    Returns:
        Picture whose panels are centred at u = (i + 0.5) / panels.
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
    return np.tile(np.asarray(small, dtype=np.uint8), (1, label.panels, 1))


def _rows(v: tuple[float, float], height: int) -> tuple[int, int]:
    """Pixel rows of a span given from the bottom up: (low, high), low being the larger row."""
    return round((1.0 - v[0]) * height), round((1.0 - v[1]) * height)


def _print(panel: Image, line: Line, width: int, rows: tuple[int, int]) -> None:
    """Set one line in the middle of the panel, stretched to its place."""
    from PIL import Image, ImageDraw, ImageFont

    font = ImageFont.load_default(size=160)
    bold = 5
    left, top, right, bottom = ImageDraw.Draw(panel).textbbox(
        (0, 0), line.text, font=font, stroke_width=bold
    )
    mask = Image.new("L", (int(right - left), int(bottom - top)), 0)
    ImageDraw.Draw(mask).text((-left, -top), line.text, font=font, fill=255, stroke_width=bold)
    mask = mask.resize((width, rows[1] - rows[0]), Image.Resampling.LANCZOS)
    panel.paste(line.ink, ((panel.width - width) // 2, rows[0]), mask)


def tomato(canvas: ImageDraw, x: float, y: float, size: float) -> None:
    """A red tomato with green leaves."""
    r = size / 2
    canvas.ellipse((x - 1.08 * r, y - 0.75 * r, x + 1.08 * r, y + r), fill=(200, 36, 26))
    canvas.ellipse((x - 0.75 * r, y - 0.45 * r, x - 0.35 * r, y - 0.05 * r), fill=(226, 84, 62))
    crown = [(x, y - 0.72 * r)]
    for i in range(5):
        angle = np.pi * (0.02 + 0.24 * i)
        tip = (x + 0.72 * r * np.cos(angle), y - 0.72 * r + 0.34 * r * np.sin(angle))
        crown += [tip, (x + 0.16 * r * np.cos(angle + 0.3), y - 0.62 * r)]
    canvas.polygon(crown, fill=(54, 120, 42))
    canvas.rectangle((x - 0.06 * r, y - r, x + 0.06 * r, y - 0.7 * r), fill=(54, 120, 42))


def peanut(canvas: ImageDraw, x: float, y: float, size: float) -> None:
    """A peanut in its shell, lying."""
    r = size / 2
    shell, line = (176, 116, 52), (120, 72, 28)
    for side in (-1, 1):
        cx = x + side * 0.85 * r
        canvas.ellipse((cx - r, y - 0.8 * r, cx + r, y + 0.8 * r), fill=shell)
    canvas.rectangle((x - 0.5 * r, y - 0.55 * r, x + 0.5 * r, y + 0.55 * r), fill=shell)
    pen = max(1, round(size / 24))
    for offset in (-0.35, 0.0, 0.35):
        canvas.line((x - 1.5 * r, y + offset * r, x + 1.5 * r, y + offset * r), line, pen)
    for offset in (-1.2, -0.6, 0.6, 1.2):
        canvas.line((x + offset * r, y - 0.6 * r, x + offset * r, y + 0.6 * r), line, pen)


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
