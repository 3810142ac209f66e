"""The annotated frame: boxes and tags of visible objects, crosses and tags of reference points.

Boxes stand just outside an object's visible pixels and hide none of them. When a picture is too
small for everything, tags of points are left out before tags of objects (see `tag_layout`); the
crosses, the boxes and the text mirror are always complete.
"""

from __future__ import annotations

import io
import zlib
from collections.abc import Sequence
from dataclasses import dataclass
from enum import StrEnum

import numpy as np
from numpy.typing import NDArray
from PIL import Image, ImageDraw

from adamo_vh.observation import Frame, ObservedObject, ReferencePoint
from adamo_vh.perception.clutter import Clutter
from adamo_vh.perception.plates import INK, POINT, Colour, plate, tag_colour
from adamo_vh.perception.tag_layout import Line, PlacedTag, TagRequest, place_tags
from adamo_vh.perception.visibility import PixelBox

BEST_QUALITY = 95
"""Above it, JPEG files grow without looking better."""


class ImageFormat(StrEnum):
    """How frames are encoded."""

    JPEG = "jpeg"
    PNG = "png"
    """Lossless: several times larger and some ten times slower."""


@dataclass(frozen=True, slots=True)
class OverlayScale:
    """Sizes of everything drawn, in pixels; they follow the height of the picture."""

    object_font: int
    point_font: int
    line: int
    """Width of box lines."""
    casing: int
    """Width of the dark rim on both sides of a line."""
    arm: int
    """Length of a cross's arms."""

    @classmethod
    def of(cls, height_px: int) -> OverlayScale:
        """Sizes for a picture; text stops shrinking where it would stop being legible."""
        return cls(
            object_font=max(10, round(height_px * 0.0185)),
            point_font=max(9, round(height_px * 0.0145)),
            line=max(1, round(height_px / 540)),
            casing=1,
            arm=max(3, round(height_px / 180)),
        )

    @property
    def margin(self) -> int:
        """From an object's tight box to the outside of the box that is drawn around it."""
        return self.line + 2 * self.casing


def layout(
    width_px: int,
    height_px: int,
    objects: Sequence[ObservedObject],
    points: Sequence[ReferencePoint],
    clutter: Clutter,
) -> tuple[PlacedTag, ...]:
    """Find a place for every tag: objects from the smallest box to the largest, then points.

    Returns:
        The placed tags; tags of points first, then of objects, if any, may be missing.
    """
    scale = OverlayScale.of(height_px)
    by_size = sorted(objects, key=lambda item: (_area(item.box_px), item.tag))
    requests = [
        TagRequest(
            tag=item.tag,
            anchor=_grown(item.box_px, scale.margin, width_px, height_px),
            size=plate(item.tag, scale.object_font, tag_colour(item.tag)).size,
            is_object=True,
        )
        for item in by_size
    ]
    marks = [(int(point.pixel[0]), int(point.pixel[1])) for point in points]
    reach = scale.arm + scale.casing
    requests += [
        TagRequest(
            tag=point.tag,
            anchor=_grown((u, v, u + 1, v + 1), reach, width_px, height_px),
            size=plate(point.tag, scale.point_font, None).size,
            is_object=False,
        )
        for point, (u, v) in zip(points, marks, strict=True)
    ]
    return place_tags(width_px, height_px, requests, clutter, marks)


def draw_overlay(
    rgb: NDArray[np.uint8],
    objects: Sequence[ObservedObject],
    points: Sequence[ReferencePoint],
    clutter: Clutter,
    image_format: ImageFormat = ImageFormat.JPEG,
    jpeg_quality: int = 88,
) -> Frame:
    """Annotate a copy of a picture and encode it.

    Args:
        rgb: (H, W, 3) colour image; left as it is.
        objects: What gets a box and a tag.
        points: What gets a cross and a tag.
        clutter: What tags should not hide.
        image_format: How to encode.
        jpeg_quality: 1 to 95.
    """
    height_px, width_px = rgb.shape[:2]
    scale = OverlayScale.of(height_px)
    picture = Image.fromarray(rgb)
    draw = ImageDraw.Draw(picture)
    placed = layout(width_px, height_px, objects, points, clutter)
    # Large boxes first, so that the lines of small ones stay whole.
    for item in sorted(objects, key=lambda item: (-_area(item.box_px), item.tag)):
        box = _grown(item.box_px, scale.margin, width_px, height_px)
        _draw_box(draw, box, tag_colour(item.tag), scale)
    for point in points:
        _draw_cross(draw, int(point.pixel[0]), int(point.pixel[1]), scale)
    object_tags = {item.tag for item in objects}
    for tag in placed:
        if tag.leader:
            colour = tag_colour(tag.tag) if tag.tag in object_tags else POINT
            _draw_leader(draw, tag.leader, colour, scale)
    for tag in placed:
        if tag.tag in object_tags:
            sprite = plate(tag.tag, scale.object_font, tag_colour(tag.tag))
        else:
            sprite = plate(tag.tag, scale.point_font, None)
        picture.paste(sprite, tag.rect[:2], sprite)
    return encoded(picture, image_format, jpeg_quality)


def _draw_box(
    draw: ImageDraw.ImageDraw, box: PixelBox, colour: Colour, scale: OverlayScale
) -> None:
    left, top, right, bottom = box[0], box[1], box[2] - 1, box[3] - 1
    draw.rectangle((left, top, right, bottom), outline=INK, width=scale.margin)
    inset = scale.casing
    draw.rectangle(
        (left + inset, top + inset, right - inset, bottom - inset),
        outline=colour,
        width=scale.line,
    )


def _draw_cross(draw: ImageDraw.ImageDraw, u: int, v: int, scale: OverlayScale) -> None:
    thin = scale.line // 2
    for grow, colour in ((scale.casing, INK), (0, POINT)):
        along, across = scale.arm + grow, grow
        draw.rectangle((u - along, v - across, u + along, v + across + thin), fill=colour)
        draw.rectangle((u - across, v - along, u + across + thin, v + along), fill=colour)


def _draw_leader(
    draw: ImageDraw.ImageDraw, leader: Line, colour: Colour, scale: OverlayScale
) -> None:
    draw.line(leader, fill=INK, width=scale.line + 2 * scale.casing)
    draw.line(leader, fill=colour, width=scale.line)


def encoded(picture: Image.Image, image_format: ImageFormat, jpeg_quality: int) -> Frame:
    """Encode a picture; see `draw_overlay`."""
    buffer = io.BytesIO()
    if image_format is ImageFormat.JPEG:
        picture.save(buffer, "JPEG", quality=jpeg_quality)
    else:
        # Of drawn pictures, runs alone are packed as small, in a quarter of the time.
        picture.save(buffer, "PNG", compress_type=zlib.Z_RLE)
    return Frame(buffer.getvalue(), f"image/{image_format}", picture.width, picture.height)


def _grown(box: PixelBox, margin: int, width_px: int, height_px: int) -> PixelBox:
    """A box with a margin around it, cut at the edge of the picture."""
    left, top, right, bottom = box
    return (
        max(0, left - margin),
        max(0, top - margin),
        min(width_px, right + margin),
        min(height_px, bottom + margin),
    )


def _area(box: PixelBox) -> int:
    return (box[2] - box[0]) * (box[3] - box[1])
