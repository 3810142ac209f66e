"""What the skeleton can do: grip points, eyes, joint limits, masses."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from adamo_vh.geometry import Array
from adamo_vh.runtime.human.rotations import about, about_y, rotation_vectors
from adamo_vh.runtime.human.skeleton import EYES, INDEX, JOINTS, REST, Pose, joint_frames

_PALM_M = 0.03
"""Distance from the bones of the hand to the middle of a thing held in it."""


def rest(name: str) -> Array:
    """(3,) place of a joint in the rest pose."""
    return np.asarray(REST[INDEX[name]])


def _palm(side: str) -> Array:
    """Direction that the palm faces in the rest pose: to the body, at right angles to the hand."""
    along = rest(f"fingers_{side}") - rest(f"hand_{side}")
    inward = np.array([0.0, along[2], -along[1]])
    inward = inward if inward[1] * along[1] < 0 else -inward
    return np.asarray(inward / np.linalg.norm(inward))


PALM: Mapping[str, Array] = {side: _palm(side) for side in "lr"}
GRIP: Mapping[str, Array] = {
    side: 0.5 * (rest(f"fingers_{side}") - rest(f"hand_{side}")) + _PALM_M * PALM[side]
    for side in "lr"
}
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
    axis = np.cross(rest(f"fingers_{side}") - rest(f"hand_{side}"), PALM[side])
    return np.asarray(axis / np.linalg.norm(axis))


FINGER_AXIS: Mapping[str, Array] = {side: _finger_axis(side) for side in "lr"}
"""The fingers turn about this axis; positive closes the hand."""

KNEE_RANGE = (np.radians(-4.0), np.radians(150.0))
ELBOW_RANGE = (np.radians(-3.0), np.radians(145.0))
_CONE_DEG = {
    "pelvis": 75.0,
    "spine": 40.0,
    "chest": 40.0,
    "neck": 45.0,
    "head": 50.0,
    "eyelids": 60.0,
    "clavicle": 45.0,
    "upper_arm": 170.0,
    "hand": 85.0,  # with the turn of the forearm, which has no joint of its own
    "fingers": 100.0,
    "thigh": 130.0,
    "foot": 60.0,
    "toes": 60.0,
}
"""Largest turn of a joint away from its rest, about any axis, degrees."""


def limit_excess(pose: Pose) -> Array:
    """How far each joint is beyond what a body can do.

    Returns:
        (J,) radians; zero within the limits. Elbows and knees are hinges: what turns them about
        any other axis counts in full.
    """
    turns = rotation_vectors(pose.rotations)
    excess = np.zeros(len(JOINTS))
    for j, joint in enumerate(JOINTS):
        name = joint[:-2] if joint[-2:] in ("_l", "_r") else joint
        if name in ("shin", "forearm"):
            axis = KNEE_AXIS if name == "shin" else ELBOW_AXIS[joint[-1]]
            low, high = KNEE_RANGE if name == "shin" else ELBOW_RANGE
            bend = float(turns[j] @ axis)
            aside = float(np.linalg.norm(turns[j] - bend * axis))
            excess[j] = max(0.0, low - bend, bend - high) + aside
        else:
            excess[j] = max(0.0, float(np.linalg.norm(turns[j])) - np.radians(_CONE_DEG[name]))
    return np.where(excess < 1e-6, 0.0, excess)


_SEGMENTS: tuple[tuple[float, str, str], ...] = (
    (0.15, "pelvis", "spine"),
    (0.13, "spine", "chest"),
    (0.21, "chest", "neck"),
    (0.08, "head", "eyelids"),
    *((0.028, f"upper_arm_{s}", f"forearm_{s}") for s in "lr"),
    *((0.022, f"forearm_{s}", f"fingers_{s}") for s in "lr"),
    *((0.105, f"thigh_{s}", f"shin_{s}") for s in "lr"),
    *((0.045, f"shin_{s}", f"foot_{s}") for s in "lr"),
    *((0.015, f"foot_{s}", f"toes_{s}") for s in "lr"),
)
"""Share of the mass, and the two joints between which it lies."""


def centre_of_mass(pose: Pose) -> Array:
    """(3,) centre of mass in the body frame, metres."""
    places, _ = joint_frames(pose)
    total = np.zeros(3)
    for share, a, b in _SEGMENTS:
        total += share * (places[INDEX[a]] + places[INDEX[b]]) / 2
    return np.asarray(total / sum(share for share, _, _ in _SEGMENTS))


def grip(pose: Pose, hand: str = "r") -> Array:
    """(3,) grip point of a hand in the body frame, metres."""
    places, rotations = joint_frames(pose)
    j = INDEX[f"hand_{hand}"]
    return np.asarray(places[j] + rotations[j] @ GRIP[hand])


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


def fingers(side: str, closed_rad: float) -> dict[str, Array]:
    """Local rotation of the fingers, closed by an angle."""
    return {f"fingers_{side}": about(tuple(FINGER_AXIS[side]), closed_rad)}


def lids(closed_rad: float) -> dict[str, Array]:
    """Local rotation of the eyelids, 0 open."""
    return {"eyelids": about_y(closed_rad)}
