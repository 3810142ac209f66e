"""What our joints are called elsewhere: bones of a humanoid as VRM 1.0 spells them."""

from __future__ import annotations

from adamo_vh.runtime.human.hand import FINGERS
from adamo_vh.runtime.human.skeleton import JOINTS

_PHALANGES = ("Proximal", "Intermediate", "Distal")
_THUMB = ("Metacarpal", "Proximal", "Distal")
_TRUNK = {"pelvis": "hips"}
_SIDED = {
    "clavicle": "Shoulder",
    "upper_arm": "UpperArm",
    "forearm": "LowerArm",
    "hand": "Hand",
    "thigh": "UpperLeg",
    "shin": "LowerLeg",
    "foot": "Foot",
    "toes": "Toes",
} | {
    f"{finger}_{number}": f"{finger.capitalize()}{part}"
    for finger in FINGERS
    for number, part in enumerate(_THUMB if finger == "thumb" else _PHALANGES, start=1)
}
_SIDES = {"l": "left", "r": "right"}


def _bone(joint: str) -> str:
    name, _, side = joint.rpartition("_")
    return _SIDES[side] + _SIDED[name] if name else _TRUNK.get(joint, joint)


BONES: tuple[str, ...] = tuple(_bone(joint) for joint in JOINTS)
"""In the order of `JOINTS`. VRM has no bone for `eyelids`: it keeps our name."""
