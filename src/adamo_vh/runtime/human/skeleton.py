"""The skeleton: joints, their rest places, and forward kinematics.

Body frame: origin on the floor between the feet, X forward, Y left, Z up, metres. In the rest pose
(arms hanging 40 degrees away from the body, palms inward) every joint frame is parallel to the body
frame, so a pose is one rotation for each joint, relative to its parent, plus a shift of the pelvis.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from adamo_vh.geometry import Array
from adamo_vh.runtime.human.hand import WRIST, finger_joints

_SIDES = ("l", "r")

_SPINE: tuple[tuple[str, str | None, tuple[float, float, float]], ...] = (
    ("pelvis", None, (0.0, 0.0, 0.93)),
    ("spine", "pelvis", (0.0, 0.0, 1.05)),
    ("chest", "spine", (0.0, 0.0, 1.20)),
    ("neck", "chest", (-0.01, 0.0, 1.44)),
    ("head", "neck", (0.01, 0.0, 1.52)),
    ("eyelids", "head", (0.065, 0.0, 1.605)),
)
_LIMBS: tuple[tuple[str, str, tuple[float, float, float]], ...] = (
    ("clavicle", "chest", (0.0, 0.03, 1.395)),
    ("upper_arm", "clavicle", (-0.01, 0.175, 1.385)),
    ("forearm", "upper_arm", (-0.01, 0.354, 1.171)),
    ("hand", "forearm", WRIST),
    ("thigh", "pelvis", (0.0, 0.09, 0.89)),
    ("shin", "thigh", (0.01, 0.095, 0.48)),
    ("foot", "shin", (-0.02, 0.10, 0.08)),
    ("toes", "foot", (0.11, 0.105, 0.02)),
)


def _mirrored(point: tuple[float, float, float], side: str) -> tuple[float, float, float]:
    return point if side == "l" else (point[0], -point[1], point[2])


def _both_sides(
    joints: tuple[tuple[str, str, tuple[float, float, float]], ...],
) -> tuple[tuple[str, str, tuple[float, float, float]], ...]:
    return tuple(
        (
            f"{name}_{side}",
            parent if parent in ("chest", "pelvis") else f"{parent}_{side}",
            _mirrored(at, side),
        )
        for side in _SIDES
        for name, parent, at in joints
    )


_FINGERS = finger_joints()
_TABLE = (*_SPINE, *_both_sides(_LIMBS), *_both_sides(_FINGERS))

JOINTS: tuple[str, ...] = tuple(name for name, _, _ in _TABLE)
"""Names; a parent always comes before its children."""
INDEX = {name: i for i, name in enumerate(JOINTS)}
PARENTS: tuple[int, ...] = tuple(-1 if parent is None else INDEX[parent] for _, parent, _ in _TABLE)
REST: Array = np.array([place for _, _, place in _TABLE])
"""(J, 3) places of the joints in the rest pose, body frame, metres."""


def _generations() -> Iterator[tuple[NDArray[np.intp], NDArray[np.intp], Array]]:
    depths = [0]
    for parent in PARENTS[1:]:
        depths.append(depths[parent] + 1)
    for depth in range(1, max(depths) + 1):
        row = np.flatnonzero(np.array(depths) == depth)
        parents = np.array(PARENTS)[row]
        yield row, parents, (REST[row] - REST[parents])[:, :, None]


_GENERATIONS = tuple(_generations())
"""Numbers of the joints that are so many joints from the pelvis, of their parents, and (N, 3, 1)
the way from these: all of a generation are placed at once."""
EYES = np.array([0.085, 0.0, 1.60])
"""Midpoint between the eyes in the rest pose, body frame; moves with the head."""


@dataclass(frozen=True, slots=True, eq=False)
class Pose:
    """How the body is bent: local joint rotations and the pelvis."""

    rotations: Array = field(default_factory=lambda: np.tile(np.eye(3), (len(JOINTS), 1, 1)))
    """(J, 3, 3) rotation of each joint relative to its parent."""
    pelvis_shift: Array = field(default_factory=lambda: np.zeros(3))
    """(3,) shift of the pelvis in the body frame, metres."""


def joint_frames(pose: Pose) -> tuple[Array, Array]:
    """Forward kinematics in the body frame.

    Returns:
        (J, 3) places and (J, 3, 3) rotations (body_from_joint). A skin vertex v of the rest pose
        bound to joint j moves to `rotations[j] @ (v - REST[j]) + places[j]`.
    """
    places = np.empty((len(JOINTS), 3))
    rotations = np.empty((len(JOINTS), 3, 3))
    places[0] = REST[0] + pose.pelvis_shift
    rotations[0] = pose.rotations[0]
    for row, parents, shifts in _GENERATIONS:
        held = rotations[parents]
        places[row] = places[parents] + np.matmul(held, shifts)[:, :, 0]
        rotations[row] = np.matmul(held, pose.rotations[row])
    return places, rotations
