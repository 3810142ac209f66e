"""What is drawn over a frame: boxes, tags and crosses, so that vision can leave them out."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from adamo_vh.geometry import Camera

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


def brightest(picture: Picture) -> NDArray[np.uint8]:
    """The brightest channel of each pixel, (H, W)."""
    import cv2

    blue, green, red = cv2.split(picture)
    return np.asarray(cv2.max(cv2.max(blue, green), red), np.uint8)


def drawn_over(
    picture: Picture,
    bright: NDArray[np.uint8],
    boxes: Sequence[PixelBox],
    points: Sequence[tuple[float, float, float]],
    camera: Camera | None,
) -> Mask:
    """Where boxes, tags and crosses hide the picture.

    Args:
        picture: (H, W, 3) BGR frame.
        bright: Its brightest channels, (H, W).
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
    _mark_plates(drawn, picture, bright, boxes)
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


def _mark_plates(
    drawn: Mask, picture: Picture, bright: NDArray[np.uint8], boxes: Sequence[PixelBox]
) -> None:
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
    ink = (bright[area] <= INK_BELOW).view(np.uint8)
    fill = max(3, round(line_px / 8))
    solid = cv2.morphologyEx(ink, cv2.MORPH_CLOSE, np.ones((fill, 3 * fill), np.uint8))
    solid = cv2.morphologyEx(solid, cv2.MORPH_OPEN, np.ones((round(line_px / 2),) * 2, np.uint8))
    outlines, _ = cv2.findContours(solid, cv2.RETR_EXTERNAL, cv2.CHAIN_APPROX_SIMPLE)
    for outline in outlines:
        x, y, width, height = cv2.boundingRect(outline)
        part = slice(y, y + height), slice(x, x + width)
        if not 0.55 * line_px <= height <= 1.25 * line_px:
            continue
        if np.count_nonzero(solid[part]) < 0.75 * width * height:
            continue
        letters = cv2.inRange(crop[part], (_TEXT_FROM,) * 3, (255, 255, 255))
        if np.count_nonzero(letters) < 0.04 * letters.size:
            continue
        edge = max(3, round(line_px / 8))
        box = (x - edge, y - edge, x + width + edge, y + height + edge)
        drawn[area][clipped(box, crop)] = True


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
    # Letters may look like what is behind the object, but they are in its midst.
    whole = cv2.morphologyEx(mask.astype(np.uint8), cv2.MORPH_CLOSE, np.ones((5, 5), np.uint8))
    inner = cv2.erode(whole, np.ones((5, 5), np.uint8))
    kernel = cv2.getStructuringElement(cv2.MORPH_RECT, (7, 1))
    dark = cv2.morphologyEx(grey, cv2.MORPH_BLACKHAT, kernel)
    bright = cv2.morphologyEx(grey, cv2.MORPH_TOPHAT, kernel)
    strong = np.asarray(cv2.max(dark, bright)) > _CONTRAST
    strokes = (strong & np.asarray(inner, bool)).view(np.uint8)
    # Letters stand side by side: closing sideways joins them to words, single edges stay thin.
    words = cv2.morphologyEx(strokes, cv2.MORPH_CLOSE, np.ones((1, 9), np.uint8))
    words = cv2.morphologyEx(words, cv2.MORPH_OPEN, np.ones((2, 9), np.uint8))
    return float(np.count_nonzero(words) / size)
