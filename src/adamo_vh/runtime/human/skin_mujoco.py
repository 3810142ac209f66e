"""The figure in MuJoCo: one mocap body for each joint, one skin for each garment.

Mocap bodies are outside the physics: they add no degree of freedom, do not collide and carry no
mass, so the world with a person in it is simulated exactly as without.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from adamo_vh.geometry import Array
from adamo_vh.runtime.assets.mujoco_parts import add_material
from adamo_vh.runtime.human.looks import HEAD_GARMENTS, Figure, Garment
from adamo_vh.runtime.human.rotations import quaternions
from adamo_vh.runtime.human.skeleton import JOINTS, REST

if TYPE_CHECKING:
    import mujoco

BODY_GROUP = 0
"""Skin group of everything below the neck."""
HEAD_GROUP = 1
"""Skin group of the head; switch it off in `MjvOption.skingroup` to look out of the eyes."""


def body_name(joint: str) -> str:
    """Name of a joint's mocap body."""
    return f"human_{joint}"


def add_human(spec: mujoco.MjSpec, figure: Figure) -> None:
    """Add a person to a model, standing at the origin in the rest pose and facing +X.

    Args:
        spec: The model being built; one person at most.
        figure: Its looks.
    """
    for joint, place in zip(JOINTS, REST, strict=True):
        spec.worldbody.add_body(name=body_name(joint), mocap=True, pos=place)
    for garment in figure.garments:
        _add_skin(spec, garment)


def pose_human(model: mujoco.MjModel, data: mujoco.MjData, places: Array, rotations: Array) -> None:
    """Put the joints where they are in the world; the next drawing shows it.

    Args:
        model: The compiled world.
        data: Its state; call `mj_kinematics` or `mj_forward` before drawing.
        places: (J, 3) world places in the order of `skeleton.JOINTS`, metres.
        rotations: (J, 3, 3) world_from_joint.
    """
    slots = [int(model.body(body_name(joint)).mocapid[0]) for joint in JOINTS]
    data.mocap_pos[slots] = places
    data.mocap_quat[slots] = quaternions(rotations)


def _add_skin(spec: mujoco.MjSpec, garment: Garment) -> None:
    name = f"human_{garment.name}"
    add_material(spec, garment.material, name)
    bones = [j for j in range(len(JOINTS)) if (garment.weights[garment.bone_ids == j] > 0).any()]
    held = [np.nonzero((garment.bone_ids == j) & (garment.weights > 0)) for j in bones]
    spec.add_skin(
        name=name,
        material=name,
        group=HEAD_GROUP if garment.material.name in HEAD_GARMENTS else BODY_GROUP,
        vert=garment.vertices.ravel().tolist(),
        texcoord=garment.uvs.ravel().tolist(),
        face=garment.faces.ravel().tolist(),
        bodyname=[body_name(JOINTS[j]) for j in bones],
        bindpos=REST[bones].ravel().tolist(),
        bindquat=[1.0, 0.0, 0.0, 0.0] * len(bones),
        vertid=[rows.tolist() for rows, _ in held],
        vertweight=[garment.weights[rows, slots].tolist() for rows, slots in held],
    )
