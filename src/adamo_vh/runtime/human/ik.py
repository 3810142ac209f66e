"""Inverse kinematics of arms and legs: two bones, a hinge between them, solved exactly."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from adamo_vh.geometry import Array
from adamo_vh.runtime.human.anatomy import (
    ELBOW_AXIS,
    ELBOW_RANGE,
    GRIP,
    KNEE_AXIS,
    KNEE_RANGE,
    rest,
    turned,
)
from adamo_vh.runtime.human.rotations import (
    about,
    about_y,
    about_z,
    basis,
    cross,
    from_rotation_vectors,
    rotation_vectors,
)
from adamo_vh.runtime.human.skeleton import INDEX, Pose, joint_frames

ANKLE_M = float(rest("foot_l")[2])
"""Height of the ankle of a flat foot."""
_BALL = np.array([rest("toes_l")[0] - rest("foot_l")[0], 0.0, rest("toes_l")[2] - ANKLE_M])
_HEEL = np.array([-0.05, 0.0, -ANKLE_M])


@dataclass(frozen=True, slots=True)
class Limb:
    """Two bones and a hinge, in the rest pose."""

    upper: Array
    """(3,) from the root to the hinge."""
    lower: Array
    """(3,) from the hinge to the end."""
    axis: Array
    """(3,) unit axis of the hinge; positive bends."""
    range_rad: tuple[float, float]
    """Least and largest turn of the hinge away from the rest pose."""


def two_bone(limb: Limb, root: Array, target: Array, hint: Array) -> tuple[Array, Array, float]:
    """Bring the end of a limb to a target, or as near as its bones allow.

    Args:
        limb: The bones.
        root: (3,) place of the shoulder or hip.
        target: (3,) where the end should be.
        hint: (3,) direction to which the elbow or knee points, in the frame of the places.

    Returns:
        The upper bone's rotation in that frame, the lower bone's rotation relative to the upper,
        and the distance left between end and target.
    """
    a, b, axis = limb.upper, limb.lower, limb.axis
    along = float(a @ axis) * float(b @ axis)
    flat_a, flat_b = a - axis * float(a @ axis), b - axis * float(b @ axis)
    product = float(np.linalg.norm(flat_a) * np.linalg.norm(flat_b))
    at_rest = float(np.arctan2(axis @ cross(flat_a, flat_b), flat_a @ flat_b))
    line = target - root
    length = float(np.linalg.norm(line))
    cosine = (length**2 - float(a @ a) - float(b @ b) - 2 * along) / (2 * product)
    bend = float(np.clip(np.arccos(np.clip(cosine, -1.0, 1.0)) - at_rest, *limb.range_rad))
    lower = about(tuple(axis), bend)
    end = a + lower @ b
    upper = basis(line, hint) @ basis(end, cross(end, axis)).T
    return upper, lower, abs(length - float(np.linalg.norm(end)))


def _arm(side: str, beyond: Array) -> Limb:
    """An arm that ends so far beyond the wrist, (3,) in the frame of the forearm."""
    elbow, hand = rest(f"forearm_{side}"), rest(f"hand_{side}")
    lower = hand - elbow + beyond
    return Limb(elbow - rest(f"upper_arm_{side}"), lower, ELBOW_AXIS[side], ELBOW_RANGE)


_LEGS = {
    side: Limb(
        rest(f"shin_{side}") - rest(f"thigh_{side}"),
        rest(f"foot_{side}") - rest(f"shin_{side}"),
        KNEE_AXIS,
        KNEE_RANGE,
    )
    for side in "lr"
}
ARM_M = float(
    sum(np.linalg.norm(bone) for bone in (_arm("r", GRIP["r"]).upper, _arm("r", GRIP["r"]).lower))
)
"""From the shoulder to the grip point of a stretched arm."""
LEG_M = float(np.linalg.norm(_LEGS["l"].upper) + np.linalg.norm(_LEGS["l"].lower))
"""From the hip to the ankle of a stretched leg."""


def _elbow_hint(direction: Array) -> Array:
    """Where the right elbow points, in the chest's frame, by where the hand goes."""
    down = np.array([-0.9, -0.45, -0.2])
    level = np.array([-0.25, -0.50, -0.85])
    up = np.array([0.35, -0.85, -0.35])
    height = float(direction[2])
    bent = level + (up - level) * max(height, 0.0) + (down - level) * max(-height, 0.0) ** 2
    return np.asarray(bent)


def arm_to(
    pose: Pose, target: Array, hand: str = "r", offset: Array | None = None
) -> tuple[Pose, float]:
    """Bring a place in a hand to a target by shoulder and elbow alone.

    Args:
        pose: The rest of the body; its wrist stays as it is.
        target: (3,) in the body frame, metres.
        hand: "l" or "r".
        offset: (3,) the place, from the wrist in the frame of the joint `hand`; `GRIP` if not
            given.

    Returns:
        The pose, and the distance left in metres.
    """
    wrist = pose.rotations[INDEX[f"hand_{hand}"]]
    return _arm_to(pose, target, hand, wrist @ (GRIP[hand] if offset is None else offset))


def hand_to(
    pose: Pose, target: Array, turn: Array, offset: Array, hand: str = "r"
) -> tuple[Pose, float]:
    """Bring a place in a hand to a target, with the hand turned as wished if the wrist can.

    Args:
        pose: The rest of the body.
        target: (3,) in the body frame, metres.
        turn: (3, 3) wished rotation of the joint `hand` in the body frame.
        offset: (3,) the place, from the wrist in the frame of the joint `hand`.
        hand: "l" or "r".

    Returns:
        The pose, and the distance left in metres.
    """
    turned_so, joint = turn, f"hand_{hand}"
    for _ in range(_TRIES):
        pose, gap = _arm_to(pose, target - turned_so @ offset, hand, np.zeros(3))
        forearm = joint_frames(pose)[1][INDEX[f"forearm_{hand}"]]
        wrist = rotation_vectors(forearm.T @ turn)
        # Far away the wrist gives way, so that the arm is long enough.
        most = WRIST_RAD * max(0.0, 1.0 - gap / _GIVE_WAY_M)
        angle = float(np.linalg.norm(wrist))
        turned_so = forearm @ from_rotation_vectors(wrist * (most / max(most, angle, 1e-9)))
        pose = turned(pose, {joint: forearm.T @ turned_so})
    # The turn is only nearly as wished by now; the place is exact.
    return arm_to(pose, target, hand, offset)


_TRIES = 4
WRIST_RAD = np.radians(92.0)
"""How far a hand can be turned away from its forearm, whose own turn is the wrist's here."""
_GIVE_WAY_M = 0.12


def _arm_to(pose: Pose, target: Array, hand: str, beyond: Array) -> tuple[Pose, float]:
    places, rotations = joint_frames(pose)
    chest, clavicle = rotations[INDEX["chest"]], rotations[INDEX[f"clavicle_{hand}"]]
    shoulder = places[INDEX[f"upper_arm_{hand}"]]
    flip = np.array([1.0, 1.0 if hand == "r" else -1.0, 1.0])
    line = chest.T @ (target - shoulder)
    hint = chest @ (flip * _elbow_hint(flip * line / max(float(np.linalg.norm(line)), 1e-9)))
    limb = _arm(hand, beyond)
    upper, lower, gap = two_bone(limb, shoulder, target, hint)
    arm = {f"upper_arm_{hand}": clavicle.T @ upper, f"forearm_{hand}": lower}
    return turned(pose, arm), gap


@dataclass(frozen=True, slots=True)
class Foot:
    """Where a foot is, in the body frame."""

    x: float
    """Place of the ankle, were the foot flat, metres."""
    y: float
    yaw_rad: float = 0.0
    pitch_rad: float = 0.0
    """Positive lifts the heel, with the ball in place; negative lifts the toes, on the heel."""
    lift_m: float = 0.0
    """Height above the floor."""

    def ankle(self) -> tuple[Array, Array]:
        """(3,) place of the ankle and (3, 3) rotation of the foot."""
        pivot = _BALL if self.pitch_rad > 0 else _HEEL
        yaw, pitch = about_z(self.yaw_rad), about_y(self.pitch_rad)
        flat = np.array([self.x, self.y, ANKLE_M + self.lift_m])
        return flat + yaw @ (pivot - pitch @ pivot), yaw @ pitch

    def contact(self) -> Array:
        """(3,) point that bears the foot: under the ball, or the heel when the toes are up."""
        pivot = _BALL if self.pitch_rad >= 0 else _HEEL
        flat = np.array([self.x, self.y, ANKLE_M + self.lift_m])
        return np.asarray(flat + about_z(self.yaw_rad) @ pivot)


STANDING_FEET = (Foot(-0.02, 0.10), Foot(-0.02, -0.10))
"""Left and right foot of a body at rest."""


def plant_feet(pose: Pose, feet: Sequence[Foot]) -> tuple[Pose, float]:
    """Bend the legs so that the feet are where they should be, whatever the pelvis does.

    Args:
        pose: The pelvis decides where the hips are.
        feet: Left and right, in the body frame.

    Returns:
        The pose, and the larger distance left between an ankle and its place, in metres.
    """
    places, rotations = joint_frames(pose)
    pelvis = rotations[INDEX["pelvis"]]
    joints: dict[str, Array] = {}
    worst = 0.0
    for side, foot in zip("lr", feet, strict=True):
        ankle, sole = foot.ankle()
        hip = places[INDEX[f"thigh_{side}"]]
        outward = 0.12 if side == "l" else -0.12
        hint = about_z(foot.yaw_rad) @ np.array([1.0, outward, 0.35])
        upper, lower, gap = two_bone(_LEGS[side], hip, ankle, hint)
        # On the floor the toes stay flat while the heel rises; in the air they follow the foot.
        flat = max(0.0, 1.0 - foot.lift_m / 0.06)
        joints[f"thigh_{side}"] = pelvis.T @ upper
        joints[f"shin_{side}"] = lower
        joints[f"foot_{side}"] = (upper @ lower).T @ sole
        joints[f"toes_{side}"] = about_y(-max(foot.pitch_rad, 0.0) * flat)
        worst = max(worst, gap)
    return turned(pose, joints), worst
