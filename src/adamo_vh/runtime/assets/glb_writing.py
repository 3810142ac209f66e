"""Write a GLB: one JSON chunk and one buffer, with meshes, materials and textures inside."""

from __future__ import annotations

import hashlib
import io
import json
import struct
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from adamo_vh.runtime.assets.asset import Asset, Material, Part
from adamo_vh.runtime.assets.atlas import roughness

FLOAT, BYTE, SHORT, INT, SIGNED_BYTE = 5126, 5121, 5123, 5125, 5120
VERTICES, INDICES = 34962, 34963
_CLAMP, _REPEAT = 33071, 10497
_TYPES = {FLOAT: "<f4", BYTE: "u1", SHORT: "<u2", INT: "<u4", SIGNED_BYTE: "i1"}
_FULL = {BYTE: 255, SHORT: 65535, SIGNED_BYTE: 127}
"""What stands for 1 where whole numbers stand for shares."""


@dataclass(slots=True)
class GlbWriter:
    """Collects the JSON and the bytes."""

    content: bytearray = field(default_factory=bytearray)
    json: dict[str, Any] = field(default_factory=dict)
    textures: dict[tuple[str, bool], int] = field(default_factory=dict)
    """Textures that are in it, by the digest of their picture and whether they repeat."""

    def add(self, key: str, item: dict[str, Any]) -> int:
        """Append to one of the top-level lists; returns its number."""
        items: list[Any] = self.json.setdefault(key, [])
        items.append(item)
        return len(items) - 1

    def view(self, raw: bytes, target: int | None = None, stride: int = 0) -> int:
        """Append bytes on a four-byte boundary; a stride tells how far apart vertices are."""
        self.content.extend(b"\0" * (-len(self.content) % 4))
        view: dict[str, Any] = {
            "buffer": 0, "byteOffset": len(self.content), "byteLength": len(raw),
        }  # fmt: skip
        if target is not None:
            view["target"] = target
        if stride:
            view["byteStride"] = stride
        self.content.extend(raw)
        return self.add("bufferViews", view)

    def accessor(
        self, values: NDArray[Any], kind: str, code: int, target: int | None = None
    ) -> int:
        """Append an array; its bounds go with floats, as positions and times need them."""
        flat = np.ascontiguousarray(values, dtype=_TYPES[code])
        item: dict[str, Any] = {
            "bufferView": self.view(flat.tobytes(), target),
            "componentType": code, "count": len(flat), "type": kind,
        }  # fmt: skip
        if kind in ("SCALAR", "VEC3") and code == FLOAT:
            rows = flat.reshape(len(flat), -1)
            item["min"], item["max"] = rows.min(axis=0).tolist(), rows.max(axis=0).tolist()
        return self.add("accessors", item)

    def shares(self, values: NDArray[Any], kind: str, code: int) -> int:
        """Append an array of vertices' values, each a share of one, as whole numbers.

        Args:
            values: (N, width) in [0, 1], or in [-1, 1] for signed bytes.
            kind: VEC2, VEC3 or VEC4.
            code: BYTE, SHORT or SIGNED_BYTE.
        """
        count, width = values.shape
        whole = np.rint(values * _FULL[code]).astype(_TYPES[code])
        # Each vertex must begin on a four-byte boundary.
        bytes_each = -(-width * whole.itemsize // 4) * 4
        rows = np.zeros((count, bytes_each // whole.itemsize), whole.dtype)
        rows[:, :width] = whole
        item: dict[str, Any] = {
            "bufferView": self.view(rows.tobytes(), VERTICES, bytes_each),
            "componentType": code, "count": count, "type": kind, "normalized": True,
        }  # fmt: skip
        return self.add("accessors", item)

    def texture(self, picture: NDArray[np.uint8], *, repeats: bool = False, jpeg: bool) -> int:
        """Add a texture, once however often it is used.

        Args:
            picture: (H, W, 3) sRGB.
            repeats: Whether it goes on beyond its edges.
            jpeg: Much smaller, and not exact.
        """
        from PIL import Image

        known = hashlib.sha256(f"{picture.shape}".encode() + picture.tobytes()).hexdigest(), repeats
        if known not in self.textures:
            content = io.BytesIO()
            if jpeg:
                Image.fromarray(picture).save(content, "JPEG", quality=85, subsampling=0)
            else:
                # To pack harder takes six times as long, for a tenth less.
                Image.fromarray(picture).save(content, "PNG")
            mime = "image/jpeg" if jpeg else "image/png"
            image = {"mimeType": mime, "bufferView": self.view(content.getvalue())}
            wrap = _REPEAT if repeats else _CLAMP
            sampler = {"magFilter": 9729, "minFilter": 9987, "wrapS": wrap, "wrapT": wrap}
            samplers = self.json.setdefault("samplers", [])
            if sampler not in samplers:
                samplers.append(sampler)
            texture = {"sampler": samplers.index(sampler), "source": self.add("images", image)}
            self.textures[known] = self.add("textures", texture)
        return self.textures[known]

    def file(self) -> bytes:
        """The finished GLB."""
        self.json["buffers"] = [{"byteLength": len(self.content)}]
        text = json.dumps(self.json, separators=(",", ":")).encode()
        text += b" " * (-len(text) % 4)
        binary = bytes(self.content) + b"\0" * (-len(self.content) % 4)
        total = 12 + 8 + len(text) + 8 + len(binary)
        return b"".join(
            (
                struct.pack("<4sII", b"glTF", 2, total),
                struct.pack("<I4s", len(text), b"JSON"),
                text,
                struct.pack("<I4s", len(binary), b"BIN\0"),
                binary,
            )
        )


def add_material(writer: GlbWriter, material: Material, *, repeats: bool = False) -> int:
    """Add a rough, non-metallic material; its factor is linear, its texture stays sRGB.

    Args:
        writer: Takes it.
        material: How a part reflects light.
        repeats: Whether its picture goes on beyond its edges.
    """
    red, green, blue, alpha = material.rgba
    surface: dict[str, Any] = {
        "baseColorFactor": [*(linear(c) for c in (red, green, blue)), alpha],
        "metallicFactor": 0.0,
        "roughnessFactor": roughness(material),
    }
    if material.texture is not None:
        index = writer.texture(material.texture, repeats=repeats, jpeg=False)
        surface["baseColorTexture"] = {"index": index}
    made: dict[str, Any] = {
        "name": material.name,
        "pbrMetallicRoughness": surface,
        "doubleSided": True,
    }
    if material.emission:
        made["emissiveFactor"] = emissive(material)
    return writer.add("materials", made)


def emissive(material: Material) -> list[float]:
    """The light that a surface gives by itself, red, green and blue, linear, 0 to 1."""
    return [round(linear(min(1.0, c * material.emission)), 4) for c in material.rgba[:3]]


def linear(value: float) -> float:
    """An sRGB component in [0, 1] as linear light."""
    return value / 12.92 if value <= 0.04045 else ((value + 0.055) / 1.055) ** 2.4


def asset_glb(asset: Asset, name: str) -> bytes:
    """An asset as a GLB of one node, with Y up as glTF has it: x stays, y is up, z is -y."""
    writer = GlbWriter()
    writer.json["asset"] = {"version": "2.0", "generator": "ADAMO"}
    writer.json["scene"] = 0
    parts = [_primitive(writer, part) for part in asset.parts]
    mesh = writer.add("meshes", {"name": name, "primitives": parts})
    node = writer.add("nodes", {"name": name, "mesh": mesh})
    writer.json["scenes"] = [{"name": name, "nodes": [node]}]
    return writer.file()


def _primitive(writer: GlbWriter, part: Part) -> dict[str, Any]:
    wide = len(part.vertices) > 65535
    attributes = {
        "POSITION": writer.accessor(_y_up(part.vertices), "VEC3", FLOAT, VERTICES),
        "NORMAL": writer.accessor(_y_up(part.normals), "VEC3", FLOAT, VERTICES),
        "TEXCOORD_0": writer.accessor(part.uvs * [1, -1] + [0, 1], "VEC2", FLOAT, VERTICES),
    }
    indices = writer.accessor(part.faces.ravel(), "SCALAR", INT if wide else SHORT, INDICES)
    material = add_material(writer, part.material, repeats=goes_beyond(part))
    return {"attributes": attributes, "indices": indices, "material": material}


def goes_beyond(part: Part) -> bool:
    """Whether a part has a picture, and shows it again beyond its edges."""
    if part.material.texture is None:
        return False
    return bool(part.uvs.min() < -1e-3 or part.uvs.max() > 1.0 + 1e-3)


def _y_up(vectors: NDArray[np.float32]) -> NDArray[np.float32]:
    return np.asarray(vectors[:, [0, 2, 1]] * np.array([1, 1, -1], np.float32))
