"""Postures of a body that stands: at ease, looking, carrying."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from adamo_vh.geometry import Array
from adamo_vh.runtime.embodiment import Stance
from adamo_vh.runtime.human.anatomy import ELBOW_AXIS, lids, mirrored, turned
from adamo_vh.runtime.human.anatomy import grip as grip_point
from adamo_vh.runtime.human.closing import FINGER_JOINTS, at_ease, mirrored_shape
from adamo_vh.runtime.human.grasp import Grip, Thing
from adamo_vh.runtime.human.ik import STANDING_FEET, arm_to, hand_to, plant_feet
from adamo_vh.runtime.human.looks import LIDS_CLOSED_RAD
from adamo_vh.runtime.human.rotations import (
    about,
    about_x,
    about_y,
    about_z,
    blended,
    eased,
    from_rotation_vectors,
    looking,
    rotation_vectors,
)
from adamo_vh.runtime.human.skeleton import INDEX, Pose, joint_frames

SLACK_M = 0.005
"""How much the pelvis of a standing body is below its rest: nobody stands with locked knees."""
STANDING_SHIFT = np.array([-0.008, 0.0, -SLACK_M])
"""Shift of the pelvis of a standing body."""
CARRY = np.array([0.34, -0.20, 1.05])
"""Grip point of the carrying hand in the body frame, metres: 63 degrees below the horizon of the
eyes and 37 degrees to the right, so it is seen when looking down and never when looking ahead."""
BREATH_S = 4.0
BLINK_EVERY_S = 3.7
_BLINK_S = 0.24
_EYES_SHARE_RAD = np.radians([20.0, 18.0])
_LEAST_TORSO_RAD = np.radians(45.0)
_NECK_RAD, _HEAD_RAD = np.radians(38.0), np.radians(46.0)
_GAZE_YAW_RAD = np.radians(100.0)
_UNKNOWN = Grip()
_MIRROR = np.array([1.0, -1.0, 1.0])
_LEFT_ARM = np.array(
    [INDEX[f"{n}_l"] for n in ("upper_arm", "forearm", "hand")] + FINGER_JOINTS["l"].tolist()
)


def arms_at_ease(swing_rad: tuple[float, float] = (0.0, 0.0)) -> dict[str, Array]:
    """Local rotations of arms that hang beside the body.

    Args:
        swing_rad: How far the left and the right arm are swung forward.
    """
    joints: dict[str, Array] = {}
    for side, swing, out in zip("lr", swing_rad, (-1.0, 1.0), strict=True):
        hang = about_x(out * np.radians(29.0))
        joints[f"clavicle_{side}"] = np.eye(3)
        joints[f"upper_arm_{side}"] = about_y(-swing - np.radians(1.0)) @ hang
        bend = np.radians(13.0) + 0.55 * max(swing, 0.0) + 0.1 * swing
        joints[f"forearm_{side}"] = about(tuple(ELBOW_AXIS[side]), bend)
        joints[f"hand_{side}"] = np.eye(3)
    return joints


def breath(time_s: float) -> float:
    """How full the lungs are: 0 at time 0, then up and down every four seconds."""
    return 0.5 - 0.5 * float(np.cos(2 * np.pi * time_s / BREATH_S))


def blink(time_s: float) -> float:
    """How far the eyes are shut by blinking: 0 but for a moment every few seconds."""
    since = (time_s % BLINK_EVERY_S) - (BLINK_EVERY_S - 2 * _BLINK_S)
    if not 0.0 < since < _BLINK_S:
        return 0.0
    return float(eased(1.0 - abs(2 * since / _BLINK_S - 1.0)))


def standing(time_s: float = 0.0) -> Pose:
    """A body at ease on both feet, breathing; arms hang, eyes ahead.

    Args:
        time_s: Time of standing; 0 is between two breaths.
    """
    pose = Pose(pelvis_shift=STANDING_SHIFT)
    pose, _ = plant_feet(turned(pose, arms_at_ease()), STANDING_FEET)
    return breathing(fingers_at_ease(pose), breath(time_s))


def fingers_at_ease(pose: Pose) -> Pose:
    """Both hands empty and relaxed."""
    return fingered(fingered(pose, at_ease(), "l"), mirrored_shape(at_ease()), "r")


def fingered(pose: Pose, shape: Array, hand: str) -> Pose:
    """The pose with the fingers of a hand bent, (15, 3, 3) in the order of its joints."""
    rotations = pose.rotations.copy()
    rotations[FINGER_JOINTS[hand]] = shape
    return replace(pose, rotations=rotations)


def breathing(pose: Pose, fullness: float) -> Pose:
    """Lungs filled: the chest rises, the shoulders with it, the head keeps level."""
    if fullness == 0.0:
        return pose
    lift = np.radians(1.5) * fullness
    joints = {"chest": about_y(-lift), "neck": about_y(lift)}
    joints |= {f"clavicle_{s}": about_x(o * np.radians(2.2) * fullness) for s, o in _SIDES}
    changed = {name: pose.rotations[INDEX[name]] @ r for name, r in joints.items()}
    return turned(pose, changed)


_SIDES = (("l", 1.0), ("r", -1.0))


def gazing(pose: Pose, direction: Array, blinking: float = 0.0, torso: float = 1.0) -> Pose:
    """Look in a direction: the eyes a little, then neck and head, and the torso for the rest.

    Args:
        pose: The body; its torso may lean, and turns further only when the neck cannot do it.
        direction: (3,) in the body frame, not zero.
        blinking: 0 to 1, how far the eyes are shut.
        torso: 0 to 1, how much of its share the torso takes; it may have other things to do.
    """
    flat = float(np.hypot(direction[0], direction[1]))
    yaw = float(np.arctan2(direction[1], direction[0]))
    pitch = -float(np.arctan2(direction[2], flat))
    # Straight up or down, a yaw means nothing, and the neck must not spin after it.
    steep = float(eased(2.0 * flat / float(np.linalg.norm(direction))))
    yaw = steep * float(np.clip(yaw, -_GAZE_YAW_RAD, _GAZE_YAW_RAD))
    shares = np.clip(0.25 * np.array([yaw, pitch]), -_EYES_SHARE_RAD, _EYES_SHARE_RAD)
    yaw, pitch = yaw - float(shares[0]), pitch - float(shares[1])
    twist = 0.5 * torso * _softly_beyond(yaw, _LEAST_TORSO_RAD)
    bow = 0.35 * torso * _softly_beyond(pitch, _LEAST_TORSO_RAD)
    part = about_z(twist / 2) @ about_y(bow / 2)
    joints = {n: pose.rotations[INDEX[n]] @ part for n in ("spine", "chest")}
    pose = turned(pose, joints)
    _, rotations = joint_frames(pose)
    wanted = looking(np.array([np.cos(yaw), np.sin(yaw), -np.tan(pitch)]))
    turn = rotation_vectors(rotations[INDEX["chest"]].T @ wanted)
    neck, head = _limited(0.45 * turn, _NECK_RAD), _limited(0.55 * turn, _HEAD_RAD)
    # The lids follow the eyes; a look up opens them no wider.
    low = max(0.0, float(shares[1])) * 0.7
    shut = low + (LIDS_CLOSED_RAD - low) * blinking
    looked = {"neck": from_rotation_vectors(neck), "head": from_rotation_vectors(head)}
    return turned(pose, looked | lids(shut))


def _softly_beyond(value: float, limit: float) -> float:
    """What of an angle is beyond a limit on either side, with a soft onset."""
    over = max(0.0, abs(value) - limit)
    return float(np.sign(value)) * over * over / (over + 0.2)


def _limited(turn: Array, limit_rad: float) -> Array:
    size = float(np.linalg.norm(turn))
    return turn if size <= limit_rad else turn * (limit_rad / size)


def carrying(pose: Pose, grip: Grip = _UNKNOWN) -> Pose:
    """Hold a thing in the right hand, in front of the body, forearm bent; the left one may help.

    Args:
        pose: The rest of the body.
        grip: How the thing is held; its middle is at `CARRY`.
    """
    # Half of what the steps do to the pelvis reaches the hand.
    moved = CARRY + 0.5 * (pose.pelvis_shift - STANDING_SHIFT)
    pose = gripping(pose, moved, grip)
    other = grip.other()
    return pose if other is None else helping(pose, grip_point(pose, "r", grip.offset), other)


def gripping(pose: Pose, place: Array, grip: Grip) -> Pose:
    """The right hand closed around a thing whose middle is at a place.

    Args:
        pose: The rest of the body.
        place: (3,) in the body frame, metres.
        grip: How it is held.
    """
    turn = grip.home()
    if turn is None:
        held, _ = arm_to(turned(pose, {"hand_r": np.eye(3)}), place, "r")
    else:
        held, _ = hand_to(pose, place, turn, grip.offset, "r")
    return fingered(held, grip.closed, "r")


def helping(
    pose: Pose, place: Array, other: Grip, turn: Array | None = None, weight: float = 1.0
) -> Pose:
    """The left hand at its side of a thing that takes two, as far as it reaches.

    Args:
        pose: The body whose right hand has the thing.
        place: (3,) the thing's middle in the body frame, metres.
        other: How the left hand holds it, as a right hand in the mirror.
        turn: (3, 3) how that hand should be turned, in the mirror; as it carries if not given.
        weight: 0 for a hand that stays where it is.
    """
    turn = other.home() if turn is None else turn
    if turn is None:
        return pose
    solved, gap = hand_to(mirrored(pose), place * _MIRROR, turn, other.offset)
    share = weight * float(eased(1.5 - gap / 0.10))
    solved = mirrored(fingered(solved, other.closed, "r"))
    rotations = pose.rotations.copy()
    rotations[_LEFT_ARM] = blended(rotations[_LEFT_ARM], solved.rotations[_LEFT_ARM], share)
    return replace(pose, rotations=rotations)


def line_of_gaze(body: Stance) -> Array:
    """(3,) unit direction of the gaze of a body, in its own frame."""
    line = body.gaze.array() - body.eyes.array()
    size = float(np.linalg.norm(line))
    if size < 1e-6:
        return np.array([1.0, 0.0, 0.0])
    return np.asarray(about_z(-body.heading_rad) @ line / size)


def at_rest(body: Stance, thing: Thing | None = None, time_s: float = 0.0) -> Pose:
    """The posture of a body that stands, looks and perhaps carries; what every motion ends in.

    Args:
        body: The state.
        thing: What is held, if known.
        time_s: Time of standing, for breath and blink.
    """
    pose = gazing(standing(time_s), line_of_gaze(body), blink(time_s))
    return pose if body.held is None else carrying(pose, Grip.of(thing, body.heading_rad))
