"""Looking at the pixels of each listed object: colours, white parts, print, shape, size.

Boxes, tags and crosses that are drawn into the frame are left out as well as the text lets one know
where they are.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from functools import cache, lru_cache

import numpy as np
from numpy.typing import NDArray

from adamo_vh.geometry import Camera
from adamo_vh.inference.baseline.prompt.reading import Listed, Prompt
from adamo_vh.inference.baseline.sight.boxes import with_boxes
from adamo_vh.inference.baseline.sight.marks import (
    INK_BELOW,
    Mask,
    Picture,
    PixelBox,
    brightest,
    clipped,
    drawn_over,
    print_share,
)
from adamo_vh.inference.baseline.sight.measures import Sight, shares, white_level
from adamo_vh.inference.baseline.sight.outlines import camera_of, misfits
from adamo_vh.inference.baseline.sight.printed import WordReader
from adamo_vh.inference.baseline.sight.standing import heights

Masks = Mapping[str, tuple[Mask, float]]

_RING_PX = 12
"""Width of the frame around a box that shows what is behind the object, at 1080 lines."""
_BINS = 20
"""Bins of a colour channel in the histogram of the background."""
_LEAST_PIXELS = 12
_READABLE_PX = 600
"""Least pixels of an object whose print can be read."""
_SOME_PRINT = 0.02
_ENOUGH_PIXELS = 15000
_READING_MARGIN_PX = 8


def sights(
    prompt: Prompt, reader: WordReader | None = None, outlines: bool = True
) -> Mapping[str, Sight]:
    """Look at every listed thing that has a box.

    Args:
        prompt: Its latest frame must be the one that the list describes.
        reader: Reads printed words on what seems to carry any; None to do without.
        outlines: Whether to measure how round things are.

    Returns:
        Measurements by tag; empty without a frame or without boxes.
    """
    things = boxed(prompt)
    if prompt.frame is None or not any(thing.box_px for thing in things):
        return {}
    found = _looked_at(prompt.frame.data, things, prompt.points_key, camera_of(prompt), outlines)
    high = heights(things, prompt.points, prompt.room)
    found = {tag: replace(sight, height_m=high.get(tag)) for tag, sight in found.items()}
    if reader is None:
        return found
    picture = decoded(prompt.frame.data)
    assert picture is not None or not found
    boxes = {thing.tag: thing.box_px for thing in things if thing.box_px}
    return {
        tag: replace(sight, words=reader.words(_with_margin(picture, boxes[tag])))
        if picture is not None and _may_be_read(sight)
        else sight
        for tag, sight in found.items()
    }


def boxed(prompt: Prompt) -> tuple[Listed, ...]:
    """What is in view, with its boxes: as the text tells them, or else as the frame shows them."""
    camera = camera_of(prompt)
    if prompt.frame is None or camera is None or all(thing.box_px for thing in prompt.things):
        return prompt.things
    return _boxed(prompt.frame.data, prompt.things, camera)


@lru_cache(maxsize=8)
def _boxed(data: bytes, things: tuple[Listed, ...], camera: Camera) -> tuple[Listed, ...]:
    picture = decoded(data)
    return things if picture is None else with_boxes(_bright(data), things, camera)


@lru_cache(maxsize=2)
def _bright(data: bytes) -> NDArray[np.uint8]:
    picture = decoded(data)
    assert picture is not None
    return brightest(picture)


@lru_cache(maxsize=2)
def decoded(data: bytes) -> Picture | None:
    """The pixels of an encoded picture, BGR; None if it cannot be read."""
    import cv2

    pixels = cv2.imdecode(np.frombuffer(data, np.uint8), cv2.IMREAD_COLOR)
    return None if pixels is None else np.asarray(pixels, np.uint8)


def _may_be_read(sight: Sight) -> bool:
    return sight.pixels >= _READABLE_PX and sight.text >= _SOME_PRINT


def _with_margin(picture: Picture, box: PixelBox) -> Picture:
    left, top, right, bottom = box
    m = _READING_MARGIN_PX
    return picture[clipped((left - m, top - m, right + m, bottom + m), picture)]


@lru_cache(maxsize=8)
def _looked_at(
    data: bytes,
    things: tuple[Listed, ...],
    points: tuple[tuple[float, float, float], ...],
    camera: Camera | None,
    outlines: bool,
) -> Mapping[str, Sight]:
    picture = decoded(data)
    if picture is None:
        return {}
    bright = _bright(data)
    boxes = [thing.box_px for thing in things if thing.box_px]
    drawn = drawn_over(picture, bright, boxes, points, camera)
    visible = [thing for thing in things if thing.box_px]
    masks = {t.tag: _solid(picture, bright, drawn, t, things) for t in visible}
    white = _white(picture, masks, visible)
    sizes = misfits(visible, camera) if camera else {}
    return {
        t.tag: _look_at(picture, masks[t.tag], t, white, sizes.get(t.tag, {}), outlines)
        for t in visible
    }


def _solid(
    picture: Picture,
    bright: NDArray[np.uint8],
    drawn: Mask,
    thing: Listed,
    things: tuple[Listed, ...],
) -> tuple[Mask, float]:
    """The pixels of a box that show its object, and how much looks like what is behind."""
    assert thing.box_px is not None
    area = clipped(thing.box_px, drawn)
    own = _own_part(thing, things, drawn[area].shape)
    return own_pixels(picture, bright, drawn, thing.box_px, own)


def own_pixels(
    picture: Picture,
    bright: NDArray[np.uint8],
    drawn: Mask,
    box: PixelBox,
    part: Mask | None = None,
) -> tuple[Mask, float]:
    """The pixels of a box that differ from what surrounds it.

    Args:
        picture: (H, W, 3) BGR.
        bright: Its brightest channels, (H, W).
        drawn: (H, W), where lines and tags hide the picture.
        box: Around the object.
        part: Which part of the box may show it; all of it by default.

    Returns:
        Mask of the box's size, and the share of it that looks like its surroundings.
    """
    area = clipped(box, drawn)
    own = ~drawn[area] if part is None else part & ~drawn[area]
    if not own.any():
        return own, 0.0
    solid = own & ~_behind(picture, bright, drawn, box)
    size, left = np.count_nonzero(own), np.count_nonzero(solid)
    return (solid if left >= _LEAST_PIXELS else own), (size - left) / size


def _white(picture: Picture, masks: Masks, things: list[Listed]) -> float:
    everything = np.zeros(picture.shape[:2], bool)
    for thing in things:
        assert thing.box_px is not None
        everything[clipped(thing.box_px, everything)] |= masks[thing.tag][0]
    # Every other pixel of every other row tells the light as well.
    return white_level(picture[::2, ::2], everything[::2, ::2])


def _look_at(
    picture: Picture,
    mask: tuple[Mask, float],
    thing: Listed,
    white_from: float,
    sizes: Mapping[str, float],
    outlines: bool,
) -> Sight:
    assert thing.box_px is not None
    left, top, right, bottom = thing.box_px
    solid, clear = mask
    if not solid.any():
        return Sight(0)
    crop = picture[clipped(thing.box_px, picture)]
    # Of large things, some of the pixels tell colours and outline as well.
    step = 1 + int((solid.size / _ENOUGH_PIXELS) ** 0.5)
    coarse = solid[::step, ::step]
    height, width = picture.shape[:2]
    return Sight(
        pixels=int(np.count_nonzero(solid)),
        colours=shares(np.ascontiguousarray(crop[::step, ::step]), coarse, white_from),
        text=print_share(crop, solid),
        roundness=roundness(coarse) if outlines else 0.0,
        clear=clear,
        misfits=sizes,
        cut=left <= 1 or top <= 1 or right >= width - 1 or bottom >= height - 1,
    )


def _own_part(thing: Listed, things: tuple[Listed, ...], shape: tuple[int, ...]) -> Mask:
    """The part of a box where no nearer thing can be in front."""
    own = np.ones(shape[:2], bool)
    assert thing.box_px is not None
    left, top, right, bottom = thing.box_px
    for other in things:
        # On one surface, what reaches lower in the picture stands nearer.
        if other is thing or not other.box_px or other.box_px[3] <= bottom:
            continue
        x0, y0, x1, y1 = other.box_px
        if x0 >= right or x1 <= left or y0 >= bottom or y1 <= top:
            continue
        own[clipped((x0 - left, y0 - top, x1 - left, y1 - top), own)] = False
    return own if np.count_nonzero(own) > 0.15 * own.size else np.ones(shape[:2], bool)


def _behind(picture: Picture, bright: NDArray[np.uint8], drawn: Mask, box: PixelBox) -> Mask:
    """Pixels of a box that have the colours of the frame around it."""
    import cv2

    ring_px = max(4, round(_RING_PX * picture.shape[0] / 1080))
    left, top, right, bottom = box
    outer = clipped((left - ring_px, top - ring_px, right + ring_px, bottom + ring_px), drawn)
    rows, columns = (
        slice(part.start - whole.start, part.stop - whole.start)
        for part, whole in zip(clipped(box, drawn), outer, strict=True)
    )
    codes = _codes(picture[outer])
    # Tags are no background, nor is anything ink.
    usable = ~drawn[outer] & (bright[outer] > INK_BELOW)
    usable[rows, columns] = False
    around = codes[usable]
    inside = codes[rows, columns]
    if len(around) < 30:
        return np.zeros(inside.shape, bool)
    counts = np.bincount(around, minlength=_BINS**3).reshape((_BINS,) * 3)
    likely = (_blurred(counts) > 0.02 * len(around)).astype(np.uint8)
    return np.asarray(cv2.medianBlur(likely[inside], 3), bool)


def _blurred(counts: NDArray[np.int64]) -> NDArray[np.float32]:
    """Each bin with all its neighbours: JPEG and shading move colours to them. Flat."""
    import cv2

    none = cv2.BORDER_CONSTANT
    wide = cv2.boxFilter(counts.astype(np.float32), -1, (3, 3), normalize=False, borderType=none)
    rows = np.asarray(wide, np.float32).reshape(-1, _BINS)
    wide = cv2.boxFilter(rows, -1, (3, 1), normalize=False, borderType=none)
    return np.asarray(wide, np.float32).ravel()


def _codes(pixels: Picture) -> NDArray[np.int16]:
    """Numbers of bins, (H, W).

    The bins are by brightness and by two colour differences, so that shading matters less.
    """
    import cv2

    channels = cv2.split(cv2.cvtColor(pixels, cv2.COLOR_BGR2LAB))
    light, *hues = (
        cv2.LUT(channel, table) for channel, table in zip(channels, _bin_tables(), strict=True)
    )
    return np.asarray(cv2.add(cv2.add(light, hues[0]), hues[1]), np.int16)


@cache
def _bin_tables() -> tuple[NDArray[np.int16], ...]:
    """What each value of each channel adds to the number of a bin."""
    values = np.arange(256)
    light = values * _BINS // 256
    hue = np.clip((values - 128) // 5 + _BINS // 2, 0, _BINS - 1)
    scales = ((light, _BINS**2), (hue, _BINS), (hue, 1))
    return tuple((bins * scale).astype(np.int16) for bins, scale in scales)


def roundness(mask: Mask) -> float:
    """How well the silhouette fits its own ellipse: overlap with it, as a share of the union."""
    import cv2

    filled = cv2.morphologyEx(mask.astype(np.uint8), cv2.MORPH_CLOSE, np.ones((5, 5), np.uint8))
    contours, _ = cv2.findContours(filled, cv2.RETR_EXTERNAL, cv2.CHAIN_APPROX_NONE)
    if not contours:
        return 0.0
    outline = max(contours, key=cv2.contourArea)
    if len(outline) < 12:
        return 0.0
    hull = cv2.convexHull(outline)
    ellipse = cv2.fitEllipse(outline)
    full, fitted = np.zeros(mask.shape, np.uint8), np.zeros(mask.shape, np.uint8)
    cv2.drawContours(full, [hull], -1, 1, -1)
    cv2.ellipse(fitted, ellipse, 1, -1)
    union = np.count_nonzero(full | fitted)
    return np.count_nonzero(full & fitted) / union if union else 0.0
