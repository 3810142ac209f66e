"""What the names of bones mean, as the usual programs give them."""

from __future__ import annotations

import re
from dataclasses import dataclass

_PIECE = re.compile(r"[A-Z]+(?![a-z])|[A-Z]?[a-z]+|[0-9]+")
_SIDES = {"left": "left", "l": "left", "right": "right", "r": "right"}
_NOISE = frozenset(
    [
        "mixamorig",
        "def",
        "org",
        "bip",
        "j",
        "c",
        "cc",
        "base",
        "b",
        "bn",
        "bone",
        "joint",
        "jnt",
        "sk",
        "skel",
        "rig",
        "armature",
        "valve",
        "biped",
        "character",
        "skeleton",
        "human",
        "f",
        "bend",
    ]
)
"""Words that say nothing about which bone it is."""

_SINGLE = {
    "hips": "hips",
    "hip": "hips",
    "pelvis": "hips",
    "neck": "neck",
    "head": "head",
    "jaw": "jaw",
    "eyelids": "eyelids",
}
_SIDED = {
    "shoulder": "Shoulder",
    "clavicle": "Clavicle",
    "collar": "Clavicle",
    "collarbone": "Clavicle",
    "upperarm": "UpperArm",
    "uparm": "UpperArm",
    "arm": "UpperArm",
    "shldr": "UpperArm",
    "lowerarm": "LowerArm",
    "forearm": "LowerArm",
    "elbow": "LowerArm",
    "hand": "Hand",
    "wrist": "Hand",
    "upperleg": "UpperLeg",
    "upleg": "UpperLeg",
    "thigh": "UpperLeg",
    "hip": "UpperLeg",
    "leg": "Leg",
    "lowerleg": "LowerLeg",
    "shin": "LowerLeg",
    "calf": "LowerLeg",
    "knee": "LowerLeg",
    "foot": "Foot",
    "ankle": "Ankle",
    "toe": "Toes",
    "toes": "Toes",
    "toebase": "Toes",
    "ball": "Toes",
    "eye": "Eye",
    "fingers": "Fingers",
}
_FINGERS = {
    "thumb": "Thumb",
    "index": "Index",
    "middle": "Middle",
    "mid": "Middle",
    "ring": "Ring",
    "little": "Little",
    "pinky": "Little",
}
_ORDER = ("Thumb", "Index", "Middle", "Ring", "Little")
_PARTS = {"metacarpal": 0, "proximal": 1, "intermediate": 2, "distal": 3, "tip": 4, "end": 4}


@dataclass(frozen=True, slots=True)
class Meaning:
    """What a name says."""

    bone: str
    """In VRM's words; `leftClavicle`, `leftLeg` and `leftAnkle` are still to be told apart."""
    rank: int
    """Among nodes of the same meaning, the lowest is taken."""


def meaning(name: str) -> Meaning | None:
    """Which bone a name is of; None if it says nothing we know."""
    bare = re.split(r"[:|]", name)[-1]
    words = [word.lower() for word in _PIECE.findall(bare)]
    side = next((_SIDES[word] for word in words if word in _SIDES), "")
    is_control = bool({"org", "mch", "ik", "ctrl", "twist", "roll", "pole", "target"} & {*words})
    rest = [word for word in words if word not in _SIDES and word not in _NOISE]
    letters = [word for word in rest if not word.isdigit()]
    numbers = [int(word[:6]) for word in rest if word.isdigit()]
    rank = 10 * is_control + len(letters)
    if words[:1] == ["bip"]:
        numbers = numbers[1:]  # Biped numbers the whole skeleton.
    finger = next((word for word in letters if word in _FINGERS), "")
    if side and finger:
        part = next((_PARTS[word] for word in letters if word in _PARTS), None)
        number = part if part is not None else (numbers[-1] if numbers else 1)
        known = {finger, *_PARTS, "finger", "hand"}
        is_bone = {*letters} <= known and number <= 4
        return Meaning(f"{side}{_FINGERS[finger]}{number}", rank) if is_bone else None
    digits = next((word for word in reversed(rest) if word.isdigit()), "")
    if side and letters == ["finger"] and len(digits) in (1, 2) and digits[0] in "01234":
        # Biped's: the first digit is the finger, the second its part after the first.
        part = 1 if len(digits) == 1 else int(digits[1]) + 1
        return Meaning(f"{side}{_ORDER[int(digits[0])]}{min(part, 4)}", rank)
    key = "".join(letters)
    if side and key in _SIDED and (not numbers or numbers[-1] in (0, 1)):
        return Meaning(side + _SIDED[key], rank + sum(numbers))
    if not side and key in _SINGLE and (not numbers or numbers[-1] in (0, 1, 2)):
        return Meaning(_SINGLE[key], rank + sum(numbers))
    return None


def dialect(names: tuple[str, ...]) -> str:
    """Whose names these are, for people; empty if it is not known."""
    marks = (
        ("mixamorig", "Mixamo"),
        ("J_Bip_", "VRoid"),
        ("DEF-", "Rigify"),
        ("CC_Base_", "Character Creator"),
        ("Bip0", "Biped"),
        ("upperarm_l", "Unreal"),
        ("upper_arm_l", "ADAMO"),
        ("LeftUpperArm", "Unity"),
        ("leftUpperArm", "VRM"),
        ("LeftForeArm", "Mixamo's without prefix"),
    )
    return next((told for mark, told in marks if any(mark in name for name in names)), "")
