"""Reaching: the hand meets a target anywhere from the floor to the top of a shelf."""

from __future__ import annotations

import numpy as np

from adamo_vh.geometry import Array
from adamo_vh.runtime.human.anatomy import FINGER_AXIS, eyes, mirrored, turned
from adamo_vh.runtime.human.hand import AXES
from adamo_vh.runtime.human.ik import arm_to, plant_feet
from adamo_vh.runtime.human.postures import gazing
from adamo_vh.runtime.human.rotations import about, blended, eased
from adamo_vh.runtime.human.skeleton import INDEX, Pose, joint_frames
from adamo_vh.runtime.human.stretch import Stretch, stretch_to

_HAND_AXIS = AXES["r"][0]
_MIRROR = np.array([1.0, -1.0, 1.0])


def reaching(pose: Pose, target: Array, hand: str = "r") -> Pose:
    """Bring the grip point of a hand to a target, leaning, crouching or stretching as needed.

    Args:
        pose: A body that stands.
        target: (3,) in the body frame, metres: 0.25 to 0.9 m from the body's axis, within 30
            degrees of straight ahead, from the floor to 2.07 m.
        hand: "l" or "r".
    """
    if hand == "l":
        return mirrored(reaching(mirrored(pose), target * _MIRROR))
    stretch = stretch_to(*(float(v) for v in target))
    bent = looking_at(stretched(pose, stretch), target)
    return arm_to(turned(bent, open_hand(float(target[2]))), target)[0]


def open_hand(height_m: float = 1.0) -> dict[str, Array]:
    """Local rotation of a right wrist that is about to grasp something at a height.

    Near the floor the forearm turns and the wrist bends back, so that the fingers point ahead
    instead of into the floor.
    """
    low = float(eased((0.55 - height_m) / 0.4))
    wrist = about(tuple(_HAND_AXIS), -np.radians(60.0) * low)
    wrist = wrist @ about(tuple(FINGER_AXIS["r"]), -np.radians(50.0) * low)
    return {"hand_r": wrist}


def stretched(pose: Pose, stretch: Stretch, weight: float = 1.0, stepped: float = 1.0) -> Pose:
    """Trunk, hips and legs bent by a share of a stretch; the idle arm hangs by its weight.

    Args:
        pose: A body that stands.
        stretch: How to bend.
        weight: How much of it, 0 to 1.
        stepped: How far the steps forward are done, 0 to 1.
    """
    bent = stretch.applied(pose, weight)
    bent, _ = plant_feet(bent, stretch.feet(weight, stepped))
    _, rotations = joint_frames(bent)
    trunk = rotations[INDEX["chest"]]
    hang = blended(np.eye(3), trunk.T, 0.75 * weight)
    idle = {n: hang @ bent.rotations[INDEX[n]] for n in ("upper_arm_l",)}
    return turned(bent, idle)


def looking_at(pose: Pose, target: Array) -> Pose:
    """Eyes on a target, (3,) in the body frame."""
    return gazing(pose, target - eyes(pose), torso=0.0)
