"""Motions as sampled clips, for skinned models in other programs."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from adamo_vh.geometry import Array, Vec3
from adamo_vh.runtime.human.gait import STEP_S, gait
from adamo_vh.runtime.human.handling import Handling
from adamo_vh.runtime.human.postures import BREATH_S, blink, gazing, standing
from adamo_vh.runtime.human.route import route
from adamo_vh.runtime.human.skeleton import REST, Pose

_AHEAD = np.array([1.0, 0.0, 0.0])
_ON_TABLE = np.array([0.55, -0.10, 0.85])


@dataclass(frozen=True, slots=True, eq=False)
class Clip:
    """A sampled motion on the spot; played in a loop it does not jump."""

    name: str
    times_s: Array
    """(T,) from 0 on."""
    rotations: Array
    """(T, J, 3, 3) rotation of each joint relative to its parent, in the order of `JOINTS`."""
    pelvis: Array
    """(T, 3) place of the pelvis in the body frame, metres."""


def _sampled(name: str, duration_s: float, rate_hz: float, pose: Callable[[float], Pose]) -> Clip:
    times = np.linspace(0.0, duration_s, round(duration_s * rate_hz) + 1)
    poses = [pose(float(t)) for t in times]
    return Clip(
        name,
        times,
        np.stack([p.rotations for p in poses]),
        np.stack([REST[0] + p.pelvis_shift for p in poses]),
    )


def walk_clip(rate_hz: float = 30.0) -> Clip:
    """One cycle of two steps at full speed, 1.2 metres, without moving from the spot."""
    steps = gait(route(0.0, [Vec3(0.0, 0.0, 0.0), Vec3(9.0, 0.0, 0.0)], 0.0))
    begin = steps.duration_s / 2
    return _sampled("walk", 2 * STEP_S, rate_hz, lambda t: gazing(steps.pose(begin + t), _AHEAD))


def reach_clip(rate_hz: float = 30.0) -> Clip:
    """Right hand out to a place on a table and back."""
    hand = Handling(_ON_TABLE, _AHEAD, takes=True)
    turn = hand.way_s
    return _sampled(
        "reach", 2 * turn, rate_hz, lambda t: hand.pose(t if t <= turn else 2 * turn - t)
    )


def idle_clip(rate_hz: float = 30.0) -> Clip:
    """Three breaths and some blinks of a body that stands."""
    return _sampled("idle", 3 * BREATH_S, rate_hz, lambda t: gazing(standing(t), _AHEAD, blink(t)))


def clips(rate_hz: float = 30.0) -> tuple[Clip, ...]:
    """All clips."""
    return walk_clip(rate_hz), reach_clip(rate_hz), idle_clip(rate_hz)
