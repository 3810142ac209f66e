"""Many small pictures on one sheet, so that what shows them is drawn with one material.

A second, smaller sheet of the same layout says how rough each picture's surface is.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from hashlib import sha256

import numpy as np
from numpy.typing import NDArray

from adamo_vh.runtime.assets.asset import Material

Pixels = NDArray[np.uint8]

PLAIN = np.full((8, 8, 3), 255, np.uint8)
"""What a material without a picture shows: white, which its tint colours."""
_WIDTH_PX = 2048
_WIDEST_PX, _TALLEST_PX = 1100, 512
"""Larger pictures are made smaller: nobody comes nearer than an arm's length."""
_RIM_PX = 8
"""Each picture's edge is continued so far, so that none shines through into another."""
_ROUGH_STEP = 8
"""One pixel of the sheet of roughness stands for so many."""


@dataclass(frozen=True, slots=True)
class Spot:
    """Where a picture lies on the sheet, as shares of it; v counts up from the bottom."""

    u: float
    v: float
    width: float
    height: float

    def placed(self, uvs: NDArray[np.float32]) -> NDArray[np.float32]:
        """(N, 2) coordinates in the picture as coordinates on the sheet."""
        inside = np.clip(uvs, 0.0, 1.0)
        return np.asarray(inside * [self.width, self.height] + [self.u, self.v], np.float32)


@dataclass(frozen=True, slots=True, eq=False)
class Atlas:
    """The sheet, and where what is on it."""

    sheet: Pixels
    """(H, W, 3) colours."""
    rough: Pixels
    """(H / 8, W / 8, 3) roughness, in the green channel as glTF has it."""
    spots: Mapping[str, Spot]
    """By `key` of the material."""


def key(material: Material) -> str:
    """What two materials must share to share a place on the sheet."""
    picture = PLAIN if material.texture is None else material.texture
    return f"{picture_key(picture)} {roughness(material)}"


def picture_key(picture: Pixels) -> str:
    """Tells pictures apart by their content."""
    return f"{picture.shape} {sha256(picture.tobytes()).hexdigest()}"


def roughness(material: Material) -> float:
    """How rough a surface is, 0 to 1."""
    return round(1.0 - 0.6 * material.shininess, 3)


def packed(materials: Sequence[Material]) -> Atlas:
    """Put the pictures of materials on one sheet, tall ones first, in rows.

    Args:
        materials: Any; what they share is there once.
    """
    found = {key(material): material for material in materials}
    pictures = {name: _fitting(material) for name, material in found.items()}
    order = sorted(pictures, key=lambda name: (-len(pictures[name]), name))
    corners: dict[str, tuple[int, int]] = {}
    x = y = row = 0
    for name in order:
        height, width = (size + 2 * _RIM_PX for size in pictures[name].shape[:2])
        if x + width > _WIDTH_PX:
            x, y, row = 0, y + row, 0
        corners[name] = (x, y)
        x, row = x + width, max(row, height)
    tall = max(_ROUGH_STEP, -(-(y + row) // _ROUGH_STEP) * _ROUGH_STEP)
    sheet = np.zeros((tall, _WIDTH_PX, 3), np.uint8)
    rough = np.zeros_like(sheet[::_ROUGH_STEP, ::_ROUGH_STEP])
    spots = {}
    for name, (left, top) in corners.items():
        picture = pictures[name]
        rim = np.pad(picture, ((_RIM_PX, _RIM_PX), (_RIM_PX, _RIM_PX), (0, 0)), "edge")
        sheet[top : top + len(rim), left : left + rim.shape[1]] = rim
        rows = slice(top // _ROUGH_STEP, -(-(top + len(rim)) // _ROUGH_STEP))
        columns = slice(left // _ROUGH_STEP, -(-(left + rim.shape[1]) // _ROUGH_STEP))
        rough[rows, columns, 1] = round(255 * roughness(found[name]))
        height, width = picture.shape[:2]
        below = tall - top - _RIM_PX - height
        spots[name] = Spot(
            (left + _RIM_PX) / _WIDTH_PX, below / tall, width / _WIDTH_PX, height / tall
        )
    return Atlas(sheet, rough, spots)


def _fitting(material: Material) -> Pixels:
    """A material's picture: halved until it is narrow enough, and then as low as it must be."""
    from PIL import Image

    picture = PLAIN if material.texture is None else material.texture
    height, width = picture.shape[:2]
    while width > _WIDEST_PX:
        height, width = -(-height // 2), -(-width // 2)
    height = min(height, _TALLEST_PX)
    if (height, width) == picture.shape[:2]:
        return picture
    return np.asarray(Image.fromarray(picture).resize((width, height), Image.Resampling.BOX))
