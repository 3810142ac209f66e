"""Where arms go that have a choice: out of boards, lamps and the sides of shelves.

Hand and shoulder leave the elbow of the right arm one turn. The way of the hand may be bent, and
the left arm, which has nothing to do, may be held otherwise.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence

import numpy as np

from adamo_vh.geometry import Array
from adamo_vh.runtime.human.anatomy import ELBOW_AXIS, turned
from adamo_vh.runtime.human.ik import WRIST_RAD
from adamo_vh.runtime.human.rotations import about, about_y, rotation_vectors
from adamo_vh.runtime.human.skeleton import INDEX, Pose, joint_frames

Depth = Callable[[Array, float], Array]
"""How deep balls are in what is solid, metres: takes their (N, 3) middles and their radius."""
_ARM = tuple(INDEX[name] for name in ("upper_arm_r", "forearm_r", "hand_r"))
_THICK_M = 0.04
_SWINGS_RAD = np.radians([0.0, 10.0, -10.0, 20.0, -20.0, 30.0, -30.0, 40.0, -40.0, 50.0, -50.0])
_COSTS_M = 0.02
"""So much depth, summed over the arm, is put up with rather than to swing by a radian."""
_DETOURS = np.array(
    [[0, y, z] for z in (0, 0.1, 0.2, 0.3) for y in (0, 0.12, -0.12, 0.24, -0.24)], float
)
"""(N, 3) how else the way of a hand may be bent in its middle, metres."""
_DETOUR_COSTS = 0.05
"""So much depth, summed over the way, is put up with rather than a detour of a metre."""
_HAND_M = 0.06
"""Radius of a ball around hand and fingers."""
_LEFT_ARMS_RAD = tuple(
    (float(back), float(bend))
    for back in np.radians([0, 25, -25, 45, -45])
    for bend in np.radians([0, 40, 80])
)
"""How the left arm may be held: swung back, and its elbow bent."""
_ALONG = np.linspace(0.25, 1.0, 4)[:, None], np.linspace(0.15, 0.9, 6)[:, None]
"""Where upper arm and forearm are tried: the shoulder has no choice."""


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


def clear_swing(poses: Iterable[Pose], depth: Depth) -> tuple[float, float]:
    """The swing of the elbow by which the right arm is least in what is solid.

    Args:
        poses: Moments of a reach.
        depth: Of balls whose middles are in the frame of the body.

    Returns:
        The swing, radians; and what it costs: depth, summed over the arm, metres.
    """
    moments = list(poses)
    costs = [_cost([swung(pose, swing) for pose in moments], depth, swing) for swing in _SWINGS_RAD]
    best = int(np.argmin(costs))
    return float(_SWINGS_RAD[best]), costs[best]


def clear_ways(ways: Array, shares: Array, depth: Depth) -> list[tuple[float, Array]]:
    """How the way of a hand may be bent, the best first.

    Args:
        ways: (N, 3) the hand at moments of the way as it is.
        shares: (N,) how much of a detour is taken at each.
        depth: Of balls whose middles are in the same frame.

    Returns:
        What each detour costs, and the detour, (3,) metres.
    """
    bent = ways + shares[:, None] * _DETOURS[:, None]
    deep = depth(bent.reshape(-1, 3), _HAND_M).reshape(len(_DETOURS), -1).sum(axis=1)
    costs = deep + _DETOUR_COSTS * np.linalg.norm(_DETOURS, axis=1)
    return [(float(costs[n]), _DETOURS[n]) for n in np.argsort(costs, kind="stable")]


def clear_left(poses: Iterable[Pose], depth: Depth) -> tuple[float, float]:
    """How to hold the left arm so that it is least in what is solid; see `held_off`."""
    moments = list(poses)
    costs = []
    for arm in _LEFT_ARMS_RAD:
        deep = _deep([held_off(pose, *arm) for pose in moments], "l", depth)
        costs.append(deep + _COSTS_M * sum(map(abs, arm)))
    return _LEFT_ARMS_RAD[int(np.argmin(costs))]


def held_off(pose: Pose, back_rad: float, bend_rad: float) -> Pose:
    """The left arm swung back (or forward, if negative), and its elbow bent further."""
    upper, fore = pose.rotations[INDEX["upper_arm_l"]], pose.rotations[INDEX["forearm_l"]]
    bent = fore @ about(tuple(ELBOW_AXIS["l"]), bend_rad)
    return turned(pose, {"upper_arm_l": about_y(back_rad) @ upper, "forearm_l": bent})


def _cost(poses: Sequence[Pose], depth: Depth, swing_rad: float) -> float:
    wrists = rotation_vectors(np.stack([pose.rotations[_ARM[2]] for pose in poses]))
    if swing_rad and np.linalg.norm(wrists, axis=1).max() > WRIST_RAD:
        return np.inf
    return _deep(poses, "r", depth) + _COSTS_M * abs(swing_rad)


def _deep(poses: Sequence[Pose], side: str, depth: Depth) -> float:
    """How deep an arm is in what is solid, summed over it and over moments, metres."""
    return sum(float(depth(_points(pose, side), _THICK_M).sum()) for pose in poses)


def _points(pose: Pose, side: str) -> Array:
    """(N, 3) points along an arm, in the frame of the body; of a left arm the hand too."""
    places, _ = joint_frames(pose)
    shoulder, elbow, wrist = (
        places[INDEX[f"{name}_{side}"]] for name in ("upper_arm", "forearm", "hand")
    )
    upper, fore = _ALONG
    points = [shoulder + upper * (elbow - shoulder), elbow + fore * (wrist - elbow)]
    if side == "l":
        points.append((wrist + 0.3 * (wrist - elbow))[None])
    return np.concatenate(points)
