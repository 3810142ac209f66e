"""Morph targets of a file as the shapes of our faces, which have ARKit's names."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from adamo_vh.runtime.human.face import SHAPES
from adamo_vh.runtime.human.own.fields import Document
from adamo_vh.runtime.human.own.skins import target_names

BOTH, LEFT, RIGHT = "both", "left", "right"
"""Which half of the face a shape is taken for."""


@dataclass(frozen=True, slots=True)
class Share:
    """A morph target that is part of a shape."""

    mesh: int
    target: int
    weight: float
    half: str = BOTH


_ALIASES: Mapping[str, tuple[str, ...]] = {
    "jawOpen": ("mouthopen", "visemeaa", "vaa", "mtha", "fclmtha"),
    "mouthFunnel": ("visemeo", "visemeoh", "voh", "mtho", "fclmtho"),
    "mouthPucker": ("visemeu", "visemeou", "vou", "mthu", "fclmthu"),
    "mouthSmileLeft": ("mouthsmilel",),
    "mouthSmileRight": ("mouthsmiler",),
    "eyeBlinkLeft": ("blinkleft", "blinkl", "winkleft", "fcleyeclosel"),
    "eyeBlinkRight": ("blinkright", "blinkr", "winkright", "fcleyecloser"),
    "browInnerUp": ("browsup", "fclbrwsurprised"),
}
"""Other names, written small and without signs, of what is the same or near enough."""
_HALVES: Mapping[str, tuple[str, tuple[str, ...]]] = {
    "eyeBlinkLeft": (LEFT, ("blink", "eyesclosed", "eyeclose", "fcleyeclose")),
    "eyeBlinkRight": (RIGHT, ("blink", "eyesclosed", "eyeclose", "fcleyeclose")),
    "eyeLookUpLeft": (LEFT, ("eyeslookup", "lookup", "eyelookup")),
    "eyeLookUpRight": (RIGHT, ("eyeslookup", "lookup", "eyelookup")),
    "eyeLookDownLeft": (LEFT, ("eyeslookdown", "lookdown", "eyelookdown")),
    "eyeLookDownRight": (RIGHT, ("eyeslookdown", "lookdown", "eyelookdown")),
    "mouthSmileLeft": (LEFT, ("mouthsmile", "smile", "visemee", "visemei", "vih", "fclmthe")),
    "mouthSmileRight": (RIGHT, ("mouthsmile", "smile", "visemee", "visemei", "vih", "fclmthe")),
    "mouthFrownLeft": (LEFT, ("mouthfrown", "frown", "fclmthdown")),
    "mouthFrownRight": (RIGHT, ("mouthfrown", "frown", "fclmthdown")),
    "browDownLeft": (LEFT, ("browdown", "browsdown", "fclbrwangry")),
    "browDownRight": (RIGHT, ("browdown", "browsdown", "fclbrwangry")),
    "browOuterUpLeft": (LEFT, ("browouterup",)),
    "browOuterUpRight": (RIGHT, ("browouterup",)),
}
"""Shapes of one side, cut out of one of both."""
_VRM: Mapping[str, tuple[tuple[str, str], ...]] = {
    "jawOpen": (("aa", BOTH), ("a", BOTH)),
    "mouthFunnel": (("oh", BOTH), ("o", BOTH)),
    "mouthPucker": (("ou", BOTH), ("u", BOTH)),
    "mouthSmileLeft": (("ee", LEFT), ("e", LEFT), ("ih", LEFT), ("i", LEFT)),
    "mouthSmileRight": (("ee", RIGHT), ("e", RIGHT), ("ih", RIGHT), ("i", RIGHT)),
    "eyeBlinkLeft": (("blinkleft", BOTH), ("blink_l", BOTH), ("blink", LEFT)),
    "eyeBlinkRight": (("blinkright", BOTH), ("blink_r", BOTH), ("blink", RIGHT)),
    "eyeLookUpLeft": (("lookup", LEFT),),
    "eyeLookUpRight": (("lookup", RIGHT),),
    "eyeLookDownLeft": (("lookdown", LEFT),),
    "eyeLookDownRight": (("lookdown", RIGHT),),
    "eyeLookOutLeft": (("lookleft", LEFT),),
    "eyeLookInRight": (("lookleft", RIGHT),),
    "eyeLookInLeft": (("lookright", LEFT),),
    "eyeLookOutRight": (("lookright", RIGHT),),
}
"""Expressions of VRM 1.0 and presets of VRM 0.x that are near a shape, the nearest first."""
WITHOUT: Mapping[str, str] = {
    "eyeBlink": "does not blink",
    "eyeLook": "eyes stay straight ahead",
    "jawOpen": "lips do not follow speech",
    "mouthSmile": "does not smile",
    "brow": "brows do not move",
}
"""By the beginning of their names, what it means that shapes are missing."""


def shapes_of(document: Document) -> dict[str, tuple[Share, ...]]:
    """The shapes of a file's faces: by ARKit's names first, then by VRM, then by other names."""
    named = _named(document)
    expressions = _expressions(document)
    found: dict[str, tuple[Share, ...]] = {}
    for shape in SHAPES:
        side = re.sub(r"(Left|Right)$", lambda m: m[1][0], shape)
        choices = [named.get(key) for key in (_bare(shape), _bare(side))]
        choices += [_half(expressions.get(key), half) for key, half in _VRM.get(shape, ())]
        choices += [named.get(key) for key in _ALIASES.get(shape, ())]
        half, keys = _HALVES.get(shape, (BOTH, ()))
        choices += [_half(named.get(key), half) for key in keys]
        if chosen := next((choice for choice in choices if choice), None):
            found[shape] = chosen
    return found


def meaning_of_missing(found: Mapping[str, Any]) -> list[str]:
    """What the lack of shapes means, in words."""
    return [
        why for begin, why in WITHOUT.items() if not any(name.startswith(begin) for name in found)
    ]


def _bare(name: str) -> str:
    return re.sub(r"[^a-z0-9]", "", name.lower())


def _half(shares: tuple[Share, ...] | None, half: str) -> tuple[Share, ...]:
    return tuple(Share(s.mesh, s.target, s.weight, half) for s in shares or ())


def _named(document: Document) -> dict[str, tuple[Share, ...]]:
    """Morph targets by their bare names; meshes often share them."""
    found: dict[str, tuple[Share, ...]] = {}
    for number, mesh in enumerate(document.meshes):
        if not mesh.primitives:
            continue
        for target, name in enumerate(target_names(mesh, mesh.primitives[0])):
            key = _bare(name.rpartition(".")[2])
            found[key] = (*found.get(key, ()), Share(number, target, 1.0))
    return found


def _expressions(document: Document) -> dict[str, tuple[Share, ...]]:
    """What a VRM calls its expressions, small letters."""
    found: dict[str, tuple[Share, ...]] = {}
    for name, binds in _groups(document.extensions):
        shares = []
        for bind in binds[:200] if isinstance(binds, list) else []:
            if (share := _share(document, bind)) is not None:
                shares.append(share)
        if shares:
            found.setdefault(name, tuple(shares))
    return found


def _groups(extensions: Mapping[str, Any]) -> list[tuple[str, Any]]:
    """Name and binds of each expression."""
    newer, older = extensions.get("VRMC_vrm"), extensions.get("VRM")
    told = newer.get("expressions") if isinstance(newer, dict) else None
    presets = told.get("preset") if isinstance(told, dict) else None
    if isinstance(presets, dict):
        return [
            (name.lower(), one.get("morphTargetBinds"))
            for name, one in presets.items()
            if isinstance(one, dict)
        ]
    master = older.get("blendShapeMaster") if isinstance(older, dict) else None
    groups = master.get("blendShapeGroups") if isinstance(master, dict) else None
    return [
        (str(one.get("presetName", "")).lower(), one.get("binds"))
        for one in (groups if isinstance(groups, list) else [])
        if isinstance(one, dict)
    ]


def _share(document: Document, bind: Any) -> Share | None:
    """A bind of an expression: VRM 1.0 names a node and goes to 1, 0.x a mesh and goes to 100."""
    if not isinstance(bind, dict):
        return None
    node, mesh = bind.get("node"), bind.get("mesh")
    target, weight = bind.get("index"), bind.get("weight")
    if not isinstance(target, int) or not isinstance(weight, int | float) or target < 0:
        return None
    if isinstance(node, int) and 0 <= node < len(document.nodes):
        mesh = document.nodes[node].mesh
    else:
        weight = weight / 100.0
    if not isinstance(mesh, int) or not 0 <= mesh < len(document.meshes):
        return None
    return Share(mesh, target, min(max(float(weight), 0.0), 1.0))
