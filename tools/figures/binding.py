"""Skin weights: how much each place of the surface follows each joint.

One function of the place serves all garments, so layers that lie on each other stay so when bent.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from adamo_vh.geometry import Array
from adamo_vh.runtime.human.hand import AXES, FINGERS, KNUCKLES, WRIST, finger_points
from adamo_vh.runtime.human.skeleton import INDEX, JOINTS, REST

_TIPS = {"hand": KNUCKLES, "toes": (0.19, 0.108, 0.02)}
_SPINE = {
    "pelvis": (((0, 0, 0.93), (0, 0, 1.02)), ((0, -0.11, 0.985), (0, 0.11, 0.985))),
    "spine": (((0, 0, 1.06), (0, 0, 1.17)), ((0, -0.09, 1.11), (0, 0.09, 1.11))),
    "chest": (
        ((0, 0, 1.22), (0, 0, 1.39)),
        ((0, -0.12, 1.22), (0, -0.105, 1.31)),
        ((0, 0.12, 1.22), (0, 0.105, 1.31)),
    ),
    "neck": (((-0.012, 0, 1.45), (0.0, 0, 1.505)),),
    "head": (((0.0, 0, 1.545), (0.0, 0, 1.7)), ((0.02, 0, 1.56), (0.06, 0, 1.515))),
}
_ENDS = {
    "clavicle": ("clavicle", "upper_arm", 0.0, 0.8),
    "upper_arm": ("upper_arm", "forearm", 0.06, 1.0),
    "forearm": ("forearm", "hand", 0.0, 1.0),
    "hand": ("hand", "", 0.0, 1.0),
    "thigh": ("thigh", "shin", 0.08, 1.0),
    "shin": ("shin", "foot", 0.0, 1.0),
    "foot": ("foot", "toes", 0.0, 1.0),
    "toes": ("toes", "", 0.0, 1.0),
}
_SPREAD_M = {
    "pelvis": 0.045, "spine": 0.045, "chest": 0.045, "neck": 0.02, "head": 0.02, "clavicle": 0.04,
    "upper_arm": 0.04, "forearm": 0.022, "hand": 0.014, "thigh": 0.045,
    "shin": 0.03, "foot": 0.02, "toes": 0.012, "eyelids": 0.02,
}  # fmt: skip
"""How wide the bend is around each joint."""


def _bones() -> dict[str, list[tuple[Array, Array]]]:
    bones = {name: [(np.array(a), np.array(b)) for a, b in s] for name, s in _SPINE.items()}
    for kind, (start, end, low, high) in _ENDS.items():
        for side, sign in (("l", 1.0), ("r", -1.0)):
            a = REST[INDEX[f"{start}_{side}"]]
            b = REST[INDEX[f"{end}_{side}"]] if end else np.array(_TIPS[kind]) * (1, sign, 1)
            bones[f"{kind}_{side}"] = [(a + low * (b - a), a + high * (b - a))]
    # The heel belongs to the foot as much as the instep does.
    for side, sign in (("l", 1.0), ("r", -1.0)):
        bones[f"foot_{side}"].append(
            (np.array((-0.05, 0.1 * sign, 0.03)), np.array((0.06, 0.104 * sign, 0.03)))
        )
    return bones


def _segment_distance(p: Array, a: Array, b: Array) -> Array:
    axis = b - a
    t = np.clip((p - a) @ axis / (axis @ axis), 0.0, 1.0)
    return np.asarray(np.linalg.norm(p - a - t[:, None] * axis, axis=1))


_KNUCKLES_SPREAD_M = 0.008


def _spread(p: Array) -> Array:
    """(N,) width of the bend: that of the joints nearby."""
    kinds = [name.removesuffix("_l").removesuffix("_r") for name in JOINTS]
    bends = [(REST[j], _SPREAD_M[kind]) for j, kind in enumerate(kinds) if kind in _SPREAD_M]
    bends += [(np.array(KNUCKLES) * (1, sign, 1), _KNUCKLES_SPREAD_M) for sign in (1.0, -1.0)]
    widths = np.array([width for _, width in bends])
    away = np.linalg.norm(p[:, None] - np.array([place for place, _ in bends]), axis=2)
    share = 1.0 / (away**4 + 1e-8)
    return np.asarray((share * widths).sum(axis=1) / share.sum(axis=1))


def bind(points: Array, allowed: Sequence[str] | None = None) -> tuple[NDArray[np.uint8], Array]:
    """Give each place its four strongest joints.

    Args:
        points: (N, 3) places in the rest pose.
        allowed: Joints that may hold them, without side; all when None.

    Returns:
        (N, 4) joint numbers and (N, 4) weights that sum to 1.
    """
    scores = np.full((len(points), len(JOINTS)), -np.inf)
    width = 2 * _spread(points) ** 2
    for name, segments in _bones().items():
        kind = name.removesuffix("_l").removesuffix("_r")
        if allowed is not None and kind not in allowed:
            continue
        nearest = np.min([_segment_distance(points, a, b) for a, b in segments], axis=0)
        score = -(nearest**2) / width
        if name != kind:
            # A limb holds only its own side, fading out at the midline.
            side = 1.0 if name.endswith("_l") else -1.0
            score = score - np.logaddexp(0.0, -side * points[:, 1] / 0.012)
        scores[:, INDEX[name]] = score
    weights = np.exp(scores - scores.max(axis=1, keepdims=True))
    return strongest(weights)


_PALM_M, _THUMB_M, _BLEND_M = 0.013, 0.011, 0.0035
"""How thick palm and thumb are around their bones, and how softly they meet."""
_JOINT_M = (0.008, 0.005, 0.004)
"""On both sides of a finger's joints the skin bends so far along."""


def bind_hands(points: Array) -> tuple[NDArray[np.uint8], Array]:
    """Give each place of both hands its joints; every finger moves without its neighbours.

    Args:
        points: (N, 3) places in the rest pose.

    Returns:
        (N, 4) joint numbers and (N, 4) weights that sum to 1.
    """
    ids, shares = bind(points, ("forearm", "hand"))
    weights = np.zeros((len(points), len(JOINTS)))
    np.put_along_axis(weights, ids.astype(np.intp), shares, axis=1)
    for side, sign in (("l", 1.0), ("r", -1.0)):
        rows = np.flatnonzero(sign * points[:, 1] > 0)
        wrist = np.array(WRIST) * (1, sign, 1)
        local = (points[rows] - wrist) @ AXES[side].T
        held = weights[rows, INDEX[f"hand_{side}"]]
        weights[rows, INDEX[f"hand_{side}"]] = 0.0
        for name, share in _hand_shares(local).items():
            weights[rows, INDEX[f"{name}_{side}"]] += held * share
    return strongest(weights)


def _hand_shares(p: Array) -> dict[str, Array]:
    """How much of a hand's places, (N, 3) in its own frame, follows hand and fingers."""
    chains = {finger: finger_points(finger) for finger in FINGERS}
    away = {finger: _chain_distance(p, points) for finger, points in chains.items()}
    palm = np.min([_segment_distance(p, np.zeros(3), chains[f][0]) for f in FINGERS[1:]], axis=0)
    fingers = np.stack([away[f] for f in FINGERS[1:]])
    other = np.minimum(palm - _PALM_M, fingers.min(axis=0) - 0.009)
    thumb = 1.0 / (1.0 + np.exp(-(other - away["thumb"] + _THUMB_M) / _BLEND_M))
    shares = {"hand": np.zeros(len(p))}
    nearest = fingers.argmin(axis=0)
    for k, finger in enumerate(FINGERS):
        mine = thumb if k == 0 else (1.0 - thumb) * (nearest == k - 1)
        rest = mine
        past = _past_joints(p, chains[finger])
        shares["hand"] = shares["hand"] + mine * (1.0 - past[0])
        for j in range(3):
            rest = rest * past[j]
            beyond = past[j + 1] if j < 2 else np.zeros(len(p))
            shares[f"{finger}_{j + 1}"] = rest * (1.0 - beyond)
    return shares


def _past_joints(p: Array, chain: Array) -> list[Array]:
    """How far places are beyond each of a finger's three joints, 0 to 1."""
    bones = np.diff(chain, axis=0)
    bones /= np.linalg.norm(bones, axis=1, keepdims=True)
    found = []
    for j, width in enumerate(_JOINT_M):
        along = bones[j] + bones[max(0, j - 1)]
        t = np.clip(0.5 + (p - chain[j]) @ along / np.linalg.norm(along) / (2 * width), 0.0, 1.0)
        found.append(np.asarray(t * t * (3 - 2 * t)))
    return found


def _chain_distance(p: Array, chain: Array) -> Array:
    return np.asarray(np.min([_segment_distance(p, a, b) for a, b in pairwise(chain)], axis=0))


def strongest(weights: Array) -> tuple[NDArray[np.uint8], Array]:
    """Keep the four largest of (N, J) weights and make them sum to 1."""
    ids = np.argsort(-weights, axis=1, kind="stable")[:, :4]
    kept = np.take_along_axis(weights, ids, axis=1)
    kept = kept / kept.sum(axis=1, keepdims=True)
    kept[kept < 0.01] = 0.0
    return ids.astype(np.uint8), kept / kept.sum(axis=1, keepdims=True)


def rigid(count: int, joint: str) -> tuple[NDArray[np.uint8], Array]:
    """Everything follows one joint."""
    ids = np.zeros((count, 4), np.uint8)
    ids[:, 0] = INDEX[joint]
    weights = np.zeros((count, 4))
    weights[:, 0] = 1.0
    return ids, weights
