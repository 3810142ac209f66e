"""Write the figure as a skinned, animated GLB for the browser: one JSON chunk and one buffer.

glTF has Y up and its figures look along +Z; the root node turns the body frame into that, so that
vertices, joints and clips stay in the body frame.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from adamo_vh.files import write_whole
from adamo_vh.geometry import Array
from adamo_vh.runtime.assets.glb_writing import (
    BYTE,
    FLOAT,
    INDICES,
    INT,
    SHORT,
    VERTICES,
    GlbWriter,
    add_material,
)
from adamo_vh.runtime.human.bone_names import BONES
from adamo_vh.runtime.human.clips import Clip
from adamo_vh.runtime.human.face import moving_face
from adamo_vh.runtime.human.looks import Figure, Garment
from adamo_vh.runtime.human.skeleton import JOINTS, PARENTS, REST

_BODY_TO_GLTF = (-0.5, -0.5, -0.5, 0.5)
"""Quaternion (x, y, z, w): X forward to +Z, Y left to +X, Z up to +Y."""


def write_glb(path: Path, figure: Figure, clips: Iterable[Clip] = ()) -> None:
    """Write a figure with its motions; see `figure_glb`.

    Args:
        path: Where to.
        figure: The looks.
        clips: Motions; they keep their names.
    """
    write_whole(path, figure_glb(figure, clips))


def figure_glb(figure: Figure, clips: Iterable[Clip] = ()) -> bytes:
    """A figure with its motions; three.js and others play the clips by name.

    Its bones are named as `BONES`, and the face has the morph targets of `face.SHAPES`.

    Args:
        figure: The looks.
        clips: Motions; they keep their names.
    """
    face = moving_face(figure)
    writer = GlbWriter()
    writer.json["asset"] = {"version": "2.0", "generator": "ADAMO"}
    writer.json["scene"] = 0
    skin = _add_skeleton(writer)
    # Only joints place a skinned mesh, so the specification wants it beside them, not below.
    roots = [0]
    for garment in face.figure.garments:
        mesh = _add_mesh(writer, garment, face.shapes.get(garment.name, {}))
        roots.append(writer.add("nodes", {"name": garment.name, "mesh": mesh, "skin": skin}))
    writer.json["scenes"] = [{"name": figure.variant, "nodes": roots}]
    for clip in clips:
        _add_clip(writer, clip)
    return writer.file()


def joint_node(joint: int) -> int:
    """Number of a joint's node: the root comes first."""
    return joint + 1


def _add_skeleton(writer: GlbWriter) -> int:
    """Add the root node, one node for each joint, and the skin."""
    root = {"name": "human", "rotation": list(_BODY_TO_GLTF), "children": [joint_node(0)]}
    writer.add("nodes", root)
    for j, (name, parent) in enumerate(zip(BONES, PARENTS, strict=True)):
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
            "inverseBindMatrices": writer.accessor(inverse.reshape(-1, 16), "MAT4", FLOAT),
        },
    )


def _add_mesh(
    writer: GlbWriter, garment: Garment, shapes: Mapping[str, NDArray[np.float32]]
) -> int:
    # A joint without weight must be number 0.
    joints = np.where(garment.weights > 0, garment.bone_ids, 0)
    # glTF counts v downward.
    uvs = garment.uvs * [1, -1] + [0, 1]
    attributes = {
        "POSITION": writer.accessor(garment.vertices, "VEC3", FLOAT, VERTICES),
        "NORMAL": writer.accessor(garment.normals, "VEC3", FLOAT, VERTICES),
        "TEXCOORD_0": writer.accessor(uvs, "VEC2", FLOAT, VERTICES),
        "JOINTS_0": writer.accessor(joints, "VEC4", BYTE, VERTICES),
        "WEIGHTS_0": writer.accessor(garment.weights, "VEC4", FLOAT, VERTICES),
    }
    wide = len(garment.vertices) > 65535
    primitive: dict[str, Any] = {
        "attributes": attributes,
        "indices": writer.accessor(
            garment.faces.ravel(), "SCALAR", INT if wide else SHORT, INDICES
        ),
        "material": add_material(writer, garment.material, repeats=_repeats(garment)),
    }
    mesh: dict[str, Any] = {"name": garment.name, "primitives": [primitive]}
    if shapes:
        primitive["targets"] = [
            {"POSITION": writer.accessor(moves, "VEC3", FLOAT)} for moves in shapes.values()
        ]
        mesh["weights"] = [0.0] * len(shapes)
        mesh["extras"] = {"targetNames": list(shapes)}
    return writer.add("meshes", mesh)


def _repeats(garment: Garment) -> bool:
    """Whether its picture goes on beyond its edges."""
    return bool(garment.uvs.min(initial=0.0) < -1e-3 or garment.uvs.max(initial=1.0) > 1.0 + 1e-3)


def _add_clip(writer: GlbWriter, clip: Clip) -> None:
    """Add an animation: the turn of every joint that moves, and the shift of the pelvis."""
    from scipy.spatial.transform import Rotation

    times = writer.accessor(clip.times_s, "SCALAR", FLOAT)
    samplers: list[dict[str, Any]] = []
    channels: list[dict[str, Any]] = []

    def add(joint: int, path: str, values: Array, kind: str) -> None:
        output = writer.accessor(values, kind, FLOAT)
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
