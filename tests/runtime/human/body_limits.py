"""What a human body can do, which every posture is held against: joint limits and balance."""

from __future__ import annotations

import numpy as np

from adamo_vh.geometry import Array
from adamo_vh.runtime.human.anatomy import ELBOW_AXIS, ELBOW_RANGE, KNEE_AXIS, KNEE_RANGE
from adamo_vh.runtime.human.rotations import rotation_vectors
from adamo_vh.runtime.human.skeleton import INDEX, JOINTS, Pose, joint_frames

_CONE_DEG = {
    "pelvis": 75.0,
    "spine": 40.0,
    "chest": 40.0,
    "neck": 45.0,
    "head": 50.0,
    "eyelids": 60.0,
    "clavicle": 45.0,
    "upper_arm": 170.0,
    "hand": 94.0,  # with the turn of the forearm, which has no joint of its own
    "thumb_1": 60.0,
    "thumb_2": 96.0,
    "thumb_3": 85.0,
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
            most = _CONE_DEG.get(name) or _FINGER_DEG[name[-1]]
            excess[j] = max(0.0, float(np.linalg.norm(turns[j])) - np.radians(most))
    return np.where(excess < 1e-6, 0.0, excess)


_FINGER_DEG = {"1": 92.0, "2": 108.0, "3": 75.0}
"""Likewise of the joints of a finger, from the knuckle on."""

_SEGMENTS: tuple[tuple[float, str, str], ...] = (
    (0.15, "pelvis", "spine"),
    (0.13, "spine", "chest"),
    (0.21, "chest", "neck"),
    (0.08, "head", "eyelids"),
    *((0.028, f"upper_arm_{s}", f"forearm_{s}") for s in "lr"),
    *((0.022, f"forearm_{s}", f"middle_1_{s}") for s in "lr"),
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
