"""Rigged humanoids for tests, made of a built-in figure: other names, poses, axes and units.

A rig is given with its own local frames (every bone turned somehow), in a T or A pose, in metres or
not, with Y or Z up, facing this way or that; its meshes are those of Mara or of a few boxes.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from adamo_vh.runtime.assets.glb_writing import (
    FLOAT,
    INDICES,
    INT,
    SHORT,
    VERTICES,
    GlbWriter,
    add_material,
)
from adamo_vh.runtime.human.face import moving_face
from adamo_vh.runtime.human.looks import Figure, Garment, load_figure
from adamo_vh.runtime.human.rotations import about_x, about_z, quaternions
from adamo_vh.runtime.human.skeleton import INDEX, JOINTS, PARENTS, REST, Pose

_WORDS = {
    "pelvis": "hips", "spine": "spine", "chest": "chest", "neck": "neck", "head": "head",
}  # fmt: skip
_LIMBS = {
    "clavicle": "Shoulder", "upper_arm": "UpperArm", "forearm": "LowerArm", "hand": "Hand",
    "thigh": "UpperLeg", "shin": "LowerLeg", "foot": "Foot", "toes": "Toes",
}  # fmt: skip
_FINGER = re.compile(r"(thumb|index|middle|ring|little)_(\d)")
FINGERS = tuple(name for name in JOINTS if _FINGER.match(name))
_PHALANX = {
    "thumb": ("Metacarpal", "Proximal", "Distal"),
    **dict.fromkeys(("index", "middle", "ring", "little"), ("Proximal", "Intermediate", "Distal")),
}
_MIXAMO = {
    "hips": "Hips", "spine": "Spine", "chest": "Spine1", "neck": "Neck", "head": "Head",
    "Shoulder": "Shoulder", "UpperArm": "Arm", "LowerArm": "ForeArm", "Hand": "Hand",
    "UpperLeg": "UpLeg", "LowerLeg": "Leg", "Foot": "Foot", "Toes": "ToeBase",
}  # fmt: skip
_RIGIFY = {
    "hips": "spine", "spine": "spine.001", "chest": "spine.003", "neck": "spine.004",
    "head": "spine.006", "Shoulder": "shoulder", "UpperArm": "upper_arm", "LowerArm": "forearm",
    "Hand": "hand", "UpperLeg": "thigh", "LowerLeg": "shin", "Foot": "foot", "Toes": "toe",
}  # fmt: skip
_UNREAL = {
    "hips": "pelvis", "spine": "spine_01", "chest": "spine_02", "neck": "neck_01", "head": "head",
    "Shoulder": "clavicle", "UpperArm": "upperarm", "LowerArm": "lowerarm", "Hand": "hand",
    "UpperLeg": "thigh", "LowerLeg": "calf", "Foot": "foot", "Toes": "ball",
}  # fmt: skip


def bone_word(joint: str) -> tuple[str, str]:
    """The side ("", "left", "right") and the name of a joint in VRM's words."""
    if joint[-2:] in ("_l", "_r"):
        side = "left" if joint.endswith("_l") else "right"
        if finger := _FINGER.match(joint):
            name, number = finger.groups()
            return side, f"{name.capitalize()}{_PHALANX[name][int(number) - 1]}"
        return side, _LIMBS.get(joint[:-2], joint[:-2])
    return "", _WORDS.get(joint, joint)


def bone_name(joint: str, style: str) -> str:
    """What a program calls a joint."""
    side, word = bone_word(joint)
    if (finger := _FINGER.match(joint)) and style not in ("nothing", "adamo", "vrm"):
        name, number = finger.groups()
        word = f"{name}_0{number}" if style == "unreal" else f"{name.capitalize()}{number}"
    match style:
        case "mixamo":
            return f"mixamorig:{side.capitalize()}{_MIXAMO.get(word, word)}"
        case "unity":
            return f"{side.capitalize()}{word[0].upper()}{word[1:]}"
        case "unreal":
            return _UNREAL.get(word, word) + (f"_{side[0]}" if side else "")
        case "rigify":
            return f"DEF-{_RIGIFY.get(word, word)}" + (f".{side[0].upper()}" if side else "")
        case "vroid":
            return f"J_Bip_{side[:1].upper() or 'C'}_{word[0].upper()}{word[1:]}"
        case "vrm":
            return f"{side}{word}" if side else word
        case "nothing":
            return f"node {INDEX[joint]}"
    return joint


def t_pose() -> Pose:
    """Arms straight out, palms down."""
    rotations = np.tile(np.eye(3), (len(JOINTS), 1, 1))
    for side, way in (("l", 1.0), ("r", -1.0)):
        bone = REST[INDEX[f"forearm_{side}"]] - REST[INDEX[f"upper_arm_{side}"]]
        down = float(np.arctan2(-bone[2], abs(bone[1])))
        rotations[INDEX[f"upper_arm_{side}"]] = about_x(way * down)
    return Pose(rotations)


def palms_forward() -> Pose:
    """Arms straight out, palms to the front, as in books of anatomy."""
    pose = t_pose()
    for side, way in (("l", -1.0), ("r", 1.0)):
        bone = REST[INDEX[f"hand_{side}"]] - REST[INDEX[f"forearm_{side}"]]
        from adamo_vh.runtime.human.rotations import about

        axis = tuple(bone / np.linalg.norm(bone))
        pose.rotations[INDEX[f"hand_{side}"]] = about(axis, way * np.pi / 2)
    return pose


Y_UP = np.array([[0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0]])
"""file_from_body: Y up, facing +Z."""
Y_UP_BACKWARDS = np.diag([-1.0, 1.0, -1.0]) @ Y_UP
"""Y up, facing -Z, as VRM 0.x."""
Z_UP = np.eye(3)
"""Z up, facing +X."""
Z_UP_BACK = about_z(-np.pi / 2)
"""Z up, facing -Y, as Blender."""


@dataclass(frozen=True)
class Rig:
    """How a rig is written."""

    style: str = "unity"
    pose: Pose = field(default_factory=Pose)
    axes: np.ndarray = field(default_factory=lambda: Y_UP)
    scale: float = 1.0
    size: float = 1.0
    """How large the figure itself is, as a share of ours."""
    turned: bool = False
    """Whether each bone has a frame of its own."""
    vrm: str = ""
    """"0" or "1" for a map of bones as VRM has it."""
    split: int = 4
    """Influences in one set; fewer make more sets."""
    extra: bool = False
    """A tail below the hips, a hat without a skin on the head, and a stage on nothing."""
    swap: bool = False
    """Left and right exchanged in names."""
    without: tuple[str, ...] = ()
    """Joints that are left out, with their parent in their place."""
    plain: bool = False
    """No pictures and no shapes."""
    garments: tuple[str, ...] = ()
    """Only these; all if none are named."""
    offsets: Mapping[str, float] = field(default_factory=dict)
    """How much longer the way to a joint is than ours, by the joint's name without its side."""
    head: float = 1.0
    """How large the head is, as a share of ours."""
    more: Mapping[str, Any] = field(default_factory=dict)
    """Further members of the JSON."""


def rig(told: Rig, who: str = "mara") -> bytes:
    """A rig as a GLB."""
    writer = written(told, load_figure(who))
    return writer.file()


def _rest(told: Rig) -> np.ndarray:
    """(J, 3) the joints of the rig in our rest pose, with its own proportions."""
    own = REST.copy()
    for j, parent in enumerate(PARENTS):
        if parent >= 0:
            longer = told.offsets.get(JOINTS[j].removesuffix("_l").removesuffix("_r"), 1.0)
            longer *= told.head if JOINTS[j] == "eyelids" else 1.0
            own[j] = own[parent] + longer * (REST[j] - REST[parent])
    own[:, 2] += REST[INDEX["foot_l"], 2] - own[INDEX["foot_l"], 2]
    return own


def _shapes(told: Rig) -> np.ndarray:
    """(J, 3, 3) how what hangs on each joint is stretched."""
    found = np.tile(np.eye(3), (len(JOINTS), 1, 1))
    for j, parent in enumerate(PARENTS):
        name = JOINTS[j].removesuffix("_l").removesuffix("_r")
        if parent < 0 or name not in told.offsets or name in ("clavicle", "upper_arm"):
            continue
        line = REST[j] - REST[parent]
        line = line / np.linalg.norm(line)
        found[parent] += (told.offsets[name] - 1.0) * np.outer(line, line)
    for name in ("head", "eyelids"):
        found[INDEX[name]] = told.head * np.eye(3)
    return found


def _shaped(told: Rig, garment: Garment) -> np.ndarray:
    """(N, 3) vertices of a garment in the rig's own proportions."""
    rest, shapes = _rest(told), _shapes(told)
    arms = garment.vertices[:, None] - REST[garment.bone_ids]
    moved = np.einsum("nbij,nbj->nbi", shapes[garment.bone_ids], arms) + rest[garment.bone_ids]
    return np.asarray((moved * garment.weights[..., None]).sum(axis=1))


def _frames(told: Rig) -> tuple[np.ndarray, np.ndarray]:
    """(J, 4, 4) world_from_bone in the file's units, and (J, 4, 4) of the rest pose."""
    rest = _rest(told)
    ours = np.tile(np.eye(4), (len(JOINTS), 1, 1))
    ours[:, :3, 3] = rest
    posed = ours.copy()
    for j, parent in enumerate(PARENTS):
        turn = told.pose.rotations[j]
        if parent < 0:
            posed[j, :3, :3] = turn
            posed[j, :3, 3] += told.pose.pelvis_shift
        else:
            posed[j, :3, :3] = posed[parent, :3, :3] @ turn
            posed[j, :3, 3] = posed[parent, :3, 3] + posed[parent, :3, :3] @ (
                rest[j] - rest[parent]
            )
    into = np.eye(4)
    into[:3, :3] = told.axes * told.scale * told.size
    return into @ posed, ours


def written(told: Rig, figure: Figure) -> GlbWriter:
    """A rig, as long as more can be written to it."""
    writer = GlbWriter()
    writer.json |= {"asset": {"version": "2.0", "generator": "a test"}, "scene": 0}
    world, ours = _frames(told)
    own = np.tile(np.eye(4), (len(JOINTS), 1, 1))
    if told.turned:
        rng = np.random.default_rng(5)
        for j in range(len(JOINTS)):
            own[j, :3, :3] = np.linalg.qr(rng.normal(size=(3, 3)))[0]
            own[j, :3, 0] *= np.sign(np.linalg.det(own[j, :3, :3]))
    frames = world @ own
    joints = [j for j, name in enumerate(JOINTS) if name not in told.without]
    nodes = _nodes(writer, told, (frames, own), joints)
    # From the pose of the file back to ours, where the vertices are given.
    inverse = np.linalg.inv(own) @ np.linalg.inv(ours)
    skin = writer.add(
        "skins",
        {
            "joints": [nodes[j] for j in joints],
            "inverseBindMatrices": writer.accessor(
                inverse[joints].transpose(0, 2, 1).reshape(-1, 16), "MAT4", FLOAT
            ),
        },
    )
    face = moving_face(figure)
    roots = [0]
    for garment in face.figure.garments:
        if told.garments and garment.name not in told.garments:
            continue
        shapes = {} if told.plain else face.shapes.get(garment.name, {})
        mesh = _mesh(writer, garment, shapes, joints, told)
        roots.append(writer.add("nodes", {"name": garment.name, "mesh": mesh, "skin": skin}))
    if told.extra:
        roots.append(_extras(writer, nodes, frames))
    writer.json["scenes"] = [{"nodes": roots}]
    _vrm(writer, told, nodes, joints)
    writer.json |= dict(told.more)
    return writer


def _nodes(
    writer: GlbWriter,
    told: Rig,
    placed: tuple[np.ndarray, np.ndarray],
    joints: Sequence[int],
) -> dict[int, int]:
    frames, _ = placed
    writer.add("nodes", {"name": "Armature"})
    nodes: dict[int, int] = {}
    for j in joints:
        parent = _parent(j, joints)
        local = frames[j] if parent < 0 else np.linalg.inv(frames[parent]) @ frames[j]
        scale = np.linalg.norm(local[:3, 0])
        turn = quaternions(local[:3, :3] / scale)[[1, 2, 3, 0]]
        name = JOINTS[j]
        if told.swap and name[-2:] in ("_l", "_r"):
            name = name[:-1] + ("r" if name.endswith("l") else "l")
        nodes[j] = writer.add(
            "nodes",
            {
                "name": bone_name(name, told.style),
                "translation": local[:3, 3].tolist(),
                "rotation": turn.tolist(),
                "scale": [float(scale)] * 3,
            },
        )
        above = writer.json["nodes"][nodes[parent] if parent >= 0 else 0]
        above.setdefault("children", []).append(nodes[j])
    return nodes


def _parent(joint: int, joints: Sequence[int]) -> int:
    parent = PARENTS[joint]
    while parent >= 0 and parent not in joints:
        parent = PARENTS[parent]
    return parent


def _mesh(
    writer: GlbWriter,
    garment: Garment,
    shapes: Mapping[str, np.ndarray],
    joints: Sequence[int],
    told: Rig,
) -> int:
    place = {j: i for i, j in enumerate(joints)}
    for j in range(len(JOINTS)):
        place.setdefault(j, place[_parent(j, joints)] if _parent(j, joints) >= 0 else 0)
    bones = np.vectorize(place.get)(garment.bone_ids)
    bones = np.where(garment.weights > 0, bones, 0)
    attributes = {
        "POSITION": writer.accessor(_shaped(told, garment), "VEC3", FLOAT, VERTICES),
        "NORMAL": writer.accessor(garment.normals, "VEC3", FLOAT, VERTICES),
        "TEXCOORD_0": writer.accessor(garment.uvs * [1, -1] + [0, 1], "VEC2", FLOAT, VERTICES),
    }
    for number, begin in enumerate(range(0, 4, told.split)):
        wide = np.zeros((len(bones), 4), int), np.zeros((len(bones), 4))
        wide[0][:, : told.split] = bones[:, begin : begin + told.split]
        wide[1][:, : told.split] = garment.weights[:, begin : begin + told.split]
        attributes[f"JOINTS_{number}"] = writer.accessor(wide[0], "VEC4", SHORT, VERTICES)
        attributes[f"WEIGHTS_{number}"] = writer.accessor(wide[1], "VEC4", FLOAT, VERTICES)
    primitive: dict[str, Any] = {
        "attributes": attributes,
        "indices": writer.accessor(garment.faces.ravel(), "SCALAR", INT, INDICES),
    }
    if not told.plain:
        primitive["material"] = add_material(writer, garment.material)
        writer.json["materials"][-1]["doubleSided"] = False
    mesh: dict[str, Any] = {"name": garment.name, "primitives": [primitive]}
    if shapes:
        primitive["targets"] = [
            {"POSITION": writer.accessor(moves, "VEC3", FLOAT)} for moves in shapes.values()
        ]
        mesh["extras"] = {"targetNames": list(shapes)}
    return writer.add("meshes", mesh)


def box(writer: GlbWriter, name: str, size: float) -> int:
    """A mesh of one cube about the origin."""
    corners = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]) * size / 2
    faces = np.array(
        [[0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5], [0, 4, 5], [0, 5, 1],
         [2, 3, 7], [2, 7, 6], [0, 2, 6], [0, 6, 4], [1, 5, 7], [1, 7, 3]]
    )  # fmt: skip
    primitive = {
        "attributes": {"POSITION": writer.accessor(corners, "VEC3", FLOAT, VERTICES)},
        "indices": writer.accessor(faces.ravel(), "SCALAR", INT, INDICES),
    }
    return writer.add("meshes", {"name": name, "primitives": [primitive]})


def _extras(writer: GlbWriter, nodes: Mapping[int, int], frames: np.ndarray) -> int:
    """A hat that hangs on the head as it is, and a stage that hangs on nothing."""
    head = nodes[INDEX["head"]]
    hat = writer.add(
        "nodes", {"name": "hat", "mesh": box(writer, "hat", 0.1), "translation": [0.0, 0.0, 0.0]}
    )
    writer.json["nodes"][head].setdefault("children", []).append(hat)
    return writer.add("nodes", {"name": "stage", "mesh": box(writer, "stage", 5.0)})


def _vrm(writer: GlbWriter, told: Rig, nodes: Mapping[int, int], joints: Sequence[int]) -> None:
    words = {}
    for j in joints:
        side, word = bone_word(JOINTS[j])
        name = f"{side}{word}" if side else word
        if word in (*_LIMBS.values(), *_WORDS.values()) or JOINTS[j] in FINGERS:
            if told.vrm == "0" and word.startswith("Thumb"):  # It names the thumb otherwise.
                name = name.replace("Proximal", "Intermediate").replace("Metacarpal", "Proximal")
            words[name] = nodes[j]
    head = next((i for i, m in enumerate(writer.json["meshes"]) if m["name"] == "lids"), 0)
    at = next(
        (i for i, n in enumerate(writer.json["nodes"]) if n.get("mesh") == head and "skin" in n), 0
    )
    if told.vrm == "1":
        writer.json["extensionsUsed"] = ["VRMC_vrm"]
        writer.json["extensions"] = {
            "VRMC_vrm": {
                "specVersion": "1.0",
                "humanoid": {"humanBones": {k: {"node": n} for k, n in words.items()}},
                "meta": {
                    "name": "Testa", "authors": ["A. Tester"], "avatarPermission": "everyone",
                    "licenseUrl": "https://vrm.dev/licenses/1.0/", "allowRedistribution": True,
                },
                "expressions": {
                    "preset": {
                        "blinkLeft": {"morphTargetBinds": [{"node": at, "index": 0, "weight": 1}]}
                    }
                },
            }
        }  # fmt: skip
    elif told.vrm == "0":
        writer.json["extensionsUsed"] = ["VRM"]
        writer.json["extensions"] = {
            "VRM": {
                "humanoid": {"humanBones": [{"bone": k, "node": n} for k, n in words.items()]},
                "meta": {"title": "Testa", "author": "A. Tester", "licenseName": "CC0"},
                "blendShapeMaster": {
                    "blendShapeGroups": [
                        {"presetName": "blink_l",
                         "binds": [{"mesh": head, "index": 0, "weight": 100}]},
                    ]
                },
            }
        }  # fmt: skip
