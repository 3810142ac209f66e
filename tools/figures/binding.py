"""Skin weights: how much each place of the surface follows each joint.

One function of the place serves all garments, so layers that lie on each other stay so when bent.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from adamo_vh.geometry import Array
from adamo_vh.runtime.human.skeleton import INDEX, JOINTS, REST

_TIPS = {"fingers": (0.045, 0.63, 0.842), "toes": (0.19, 0.108, 0.02)}
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
    "hand": ("hand", "fingers", 0.0, 1.0),
    "fingers": ("fingers", "", 0.0, 1.0),
    "thigh": ("thigh", "shin", 0.08, 1.0),
    "shin": ("shin", "foot", 0.0, 1.0),
    "foot": ("foot", "toes", 0.0, 1.0),
    "toes": ("toes", "", 0.0, 1.0),
}
_SPREAD_M = {
    "pelvis": 0.045, "spine": 0.045, "chest": 0.045, "neck": 0.02, "head": 0.02, "clavicle": 0.04,
    "upper_arm": 0.04, "forearm": 0.022, "hand": 0.014, "fingers": 0.008, "thigh": 0.045,
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


def _spread(p: Array) -> Array:
    """(N,) width of the bend: that of the joints nearby."""
    widths = np.array([_SPREAD_M[name.removesuffix("_l").removesuffix("_r")] for name in JOINTS])
    away = np.linalg.norm(p[:, None] - REST, axis=2)
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
