"""Where the elbow goes: hand and shoulder leave it one turn, which keeps the arm out of boards."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence

import numpy as np

from adamo_vh.geometry import Array
from adamo_vh.runtime.human.anatomy import turned
from adamo_vh.runtime.human.ik import WRIST_RAD
from adamo_vh.runtime.human.rotations import about, rotation_vectors
from adamo_vh.runtime.human.skeleton import INDEX, Pose, joint_frames

Depth = Callable[[Array, float], Array]
"""How deep balls are in what is solid, metres: takes their (N, 3) middles and their radius."""
_ARM = tuple(INDEX[name] for name in ("upper_arm_r", "forearm_r", "hand_r"))
_THICK_M = 0.04
_SWINGS_RAD = np.radians([0.0, 10.0, -10.0, 20.0, -20.0, 30.0, -30.0, 40.0, -40.0, 50.0, -50.0])
_COSTS_M = 0.02
"""So much depth, summed over the arm, is put up with rather than to swing by a radian."""
_ALONG = np.linspace(0.25, 1.0, 4)[:, None], np.linspace(0.15, 0.9, 6)[:, None]
"""Where upper arm and forearm are tried: neither the shoulder nor the hand has a choice."""


def swung(pose: Pose, angle_rad: float) -> Pose:
    """The right elbow turned about the line from shoulder to wrist; the hand stays as it is."""
    if angle_rad == 0.0:
        return pose
    places, rotations = joint_frames(pose)
    upper, fore, hand = _ARM
    line = places[hand] - places[upper]
    turn = about(line / np.linalg.norm(line), angle_rad)
    above = rotations[INDEX["clavicle_r"]]
    return turned(
        pose,
        {
            "upper_arm_r": above.T @ turn @ rotations[upper],
            "hand_r": (turn @ rotations[fore]).T @ rotations[hand],
        },
    )


def clear_swing(poses: Iterable[Pose], depth: Depth) -> float:
    """The swing of the elbow, radians, by which an arm is least in what is solid.

    Args:
        poses: Moments of a reach.
        depth: Of balls whose middles are in the frame of the body.
    """
    moments = list(poses)
    costs = [_cost([swung(pose, swing) for pose in moments], depth, swing) for swing in _SWINGS_RAD]
    return float(_SWINGS_RAD[int(np.argmin(costs))])


def _cost(poses: Sequence[Pose], depth: Depth, swing_rad: float) -> float:
    wrists = rotation_vectors(np.stack([pose.rotations[_ARM[2]] for pose in poses]))
    if swing_rad and np.linalg.norm(wrists, axis=1).max() > WRIST_RAD:
        return np.inf
    deep = sum(float(depth(_middles(pose), _THICK_M).sum()) for pose in poses)
    return deep + _COSTS_M * abs(swing_rad)


def _middles(pose: Pose) -> Array:
    """(10, 3) points along the right arm, in the frame of the body."""
    places, _ = joint_frames(pose)
    shoulder, elbow, wrist = (places[joint] for joint in _ARM)
    upper, fore = _ALONG
    return np.concatenate([shoulder + upper * (elbow - shoulder), elbow + fore * (wrist - elbow)])
