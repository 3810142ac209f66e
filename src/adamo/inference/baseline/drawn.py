"""What is drawn over a frame: boxes, tags and crosses, so that vision can leave them out."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from adamo.geometry import Camera

Mask = NDArray[np.bool_]
Picture = NDArray[np.uint8]
PixelBox = tuple[int, int, int, int]

INK_BELOW = 44
"""Channels of the ink of tags stay below this, also after JPEG."""
_TEXT_FROM = 190


def clipped(box: PixelBox, picture: NDArray[np.generic]) -> tuple[slice, slice]:
    """Rows and columns of a pixel box, cut at the edges of a picture."""
    height, width = picture.shape[:2]
    left, top, right, bottom = box
    return (
        slice(min(max(0, top), height), min(max(0, bottom), height)),
        slice(min(max(0, left), width), min(max(0, right), width)),
    )


def drawn_over(
    picture: Picture,
    boxes: Sequence[PixelBox],
    points: Sequence[tuple[float, float, float]],
    camera: Camera | None,
) -> Mask:
    """Where boxes, tags and crosses hide the picture.

    Args:
        picture: (H, W, 3) BGR frame.
        boxes: Tight boxes of the objects, as the text lists them; lines run around them.
        points: Reference points in the world, metres.
        camera: Of the frame; without one, crosses are not found.

    Returns:
        (H, W) bool.
    """
    drawn = np.zeros(picture.shape[:2], bool)
    margin = max(1, round(picture.shape[0] / 540)) + 3
    for left, top, right, bottom in boxes:
        # The lines' inner edge is the box itself, so its own pixels stay.
        outer = (left - margin, top - margin, right + margin, bottom + margin)
        for line in (
            (outer[0], outer[1], outer[2], top),
            (outer[0], bottom, outer[2], outer[3]),
            (outer[0], top, left, bottom),
            (right, top, outer[2], bottom),
        ):
            drawn[clipped(line, drawn)] = True
    _mark_crosses(drawn, points, camera)
    _mark_plates(drawn, picture, boxes)
    return drawn


def _mark_crosses(
    drawn: Mask, points: Sequence[tuple[float, float, float]], camera: Camera | None
) -> None:
    if camera is None or not points:
        return
    reach = max(3, round(drawn.shape[0] / 180)) + 3
    for u, v, depth in camera.project(np.array(points)):
        if depth > 0:
            box = (int(u) - reach, int(v) - reach, int(u) + reach, int(v) + reach)
            drawn[clipped(box, drawn)] = True


def _mark_plates(drawn: Mask, picture: Picture, boxes: Sequence[PixelBox]) -> None:
    """Tags: dark rectangles of the height of a line of text, with bright letters in them."""
    import cv2

    if not boxes:
        return
    line_px = max(12.0, picture.shape[0] * 0.0185 * 1.4)
    around = round(3 * line_px)
    area = clipped(
        (
            min(b[0] for b in boxes) - around,
            min(b[1] for b in boxes) - around,
            max(b[2] for b in boxes) + around,
            max(b[3] for b in boxes) + around,
        ),
        drawn,
    )
    crop = picture[area]
    ink = cv2.inRange(crop, (0, 0, 0), (INK_BELOW, INK_BELOW, INK_BELOW))
    letters = cv2.inRange(crop, (_TEXT_FROM,) * 3, (255, 255, 255))
    fill = max(3, round(line_px / 8))
    solid = cv2.morphologyEx(ink, cv2.MORPH_CLOSE, np.ones((fill, 3 * fill), np.uint8))
    solid = cv2.morphologyEx(solid, cv2.MORPH_OPEN, np.ones((round(line_px / 2),) * 2, np.uint8))
    count, _, stats, _ = cv2.connectedComponentsWithStats(solid)
    for index in range(1, count):
        x, y, width, height, size = (int(value) for value in stats[index])
        if not 0.55 * line_px <= height <= 1.25 * line_px or size < 0.75 * width * height:
            continue
        if (letters[y : y + height, x : x + width] > 0).mean() < 0.04:
            continue
        edge = max(3, round(line_px / 8))
        box = (x - edge, y - edge, x + width + edge, y + height + edge)
        drawn[area][clipped(box, crop)] = True
