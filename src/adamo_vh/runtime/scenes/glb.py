"""A whole scene as one GLB for a browser: small to load, and few things to draw.

Below the root node `world`, which turns Z up into glTF's Y up, everything is in the world's own
frame: `room`, `furniture/NAME` and `object/ID`. What has no repeating picture shares one material
with an atlas and colours at the vertices, so that most objects are drawn at once.
"""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from adamo_vh.engine import ObjectState
from adamo_vh.geometry import Quaternion
from adamo_vh.runtime.assets.asset import Asset, Material, Part
from adamo_vh.runtime.assets.atlas import Atlas, key, packed, picture_key, roughness
from adamo_vh.runtime.assets.glb_writing import (
    BYTE,
    FLOAT,
    INDICES,
    INT,
    SHORT,
    SIGNED_BYTE,
    VERTICES,
    GlbWriter,
    emissive,
    goes_beyond,
    linear,
)
from adamo_vh.runtime.scenes.scene import Scene
from adamo_vh.runtime.world import load_room, scene_assets

SOURCE = Path(__file__)
"""What decides, beside the scene and its assets, how it is written."""
_UPRIGHT = (-math.sqrt(0.5), 0.0, 0.0, math.sqrt(0.5))
"""Quaternion (x, y, z, w): Z up to +Y."""
_GRAIN_M = 1 / 2**14
"""Places are rounded to this, 0.06 mm, because round numbers pack well."""
_OPAQUE, _GLASS = "painted", "glass"
_SUNLIT = 2.0
"""What shines more than this is seen as its picture, whatever the light."""
_OWN_SHEET = frozenset({"walls", "ceiling", "outside"})
"""Large pictures of the room, which a page may want to hide or to light by themselves."""


@dataclass(frozen=True, slots=True)
class Drawn:
    """What a scene's GLB asks of whoever draws it."""

    calls: int
    """Draw calls with everything in view, without shadows."""
    triangles: int
    content: bytes


def scene_glb(scene: Scene, objects: Sequence[ObjectState]) -> Drawn:
    """Write a scene.

    Args:
        scene: What it is made of.
        objects: Where its objects are.
    """
    assets = scene_assets(scene)
    shell = load_room(scene)
    meshes = _Meshes([shell, *assets.values()])
    asset_of = {item.id: item.asset for item in scene.objects}
    nodes: list[tuple[str, Asset, Sequence[float], Quaternion]] = [
        ("room", shell, (0.0, 0.0, 0.0), Quaternion.from_yaw(0.0)),
        *(
            (
                f"furniture/{piece.name}",
                assets[piece.asset],
                (*piece.position, 0.0),
                Quaternion.from_yaw(math.radians(piece.yaw_deg)),
            )
            for piece in scene.furniture
        ),
        *(
            (
                f"object/{item.id}",
                assets[asset_of[item.id]],
                (item.box.center.x, item.box.center.y, item.box.center.z),
                item.box.orientation,
            )
            for item in objects
        ),
    ]
    return meshes.finished(scene.title or scene.name, nodes)


class _Meshes:
    """The GLB while it is written; every asset is in it once."""

    def __init__(self, assets: Iterable[Asset]) -> None:
        """Begin with what all share: the atlas and the two materials that show it."""
        self._writer = GlbWriter()
        self._writer.json["asset"] = {"version": "2.0", "generator": "ADAMO"}
        self._writer.json["extensionsUsed"] = ["KHR_mesh_quantization", "KHR_materials_unlit"]
        self._writer.json["extensionsRequired"] = ["KHR_mesh_quantization"]
        parts = [part for asset in assets for part in asset.parts]
        self._repeated = {_picture(part) for part in parts if goes_beyond(part)}
        self._atlas = packed([p.material for p in parts if self._shared(p)])
        self._sheets = self._add_sheets(self._atlas)
        self._materials: dict[str, int] = {}
        self._meshes: dict[int, int] = {}
        self._calls: dict[int, tuple[int, int]] = {}

    def finished(
        self, title: str, nodes: Sequence[tuple[str, Asset, Sequence[float], Quaternion]]
    ) -> Drawn:
        """Place everything, and close the file."""
        writer, calls, triangles = self._writer, 0, 0
        children = []
        for name, asset, place, turn in nodes:
            mesh = self._mesh(asset)
            primitives, faces = self._calls[mesh]
            calls, triangles = calls + primitives, triangles + faces
            rotation = [round(v, 6) for v in (turn.x, turn.y, turn.z, turn.w)]
            node = {
                "name": name,
                "mesh": mesh,
                "translation": [round(float(v), 5) for v in place],
                "rotation": rotation,
            }
            children.append(writer.add("nodes", node))
        root = {"name": "world", "rotation": list(_UPRIGHT), "children": children}
        writer.json["scenes"] = [{"name": title, "nodes": [writer.add("nodes", root)]}]
        writer.json["scene"] = 0
        return Drawn(calls, triangles, writer.file())

    def _shared(self, part: Part) -> bool:
        """Whether a part is painted from the atlas."""
        material = part.material
        return not (
            material.name in _OWN_SHEET or material.emission or _picture(part) in self._repeated
        )

    def _add_sheets(self, atlas: Atlas) -> Mapping[str, int]:
        sheet = self._writer.texture(atlas.sheet, jpeg=True)
        rough = self._writer.texture(atlas.rough, jpeg=False)
        made = {}
        for name, mode in ((_OPAQUE, "OPAQUE"), (_GLASS, "BLEND")):
            material = {
                "name": name,
                "alphaMode": mode,
                "pbrMetallicRoughness": {
                    "baseColorTexture": {"index": sheet},
                    "metallicRoughnessTexture": {"index": rough},
                    "metallicFactor": 0.0,
                },
            }
            made[name] = self._writer.add("materials", material)
        return made

    def _mesh(self, asset: Asset) -> int:
        if id(asset) not in self._meshes:
            groups: dict[int, list[Part]] = defaultdict(list)
            for part in asset.parts:
                groups[self._material(part)].append(part)
            primitives = [self._primitive(group, number) for number, group in groups.items()]
            mesh = self._writer.add("meshes", {"name": asset.class_name, "primitives": primitives})
            self._meshes[id(asset)] = mesh
            self._calls[mesh] = len(groups), sum(len(part.faces) for part in asset.parts)
        return self._meshes[id(asset)]

    def _material(self, part: Part) -> int:
        material = part.material
        if self._shared(part):
            return self._sheets[_OPAQUE if material.rgba[3] == 1.0 else _GLASS]
        known = f"{key(material)} {material.rgba} {material.emission}"
        if known not in self._materials:
            self._materials[known] = self._add_own(material, repeats=goes_beyond(part))
        return self._materials[known]

    def _add_own(self, material: Material, *, repeats: bool) -> int:
        """Add a material of its own: one with a repeating picture, or one that shines."""
        colour = [round(linear(c), 4) for c in material.rgba[:3]]
        surface: dict[str, Any] = {"metallicFactor": 0.0, "roughnessFactor": roughness(material)}
        made: dict[str, Any] = {"name": material.name, "pbrMetallicRoughness": surface}
        is_sunlit = material.emission > _SUNLIT
        surface["baseColorFactor"] = [*((1.0, 1.0, 1.0) if is_sunlit else colour), 1.0]
        if material.texture is not None:
            jpeg = self._writer.texture(material.texture, repeats=repeats, jpeg=True)
            surface["baseColorTexture"] = {"index": jpeg}
        if is_sunlit:
            made["extensions"] = {"KHR_materials_unlit": {}}
        elif material.emission:
            made["emissiveFactor"] = emissive(material)
        return self._writer.add("materials", made)

    def _primitive(self, parts: Sequence[Part], material: int) -> dict[str, Any]:
        """Parts of one material as one thing to draw."""
        writer = self._writer
        starts = np.cumsum([0, *(len(part.vertices) for part in parts)])
        places = np.concatenate([part.vertices for part in parts])
        normals = np.concatenate([part.normals for part in parts])
        faces = np.concatenate(
            [part.faces + start for part, start in zip(parts, starts[:-1], strict=True)]
        )
        rounded = np.asarray(np.rint(places / _GRAIN_M) * _GRAIN_M, np.float32)
        attributes = {
            "POSITION": writer.accessor(rounded, "VEC3", FLOAT, VERTICES),
            "NORMAL": writer.shares(np.clip(normals, -1.0, 1.0), "VEC3", SIGNED_BYTE),
        }
        if material in self._sheets.values():
            spots = [self._atlas.spots[key(part.material)] for part in parts]
            uvs = np.concatenate(
                [spot.placed(part.uvs) for spot, part in zip(spots, parts, strict=True)]
            )
            attributes["TEXCOORD_0"] = writer.shares(_downward(uvs), "VEC2", SHORT)
            colours = np.concatenate([_tint(part) for part in parts])
            attributes["COLOR_0"] = writer.shares(colours, "VEC4", BYTE)
        else:
            uvs = np.concatenate([part.uvs for part in parts])
            attributes["TEXCOORD_0"] = writer.accessor(_downward(uvs), "VEC2", FLOAT, VERTICES)
        wide = len(places) > 65535
        indices = writer.accessor(faces.ravel(), "SCALAR", INT if wide else SHORT, INDICES)
        return {"attributes": attributes, "indices": indices, "material": material}


def _picture(part: Part) -> str:
    """A part's picture, by its content; empty for none."""
    texture = part.material.texture
    return "" if texture is None else picture_key(texture)


def _downward(uvs: NDArray[np.float32]) -> NDArray[np.float32]:
    """GlTF counts v downward."""
    return np.asarray(uvs * [1, -1] + [0, 1], np.float32)


def _tint(part: Part) -> NDArray[np.float32]:
    """(N, 4) linear colour of every vertex."""
    red, green, blue, alpha = part.material.rgba
    colour = np.array([linear(red), linear(green), linear(blue), alpha], np.float32)
    return np.tile(colour, (len(part.vertices), 1))
