"""Maps that bring a figure, bone by bone, into the rest pose of the standard body."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from adamo_vh.geometry import Array
from adamo_vh.runtime.human.hand import KNUCKLES
from adamo_vh.runtime.human.own.bones import FINGERS
from adamo_vh.runtime.human.own.faults import Broken
from adamo_vh.runtime.human.own.stature import SIDES, Stature
from adamo_vh.runtime.human.rotations import about
from adamo_vh.runtime.human.skeleton import INDEX, REST

_HEAD_MOST_M = 0.42
"""From the joint of the head to its top: of a larger head, the scale is smaller."""
_TWIST_LEAST_RAD = np.radians(8.0)
_TWIST_MOST_RAD = np.radians(120.0)
_KNUCKLES = ("Index1", "Middle1", "Ring1", "Little1", "Fingers")
_UP = np.array([0.0, 0.0, 1.0])
_ARM = (("UpperArm", "LowerArm", "upper_arm", "forearm"), ("LowerArm", "Hand", "forearm", "hand"))
_LEG = (("UpperLeg", "LowerLeg", "thigh", "shin"), ("LowerLeg", "Foot", "shin", "foot"))
"""Bones of a limb, each with the one after it, our joint and the joint below that."""


@dataclass(frozen=True, slots=True, eq=False)
class Fit:
    """A map for each bone of a figure."""

    maps: Mapping[str, Array]
    """(4, 4) from the body frame in units of the file, to the rest pose in metres."""
    hem: Array
    """(4, 4) of the hips, for what hangs below them."""
    hips_z: float
    """Where that begins, units of the file."""
    joints: Mapping[str, int]
    """The standard joint that each bone is."""
    stretches: Mapping[str, float]
    """How much longer limbs are drawn than the whole figure's scale says."""


def fit_of(stature: Stature, crown: float, spine: tuple[str, ...]) -> Fit:
    """Fit a figure to the standard body.

    Args:
        stature: How it stands.
        crown: How far the head goes above its joint, units of the file.
        spine: The bones of its trunk, from below.

    Raises:
        Broken: Two bones that should be apart are in one place.
    """
    at, scale = stature.places, stature.scale
    maps: dict[str, Array] = {}
    stretches: dict[str, float] = {}
    trunk = _Trunk.of(stature)
    wide = {"hips": trunk.hips_wide, "chest": trunk.shoulders_wide}
    joints = {"hips": INDEX["pelvis"], "head": INDEX["head"], "neck": INDEX["neck"]}
    maps["hips"] = trunk.map(wide["hips"])
    for number, bone in enumerate(spine):
        share = (number + 1) / len(spine)
        maps[bone] = trunk.map(wide["hips"] + (wide["chest"] - wide["hips"]) * share)
        height = float((maps[bone] @ [*at[bone], 1.0])[2])
        is_chest = number == len(spine) - 1 or height > 1.14
        joints[bone] = INDEX["chest" if is_chest else "spine"]
    top = maps[spine[-1]] if spine else trunk.map(wide["chest"])
    head_scale = min(scale, _HEAD_MOST_M / max(crown, 1e-9))
    maps["head"] = _anchored(at["head"], head_scale * np.eye(3), REST[INDEX["head"]])
    if "neck" in at:
        maps["neck"] = _neck(at, top, scale)
    for bone in ("jaw", "leftEye", "rightEye", "eyelids"):
        maps[bone] = maps["head"]
        joints[bone] = INDEX["head"]
    joints["eyelids"] = INDEX["eyelids"]
    for side, letter in SIDES:
        maps[f"{side}Shoulder"] = top
        joints[f"{side}Shoulder"] = INDEX[f"clavicle_{letter}"]
        _fit_arm(at, scale, (side, letter), maps, stretches)
        _fit_leg(at, scale, (side, letter), maps, stretches)
        joints |= _limb_joints(side, letter)
    hem = maps["hips"].copy()
    hem[:3, 2] = [0.0, 0.0, REST[INDEX["thigh_l"], 2] / max(trunk.hips[2], 1e-9)]
    hem[:3, 3] += maps["hips"][:3, 2] * trunk.hips[2] - hem[:3, 2] * trunk.hips[2]
    return Fit(maps, hem, float(trunk.hips[2]), joints, stretches)


def _limb_joints(side: str, letter: str) -> dict[str, int]:
    names = {
        "UpperArm": "upper_arm", "LowerArm": "forearm", "Hand": "hand", "Fingers": "middle_1",
        "UpperLeg": "thigh", "LowerLeg": "shin", "Foot": "foot", "Toes": "toes",
    }  # fmt: skip
    for finger in FINGERS:
        names |= {f"{finger}{n}": f"{finger.lower()}_{min(n, 3)}" for n in (1, 2, 3, 4)}
        names[f"{finger}0"] = "hand"
    return {f"{side}{bone}": INDEX[f"{joint}_{letter}"] for bone, joint in names.items()}


def _anchored(place: Array, linear: Array, target: Array) -> Array:
    """(4, 4) the map with this linear part that takes a place to a target."""
    found = np.eye(4)
    found[:3, :3] = linear
    found[:3, 3] = target - linear @ place
    return found


@dataclass(frozen=True, slots=True, eq=False)
class _Trunk:
    """From the hips to the shoulders: scaled and sheared, so that both ends meet ours."""

    hips: Array
    shoulders: Array
    scale: float
    hips_wide: float
    shoulders_wide: float

    @classmethod
    def of(cls, stature: Stature) -> _Trunk:
        at, scale = stature.places, stature.scale
        hips = (at["leftUpperLeg"] + at["rightUpperLeg"]) / 2
        shoulders = (at["leftUpperArm"] + at["rightUpperArm"]) / 2
        if shoulders[2] - hips[2] < 0.05 * abs(at["head"][2]):
            raise Broken("it does not stand upright. Export it standing, in a T or A pose.")

        def wide(bone: str, joint: str, least: float, most: float) -> float:
            half = abs(float(at[f"left{bone}"][1] - at[f"right{bone}"][1])) / 2
            wish = float(REST[INDEX[f"{joint}_l"], 1]) / max(half, 1e-9)
            return float(np.clip(wish, least * scale, most * scale))

        hips_wide = wide("UpperLeg", "thigh", 0.85, 1.2)
        return cls(hips, shoulders, scale, hips_wide, wide("UpperArm", "upper_arm", 0.75, 1.35))

    def map(self, wide: float) -> Array:
        """(4, 4) the map with this scale to the sides."""
        low, high = REST[INDEX["thigh_l"]], REST[INDEX["upper_arm_l"]]
        rise = float(self.shoulders[2] - self.hips[2])
        linear = np.diag([self.scale, wide, 0.0])
        linear[2, 2] = (high[2] - low[2]) / rise
        linear[0, 2] = (high[0] - low[0] - self.scale * (self.shoulders[0] - self.hips[0])) / rise
        linear[1, 2] = -wide * (self.shoulders[1] - self.hips[1]) / rise
        return _anchored(self.hips, linear, np.array([low[0], 0.0, low[2]]))


def _neck(at: Mapping[str, Array], top: Array, scale: float) -> Array:
    """(4, 4) from where the trunk ends to where the head begins."""
    begin, end = at["neck"], at["head"]
    target = (top @ [*begin, 1.0])[:3]
    rise = float(end[2] - begin[2])
    goal = REST[INDEX["head"]] - target
    least = 0.4 * scale
    linear = scale * np.eye(3)
    if rise > 1e-6:
        linear[2, 2] = max(goal[2] / rise, least)
        linear[0, 2] = (goal[0] - scale * (end[0] - begin[0])) / rise
        linear[1, 2] = (goal[1] - scale * (end[1] - begin[1])) / rise
    return _anchored(end, linear, REST[INDEX["head"]])


def _between(a: Array, b: Array, what: str) -> tuple[Array, float]:
    """(3,) the direction from one bone to the next, and how far it is."""
    line = b - a
    size = float(np.linalg.norm(line))
    if size < 1e-6:
        raise Broken(f"two bones of the {what} are in one place. Correct its bones.")
    return line / size, size


def _swing(start: Array, goal: Array) -> Array:
    """(3, 3) the shortest turn from one direction to another."""
    axis = np.cross(start, goal)
    sine, cosine = float(np.linalg.norm(axis)), float(start @ goal)
    if sine < 1e-9:
        if cosine > 0:
            return np.eye(3)
        axis = np.cross(start, _UP if abs(start[2]) < 0.9 else np.array([1.0, 0.0, 0.0]))
        sine = float(np.linalg.norm(axis))
        return about(tuple(axis / sine), np.pi)
    return about(tuple(axis / sine), float(np.arctan2(sine, cosine)))


def _stretched(turn: Array, direction: Array, along: float, across: float) -> Array:
    """(3, 3) a turn, with one scale along a direction before it and another across."""
    return np.asarray(
        turn @ (across * np.eye(3) + (along - across) * np.outer(direction, direction))
    )


def _swung(
    at: Mapping[str, Array], side: tuple[str, str], limb: str, chain: Sequence[tuple[str, ...]]
) -> Iterator[tuple[str, str, Array, Array, float]]:
    """Turn the bones of a limb one after the other, until each lies along ours.

    Args:
        at: Where the bones of the file begin.
        side: As the file's bones and as our joints are called.
        limb: What it is, for people.
        chain: Of each bone: itself, the one after it, our joint, and the joint below that.

    Yields:
        Bone, joint, the (3, 3) turn, the (3,) direction in the file, how much longer ours is.
    """
    left, letter = side
    turn = np.eye(3)
    for bone, after, joint, below in chain:
        line, length = _between(at[left + bone], at[left + after], f"{left} {limb}")
        ours = REST[INDEX[f"{below}_{letter}"]] - REST[INDEX[f"{joint}_{letter}"]]
        turn = _swing(turn @ line, ours / np.linalg.norm(ours)) @ turn
        yield bone, joint, turn, line, float(np.linalg.norm(ours)) / length


def _fit_arm(
    at: Mapping[str, Array],
    scale: float,
    side: tuple[str, str],
    maps: dict[str, Array],
    stretches: dict[str, float],
) -> None:
    """Turn an arm to hang as ours does in the rest pose, palm inwards."""
    left, letter = side
    turns: dict[str, tuple[Array, Array, float]] = {}
    for bone, _, turn, line, along in _swung(at, side, "arm", _ARM):
        turns[bone] = turn, line, along
        stretches[left + bone] = along / scale
    turn = turns["LowerArm"][0]
    hand = at[left + "Hand"]
    knuckles = [at[left + name] for name in _KNUCKLES if left + name in at]
    ours = _knuckles([name for name in _KNUCKLES if left + name in at], letter)
    ours = ours - REST[INDEX[f"hand_{letter}"]]
    axis = ours / np.linalg.norm(ours)
    line, size = turns["LowerArm"][1], scale
    if knuckles and np.linalg.norm(np.mean(knuckles, axis=0) - hand) > 1e-6:
        line, length = _between(hand, np.mean(knuckles, axis=0), f"{left} hand")
        wish = float(np.linalg.norm(ours)) / length
        size = float(np.clip(wish, 0.65 * scale, 1.5 * scale))
        turn = _swing(turn @ line, axis) @ turn
    twist = _twist(at, left, turn, axis)
    upper, lower = turns["UpperArm"], turns["LowerArm"]
    forearm = lower[0] @ lower[1]
    lower_turn = about(tuple(forearm), twist / 2) @ lower[0]
    maps[left + "UpperArm"] = _anchored(
        at[left + "UpperArm"],
        _stretched(upper[0], upper[1], upper[2], scale),
        REST[INDEX[f"upper_arm_{letter}"]],
    )
    maps[left + "LowerArm"] = _anchored(
        at[left + "LowerArm"],
        _stretched(lower_turn, lower[1], lower[2], scale),
        REST[INDEX[f"forearm_{letter}"]],
    )
    palm = about(tuple(axis), twist) @ turn
    held = _anchored(hand, size * palm, REST[INDEX[f"hand_{letter}"]])
    maps[left + "Hand"] = maps[left + "Fingers"] = held
    for finger in FINGERS:
        maps |= {f"{left}{finger}{n}": held for n in range(5)}
        _fit_finger(at, (left + finger, f"{finger.lower()}_{{}}_{letter}"), palm, size, maps)


def _knuckles(named: Sequence[str], letter: str) -> Array:
    """(3,) the middle between our knuckles that a figure has too; of all if it has none."""
    joints = [f"{name[:-1].lower()}_1_{letter}" for name in named if name != "Fingers"]
    if joints:
        return np.asarray(np.mean([REST[INDEX[joint]] for joint in joints], axis=0))
    return np.array(KNUCKLES) * [1.0, 1.0 if letter == "l" else -1.0, 1.0]


def _fit_finger(
    at: Mapping[str, Array],
    names: tuple[str, str],
    turn: Array,
    size: float,
    maps: dict[str, Array],
) -> None:
    """Bend a finger as ours is in the rest pose, joint on joint.

    Args:
        at: Where bones are, units of the file.
        names: Of the finger's bones without their numbers, and of our joints with a gap for it.
        turn: (3, 3) how the hand is turned.
        size: Scale of the hand.
        maps: Takes those of the bones.
    """
    bone, joint = names
    for number in (1, 2, 3):
        if f"{bone}{number}" not in at:
            return
        begin, linear = at[f"{bone}{number}"], size * turn
        ours = REST[INDEX[joint.format(number)]]
        if number < 3 and f"{bone}{number + 1}" in at:
            line, length = _between(begin, at[f"{bone}{number + 1}"], "hand")
            goal = REST[INDEX[joint.format(number + 1)]] - ours
            long = float(np.linalg.norm(goal))
            turn = _swing(turn @ line, goal / long) @ turn
            linear = _stretched(turn, line, long / length, size)
        maps[f"{bone}{number}"] = maps[f"{bone}4"] = _anchored(begin, linear, ours)


def _twist(at: Mapping[str, Array], left: str, turn: Array, axis: Array) -> float:
    """How far the hand is to be turned about its axis, so that the thumb is in front."""
    index, thumb = at.get(left + "Index1"), at.get(left + "Thumb1")
    other = next((at[left + n] for n in ("Little1", "Ring1", "Middle1") if left + n in at), None)
    if index is not None and other is not None:
        front = index - other
    elif thumb is not None:
        front = thumb - at[left + "Hand"]
    else:
        return 0.0
    flat = turn @ front
    flat = flat - axis * float(axis @ flat)
    if float(np.linalg.norm(flat)) < 0.3 * float(np.linalg.norm(front)):
        return 0.0
    goal = np.array([1.0, 0.0, 0.0]) - axis * axis[0]
    angle = float(np.arctan2(axis @ np.cross(flat, goal), flat @ goal))
    if abs(angle) < _TWIST_LEAST_RAD:
        return 0.0
    return float(np.clip(angle, -_TWIST_MOST_RAD, _TWIST_MOST_RAD))


def _fit_leg(
    at: Mapping[str, Array],
    scale: float,
    side: tuple[str, str],
    maps: dict[str, Array],
    stretches: dict[str, float],
) -> None:
    """Straighten a leg as ours, and put its sole flat on the floor."""
    left, letter = side
    for bone, joint, turn, line, along in _swung(at, side, "leg", _LEG):
        begin = REST[INDEX[f"{joint}_{letter}"]]
        maps[left + bone] = _anchored(at[left + bone], _stretched(turn, line, along, scale), begin)
        stretches[left + bone] = along / scale
    ankle = at[left + "Foot"]
    goal = REST[INDEX[f"foot_{letter}"]]
    yaw, size = np.eye(3), scale
    if left + "Toes" in at:
        flat = (at[left + "Toes"] - ankle) * [1.0, 1.0, 0.0]
        ours = (REST[INDEX[f"toes_{letter}"]] - goal) * [1.0, 1.0, 0.0]
        length = float(np.linalg.norm(flat))
        if length > 1e-6 and flat[0] > 0:
            yaw = _swing(flat / length, ours / np.linalg.norm(ours))
            wish = float(np.linalg.norm(ours)) / length
            size = float(np.clip(wish, 0.75 * scale, 1.3 * scale))
    tall = goal[2] / ankle[2] if ankle[2] > 1e-6 else scale
    tall = float(np.clip(tall, 0.4 * scale, 1.6 * scale))
    linear = np.diag([size, size, tall]) @ yaw
    target = np.array([goal[0], goal[1], tall * ankle[2]])
    maps[left + "Foot"] = maps[left + "Toes"] = _anchored(ankle, linear, target)
