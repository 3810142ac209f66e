"""Taking a thing and putting it down: the body bends, the hand goes out and comes back."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from adamo.geometry import Array, Vec3
from adamo.runtime.human.anatomy import eyes, grip, turned
from adamo.runtime.human.ik import arm_to
from adamo.runtime.human.postures import CARRY, gazing, holding, standing
from adamo.runtime.human.reach import open_hand, stretched
from adamo.runtime.human.rotations import blended, eased
from adamo.runtime.human.skeleton import INDEX, Pose
from adamo.runtime.human.stretch import Bend, Stretch, stretch_to

_GRASP_S = 0.36
"""How long the hand stays at the target to close or open."""
_ARM = [INDEX[n] for n in ("upper_arm_r", "forearm_r")]
_HAND = [INDEX[n] for n in ("hand_r", "fingers_r")]


@dataclass(frozen=True)
class Handling:
    """A reach of the right hand to a target and back, for a body that faces it."""

    target: Array
    """(3,) in the body frame, metres."""
    gaze: Array
    """(3,) direction of the gaze before and after, in the body frame."""
    takes: bool
    """Whether the hand comes back full; else it goes out full."""
    size: Vec3 | None = None
    """Edge lengths of the thing."""

    @cached_property
    def stretch(self) -> Stretch:
        """How the body bends for it."""
        return stretch_to(*(float(v) for v in self.target))

    @cached_property
    def way_s(self) -> float:
        """Time for the way out, and for the way back."""
        bends = self.stretch.bends
        steps = float(np.count_nonzero(bends[[Bend.STEP, Bend.FOLLOW]] > 0.01))
        far = float(np.linalg.norm(self.target - CARRY))
        return 0.7 + 0.35 * far + 0.8 * abs(float(bends[Bend.UP])) + 0.3 * steps

    @property
    def event_s(self) -> float:
        """When the hand grasps or lets go."""
        return self.way_s + _GRASP_S / 2

    @property
    def duration_s(self) -> float:
        """From standing to standing."""
        return 2 * self.way_s + _GRASP_S

    def pose(self, time_s: float) -> Pose:
        """The posture at a time, in the body frame."""
        back = time_s > self.event_s
        # Linear progress of the way: 0 at home, 1 at the target.
        part = min(1.0, (self.duration_s - time_s if back else time_s) / self.way_s)
        bend = float(eased(part / 0.92))
        body = stretched(standing(), self.stretch, bend, part)
        body = self._watching(body, bend)
        full = back == self.takes
        arm = self._arm(body, part, full)
        rotations = body.rotations.copy()
        rotations[_ARM] = arm.rotations[_ARM]
        rotations[_HAND] = self._hand(time_s, part, full)
        return Pose(rotations, body.pelvis_shift)

    def _watching(self, body: Pose, bend: float) -> Pose:
        """Eyes on the target, from wherever the head has come to."""
        line = self.target - eyes(body)
        line = self.gaze * (1.0 - bend) + line / np.linalg.norm(line) * bend
        return gazing(body, line, torso=1.0 - bend)

    def _arm(self, body: Pose, part: float, full: bool) -> Pose:
        """The right arm: it leaves home, and meets the target at the end of the way."""
        along = float(eased((part - 0.08) / 0.92))
        start = CARRY if full else self._relaxed_grip
        way = _arc(start, self.target, along)
        solved, _ = arm_to(turned(body, open_hand()), way)
        if full:
            return solved
        weight = float(eased(part / 0.6))
        rotations = blended(body.rotations, solved.rotations, weight)
        return Pose(rotations, body.pelvis_shift)

    @cached_property
    def _relaxed_grip(self) -> Array:
        return grip(standing())

    def _hand(self, time_s: float, part: float, full: bool) -> Array:
        """Local rotations of hand and fingers: open before the grasp, closed around the thing."""
        relaxed, closed = standing(), turned(standing(), holding(self.size))
        opened = turned(standing(), open_hand())
        if part < 1.0 and full:
            return closed.rotations[_HAND]
        if part < 1.0:
            weight = float(eased(part / 0.7))
            return blended(relaxed.rotations[_HAND], opened.rotations[_HAND], weight)
        done = float(eased((time_s - self.way_s) / _GRASP_S))
        closing = done if self.takes else 1.0 - done
        return blended(opened.rotations[_HAND], closed.rotations[_HAND], closing)


def _arc(start: Array, target: Array, along: float) -> Array:
    """A point on the way of the hand, which meets the target from the side that is free.

    Things on the floor and on tables are met from above, those in shelves from the front.
    """
    height = float(target[2])
    forward = float(np.interp(height, [0.3, 0.8, 1.2], [0.8, 0.6, 0.5]))
    above = float(np.interp(height, [0.1, 0.7, 1.0, 1.2], [0.30, 0.16, 0.14, -0.03]))
    middle = np.array([forward * target[0], 0.4 * start[1] + 0.6 * target[1], height + above])
    rest = 1.0 - along
    return np.asarray(rest * rest * start + 2 * rest * along * middle + along * along * target)
