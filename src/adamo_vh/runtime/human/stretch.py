"""How the body bends so that the hand comes to a place: lean, crouch, tiptoe, a step forward.

A dozen numbers describe the trunk, the hips and the feet. A small least-squares problem finds the
most comfortable ones that bring the shoulder within an arm's length of the target while the legs
reach the floor, the joints stay within their limits and the weight over the feet. Everything is
for the right hand; the left is its mirror image.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import IntEnum, auto
from functools import lru_cache

import numpy as np

from adamo_vh.geometry import Array
from adamo_vh.runtime.human.anatomy import rest
from adamo_vh.runtime.human.ik import ANKLE_M, ARM_M, LEG_M, STANDING_FEET, Foot
from adamo_vh.runtime.human.postures import STANDING_SHIFT
from adamo_vh.runtime.human.rotations import about_x, about_y, about_z, eased
from adamo_vh.runtime.human.skeleton import INDEX, Pose


class Bend(IntEnum):
    """The numbers of a stretch; metres and radians, zero when standing."""

    FORWARD = 0
    """Pelvis forward."""
    LEFT = auto()
    """Pelvis to the left."""
    UP = auto()
    """Pelvis up."""
    YAW = auto()
    """Pelvis turned left."""
    PITCH = auto()
    """Pelvis bowed."""
    LEAN = auto()
    """Spine and chest bowed."""
    TWIST = auto()
    """Spine and chest turned left, so that the right shoulder comes forward."""
    SIDE = auto()
    """Spine and chest leaning to the right."""
    SHRUG = auto()
    """Right shoulder up."""
    PROTRACT = auto()
    """Right shoulder forward."""
    HEEL_LEFT = auto()
    """Left heel up."""
    HEEL_RIGHT = auto()
    """Right heel up."""
    STEP = auto()
    """One foot forward."""
    FOLLOW = auto()
    """The other foot forward, after it."""


_DEG = np.pi / 180
_LOW = np.array([-0.25, -0.14, -0.66, -25 * _DEG, -10 * _DEG, -14 * _DEG, -35 * _DEG, -26 * _DEG,
                 -6 * _DEG, -12 * _DEG, 0.0, 0.0, 0.0, 0.0])  # fmt: skip
_HIGH = np.array([0.45, 0.26, 0.10, 30 * _DEG, 60 * _DEG, 62 * _DEG, 38 * _DEG, 24 * _DEG,
                  36 * _DEG, 28 * _DEG, 50 * _DEG, 50 * _DEG, 0.50, 0.40])  # fmt: skip
_EASY = np.array([0.12, 0.05, 0.22, 14 * _DEG, 24 * _DEG, 22 * _DEG, 16 * _DEG, 10 * _DEG,
                  16 * _DEG, 14 * _DEG, 14 * _DEG, 14 * _DEG, 0.22, 0.10])  # fmt: skip
"""A deviation that costs as much as this one of another number."""
_ARM_EASY_M, _ARM_MOST_M, _ARM_LEAST_M = 0.82 * ARM_M, 0.975 * ARM_M, 0.27
_SHIN_TILT_MOST = np.radians(36.0)
_HIP_FLEXION_MOST = np.radians(122.0)
_THIGH_M = float(np.linalg.norm(rest("shin_l") - rest("thigh_l")))
_SHIN_M = LEG_M - _THIGH_M


@dataclass(frozen=True, slots=True, eq=False)
class Stretch:
    """A way to bend."""

    bends: Array
    """Values in the order of `Bend`."""
    stepping: int
    """Which foot takes the step forward: 0 left, 1 right."""
    towards_rad: float
    """Direction of the step: that of the target."""

    def feet(self, weight: float = 1.0, stepped: float = 1.0) -> list[Foot]:
        """Left and right foot.

        Args:
            weight: How much of the stretch is applied.
            stepped: How far the steps forward are done: one foot in the first part, then the other.
        """
        feet = []
        for i, foot in enumerate(STANDING_FEET):
            mine = i == self.stepping
            length = float(self.bends[Bend.STEP if mine else Bend.FOLLOW])
            begin, end = (0.0, 0.55) if mine else (0.45, 1.0)
            part = float(np.clip((stepped - begin) / (end - begin), 0.0, 1.0))
            done = float(eased(part)) * length
            heel_rad = float(self.bends[Bend.HEEL_LEFT + i]) * weight
            lift = 0.05 * min(1.0, length / 0.15) * float(np.sin(np.pi * part)) ** 2
            x = foot.x + done * float(np.cos(self.towards_rad))
            y = foot.y + done * float(np.sin(self.towards_rad))
            feet.append(Foot(x, y, 0.0, heel_rad, lift))
        return feet

    def applied(self, pose: Pose, weight: float = 1.0) -> Pose:
        """The pose with trunk and hips bent; legs and arms are left to be solved.

        Args:
            pose: A body that stands.
            weight: How much of the stretch is applied, 0 to 1.
        """
        trunk = _Trunk.of(self.bends[None] * weight)
        rotations = pose.rotations.copy()
        for name, turn in (
            ("pelvis", trunk.pelvis),
            ("spine", trunk.part),
            ("chest", trunk.part),
            ("clavicle_r", trunk.clavicle),
        ):
            rotations[INDEX[name]] = rotations[INDEX[name]] @ turn[0]
        return Pose(rotations, pose.pelvis_shift + weight * self.bends[: Bend.YAW])


@dataclass(frozen=True, slots=True, eq=False)
class _Trunk:
    """Local rotations of the trunk for a batch of bends, each (N, 3, 3)."""

    pelvis: Array
    part: Array
    """Of the spine and of the chest: each takes half."""
    clavicle: Array

    @classmethod
    def of(cls, bends: Array) -> _Trunk:
        half = bends / 2
        part = about_z(half[:, Bend.TWIST]) @ about_y(half[:, Bend.LEAN])
        return cls(
            about_z(bends[:, Bend.YAW]) @ about_y(bends[:, Bend.PITCH]),
            part @ about_x(half[:, Bend.SIDE]),
            about_x(-bends[:, Bend.SHRUG]) @ about_z(bends[:, Bend.PROTRACT]),
        )


def _bone(a: str, b: str) -> Array:
    return rest(b) - rest(a)


def _hinge(value: Array, limit: float, weight: float) -> Array:
    """A cost for what is above a limit."""
    return weight * np.maximum(0.0, value - limit)


def _costs(bends: Array, target: Array, stepping: int) -> Array:
    """Residuals of a batch of bends: (N, B) to (N, R)."""
    trunk = _Trunk.of(bends)
    pelvis = rest("pelvis") + STANDING_SHIFT + bends[:, : Bend.YAW]
    spine = pelvis + trunk.pelvis @ _bone("pelvis", "spine")
    spine_turn = trunk.pelvis @ trunk.part
    chest = spine + spine_turn @ _bone("spine", "chest")
    chest_turn = spine_turn @ trunk.part
    clavicle = chest + chest_turn @ _bone("chest", "clavicle_r")
    shoulder = clavicle + (chest_turn @ trunk.clavicle) @ _bone("clavicle_r", "upper_arm_r")
    away = np.linalg.norm(target - shoulder, axis=1)
    easy = _EASY.copy()
    # What stands on a table is reached by leaning over it; only low things make the knees bend.
    easy[Bend.UP] *= 0.2 + 0.9 * float(eased((0.8 - target[2]) / 0.6))
    costs = [
        bends / easy,
        _hinge(away, _ARM_EASY_M, 6.0)[:, None],
        _hinge(away, _ARM_MOST_M, 300.0)[:, None],
        _hinge(-away, -_ARM_LEAST_M, 40.0)[:, None],
    ]
    mass = 0.16 * pelvis + 0.14 * chest + 0.05 * (shoulder + target) / 2
    mass = mass + 0.24 * (chest + chest_turn @ np.array([0.0, 0.0, 0.13]))
    mass = mass + 0.08 * (chest + chest_turn @ np.array([0.03, 0.0, 0.38]))
    support = np.zeros((len(bends), 3))
    ahead = target * [1.0, 1.0, 0.0] / np.hypot(target[0], target[1])
    for i, side in enumerate("lr"):
        hip = pelvis + trunk.pelvis @ _bone("pelvis", f"thigh_{side}")
        step = bends[:, Bend.STEP if i == stepping else Bend.FOLLOW][:, None] * ahead
        heel = bends[:, Bend.HEEL_LEFT + i]
        foot = step + np.array([STANDING_FEET[i].x, STANDING_FEET[i].y, ANKLE_M])
        cost, knee, ankle = _leg_costs(hip, foot, heel, bends[:, Bend.PITCH])
        costs.append(cost)
        mass = mass + 0.08 * hip + 0.055 * knee + 0.03 * ankle
        support += 0.5 * foot
        support[:, 0] += 0.5 * (0.07 + 0.05 * heel)
    reach = 0.085 + (bends[:, Bend.STEP] - bends[:, Bend.FOLLOW]) / 2
    costs.append((60.0 * np.maximum(0.0, np.abs(mass[:, 0] - support[:, 0]) - reach))[:, None])
    costs.append((40.0 * np.maximum(0.0, np.abs(mass[:, 1] - support[:, 1]) - 0.07))[:, None])
    return np.concatenate(costs, axis=1)


def _leg_costs(hip: Array, foot: Array, heel: Array, pitch: Array) -> tuple[Array, Array, Array]:
    """What a leg minds, seen from the side, and where its knee and ankle are."""
    to_ball = np.array([0.13, 0.0, 0.02 - ANKLE_M])
    ankle = foot + to_ball - about_y(heel) @ to_ball
    line = hip - ankle
    length = np.linalg.norm(line, axis=1)
    cosine = (_SHIN_M**2 + length**2 - _THIGH_M**2) / (2 * _SHIN_M * np.maximum(length, 0.05))
    tilt = np.arctan2(line[:, 0], line[:, 2]) + np.arccos(np.clip(cosine, -1.0, 1.0))
    knee = ankle + _SHIN_M * np.stack([np.sin(tilt), np.zeros_like(tilt), np.cos(tilt)], axis=1)
    flexion = np.arctan2(knee[:, 0] - hip[:, 0], hip[:, 2] - knee[:, 2]) + pitch
    costs = [
        _hinge(length, 0.806, 400.0),
        _hinge(-length, -0.26, 60.0),
        _hinge(tilt - heel, _SHIN_TILT_MOST, 12.0),
        _hinge(flexion, _HIP_FLEXION_MOST, 12.0),
        _hinge(-knee[:, 2], -0.09, 60.0),
    ]
    return np.stack(costs, axis=1), knee, ankle


def _solved(target: Array, stepping: int, may_step: bool) -> tuple[Array, float]:
    """The most comfortable bends, and their cost."""
    from scipy.optimize import least_squares

    high = _HIGH.copy()
    if not may_step:
        high[Bend.STEP :] = 1e-6
    nudge = 1e-6

    def costs(bends: Array) -> Array:
        return np.asarray(_costs(bends[None], target, stepping)[0])

    def slopes(bends: Array) -> Array:
        nudges = np.vstack([np.zeros(len(bends)), nudge * np.eye(len(bends))])
        rows = _costs(bends + nudges, target, stepping)
        return np.asarray((rows[1:] - rows[0]).T / nudge)

    low = target[2] < 0.7
    start = np.clip(np.zeros(len(_LOW)) + 0.01, _LOW, high - 1e-7)
    if low:
        start[Bend.UP], start[Bend.PITCH], start[Bend.LEAN] = -0.3, 0.4, 0.4
    start = np.clip(start, _LOW + 1e-7, high - 5e-7)
    found = least_squares(
        costs, start, slopes, bounds=(_LOW, high), method="trf", max_nfev=60, xtol=1e-7
    )
    return np.asarray(found.x), float(found.cost)


_STEP_COSTS = 1.5


@lru_cache(maxsize=64)
def stretch_to(x: float, y: float, z: float) -> Stretch:
    """How to bend for the right hand to reach a target in the body frame, metres.

    The feet stay in place if that is possible with some comfort; else one steps forward, the left
    one for low targets (it leaves room for the arm beside the knee), the right one for high ones.
    """
    target = np.array([x, y, z])
    stepping = 0 if z < 0.9 else 1
    planted, strain = _solved(target, stepping, may_step=False)
    planted[Bend.STEP :] = 0.0
    towards = float(np.arctan2(y, x))
    if strain > _STEP_COSTS:
        stepped, strain_stepped = _solved(target, stepping, may_step=True)
        if strain > strain_stepped + _STEP_COSTS:
            return Stretch(stepped, stepping, towards)
    return Stretch(planted, stepping, towards)
