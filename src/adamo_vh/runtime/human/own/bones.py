"""Which node of a file is which bone of a body, in VRM's words."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from adamo_vh.readable import readable
from adamo_vh.runtime.human.own.faults import Broken
from adamo_vh.runtime.human.own.fields import Document
from adamo_vh.runtime.human.own.names import Meaning, dialect, meaning
from adamo_vh.runtime.human.own.tree import Tree

LIMBS = ("UpperArm", "LowerArm", "Hand", "UpperLeg", "LowerLeg", "Foot")
REQUIRED = ("hips", "head", *(side + limb for limb in LIMBS for side in ("left", "right")))
"""Without one of these a figure cannot be moved."""
OPTIONAL: Mapping[str, str] = {
    "spine": "the trunk bends as one piece",
    "neck": "the head turns on the trunk",
    "leftShoulder": "shoulders do not rise",
    "rightShoulder": "shoulders do not rise",
    "leftToes": "feet do not roll over their toes",
    "rightToes": "feet do not roll over their toes",
    "leftFingers": "the hand does not close",
    "rightFingers": "the hand does not close",
}
"""What it means that a bone is missing."""
FINGERS = ("Thumb", "Index", "Middle", "Ring", "Little")
_KNOWN = frozenset(
    (
        *("hips", "spine", "chest", "upperChest", "neck", "head", "jaw"),
        *(
            side + bone
            for side in ("left", "right")
            for bone in (*LIMBS, "Shoulder", "Toes", "Eye")
        ),
        *(f"{s}{finger}{n}" for s in ("left", "right") for finger in FINGERS for n in range(1, 4)),
    )
)
"""Bones of VRM, with numbered fingers."""
_THUMB = ("Metacarpal", "Proximal", "Distal")
_PHALANX = ("Proximal", "Intermediate", "Distal")


@dataclass(frozen=True, slots=True, eq=False)
class Bones:
    """The bones of a figure."""

    nodes: Mapping[str, int]
    """By VRM 1.0's words, and `spine0`, `spine1`, ... for all between hips and arms; fingers are
    `leftIndex1` to `leftIndex3`."""
    source: str
    """How they were recognised."""
    notes: tuple[str, ...] = ()

    def __contains__(self, bone: str) -> bool:
        """Whether the file has it."""
        return bone in self.nodes

    @property
    def spine(self) -> tuple[str, ...]:
        """Bones of the trunk between the hips and the arms, from below."""
        found = [name for name in self.nodes if name.startswith("spine") and name != "spine"]
        return tuple(sorted(found, key=lambda name: int(name[5:])))

    def lacking(self) -> dict[str, str]:
        """What is missing of what would be used, and what that means."""
        found = {}
        for bone, why in OPTIONAL.items():
            side = bone.removesuffix("Fingers")
            if bone == "spine":
                is_here = bool(self.spine)
            elif bone.endswith("Fingers"):
                is_here = bone in self or any(f"{side}{finger}1" in self for finger in FINGERS[1:])
            else:
                is_here = bone in self
            if not is_here:
                found[bone] = why
        return found


def bones_of(document: Document, tree: Tree) -> Bones:
    """Find the bones.

    Raises:
        Broken: One that is needed is missing, or one stands twice; says what was found.
    """
    named, source = _told_by_vrm(document.extensions)
    if source:
        found = {
            bone: node
            for bone, node in named.items()
            if bone in _KNOWN and 0 <= node < len(tree.names)
        }
    else:
        found = _told_by_names(document, tree)
        whose = dialect(tree.names)
        source = f"names of bones{f' ({whose})' if whose else ''}"
    found |= _trunk(found, tree)
    if missing := [bone for bone in REQUIRED if bone not in found]:
        fingers = tuple(f"{side}{finger}" for side in ("left", "right") for finger in FINGERS)
        known = ", ".join(sorted(b for b in found if not b.startswith(fingers))) or "none"
        shown = ", ".join(readable(name)[:30] for name in tree.names if name)
        raise Broken(
            f"bones are missing: {', '.join(missing)} (found: {known}). Name its bones as VRM, "
            f"Mixamo or Unity does, or export it as VRM. Its nodes: {shown[:300]}."
        )
    seen: dict[int, str] = {}
    for bone in REQUIRED:
        other = seen.setdefault(found[bone], bone)
        if other != bone:
            raise Broken(f"one node is both {other} and {bone}. Correct its bone map.")
    return Bones(found, source)


def _told_by_vrm(extensions: Mapping[str, Any]) -> tuple[dict[str, int], str]:
    """The map that a VRM brings, in the words of VRM 1.0, and which version it is."""
    newer = _within(extensions, "VRMC_vrm", "humanoid", "humanBones")
    if isinstance(newer, dict):
        nodes = {bone: told.get("node") for bone, told in newer.items() if isinstance(told, dict)}
        return _with_fingers(nodes, _THUMB), "VRM 1.0"
    older = _within(extensions, "VRM", "humanoid", "humanBones")
    if isinstance(older, list):
        nodes = {str(t.get("bone")): t.get("node") for t in older if isinstance(t, dict)}
        return _with_fingers(nodes, _PHALANX), "VRM 0.x"
    return {}, ""


def _within(told: Any, *path: str) -> Any:
    for key in path:
        told = told.get(key) if isinstance(told, dict) else None
    return told


def _with_fingers(nodes: Mapping[str, Any], thumb: tuple[str, ...]) -> dict[str, int]:
    """The map with numbered fingers, of what is a node."""
    numbered = {
        f"{side}{finger}{part}": f"{side}{finger}{number}"
        for side in ("left", "right")
        for finger in FINGERS
        for number, part in enumerate(thumb if finger == "Thumb" else _PHALANX, start=1)
    }
    return {
        numbered.get(bone, bone): node
        for bone, node in nodes.items()
        if isinstance(node, int) and not isinstance(node, bool)
    }


def _told_by_names(document: Document, tree: Tree) -> dict[str, int]:
    """What the names say, the clearest of each meaning; bones before what only holds bones."""
    joints = {joint for skin in document.skins for joint in skin.joints if joint < len(tree.names)}
    candidates = _with_above(joints, tree) or {*tree.order}
    for node in tree.order:
        if tree.parents[node] in joints:
            joints.add(node)
            candidates.add(node)
    best: dict[str, tuple[tuple[bool, int, int], int]] = {}
    for place, node in enumerate(tree.order):
        told: Meaning | None = meaning(tree.names[node][:200])
        if told is None or node not in candidates or document.nodes[node].mesh is not None:
            continue
        key = (node not in joints, told.rank, place)
        if told.bone not in best or key < best[told.bone][0]:
            best[told.bone] = (key, node)
    found = {bone: node for bone, (_, node) in best.items()}
    for side in ("left", "right"):
        _sort_out(found, side)
    _rigify(found, tree)
    return found


def _with_above(nodes: set[int], tree: Tree) -> set[int]:
    """Nodes and all that are above any of them."""
    found: set[int] = set()
    for start in nodes:
        node = start
        while node >= 0 and node not in found:
            found.add(node)
            node = tree.parents[node]
    return found


def _sort_out(found: dict[str, int], side: str) -> None:
    """Tell bones apart that some name as others name their neighbours."""
    clavicle, leg, ankle = (found.pop(side + word, None) for word in ("Clavicle", "Leg", "Ankle"))
    if clavicle is not None:
        if side + "Shoulder" in found and side + "UpperArm" not in found:
            found[side + "UpperArm"] = found[side + "Shoulder"]
        found[side + "Shoulder"] = clavicle
    if leg is not None:
        found.setdefault(side + ("LowerLeg" if side + "UpperLeg" in found else "UpperLeg"), leg)
    if ankle is not None:
        if side + "Foot" in found and side + "Toes" not in found:
            found[side + "Toes"] = found[side + "Foot"]
        found[side + "Foot"] = ankle
    thumb = side + "Thumb"
    if thumb + "0" in found and thumb + "2" not in found:
        # As in VRM 1.0, whose thumb begins with its metacarpal.
        for number in (1, 0):
            if f"{thumb}{number}" in found:
                found[f"{thumb}{number + 1}"] = found.pop(f"{thumb}{number}")


def _rigify(found: dict[str, int], tree: Tree) -> None:
    """Rigify's trunk is `spine` and numbers up to the head."""
    chain = {
        name.rpartition("-")[2]: node
        for node, name in enumerate(tree.names)
        if name.rpartition("-")[2].startswith("spine") and not name.startswith(("ORG", "MCH"))
    }
    names = ("hips", "spine0", "spine1", "spine2", "neck", None, "head")
    if "head" in found or "spine" not in chain or "spine.006" not in chain:
        return
    for number, bone in enumerate(names):
        node = chain.get("spine" if number == 0 else f"spine.{number:03d}")
        if bone and node is not None:
            found.setdefault(bone, node)


def _trunk(found: dict[str, int], tree: Tree) -> dict[str, int]:
    """What lies between the hips and the head, by its place in the tree."""
    told: dict[str, int] = {}
    if "head" not in found:
        return told
    above_head = tree.above(found["head"])
    if "hips" not in found:
        legs = _above_both(found, "UpperLeg", tree)
        common = [node for node in above_head if node in legs]
        if not common:
            return told
        told["hips"] = common[0]
    hips = told.get("hips", found.get("hips", -1))
    if hips not in above_head:
        return told | _as_named(found)
    path = above_head[1 : above_head.index(hips)][::-1]
    arms = _above_both(found, "UpperArm", tree)
    holds = [node for node in path if node in arms]
    top = path.index(holds[-1]) + 1 if holds else len(path)
    if not holds and found.get("neck") in path:
        top = path.index(found["neck"])
    told |= {f"spine{i}": node for i, node in enumerate(path[:top])}
    if "neck" not in found and path[top:]:
        told["neck"] = path[top]
    return told


def _above_both(found: Mapping[str, int], limb: str, tree: Tree) -> set[int]:
    """The nodes above a limb of both sides; none if one is missing."""
    above = [
        {*tree.above(found[side + limb])} if side + limb in found else set()
        for side in ("left", "right")
    ]
    return above[0] & above[1]


def _as_named(found: Mapping[str, int]) -> dict[str, int]:
    """The trunk as a map tells it, where the tree does not hold together."""
    named = [found[bone] for bone in ("spine", "chest", "upperChest") if bone in found]
    return {f"spine{i}": node for i, node in enumerate(named)}
