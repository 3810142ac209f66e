"""How a figure stands in its file: which way is up and forward, and how large it is."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from adamo_vh.geometry import Array
from adamo_vh.runtime.human.own.bones import Bones
from adamo_vh.runtime.human.own.faults import Broken
from adamo_vh.runtime.human.own.tree import Tree
from adamo_vh.runtime.human.skeleton import INDEX, REST

_AXES = "XYZ"
_ALMOST = np.cos(np.radians(25.0))
"""A direction this near to an axis of the file is meant to be that axis."""
SIDES = (("left", "l"), ("right", "r"))


@dataclass(frozen=True, slots=True, eq=False)
class Stature:
    """How a figure stands."""

    turn: Array
    """(3, 3) body_from_file, without the scale."""
    places: Mapping[str, Array]
    """Where each bone is, in the body frame but in units of the file, its origin on the floor."""
    origin: Array
    """(3,) what is taken off a turned place to have it there."""
    scale: float
    """Metres of the standard body in a unit of the file."""
    height: float
    """Of everything, units of the file."""
    up: str
    """Axis of the file, with its sign."""
    facing: str
    arms_rad: float
    """How far the upper arms hang below the horizontal."""

    def local(self, points: Array) -> Array:
        """(N, 3) points of the file's world in the body frame, units of the file."""
        return np.asarray(points @ self.turn.T - self.origin)

    @property
    def rest_pose(self) -> str:
        """What the arms do, in a word."""
        degrees = np.degrees(self.arms_rad)
        return "T" if degrees < 20 else "A" if degrees < 70 else "arms hanging"

    @property
    def unit(self) -> str:
        """What the file's unit seems to be."""
        for name, factor in (("metres", 1.0), ("centimetres", 0.01), ("inches", 0.0254)):
            if 0.5 <= self.height * factor <= 2.6:
                return name
        return "unknown units"


def stature_of(
    bones: Bones, tree: Tree, points: Array, soles: Array
) -> tuple[Stature, Mapping[str, int]]:
    """Measure a figure.

    Args:
        bones: Its bones.
        tree: Where they are.
        points: (N, 3) all vertices in the file's world.
        soles: (M, 3) those of the feet.

    Returns:
        How it stands, and the map of its bones, left and right exchanged if the file has them so.

    Raises:
        Broken: The bones are no upright body.
    """
    nodes = dict(bones.nodes)
    at = {bone: tree.place(node) for bone, node in nodes.items()}
    turn = _turn(at)
    toes = [at[f"{s}Toes"] - at[f"{s}Foot"] for s, _ in SIDES if f"{s}Toes" in at]
    legs = float(np.linalg.norm(at["leftUpperLeg"] - at["leftFoot"]))
    if toes and float((turn @ np.mean(toes, axis=0))[0]) < -0.03 * legs:
        nodes = {_other(bone): node for bone, node in nodes.items()}
        at = {_other(bone): place for bone, place in at.items()}
        turn = _turn(at)
    turned = {bone: turn @ place for bone, place in at.items()}
    middle = (turned["leftUpperLeg"] + turned["rightUpperLeg"]) / 2
    low = soles if len(soles) else points
    origin = np.array([middle[0], middle[1], float((low @ turn.T)[:, 2].min())])
    places = {bone: place - origin for bone, place in turned.items()}
    heights = (points @ turn.T)[:, 2]
    arms = [places[f"{s}LowerArm"] - places[f"{s}UpperArm"] for s, _ in SIDES]
    hang = float(np.mean([np.arctan2(-a[2], np.hypot(a[0], a[1])) for a in arms]))
    scale = _length(_ours()) / _length(places)
    told = Stature(
        turn, places, origin, scale, float(heights.max() - origin[2]),
        _axis(turn[2]), _axis(turn[0]), hang,
    )  # fmt: skip
    return told, nodes


def _other(bone: str) -> str:
    if bone.startswith("left"):
        return f"right{bone[4:]}"
    return f"left{bone[5:]}" if bone.startswith("right") else bone


def _turn(at: Mapping[str, Array]) -> Array:
    """(3, 3) body_from_file: rows are forward, left and up."""
    feet = (at["leftFoot"] + at["rightFoot"]) / 2
    up = _snapped(at["head"] - feet)
    left = at["leftUpperArm"] - at["rightUpperArm"] + at["leftUpperLeg"] - at["rightUpperLeg"]
    left = _snapped(left - up * float(left @ up))
    left = left - up * float(left @ up)
    size = float(np.linalg.norm(left))
    if size < 1e-6:
        raise Broken("its left and right arms and legs are in one place. Correct its bone map.")
    left /= size
    return np.stack([np.cross(left, up), left, up])


def _snapped(direction: Array) -> Array:
    """(3,) a direction, or the axis of the file that it almost is."""
    size = float(np.linalg.norm(direction))
    if size < 1e-9:
        raise Broken("its head and feet, or left and right, are in one place. Correct its bones.")
    unit = direction / size
    most = int(np.abs(unit).argmax())
    if abs(unit[most]) < _ALMOST:
        return np.asarray(unit)
    return np.asarray(np.eye(3)[most] * np.sign(unit[most]))


def _axis(direction: Array) -> str:
    most = int(np.abs(direction).argmax())
    if abs(direction[most]) < 0.999:
        return "between two axes"
    return ("+" if direction[most] > 0 else "-") + _AXES[most]


def _ours() -> dict[str, Array]:
    names = {"head": "head", "leftUpperLeg": "thigh_l", "rightUpperLeg": "thigh_r"}
    names |= {"leftLowerLeg": "shin_l", "leftFoot": "foot_l"}
    names |= {"rightLowerLeg": "shin_r", "rightFoot": "foot_r"}
    return {bone: REST[INDEX[joint]] for bone, joint in names.items()}


def _length(at: Mapping[str, Array]) -> float:
    """Length of the body along its bones, from the soles to the head's joint."""
    total = 0.0
    for side, _ in SIDES:
        hip, knee, foot = (at[f"{side}{name}"] for name in ("UpperLeg", "LowerLeg", "Foot"))
        total += float(np.linalg.norm(hip - knee) + np.linalg.norm(knee - foot))
        total += max(0.0, float(foot[2]))
    hips = (at["leftUpperLeg"] + at["rightUpperLeg"]) / 2
    found = total / 2 + float(np.linalg.norm(at["head"] - hips))
    if found < 1e-6:
        raise Broken("all its bones are in one place. Export it with its skeleton.")
    return found
