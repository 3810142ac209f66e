"""Smooth outlines without drawing anything more than once.

Where two neighbouring pixels show different surfaces, the outline between them is a staircase. The
straight line that a step of it stands for tells how much of each pixel the other surface covers,
and that much of its colour is mixed in. Textures and prints are left as they are.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

_Picture = NDArray[np.uint8]
_Mask = NDArray[np.bool_]
_Index = NDArray[np.intp]
_WITHIN = np.array([0, 0, 12, 1], float)
"""How much a label may change within one surface: part (two bytes), facing, distance."""


def smooth(picture: _Picture, labels: _Picture) -> None:
    """Smooth the outlines in a picture, in place.

    Args:
        picture: (H, W, 4) colours.
        labels: (H, W, 4) what each pixel shows; see `adamo_vh.runtime.shading`.
    """
    if min(labels.shape[:2]) < 2:
        return
    below = _differ(labels[1:], labels[:-1])
    beside = _differ(labels[:, 1:], labels[:, :-1])
    width = labels.shape[1]
    colours = picture.reshape(-1, 4).view(np.uint32)[:, 0]
    mixtures = [
        *_mixtures(below, beside, along=1, across=width),
        *_mixtures(beside.T, below.T, along=width, across=1),
    ]
    added = [_channels(colours[others]) for _, others, _ in mixtures]
    for (pixels, _, shares), other in zip(mixtures, added, strict=True):
        own = _channels(colours[pixels])
        mixed = own + (other - own) * shares[:, np.newaxis]
        colours[pixels] = (mixed + 0.5).astype(np.uint8).view(np.uint32)[:, 0]


def _differ(one: _Picture, other: _Picture) -> _Mask:
    """(H, W) where two label pictures show different surfaces."""
    import cv2

    changes = cv2.subtract(cv2.absdiff(one, other), _WITHIN)
    different: _Mask = np.asarray(changes, np.uint8).view(np.uint32)[:, :, 0] != 0
    return different


def _channels(colours: NDArray[np.uint32]) -> NDArray[np.float32]:
    return colours.view(np.uint8).reshape(-1, 4).astype(np.float32)


def _mixtures(
    edges: _Mask, crossing: _Mask, *, along: int, across: int
) -> list[tuple[_Index, _Index, NDArray[np.float32]]]:
    """What to mix along all steps of one direction.

    Args:
        edges: (lines - 1, length) whether a line's pixel and that of the next line differ.
        crossing: (lines, length - 1) whether a pixel and the next in its line differ.
        along: From a pixel to the next in its line, in the flat picture.
        across: From a pixel to that of the next line.

    Returns:
        Twice: pixels, each once; the pixel whose colour is added; and its share.
    """
    length = edges.shape[1]
    found = np.flatnonzero(edges)
    line, place = np.divmod(found, length)
    begins = np.flatnonzero(np.diff(found, prepend=-2) - 1 | (place == 0))
    runs = np.diff(begins, append=len(found))
    first, last = place[begins], place[begins] + runs - 1
    at_start = _turn(crossing, line[begins], first - 1)
    at_end = _turn(crossing, line[begins], last)
    turned = np.repeat((at_start != 0) | (at_end != 0), runs)
    number = np.repeat(np.arange(len(runs)), runs)[turned]
    line, place = line[turned], place[turned]
    size = runs[number].astype(np.float32)
    covers = (
        at_start[number] * _covered(place - first[number], size),
        at_end[number] * _covered(last[number] - place, size),
    )
    near = line * across + place * along
    mixtures = []
    for pixels, others, sign in ((near, near + across, 1), (near + across, near, -1)):
        shares = sum(np.maximum(sign * part, 0) for part in covers)
        mixed = np.flatnonzero(shares)
        mixtures.append((pixels[mixed], others[mixed], shares[mixed]))
    return mixtures


def _turn(crossing: _Mask, line: _Index, place: _Index) -> NDArray[np.float32]:
    """Where an edge goes at one end: half a pixel into its line, into the next (less than 0), 0."""
    inside = (place >= 0) & (place < crossing.shape[1])
    place = np.where(inside, place, 0)
    into, beyond = crossing[line, place], crossing[line + 1, place]
    turn = (into.astype(np.float32) - beyond.astype(np.float32)) / 2
    return np.where(inside, turn, np.float32(0))


def _covered(distance: _Index, size: NDArray[np.float32]) -> NDArray[np.float32]:
    """Mean height over a pixel of a line that falls from 1 at one end of a run to 0 in its middle.

    Args:
        distance: Whole pixels between the end and this pixel.
        size: Pixels of the run.
    """

    def below(x: NDArray[np.float32]) -> NDArray[np.float32]:
        x = np.minimum(x, size / 2)
        return x - x * x / size

    start = distance.astype(np.float32)
    return below(start + 1) - below(start)
