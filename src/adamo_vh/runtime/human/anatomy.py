"""What the skeleton can do: grip points, eyes, its hinges."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from adamo_vh.geometry import Array
from adamo_vh.runtime.human.hand import KNUCKLES
from adamo_vh.runtime.human.rotations import about_y
from adamo_vh.runtime.human.skeleton import EYES, INDEX, JOINTS, REST, Pose, joint_frames

_PALM_M = 0.03
"""Distance from the bones of the hand to the middle of a thing held in it."""


def rest(name: str) -> Array:
    """(3,) place of a joint in the rest pose."""
    return np.asarray(REST[INDEX[name]])


def _along(side: str) -> Array:
    """From the wrist to the knuckles in the rest pose."""
    sign = 1.0 if side == "l" else -1.0
    return np.array(KNUCKLES) * [1.0, sign, 1.0] - rest(f"hand_{side}")


def _palm(side: str) -> Array:
    """Direction that the palm faces in the rest pose: to the body, at right angles to the hand."""
    along = _along(side)
    inward = np.array([0.0, along[2], -along[1]])
    inward = inward if inward[1] * along[1] < 0 else -inward
    return np.asarray(inward / np.linalg.norm(inward))


PALM: Mapping[str, Array] = {side: _palm(side) for side in "lr"}
GRIP: Mapping[str, Array] = {side: 0.5 * _along(side) + _PALM_M * PALM[side] for side in "lr"}
"""(3,) where a held thing's middle sits, in the frame of the joint `hand`, metres, by side."""

KNEE_AXIS = np.array([0.0, 1.0, 0.0])
"""The shin turns about this axis; positive bends the knee."""


def _elbow_axis(side: str) -> Array:
    bone = rest(f"forearm_{side}") - rest(f"upper_arm_{side}")
    axis = np.cross(bone, [1.0, 0.0, 0.0])
    return np.asarray(axis / np.linalg.norm(axis))


ELBOW_AXIS: Mapping[str, Array] = {side: _elbow_axis(side) for side in "lr"}
"""The forearm turns about this axis; positive bends the elbow forward, to the upper arm."""


def _finger_axis(side: str) -> Array:
    axis = np.cross(_along(side), PALM[side])
    return np.asarray(axis / np.linalg.norm(axis))


FINGER_AXIS: Mapping[str, Array] = {side: _finger_axis(side) for side in "lr"}
"""The fingers turn about this axis; positive closes the hand."""

KNEE_RANGE = (np.radians(-4.0), np.radians(150.0))
ELBOW_RANGE = (np.radians(-3.0), np.radians(145.0))


def grip(pose: Pose, hand: str = "r", offset: Array | None = None) -> Array:
    """(3,) where the middle of a held thing is in the body frame, metres.

    Args:
        pose: The body.
        hand: "l" or "r".
        offset: (3,) from the wrist in the frame of the joint `hand`; `GRIP` if not given.
    """
    places, rotations = joint_frames(pose)
    j = INDEX[f"hand_{hand}"]
    return np.asarray(places[j] + rotations[j] @ (GRIP[hand] if offset is None else offset))


def eyes(pose: Pose) -> Array:
    """(3,) midpoint between the eyes in the body frame, metres."""
    places, rotations = joint_frames(pose)
    j = INDEX["head"]
    return np.asarray(places[j] + rotations[j] @ (EYES - REST[j]))


def turned(pose: Pose, joints: Mapping[str, Array]) -> Pose:
    """The pose with the local rotations of some joints replaced."""
    rotations = pose.rotations.copy()
    for name, rotation in joints.items():
        rotations[INDEX[name]] = rotation
    return replace(pose, rotations=rotations)


_OTHER_SIDE = [
    INDEX[f"{n[:-2]}_{'r' if n.endswith('_l') else 'l'}"] if n[-2:] in ("_l", "_r") else INDEX[n]
    for n in JOINTS
]
_FLIP = np.array([1.0, -1.0, 1.0])


def mirrored(pose: Pose) -> Pose:
    """Left and right exchanged."""
    rotations = pose.rotations[_OTHER_SIDE] * (_FLIP[:, None] * _FLIP)
    return Pose(rotations, pose.pelvis_shift * _FLIP)


def lids(closed_rad: float) -> dict[str, Array]:
    """Local rotation of the eyelids, 0 open."""
    return {"eyelids": about_y(closed_rad)}
