"""Close-ups: an object large, seen from the same eyes through a narrower angle.

Partial observability stays strict: a close-up is aimed at the pixels that show the object in the
view, and what lies beyond the edge of that view stays blank. Only what is in the hand can be seen
wherever the eyes look.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from PIL import Image, ImageDraw

from adamo_vh.geometry import Array, Camera, Vec3
from adamo_vh.observation import Percept
from adamo_vh.perception.plates import INK, Colour, plate, tag_colour
from adamo_vh.perception.visibility import PixelBox

Closeup = Callable[[Vec3, float, int, int], Percept]
"""Like `adamo_vh.engine.Engine.closeup`: point, vertical angle in radians, width and height."""

CLOSEUP_PX = 512
"""Longer side of a close-up, without the strip of its tag."""
CLOSEUP_FONT_PX = 22
SLIMMEST = 0.6
"""Shorter side of a close-up over its longer side, at least: some surroundings belong to it."""
STRIP: Colour = (30, 32, 37)
"""Behind tags."""
_BLANK = (58, 60, 66)
"""Beyond the edge of the view."""
_MARGIN = 1.16
"""How much wider a close-up is than what it shows."""
_LEAST_TAN = 0.002
"""Half a close-up's angle, as a tangent: nothing is enlarged any further."""
_MARK_OFF_PX = 4
_MARK_SHARE = 0.05
"""Length of a corner mark as a share of the picture's longer side."""


@dataclass(frozen=True, slots=True)
class Aim:
    """The arguments of a close-up."""

    point: Vec3
    """In the middle of the picture, metres."""
    fov_y_rad: float
    width_px: int
    height_px: int


def closeup_of(
    view: Percept, object_id: int, tag: str, points: Array, closeup: Closeup
) -> Image.Image:
    """Draw an object close up, below its tag.

    Args:
        view: What the eyes see.
        object_id: The object.
        tag: Its tag.
        points: (N, 3) what must be in the picture: its `seen_corners`, or those of its box.
        closeup: Draws it.
    """
    aimed = aim(view.camera.position, points, CLOSEUP_PX)
    return titled(detail(view, object_id, tag, aimed, closeup), tag, CLOSEUP_FONT_PX)


def aim(eyes: Vec3, points: Array, longer_px: int, slimmest: float = SLIMMEST) -> Aim:
    """Find the narrowest view from the eyes that shows all points, with a margin.

    Args:
        eyes: Where the camera is, metres.
        points: (N, 3) in the world, metres, all before the eyes.
        longer_px: Longer side of the picture.
        slimmest: Its shorter side over its longer side, at least; 1 makes it square.
    """
    middle = Vec3.of(points.mean(axis=0))
    half = np.zeros(2)
    for _ in range(3):  # Turning the camera to the middle moves the middle a little.
        # Two pixels high at a right angle: its pixels are tangents, with (1, 1) in the middle.
        camera = Camera.towards(eyes, middle, math.pi / 2, (2, 2))
        pixels = camera.project(points)[:, :2]
        low, high = pixels.min(axis=0), pixels.max(axis=0)
        half = (high - low) / 2
        middle = eyes + Vec3.of(camera.rays(((low + high) / 2)[None])[0]) * middle.distance(eyes)
    half = np.maximum(half * _MARGIN, _LEAST_TAN)
    half = np.maximum(half, half.max() * slimmest)
    width, height = (round(float(side)) for side in half / half.max() * longer_px)
    return Aim(middle, 2 * math.atan(float(half[1])), width, height)


def seen_corners(view: Percept, box: PixelBox) -> Array:
    """(4, 3) points 1 m before the eyes, at the corners of a box of pixels in a view."""
    left, top, right, bottom = box
    pixels = np.array([[left, top], [right, top], [left, bottom], [right, bottom]], np.float64)
    return np.asarray(view.camera.position.array() + view.camera.rays(pixels))


def detail(view: Percept, object_id: int, tag: str, aimed: Aim, closeup: Closeup) -> Image.Image:
    """Draw a close-up of an object, with small marks at the corners of its box.

    Args:
        view: What the eyes see; nothing beyond its edge is shown, but the object in the hand.
        object_id: What the close-up is of.
        tag: Its tag, for the colour of the marks.
        aimed: Where to look.
        closeup: Draws it.
    """
    near = closeup(aimed.point, aimed.fov_y_rad, aimed.width_px, aimed.height_px)
    shows = np.logical_or.reduce([layer == object_id for layer in near.id_layers])
    rgb = near.rgb
    beyond = _beyond(view.camera, near.camera)
    if beyond is not None:
        if view.body.held == object_id:
            beyond &= ~shows
        rgb = rgb.copy()
        rgb[beyond] = _BLANK
        shows = shows & ~beyond
    picture = Image.fromarray(rgb)
    if shows.any():
        rows, columns = np.flatnonzero(shows.any(axis=1)), np.flatnonzero(shows.any(axis=0))
        box = int(columns[0]), int(rows[0]), int(columns[-1]) + 1, int(rows[-1]) + 1
        _draw_marks(picture, box, tag_colour(tag))
    return picture


def titled(picture: Image.Image, tag: str, font_px: int) -> Image.Image:
    """Put a strip with a tag above a picture, so that it hides nothing of it."""
    sprite = plate(tag, font_px, tag_colour(tag))
    while sprite.width > picture.width and font_px > 8:
        font_px -= 1
        sprite = plate(tag, font_px, tag_colour(tag))
    strip = strip_px(font_px)
    whole = Image.new("RGB", (picture.width, picture.height + strip), STRIP)
    whole.paste(sprite, ((picture.width - sprite.width) // 2, (strip - sprite.height) // 2), sprite)
    whole.paste(picture, (0, strip))
    return whole


def strip_px(font_px: int) -> int:
    """Height of the strip with a tag."""
    return round(font_px * 1.9)


def _beyond(view: Camera, near: Camera) -> NDArray[np.bool_] | None:
    """(H, W) pixels of a close-up that lie outside the view; None if there are none."""
    width, height = near.width_px, near.height_px
    corners = np.array([[0, 0], [width, 0], [0, height], [width, height]], np.float64)
    if not _outside(view, near, corners).any():
        return None
    v, u = np.mgrid[0:height, 0:width] + 0.5
    pixels = np.stack([u.ravel(), v.ravel()], axis=1)
    return _outside(view, near, pixels).reshape(height, width)


def _outside(view: Camera, near: Camera, pixels: Array) -> NDArray[np.bool_]:
    seen = view.project(view.position.array() + near.rays(pixels))
    limit = np.array([view.width_px, view.height_px])
    outside = (seen[:, :2] < 0).any(axis=1) | (seen[:, :2] > limit).any(axis=1)
    return np.asarray(outside | (seen[:, 2] <= 0))


def _draw_marks(picture: Image.Image, box: PixelBox, colour: Colour) -> None:
    """Two short lines at each corner of a box, just outside it."""
    draw = ImageDraw.Draw(picture)
    arm = round(max(picture.size) * _MARK_SHARE)
    left, top = box[0] - _MARK_OFF_PX, box[1] - _MARK_OFF_PX
    right, bottom = box[2] - 1 + _MARK_OFF_PX, box[3] - 1 + _MARK_OFF_PX
    for x, along in ((left, 1), (right, -1)):
        for y, down in ((top, 1), (bottom, -1)):
            lines = ((x, y, x + along * arm, y), (x, y, x, y + down * arm))
            for line in lines:
                draw.line(line, fill=INK, width=4)
            for line in lines:
                draw.line(line, fill=colour, width=2)
