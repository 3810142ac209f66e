"""Taking a thing and putting it down: the body bends, the hand goes out and comes back."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np

from adamo_vh.geometry import Array
from adamo_vh.runtime.human.anatomy import eyes, grip, turned
from adamo_vh.runtime.human.clearing import (
    Depth,
    clear_left,
    clear_swing,
    clear_ways,
    held_off,
    swung,
)
from adamo_vh.runtime.human.closing import FINGER_JOINTS
from adamo_vh.runtime.human.grasp import Grip
from adamo_vh.runtime.human.ik import arm_to, hand_to
from adamo_vh.runtime.human.postures import CARRY, carrying, gazing, helping, standing
from adamo_vh.runtime.human.reach import open_hand, stretched
from adamo_vh.runtime.human.rotations import blended, eased
from adamo_vh.runtime.human.skeleton import INDEX, Pose, joint_frames
from adamo_vh.runtime.human.stretch import Bend, Stretch, stretch_to

_GRASP_S = 0.36
"""How long the hand stays at the target to close or open."""
_NEAR = (0.7, 0.85, 1.0)
"""Shares of the way at which the arm is kept out of furniture."""
_UNDERWAY = np.linspace(0.25, 0.9, 8)
"""Shares of the way at which the hand is kept out of it too."""
_IDLE = (0.4, 0.7, 1.0)
"""Shares of the way at which the left arm is."""
_MOST_TRIES = 4
"""So many detours are tried with the whole arm."""
_ENOUGH_M = 0.03
"""An arm that costs no more is out of furniture."""
_ON_THE_WAY_M = (0.88, 1.02, 1.14, 1.32)
"""Height of the hand in front of the body, on its way to 0.7, 1.0, 1.3 and 2.0 m."""
_MIRROR = np.array([1.0, -1.0, 1.0])
_ARM = [INDEX[n] for n in ("upper_arm_r", "forearm_r", "hand_r")]
_FINGERS = FINGER_JOINTS["r"]


@dataclass(frozen=True)
class Handling:
    """A reach of the right hand to a target and back, for a body that faces it."""

    target: Array
    """(3,) in the body frame, metres."""
    gaze: Array
    """(3,) direction of the gaze before and after, in the body frame."""
    takes: bool
    """Whether the hand comes back full; else it goes out full."""
    grip: Grip = field(default_factory=Grip)
    """How the hand holds the thing."""
    detour: Array = field(default_factory=lambda: np.zeros(3))
    """(3,) how far the way of the hand is bent aside in its middle, metres."""
    swing_rad: float = 0.0
    """How far the elbow is swung aside at the target; see `clearing`."""
    left_rad: tuple[float, float] = (0.0, 0.0)
    """How the left arm is held off; see `clearing.held_off`."""

    def clear(self, depth: Depth) -> Handling:
        """The same reach with its arms where they are least in what is solid.

        Args:
            depth: Of balls whose middles are in the frame of the body.
        """
        straight = [self._way(self._body(part), part, full=False) for part in _UNDERWAY]
        found: list[tuple[float, Handling]] = []
        for deep, detour in clear_ways(np.array(straight), _bulge(eased(_UNDERWAY)), depth):
            around = replace(self, detour=detour)
            moments = (around.pose(self.way_s * part) for part in _NEAR)
            swing, more = clear_swing(moments, depth)
            found.append((deep + more, replace(around, swing_rad=swing)))
            if more < _ENOUGH_M or len(found) == _MOST_TRIES:
                break
        best = min(found, key=lambda one: one[0])[1]
        if self.grip.other() is not None:
            return best
        moments = (best.pose(self.way_s * part) for part in _IDLE)
        return replace(best, left_rad=clear_left(moments, depth))

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
        high = max(0.0, float(self.target[2]) - 1.2)
        return 0.7 + 0.35 * far + 0.8 * abs(float(bends[Bend.UP])) + 0.3 * steps + 0.4 * high

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
        body = self._body(part)
        full = back == self.takes
        arm = self._arm(body, part, full)
        rotations = body.rotations.copy()
        rotations[_ARM] = arm.rotations[_ARM]
        rotations[_FINGERS] = self._fingers(time_s, part, full)
        return self._helped(Pose(rotations, body.pelvis_shift), part, full)

    def _body(self, part: float) -> Pose:
        """All of the body but the arms."""
        bend = self._bend(part)
        return self._watching(stretched(self._standing, self.stretch, bend, part), bend)

    def _helped(self, pose: Pose, part: float, full: bool) -> Pose:
        """The left hand on the thing too, if it takes both; else the left arm out of the way."""
        other = self.grip.other()
        if other is None:
            back, bend = (float(eased(part)) * angle for angle in self.left_rad)
            return held_off(pose, back, bend) if back or bend else pose
        place = grip(pose, "r", self.grip.offset) if full else self.target
        weight = 1.0 if full else float(eased((part - 0.25) / 0.75))
        turn = _between(other.home(), other.there(self.target * _MIRROR), float(eased(part)))
        return helping(pose, place, other, turn, weight)

    @staticmethod
    def _bend(part: float) -> float:
        """How far the body is bent; the hand leaves first, so that it clears the table's edge."""
        return float(eased((part - 0.07) / 0.88))

    def _watching(self, body: Pose, bend: float) -> Pose:
        """Eyes on the target, from wherever the head has come to."""
        line = self.target - eyes(body)
        line = self.gaze * (1.0 - bend) + line / np.linalg.norm(line) * bend
        return gazing(body, line, torso=1.0 - bend)

    def _arm(self, body: Pose, part: float, full: bool) -> Pose:
        """The right arm: it leaves home, and meets the target at the end of the way."""
        along = float(eased(part))
        offset = self.grip.offset
        way = self._way(body, part, full)
        turn = _between(self.grip.home(), self.grip.there(self.target), along)
        if turn is None:
            wrist = blended(np.eye(3), open_hand(float(self.target[2]))["hand_r"], along)
            solved, _ = arm_to(turned(body, {"hand_r": wrist}), way)
        else:
            solved, _ = hand_to(body, way, turn, offset)
        solved = swung(solved, self.swing_rad * along)
        if full:
            return solved
        weight = float(eased(part / 0.6))
        rotations = blended(body.rotations, solved.rotations, weight)
        return Pose(rotations, body.pelvis_shift)

    def _way(self, body: Pose, part: float, full: bool) -> Array:
        """(3,) where the hand is on its way."""
        base = self._home(full)
        # The arc is drawn for a body that stands, and goes along with the shoulder as it bends;
        # so the hand never comes too close to the shoulder.
        goal = self.target - (_shoulder(self._bent) - _shoulder(base))
        along = float(eased(part))
        start = grip(base, "r", self.grip.offset)
        way = _arc(start, goal, float(self.target[2]), along) + _bulge(along) * self.detour
        return np.asarray(way + _shoulder(body) - _shoulder(base))

    @cached_property
    def _standing(self) -> Pose:
        return standing()

    @cached_property
    def _bent(self) -> Pose:
        return stretched(self._standing, self.stretch)

    @cached_property
    def _homes(self) -> tuple[Pose, Pose]:
        empty = gazing(self._standing, self.gaze)
        return empty, carrying(empty, self.grip)

    def _home(self, full: bool) -> Pose:
        """The posture before or after, with an empty or a full hand."""
        return self._homes[1 if full else 0]

    def _fingers(self, time_s: float, part: float, full: bool) -> Array:
        """(15, 3, 3) the fingers: open before the grasp, closed around the thing."""
        closed, opened = self.grip.closed, self.grip.opened
        if part < 1.0 and full:
            return closed
        if part < 1.0:
            return blended(self._standing.rotations[_FINGERS], opened, float(eased(part / 0.7)))
        done = float(eased((time_s - self.way_s) / _GRASP_S))
        return blended(opened, closed, done if self.takes else 1.0 - done)


def _between(home: Array | None, there: Array | None, along: float) -> Array | None:
    """(3, 3) how a hand is turned on its way; None leaves it to the arm."""
    return None if home is None or there is None else blended(home, there, along)


def _shoulder(pose: Pose) -> Array:
    return np.asarray(joint_frames(pose)[0][INDEX["upper_arm_r"]])


def _bulge(along: Array | float) -> Array:
    """How much of a detour is taken at a share of the way: nothing at its ends, 0.75 halfway."""
    return np.asarray(3 * along * (1 - along))


def _arc(start: Array, goal: Array, height_m: float, along: float) -> Array:
    """A point on the way of the hand, which meets the target from the side that is free.

    Args:
        start: (3,) where the hand is at home.
        goal: (3,) where it goes, relative to a body that stands.
        height_m: Height of the target above the floor: things on the floor and on tables are met
            from above, those in shelves from the front.
        along: 0 at the start, 1 at the goal.
    """
    aside = 0.5 * (start[1] + goal[1]) - 0.06 * float(eased(height_m - 1.0))  # not past the face
    front = max(0.42, 0.45 * float(goal[0]))
    first = np.array([front, aside, np.interp(goal[2], [0.7, 1.0, 1.3, 2.0], _ON_THE_WAY_M)])
    forward = float(np.interp(height_m, [0.3, 0.8, 1.2], [0.9, 0.75, 0.55]))
    above = float(np.interp(height_m, [0.1, 0.7, 1.0, 1.2], [0.22, 0.14, 0.12, -0.02]))
    last = np.array([forward * goal[0], 0.2 * aside + 0.8 * goal[1], goal[2] + above])
    rest = 1.0 - along
    ends = rest**3 * start + along**3 * goal
    return np.asarray(ends + 3 * rest * along * (rest * first + along * last))
