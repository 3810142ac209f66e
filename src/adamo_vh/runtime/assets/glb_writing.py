"""Write a GLB: one JSON chunk and one buffer, with meshes, materials and textures inside."""

from __future__ import annotations

import io
import json
import struct
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from adamo_vh.runtime.assets.asset import Asset, Material, Part

FLOAT, BYTE, SHORT, INT = 5126, 5121, 5123, 5125
VERTICES, INDICES = 34962, 34963


@dataclass(slots=True)
class GlbWriter:
    """Collects the JSON and the bytes."""

    content: bytearray = field(default_factory=bytearray)
    json: dict[str, Any] = field(default_factory=dict)

    def add(self, key: str, item: dict[str, Any]) -> int:
        """Append to one of the top-level lists; returns its number."""
        items: list[Any] = self.json.setdefault(key, [])
        items.append(item)
        return len(items) - 1

    def view(self, raw: bytes, target: int | None = None) -> int:
        """Append bytes on a four-byte boundary."""
        self.content.extend(b"\0" * (-len(self.content) % 4))
        view: dict[str, Any] = {
            "buffer": 0, "byteOffset": len(self.content), "byteLength": len(raw),
        }  # fmt: skip
        if target is not None:
            view["target"] = target
        self.content.extend(raw)
        return self.add("bufferViews", view)

    def accessor(
        self, values: NDArray[Any], kind: str, code: int, target: int | None = None
    ) -> int:
        """Append an array; its bounds go with floats, as positions and times need them."""
        types = {FLOAT: "<f4", BYTE: "u1", SHORT: "<u2", INT: "<u4"}
        flat = np.ascontiguousarray(values, dtype=types[code])
        item: dict[str, Any] = {
            "bufferView": self.view(flat.tobytes(), target),
            "componentType": code, "count": len(flat), "type": kind,
        }  # fmt: skip
        if kind in ("SCALAR", "VEC3") and code == FLOAT:
            rows = flat.reshape(len(flat), -1)
            item["min"], item["max"] = rows.min(axis=0).tolist(), rows.max(axis=0).tolist()
        return self.add("accessors", item)

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


def add_material(writer: GlbWriter, material: Material) -> int:
    """Add a rough, non-metallic material; its factor is linear, its texture stays sRGB."""
    red, green, blue, alpha = material.rgba
    surface: dict[str, Any] = {
        "baseColorFactor": [*(linear(c) for c in (red, green, blue)), alpha],
        "metallicFactor": 0.0,
        "roughnessFactor": round(1.0 - 0.6 * material.shininess, 3),
    }
    if material.texture is not None:
        surface["baseColorTexture"] = {"index": _add_texture(writer, material.texture)}
    return writer.add(
        "materials",
        {"name": material.name, "pbrMetallicRoughness": surface, "doubleSided": True},
    )


def _add_texture(writer: GlbWriter, picture: NDArray[np.uint8]) -> int:
    from PIL import Image

    if "samplers" not in writer.json:
        writer.add(
            "samplers", {"magFilter": 9729, "minFilter": 9987, "wrapS": 33071, "wrapT": 33071}
        )
    content = io.BytesIO()
    Image.fromarray(picture).save(content, "PNG", optimize=True)
    view = writer.view(content.getvalue())
    source = writer.add("images", {"mimeType": "image/png", "bufferView": view})
    return writer.add("textures", {"sampler": 0, "source": source})


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
    material = add_material(writer, part.material)
    return {"attributes": attributes, "indices": indices, "material": material}


def _y_up(vectors: NDArray[np.float32]) -> NDArray[np.float32]:
    return np.asarray(vectors[:, [0, 2, 1]] * np.array([1, 1, -1], np.float32))
