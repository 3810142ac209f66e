"""The hand: its frame, its fingers, and where their joints are in the rest pose.

In its own frame a hand has three axes: along it, from the wrist to the knuckles; across it, to the
thumb; and out of the palm. Fingers are in a relaxed curl in the rest pose, which happens in the
plane of the first and the third.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from adamo_vh.geometry import Array

FINGERS = ("thumb", "index", "middle", "ring", "little")
WRIST = (0.01, 0.515, 0.979)
"""Of the left hand in the rest pose, body frame, metres."""
KNUCKLES = (0.02, 0.573, 0.910)
"""Middle between the knuckles, likewise."""
KNUCKLE: Mapping[str, tuple[float, float, tuple[float, float, float], float]] = {
    "index": (0.086, 0.0300, (0.039, 0.024, 0.019), 5.0),
    "middle": (0.091, 0.0095, (0.044, 0.027, 0.020), 1.0),
    "ring": (0.088, -0.0110, (0.041, 0.025, 0.019), -3.0),
    "little": (0.079, -0.0300, (0.031, 0.019, 0.017), -8.0),
}
"""Knuckle along and across the hand, lengths of the phalanges, and spread in degrees."""
CURL_DEG = (10.0, 20.0, 14.0)
"""How far each phalanx is bent in the rest pose."""
THUMB = np.array(
    [[0.018, 0.020, 0.006], [0.046, 0.036, 0.009], [0.076, 0.052, 0.016], [0.100, 0.057, 0.022]]
)
"""(4, 3) the thumb's three joints and its tip in the frame of the hand."""
_WIDTH, _LENGTH = 0.95, 0.985
"""The skeleton's hand is between the narrowest and the widest of the figures."""


def axes(side: str) -> Array:
    """(3, 3) rows in the rest pose: along the hand, to the thumb, out of the palm."""
    along = np.subtract(KNUCKLES, WRIST)
    along = along / np.linalg.norm(along)
    thumb = np.array([1.0, 0.0, 0.0]) - along[0] * along
    thumb /= np.linalg.norm(thumb)
    palm = np.cross(along, thumb)
    rows = np.stack([along, thumb, palm if palm[1] < 0 else -palm])
    return rows if side == "l" else rows * [1.0, -1.0, 1.0]


AXES: Mapping[str, Array] = {side: axes(side) for side in "lr"}


def finger_points(finger: str, width: float = _WIDTH, length: float = _LENGTH) -> Array:
    """(4, 3) three joints and the tip of a finger in the frame of the hand, metres.

    Args:
        finger: One of `FINGERS`.
        width: Scale across the hand.
        length: Scale of the phalanges.
    """
    if finger == "thumb":
        return THUMB * [1.0, width, 1.0]
    along, across, lengths, spread_deg = KNUCKLE[finger]
    points = [np.array([along, across * width, 0.0])]
    angle, spread = 0.0, np.radians(spread_deg)
    for phalanx, curl in zip(lengths, CURL_DEG, strict=True):
        angle += np.radians(curl)
        ahead = np.cos(angle)
        step = np.array([ahead * np.cos(spread), ahead * np.sin(spread), np.sin(angle)])
        points.append(points[-1] + phalanx * length * step)
    return np.stack(points)


def finger_joints() -> tuple[tuple[str, str, tuple[float, float, float]], ...]:
    """Every joint of the left fingers: name, parent and place in the rest pose, body frame."""
    found = []
    for finger in FINGERS:
        parent = "hand"
        for k, point in enumerate(finger_points(finger)[:3], start=1):
            x, y, z = (np.array(WRIST) + point @ AXES["l"]).tolist()
            found.append((f"{finger}_{k}", parent, (x, y, z)))
            parent = f"{finger}_{k}"
    return tuple(found)
