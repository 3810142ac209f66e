"""How fingers close: at ease, around something round, on something small, under something flat.

Everything is computed for the left hand in its own frame, in metres: along the hand, to the thumb,
out of the palm. Fingers bend in the plane of the first and the third axis; the thumb goes where it
opposes them.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import lru_cache

import numpy as np

from adamo_vh.geometry import Array
from adamo_vh.runtime.human.hand import AXES, CURL_DEG, FINGERS, THUMB, finger_points
from adamo_vh.runtime.human.rotations import about, blended, from_rotation_vectors
from adamo_vh.runtime.human.skeleton import INDEX

FINGER_JOINTS: Mapping[str, Array] = {
    side: np.array([INDEX[f"{f}_{k}_{side}"] for f in FINGERS for k in (1, 2, 3)]) for side in "lr"
}
"""Numbers of the joints of a hand's fingers, in the order of a shape."""
PALM_M = 0.013
"""From the bones of the hand to its skin."""
_FINGER_M, _THUMB_M, _TIP_M = 0.0088, 0.0100, 0.0062
_REST = np.cumsum(np.radians(CURL_DEG))
_AXIS = np.cross(AXES["l"][0], AXES["l"][2])
_FLIP = np.array([1.0, -1.0, 1.0])
_LIMITS = np.radians([[-8.0, 88.0], [4.0, 105.0], [4.0, 70.0]])
"""Least and largest bend of knuckle, middle and last joint."""
_BONES = {
    finger: np.linalg.norm(np.diff(finger_points(finger), axis=0), axis=1) for finger in FINGERS
}
_METACARPAL = np.array([0.80, 0.45, 0.40]) / np.linalg.norm([0.80, 0.45, 0.40])
"""Where the ball of the thumb points when the thumb opposes the fingers."""
_THUMB_ROOT = THUMB[0] + _BONES["thumb"][0] * _METACARPAL


def mirrored_shape(shape: Array) -> Array:
    """The same shape of the other hand, (15, 3, 3)."""
    return np.asarray(shape * (_FLIP[:, None] * _FLIP))


def _shape(bends: Mapping[str, Array], thumb: Array) -> Array:
    """(15, 3, 3) local rotations of the fingers of the left hand.

    Args:
        bends: By finger, (3,) directions of the phalanges: angles from along the hand to the palm.
        thumb: (3, 3) directions of the thumb's three bones.
    """
    turns = np.empty((len(FINGERS), 3, 3, 3))
    whole = np.eye(3)
    rest = np.diff(THUMB, axis=0)
    for k in range(3):
        turn = _least_turn(rest[k], thumb[k])
        turn = AXES["l"].T @ turn @ AXES["l"]
        turns[0, k] = whole.T @ turn
        whole = turn
    for number, finger in enumerate(FINGERS[1:], start=1):
        local = np.diff(bends[finger] - _REST, prepend=0.0)
        turns[number] = about((float(_AXIS[0]), float(_AXIS[1]), float(_AXIS[2])), local)
    return turns.reshape(-1, 3, 3)


def _least_turn(start: Array, end: Array) -> Array:
    """The shortest rotation from one direction to another."""
    a, b = start / np.linalg.norm(start), end / np.linalg.norm(end)
    axis = np.cross(a, b)
    sine = float(np.linalg.norm(axis))
    if sine < 1e-9:
        return np.eye(3)
    return from_rotation_vectors(axis / sine * float(np.arctan2(sine, float(a @ b))))


@lru_cache
def at_ease() -> Array:
    """An empty hand that hangs: more curled towards the little finger, the thumb beside it."""
    degrees = {
        "index": (18, 46, 62), "middle": (22, 55, 74), "ring": (26, 64, 84), "little": (28, 68, 90),
    }  # fmt: skip
    thumb = np.array([[0.86, 0.42, 0.24], [0.88, 0.28, 0.34], [0.93, 0.02, 0.32]])
    return _shape({finger: np.radians(angles) for finger, angles in degrees.items()}, thumb)


@lru_cache
def flat() -> Array:
    """A hand laid against something wide: fingers a little bent, the thumb away from them."""
    degrees = {
        "index": (6, 20, 30), "middle": (6, 21, 32), "ring": (7, 23, 34), "little": (8, 26, 38),
    }  # fmt: skip
    thumb = np.array([[0.72, 0.62, 0.18], [0.74, 0.60, 0.30], [0.86, 0.42, 0.26]])
    return _shape({finger: np.radians(angles) for finger, angles in degrees.items()}, thumb)


def round_middle(radius_m: float) -> Array:
    """(3,) where the axis of something round sits that a hand is closed around."""
    out = PALM_M + radius_m
    beside = (radius_m + 0.0105) ** 2 - (out - _THUMB_ROOT[2]) ** 2
    along = max(0.080, 0.092 - 0.35 * radius_m, _THUMB_ROOT[0] + np.sqrt(max(0.0, beside)))
    return np.array([along, 0.0, out])


@lru_cache(maxsize=256)
def around(radius_mm: int) -> Array:
    """Fingers and thumb closed around something round, of some radius, across the palm."""
    middle = round_middle(radius_mm / 1000.0)[[0, 2]]
    radius = radius_mm / 1000.0
    bends = {finger: _closed(finger, middle, radius + _FINGER_M) for finger in FINGERS[1:]}
    place, directions = _THUMB_ROOT, [_METACARPAL]
    last = 0.0
    for k in (1, 2):
        line = middle - place[[0, 2]]
        far = float(np.linalg.norm(line))
        beside = np.arcsin(min(1.0, (radius + _THUMB_M) / max(far, 1e-6)))
        angle = float(np.arctan2(line[1], line[0]) + beside)
        angle = min(angle, np.radians(120.0)) if k == 1 else max(angle, last - np.radians(75.0))
        last = angle
        across = -0.18 if k == 1 else -0.30
        direction = np.array([np.cos(angle), across, np.sin(angle)])
        directions.append(direction / np.linalg.norm(direction))
        place = place + _BONES["thumb"][k] * directions[-1]
    return _shape(bends, np.stack(directions))


def _closed(finger: str, middle: Array, away_m: float) -> Array:
    """(3,) angles of the phalanges that touch a circle, one after the other."""
    place, before = finger_points(finger)[0][[0, 2]], 0.0
    angles = []
    for k, (low, high) in enumerate(_LIMITS):
        tried = before + np.linspace(low, high, 97)
        ahead = np.stack([np.cos(tried), np.sin(tried)], axis=1)
        line = middle - place
        t = np.clip(ahead @ line, 0.0, _BONES[finger][k])
        touches = np.linalg.norm(line - t[:, None] * ahead, axis=1) <= away_m
        # A phalanx that cannot touch goes on in the curl of those before it.
        chosen = int(np.argmax(touches)) if touches.any() else 60
        before = float(tried[chosen])
        angles.append(before)
        place = place + _BONES[finger][k] * ahead[chosen]
    return np.array(angles)


MOST_GAP_M = 0.045
"""Widest gap between tips that hold something."""
OPPOSED = np.array([0.94, 0.0, 0.34])
"""From the tip of the thumb to those of the fingers that meet it."""


def pinch_middle(gap_m: float) -> Array:
    """(3,) middle between the tips of the thumb and of two fingers."""
    thumb = np.array([0.078 - 0.26 * gap_m, 0.018, 0.064 - 0.1 * gap_m])
    return np.asarray(thumb + (gap_m / 2 + _TIP_M) * OPPOSED)


@lru_cache(maxsize=128)
def pinching(gap_mm: int) -> Array:
    """Thumb, index and middle finger with something thin between their tips."""
    gap = gap_mm / 1000.0
    middle, half = pinch_middle(gap), gap / 2 + _TIP_M
    target = (middle + half * OPPOSED)[[0, 2]]
    index, long = _tip_at("index", target), _tip_at("middle", target)
    curled = np.radians([10.0, 16.0, 20.0])
    bends = {"index": index, "middle": long, "ring": long + curled, "little": long + 1.6 * curled}
    line = middle - half * OPPOSED - _THUMB_ROOT
    first, second = _BONES["thumb"][1:]
    far = min(float(np.linalg.norm(line)), 0.985 * (first + second))
    line = line / np.linalg.norm(line)
    along = (far**2 + first**2 - second**2) / (2 * far)
    out = np.array([-0.8, 0.5, 0.1])
    out = out - line * float(out @ line)
    bow = along * line + np.sqrt(max(0.0, first**2 - along**2)) * out / np.linalg.norm(out)
    return _shape(bends, np.stack([_METACARPAL, bow, far * line - bow]))


def _tip_at(finger: str, target: Array) -> Array:
    """(3,) angles of the phalanges that bring the tip to a place in the plane of bending."""
    knuckle, middle = np.meshgrid(np.radians(np.arange(-8, 89)), np.radians(np.arange(6, 100)))
    angles = np.cumsum(np.stack([knuckle, middle, 0.5 * middle]), axis=0)
    bones = _BONES[finger][:, None, None]
    base = finger_points(finger)[0]
    x = base[0] + (bones * np.cos(angles)).sum(axis=0) - target[0]
    z = base[2] + (bones * np.sin(angles)).sum(axis=0) - target[1]
    best = int(np.argmin(x * x + z * z))
    return np.asarray(angles.reshape(3, -1)[:, best])


def opened(closed: Array) -> Array:
    """A hand that is about to close into a shape, or has just let go."""
    return blended(flat(), closed, 0.4)


@lru_cache(maxsize=64)
def under(height_mm: int) -> Array:
    """Fingers under something flat, the thumb on it."""
    degrees = {
        "index": (-6, -4, 4), "middle": (-6, -3, 5), "ring": (-5, -1, 8), "little": (-4, 2, 12),
    }  # fmt: skip
    top = PALM_M + height_mm / 1000.0 + _THUMB_M
    rise = np.clip((top - _THUMB_ROOT[2]) / _BONES["thumb"][1], -0.4, 0.9)
    level = np.sqrt(1.0 - rise**2)
    thumb = np.stack([_METACARPAL, [0.96 * level, 0.28 * level, rise], [0.98, -0.12, -0.05]])
    return _shape({finger: np.radians(angles) for finger, angles in degrees.items()}, thumb)
