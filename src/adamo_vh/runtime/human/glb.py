"""Write the figure as a skinned, animated GLB for the browser: one JSON chunk and one buffer.

glTF has Y up and its figures look along +Z; the root node turns the body frame into that, so that
vertices, joints and clips stay in the body frame.
"""

from __future__ import annotations

import io
import json
import struct
from collections.abc import Iterable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from adamo_vh.files import write_whole
from adamo_vh.geometry import Array
from adamo_vh.runtime.assets.asset import Material
from adamo_vh.runtime.human.clips import Clip
from adamo_vh.runtime.human.looks import Figure, Garment
from adamo_vh.runtime.human.skeleton import JOINTS, PARENTS, REST

_FLOAT, _BYTE, _SHORT, _INT = 5126, 5121, 5123, 5125
_VERTICES, _INDICES = 34962, 34963
_BODY_TO_GLTF = (-0.5, -0.5, -0.5, 0.5)
"""Quaternion (x, y, z, w): X forward to +Z, Y left to +X, Z up to +Y."""


@dataclass(slots=True)
class _Writer:
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
        types = {_FLOAT: "<f4", _BYTE: "u1", _SHORT: "<u2", _INT: "<u4"}
        flat = np.ascontiguousarray(values, dtype=types[code])
        item: dict[str, Any] = {
            "bufferView": self.view(flat.tobytes(), target),
            "componentType": code, "count": len(flat), "type": kind,
        }  # fmt: skip
        if kind in ("SCALAR", "VEC3") and code == _FLOAT:
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


def write_glb(path: Path, figure: Figure, clips: Iterable[Clip] = ()) -> None:
    """Write a figure with its motions; three.js and others play the clips by name.

    Args:
        path: Where to.
        figure: The looks.
        clips: Motions; they keep their names.
    """
    writer = _Writer()
    writer.json["asset"] = {"version": "2.0", "generator": "ADAMO"}
    writer.json["scene"] = 0
    skin = _add_skeleton(writer)
    # Only joints place a skinned mesh, so the specification wants it beside them, not below.
    roots = [0]
    for garment in figure.garments:
        mesh = _add_mesh(writer, garment)
        roots.append(writer.add("nodes", {"name": garment.name, "mesh": mesh, "skin": skin}))
    writer.json["scenes"] = [{"name": figure.variant, "nodes": roots}]
    for clip in clips:
        _add_clip(writer, clip)
    write_whole(path, writer.file())


def joint_node(joint: int) -> int:
    """Number of a joint's node: the root comes first."""
    return joint + 1


def _add_skeleton(writer: _Writer) -> int:
    """Add the root node, one node for each joint, and the skin."""
    root = {"name": "human", "rotation": list(_BODY_TO_GLTF), "children": [joint_node(0)]}
    writer.add("nodes", root)
    for j, (name, parent) in enumerate(zip(JOINTS, PARENTS, strict=True)):
        shift = REST[j] - (REST[parent] if parent >= 0 else 0.0)
        node: dict[str, Any] = {"name": name, "translation": shift.tolist()}
        children = [joint_node(k) for k, p in enumerate(PARENTS) if p == j]
        if children:
            node["children"] = children
        writer.add("nodes", node)
    inverse = np.tile(np.eye(4), (len(JOINTS), 1, 1))
    # Columns first: the last row of the stored matrix is the shift.
    inverse[:, 3, :3] = -REST
    return writer.add(
        "skins",
        {
            "joints": [joint_node(j) for j in range(len(JOINTS))],
            "skeleton": joint_node(0),
            "inverseBindMatrices": writer.accessor(inverse.reshape(-1, 16), "MAT4", _FLOAT),
        },
    )


def _add_mesh(writer: _Writer, garment: Garment) -> int:
    # A joint without weight must be number 0.
    joints = np.where(garment.weights > 0, garment.bone_ids, 0)
    # glTF counts v downward.
    uvs = garment.uvs * [1, -1] + [0, 1]
    attributes = {
        "POSITION": writer.accessor(garment.vertices, "VEC3", _FLOAT, _VERTICES),
        "NORMAL": writer.accessor(garment.normals, "VEC3", _FLOAT, _VERTICES),
        "TEXCOORD_0": writer.accessor(uvs, "VEC2", _FLOAT, _VERTICES),
        "JOINTS_0": writer.accessor(joints, "VEC4", _BYTE, _VERTICES),
        "WEIGHTS_0": writer.accessor(garment.weights, "VEC4", _FLOAT, _VERTICES),
    }
    wide = len(garment.vertices) > 65535
    primitive = {
        "attributes": attributes,
        "indices": writer.accessor(
            garment.faces.ravel(), "SCALAR", _INT if wide else _SHORT, _INDICES
        ),
        "material": _add_material(writer, garment.material),
    }
    return writer.add("meshes", {"name": garment.name, "primitives": [primitive]})


def _add_material(writer: _Writer, material: Material) -> int:
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


def _add_texture(writer: _Writer, picture: NDArray[np.uint8]) -> int:
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


def _add_clip(writer: _Writer, clip: Clip) -> None:
    """Add an animation: the turn of every joint that moves, and the shift of the pelvis."""
    from scipy.spatial.transform import Rotation

    times = writer.accessor(clip.times_s, "SCALAR", _FLOAT)
    samplers: list[dict[str, Any]] = []
    channels: list[dict[str, Any]] = []

    def add(joint: int, path: str, values: Array, kind: str) -> None:
        output = writer.accessor(values, kind, _FLOAT)
        target = {"node": joint_node(joint), "path": path}
        channels.append({"sampler": len(samplers), "target": target})
        samplers.append({"input": times, "output": output, "interpolation": "LINEAR"})

    add(0, "translation", clip.pelvis, "VEC3")
    for j in range(len(JOINTS)):
        quaternions = Rotation.from_matrix(clip.rotations[:, j]).as_quat()
        add(j, "rotation", _continuous(quaternions), "VEC4")
    writer.add("animations", {"name": clip.name, "samplers": samplers, "channels": channels})


def _continuous(quaternions: Array) -> Array:
    """(T, 4) with signs chosen so that no step takes the long way round."""
    turned = np.einsum("ij,ij->i", quaternions[1:], quaternions[:-1]) < 0
    signs = np.cumprod(np.where(np.concatenate([[False], turned]), -1.0, 1.0))
    return quaternions * signs[:, None]
