"""Walking and turning: steps planned along a route, legs solved to planted feet.

Time is counted in steps. While one foot swings, the other stays where it is in the world, so feet
cannot slide; where the body's axis is, the route says.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from adamo_vh.geometry import Array
from adamo_vh.runtime.human.anatomy import turned
from adamo_vh.runtime.human.ik import LEG_M, STANDING_FEET, Foot, plant_feet
from adamo_vh.runtime.human.postures import SLACK_M, STANDING_SHIFT, arms_at_ease, fingers_at_ease
from adamo_vh.runtime.human.rotations import about_x, about_y, about_z, eased
from adamo_vh.runtime.human.route import TURN_M, Route, Stand
from adamo_vh.runtime.human.skeleton import REST, Pose

STEP_S = 0.5
STEP_M = 0.60
"""Length of a full step: 1.2 m/s."""
_RAMP = 1.3
"""Steps in which the body gathers speed, and loses it again."""
_LIFT, _LAND = 0.1, 0.9
"""The part of a step in which its foot is in the air."""
_PRELUDE = 0.35
"""Steps before the first one, in which its heel comes up."""
_STANCE = 2.0 - (_LAND - _LIFT)
_SLIDE_M = 0.045
"""A route this short (a turn of 4 degrees) is done without lifting a foot."""
_HALF_WIDTH_M = (0.10, 0.065)
"""Sideways distance of a foot from the axis: standing, walking."""
_HIP_M = float(REST[0, 2]) - 0.04


@dataclass(frozen=True, slots=True)
class Landing:
    """A foot on the floor, in the world."""

    lifts: float
    """When it started to get here, in steps; minus infinity for where it stood at first."""
    x: float
    y: float
    yaw_rad: float
    length: float
    """Length of the step that led here, as a share of a full step."""

    @property
    def lands(self) -> float:
        """When it touched the floor."""
        return self.lifts + _LAND - _LIFT


@dataclass(frozen=True, slots=True, eq=False)
class Gait:
    """A walk along a route: the axis, the feet and the posture at every moment."""

    route: Route
    steps: int
    """How many steps are taken; 0 for none."""
    landings: tuple[tuple[Landing, ...], tuple[Landing, ...]]
    """Of the left and the right foot, in the order of time."""

    @property
    def duration_s(self) -> float:
        """Time from standing to standing."""
        if self.steps == 0:
            return 0.25 if self.route.length_m > 0 else 0.0
        return (self.steps + _PRELUDE) * STEP_S

    def stand(self, time_s: float) -> Stand:
        """Where the axis is."""
        if self.steps == 0:
            part = float(eased(time_s / 0.25))
            return self.route.at(part * self.route.length_m)
        return self.route.at(_travelled(self._phase(time_s), self.steps, self.route.length_m))

    def pose(self, time_s: float) -> Pose:
        """The posture, in the frame of `stand`; head straight, arms swinging."""
        phase = self._phase(time_s)
        if self.steps == 0 or not -_PRELUDE < phase < self.steps:
            pose = Pose(pelvis_shift=STANDING_SHIFT)
            pose = plant_feet(turned(pose, arms_at_ease()), STANDING_FEET)[0]
            return fingers_at_ease(pose)
        here = self.stand(time_s)
        feet = [_in_body(_foot(track, phase), here) for track in self.landings]
        stride = self._stride(phase)
        return _posture(feet, phase, stride, self._favours_left(), self._presence(phase))

    def _phase(self, time_s: float) -> float:
        """Time in steps; the first one begins at 0."""
        return time_s / STEP_S - _PRELUDE

    def _presence(self, phase: float) -> float:
        """0 at both ends, 1 from a step after the start to half a step before the end."""
        return float(eased(phase / 0.6) * eased((self.steps - phase) / 0.6))

    def _favours_left(self) -> bool:
        return self.landings[0][1].lifts < self.landings[1][1].lifts

    def _stride(self, phase: float) -> float:
        """Length of the steps around a moment, as a share of a full step."""
        a, b = (
            self.route.walked(_travelled(p, self.steps, self.route.length_m))
            for p in (phase - 0.5, phase + 0.5)
        )
        return (b - a) / STEP_M

    def feet(self, time_s: float) -> list[Foot]:
        """Left and right foot in the world."""
        return [_foot(track, self._phase(time_s)) for track in self.landings]


def gait(way: Route) -> Gait:
    """Plan the steps along a route."""
    length = way.length_m
    start = way.at(0.0)
    first = tuple(_placed(start, i, -np.inf, 1.0, 0.0) for i in range(2))
    if length < _SLIDE_M and way.walked(length) < 0.003:
        return Gait(way, 0, ((first[0],), (first[1],)))
    steps = max(2, int(np.ceil(length / STEP_M + 0.5 + _RAMP - 1e-9)))
    tracks = [[first[0]], [first[1]]]
    # The foot on the inner side of a turn goes first, so that the legs do not cross.
    left_first = way.at(TURN_M * 0.6).heading_rad > start.heading_rad + 0.05
    for step in range(steps):
        foot = (step + (0 if left_first else 1)) % 2
        middle = _travelled(step + _LAND + _STANCE / 2, steps, length)
        before = _travelled(step + _LAND + _STANCE / 2 - 2.0, steps, length)
        share = (way.walked(middle) - way.walked(before)) / (2 * STEP_M)
        standing = 1.0 - float(np.clip(share, 0.0, 1.0)) if step < steps - 2 else 1.0
        tracks[foot].append(_placed(way.at(middle), foot, step + _LIFT, standing, share))
    return Gait(way, steps, (tuple(tracks[0]), tuple(tracks[1])))


def _travelled(phase: float, steps: int, length_m: float) -> float:
    """Length of the route behind the axis after some steps; it stops half a step early."""
    last = steps - 0.5
    ramp = min(_RAMP, last / 2)
    x = float(np.clip(phase, 0.0, last))

    def gathered(t: float) -> float:
        return t / 2 - ramp * float(np.sin(np.pi * t / ramp)) / (2 * np.pi)

    full = last - ramp
    done = gathered(min(x, ramp)) + max(0.0, min(x, last - ramp) - ramp)
    done += ramp / 2 - gathered(last - max(x, last - ramp))
    return length_m * done / full


def _placed(stand: Stand, foot: int, lifts: float, standing: float, share: float) -> Landing:
    """Put a foot beside the axis."""
    wide, narrow = _HALF_WIDTH_M
    side = (narrow + (wide - narrow) * standing) * (1.0 if foot == 0 else -1.0)
    back = STANDING_FEET[foot].x
    cos, sin = np.cos(stand.heading_rad), np.sin(stand.heading_rad)
    x, y = stand.x + cos * back - sin * side, stand.y + sin * back + cos * side
    return Landing(lifts, float(x), float(y), stand.heading_rad, share)


def _foot(track: tuple[Landing, ...], phase: float) -> Foot:
    """A foot in the world at a moment."""
    now = max(i for i, landing in enumerate(track) if landing.lifts <= phase)
    here = track[now]
    if phase < here.lands:
        return _swinging(track[now - 1], here, (phase - here.lifts) / (_LAND - _LIFT))
    pitch = 0.0
    if here.length > 0:
        pitch -= _strike(here) * (1.0 - float(eased((phase - here.lands) / 0.22)))
    if now + 1 < len(track):
        left = track[now + 1].lifts - phase
        rise = 0.62 if now > 0 or track[1].lifts > 1.0 else _PRELUDE + _LIFT
        pitch += _push(track[now + 1]) * float(eased(1.0 - left / rise))
    return Foot(here.x, here.y, here.yaw_rad, pitch)


def _strike(landing: Landing) -> float:
    return float(np.radians(17.0) * min(1.0, max(0.0, landing.length)) ** 1.5)


def _push(landing: Landing) -> float:
    return float(np.radians(10.0 + 32.0 * min(1.0, max(0.0, landing.length))))


def _swinging(a: Landing, b: Landing, part: float) -> Foot:
    """A foot in the air, between two landings; `part` from 0 to 1."""
    way = float(0.35 * eased(part) + 0.65 * (part * part * (3 - 2 * part)))
    length = min(1.0, max(0.0, b.length))
    lift = (0.035 + 0.025 * length) * float(np.sin(np.pi * part**0.8)) ** 2
    push, strike = _push(b), _strike(b)
    pitch = push * (1.0 - float(eased(part / 0.75))) - strike * float(eased((part - 0.35) / 0.65))
    return Foot(
        a.x + (b.x - a.x) * way,
        a.y + (b.y - a.y) * way,
        a.yaw_rad + (b.yaw_rad - a.yaw_rad) * float(eased(part)),
        pitch,
        lift,
    )


def _in_body(foot: Foot, here: Stand) -> Foot:
    """A foot of the world in the frame of a stand."""
    cos, sin = float(np.cos(here.heading_rad)), float(np.sin(here.heading_rad))
    dx, dy = foot.x - here.x, foot.y - here.y
    yaw = foot.yaw_rad - here.heading_rad
    return Foot(cos * dx + sin * dy, cos * dy - sin * dx, yaw, foot.pitch_rad, foot.lift_m)


def _posture(
    feet: list[Foot], phase: float, stride: float, left_first: bool, presence: float
) -> Pose:
    """Pelvis, trunk and arms that go with the feet.

    Args:
        feet: Left and right, in the body frame.
        phase: Time in steps.
        stride: Length of the steps, as a share of a full one.
        left_first: Which foot takes the even steps.
        presence: How much of the walking is there, at the start and the end.
    """
    size = min(1.0, stride) * presence
    # +1 in the middle of a step of the left foot, -1 in the middle of one of the right.
    side = (1.0 if left_first else -1.0) * float(np.sin(np.pi * phase)) * presence
    # +1 when the left foot is in front, on the floor; -1 when the right one is.
    front = (-1.0 if left_first else 1.0) * float(np.cos(np.pi * phase)) * size
    sway = -(0.018 + 0.008 * size) * side
    drop = SLACK_M + size * (0.012 + 0.014 * float(np.cos(2 * np.pi * phase)))
    shift = np.array([-0.008 + 0.012 * size, sway, -drop])
    shift[2] = _lowered(shift, feet, presence)
    yaw, list_rad = -np.radians(5.0) * front, -np.radians(2.5) * side * (0.4 + 0.6 * size)
    joints = arms_at_ease((-np.radians(21.0) * front, np.radians(21.0) * front))
    joints["pelvis"] = about_z(yaw) @ about_x(list_rad) @ about_y(np.radians(1.5) * size)
    counter = about_z(-yaw * 0.9) @ about_x(-list_rad * 0.5)
    joints["spine"] = counter @ about_y(np.radians(1.5) * size)
    joints["chest"] = counter
    pose, _ = plant_feet(turned(Pose(pelvis_shift=shift), joints), feet)
    return fingers_at_ease(pose)


def _lowered(shift: Array, feet: list[Foot], presence: float) -> float:
    """Height of the pelvis at which no leg is overstretched: the lowest wish, softly."""
    heights = [shift[2]]
    for side, foot in zip((0.09, -0.09), feet, strict=True):
        ankle, _ = foot.ankle()
        across = float(np.hypot(ankle[0] - shift[0], ankle[1] - shift[1] - side))
        most = 0.998 * LEG_M
        up = float(np.sqrt(max(0.01, most**2 - across**2)))
        heights.append(float(ankle[2]) + up - _HIP_M)
    soft = 0.005
    low = float(min(heights))
    together = low - soft * float(np.log(sum(np.exp(-(h - low) / soft) for h in heights)))
    return float(shift[2]) + (together - float(shift[2])) * presence
