"""Materials of a file: its colours and pictures, and what of them is transparent."""

from __future__ import annotations

import io
import warnings
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from pydantic import ValidationError

from adamo_vh.geometry import Array
from adamo_vh.readable import readable
from adamo_vh.runtime.assets.asset import Material
from adamo_vh.runtime.human.own import fields
from adamo_vh.runtime.human.own.colours import srgb
from adamo_vh.runtime.human.own.fields import Document, TextureUse
from adamo_vh.runtime.human.own.numbers import Numbers

_MOST_EDGE = 8192
"""Pixels of a side of a picture that is read."""
_MOST_PIXELS = 400_000_000
"""Of all pictures together, as they are in the file."""
_MOST_PICTURES = 100
_KEPT_EDGE = 1024
"""Larger pictures are made smaller."""
_FORMATS = ("PNG", "JPEG", "WEBP")
_HALF = 0.5


@dataclass(frozen=True, slots=True, eq=False)
class Surface:
    """How the triangles of a material look."""

    material: Material
    alpha: NDArray[np.float32] | None
    """(H, W) how solid its picture is, 0 to 1; None if all of it is solid."""
    solid_from: float
    """What is less solid is not drawn."""
    is_seen: bool
    two_sided: bool
    shift: Array
    """(2, 3) texture coordinates of the picture, from those of the mesh."""


class Surfaces:
    """The materials of one file; each picture is read once."""

    def __init__(self, document: Document, numbers: Numbers, notes: list[str]) -> None:
        """Read none yet.

        Args:
            document: The file.
            numbers: Its arrays.
            notes: Takes what cannot be shown, in words.
        """
        self._document, self._numbers, self._notes = document, numbers, notes
        self._pixels = 0
        self._pictures: dict[int, NDArray[np.uint8] | None] = {}
        self._known: dict[int | None, Surface] = {}

    @property
    def pictures(self) -> int:
        """How many pictures are shown."""
        return sum(picture is not None for picture in self._pictures.values())

    def surface(self, number: int | None) -> Surface:
        """A material, or the plain one of what has none."""
        if number not in self._known:
            told = fields.PLAIN if number is None else self._document.materials[number]
            self._known[number] = self._read(told, number)
        return self._known[number]

    def _read(self, told: fields.Material, number: int | None) -> Surface:
        factor, use = told.metallic.factor, told.metallic.texture
        older = told.extensions.get("KHR_materials_pbrSpecularGlossiness")
        if isinstance(older, dict):
            try:
                glossy = fields.Glossiness.model_validate(older)
            except ValidationError:
                glossy = fields.DULL
            factor, use = glossy.factor, glossy.texture
        name = readable(told.name or f"material {number}")[:60]
        picture = self._picture(use, name)
        alpha = None
        colour, emission = np.clip(factor[:3], 0.0, 1.0), 0.0
        # Where it shines with a picture, most of that is black, and what shines is not known here.
        if picture is None and told.glow_texture is None and max(told.glow) > 0.0:
            shine = np.clip(told.glow, 0.0, 1.0)
            colour = np.clip(colour + shine, 0.0, 1.0)
            emission = float(shine.sum() / colour.sum())
        red, green, blue = (round(float(v), 9) for v in srgb(colour))
        opacity, is_seen = float(np.clip(factor[3], 0.0, 1.0)), True
        solid_from = told.cutoff if told.alpha == "MASK" else _HALF
        if told.alpha in ("MASK", "BLEND"):
            is_seen = opacity >= solid_from
            if picture is not None and picture.shape[2] == 4:
                alpha = (picture[..., 3] * np.float32(opacity / 255.0)).astype(np.float32)
                alpha = None if alpha.min() >= solid_from else alpha
        rough = float(np.clip(told.metallic.roughness, 0.0, 1.0))
        material = Material(
            name,
            (red, green, blue, 1.0),
            None if picture is None else np.ascontiguousarray(picture[..., :3]),
            specular=0.05 + 0.15 * (1.0 - rough),
            shininess=min(1.0, (1.0 - rough) / 0.6),
            emission=emission,
        )
        return Surface(material, alpha, solid_from, is_seen, told.two_sided, _shift(use))

    def _picture(self, use: TextureUse | None, name: str) -> NDArray[np.uint8] | None:
        """(H, W, 4) or (H, W, 3), sRGB."""
        if use is None:
            return None
        if use.index >= len(self._document.textures):
            self._notes.append(f"{name}: its picture is missing, so it has one colour")
            return None
        texture = self._document.textures[use.index]
        packed = texture.extensions.get("EXT_texture_webp")
        source = packed.get("source") if isinstance(packed, dict) else texture.source
        if not isinstance(source, int) or not 0 <= source < len(self._document.images):
            self._notes.append(f"{name}: its picture is missing, so it has one colour")
            return None
        if source not in self._pictures:
            image = self._document.images[source]
            if image.uri is not None or image.view is None:
                self._notes.append(f"{name}: its picture lies in another file, and none is read")
                self._pictures[source] = None
            else:
                self._pictures[source] = self._decoded(self._numbers.raw(image.view), name)
        return self._pictures[source]

    def _decoded(self, content: bytes, name: str) -> NDArray[np.uint8] | None:
        from PIL import Image

        try:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")
                picture = Image.open(io.BytesIO(content), formats=_FORMATS)
                if max(picture.size) > _MOST_EDGE:
                    width, height = picture.size
                    self._notes.append(
                        f"{name}: its picture has {width}x{height} pixels, and {_MOST_EDGE} a side "
                        "is the most; it has one colour"
                    )
                    return None
                self._pixels += picture.size[0] * picture.size[1]
                if self._pixels > _MOST_PIXELS or self.pictures >= _MOST_PICTURES:
                    self._notes.append("its pictures are too many or too large: some are left out")
                    return None
                picture.draft("RGB", (_KEPT_EDGE, _KEPT_EDGE))
                has_alpha = "A" in picture.getbands() or "transparency" in picture.info
                made = picture.convert("RGBA" if has_alpha else "RGB")
                made.thumbnail((_KEPT_EDGE, _KEPT_EDGE))
        except (OSError, ValueError, SyntaxError, ArithmeticError, Image.DecompressionBombError):
            self._notes.append(f"{name}: its picture cannot be read, so it has one colour")
            return None
        return np.asarray(made, np.uint8)


def _shift(use: TextureUse | None) -> Array:
    """(2, 3) what KHR_texture_transform does to texture coordinates."""
    told = use.extensions.get("KHR_texture_transform") if use is not None else None
    found = np.eye(2, 3)
    if not isinstance(told, dict):
        return found
    try:
        offset, scale = (
            np.array(told.get(key, value), float).reshape(2)
            for key, value in (("offset", [0.0, 0.0]), ("scale", [1.0, 1.0]))
        )
        angle = float(told.get("rotation", 0.0))
    except (TypeError, ValueError):
        return found
    cos, sin = np.cos(angle), np.sin(angle)
    found[:, :2] = np.array([[cos, sin], [-sin, cos]]) * scale
    found[:, 2] = offset
    return found if np.isfinite(found).all() else np.eye(2, 3)
