"""Actions as motion: what the body does between one state and the next, over simulated time.

The engine's logic decides the states; a motion only shows how the body gets from one to the other.
It is a pure function of time, so frames in between can be asked for in any order or left out, and
it ends exactly in the given state. Stopped halfway, it says what state the body is then in.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from typing import Literal

import numpy as np

from adamo_vh.geometry import Array, Vec3, wrap_angle
from adamo_vh.runtime.embodiment import Stance
from adamo_vh.runtime.human.anatomy import eyes, grip
from adamo_vh.runtime.human.clearing import Depth
from adamo_vh.runtime.human.face import MOST_LOOK_RAD
from adamo_vh.runtime.human.gait import Gait, gait
from adamo_vh.runtime.human.grasp import Grip, Thing
from adamo_vh.runtime.human.handling import Handling
from adamo_vh.runtime.human.ik import arm_to
from adamo_vh.runtime.human.postures import (
    at_rest,
    blink,
    breath,
    breathing,
    carrying,
    gazing,
    helping,
    line_of_gaze,
)
from adamo_vh.runtime.human.rotations import about_z, eased
from adamo_vh.runtime.human.route import route
from adamo_vh.runtime.human.skeleton import INDEX, Pose, joint_frames
from adamo_vh.runtime.navigation import Path

_HEAD = INDEX["head"]
_GAZE_RAD_S = 5.0
_GAZE_LEAST_S = 0.35
_LEAD_S = 0.45
"""How far ahead of the body the gaze is in a turn."""
_PATH_PITCH_RAD = math.radians(-11.0)
"""Someone who walks looks at the floor some metres ahead."""


@dataclass(frozen=True, slots=True)
class BodyFrame:
    """The body at one moment."""

    body: Stance
    """The state the body would be in if the motion stopped now."""
    pose: Pose
    """In the frame of the body: origin at `body.position`, X along `body.heading_rad`."""
    grip: Grip = field(default_factory=Grip)
    """How the right hand holds what it holds."""

    def joints(self) -> tuple[Array, Array]:
        """World places (J, 3) and rotations (J, 3, 3) of the joints."""
        places, rotations = joint_frames(self.pose)
        turn = about_z(self.body.heading_rad)
        return places @ turn.T + self.body.position.array(), turn @ rotations

    def _in_world(self, place: Array) -> Vec3:
        turn = about_z(self.body.heading_rad)
        return Vec3.of(turn @ place + self.body.position.array())

    @property
    def hand(self) -> Vec3:
        """World place of the middle of a held thing: in the right hand."""
        return self._in_world(grip(self.pose, "r", self.grip.offset))

    def with_hand_at(self, place: Vec3) -> BodyFrame:
        """The same moment, but the right arm is bent or turned so that the hand is at a place."""
        turn = about_z(-self.body.heading_rad)
        local = turn @ (place - self.body.position).array()
        pose, _ = arm_to(self.pose, local, "r", self.grip.offset)
        other = self.grip.other()
        pose = pose if other is None else helping(pose, local, other)
        return replace(self, pose=pose)

    @property
    def eyes(self) -> Vec3:
        """World place of the figure's eyes, which move with trunk and head."""
        return self._in_world(eyes(self.pose))

    @property
    def look_rad(self) -> tuple[float, float]:
        """How the eyes are turned in the head to look at the gaze: to the left, and down."""
        line = (self.body.gaze - self.eyes).array()
        turn = self.joints()[1][_HEAD]
        x, y, z = turn.T @ line / max(float(np.linalg.norm(line)), 1e-6)
        # What is behind her, her eyes do not follow: they would have to jump from side to side.
        ahead = float(np.clip(0.5 + x, 0.0, 1.0))
        left, down = ahead * math.asin(np.clip(y, -1, 1)), ahead * math.asin(np.clip(-z, -1, 1))
        most = MOST_LOOK_RAD
        return min(max(left, -most), most), min(max(down, -most), most)


@dataclass(frozen=True, slots=True)
class Event:
    """The moment from which a thing is in the hand, or no longer."""

    time_s: float
    kind: Literal["grasp", "release"]


@dataclass(frozen=True, slots=True)
class Motion:
    """The way from one state of the body to another."""

    start: Stance
    end: Stance
    duration_s: float
    inside: Callable[[float], BodyFrame]
    """The frame at a time strictly between start and end."""
    events: tuple[Event, ...] = ()
    thing: Thing | None = None
    """What is held at the start or the end."""

    def at(self, time_s: float) -> BodyFrame:
        """The frame at a time; the ends hold before the start and after the end."""
        if time_s >= self.duration_s:
            return idle(self.end, 0.0, self.thing)
        if time_s <= 0.0:
            return idle(self.start, 0.0, self.thing)
        return self.inside(time_s)

    def body_at(self, time_s: float) -> Stance:
        """The state in which a motion cancelled at a time leaves the body, feet together."""
        if time_s >= self.duration_s:
            return self.end
        return self.at(time_s).body

    def then(self, other: Motion) -> Motion:
        """This motion and then another one.

        Raises:
            ValueError: The other motion does not start where this one ends.
        """
        if other.start != self.end:
            raise ValueError("a motion must start in the state in which the one before it ends")
        until = self.duration_s

        def inside(time_s: float) -> BodyFrame:
            return self.at(time_s) if time_s < until else other.at(time_s - until)

        later = tuple(Event(e.time_s + until, e.kind) for e in other.events)
        thing = self.thing if self.thing is not None else other.thing
        events = self.events + later
        return Motion(self.start, other.end, until + other.duration_s, inside, events, thing)


def idle(body: Stance, time_s: float, thing: Thing | None = None) -> BodyFrame:
    """A body that stands and waits: it breathes and blinks, and its state does not change."""
    return BodyFrame(body, at_rest(body, thing, time_s), _grip(body, thing))


def _grip(body: Stance, thing: Thing | None) -> Grip:
    return Grip.of(None if body.held is None else thing, body.heading_rad)


def look_motion(start: Stance, end: Stance, thing: Thing | None = None) -> Motion:
    """Look somewhere else, turning on the spot if the end says so; the gaze goes ahead.

    Args:
        start: The state before.
        end: The state after, at the same place.
        thing: What is held, if known.
    """
    steps = gait(route(start.heading_rad, [start.position], end.heading_rad))
    (yaw0, pitch0, far0), (yaw1, pitch1, far1) = _gaze(start), _gaze(end)
    turn = float(steps.route.stands[-1, 2] - steps.route.stands[0, 2])
    change = turn + yaw1 - yaw0
    angle = math.hypot(change, pitch1 - pitch0)
    settling = 0.0 if angle < 1e-9 else _GAZE_LEAST_S + angle / _GAZE_RAD_S
    duration = max(steps.duration_s, settling)

    def gaze(time_s: float, heading_rad: float) -> tuple[float, float, float]:
        part = float(eased(time_s / settling)) if settling else 1.0
        yaw = start.heading_rad + yaw0 + change * part - heading_rad
        return yaw, pitch0 + (pitch1 - pitch0) * part, far0 + (far1 - far0) * part

    return _on_foot(start, end, steps, duration, gaze, thing)


def walk_motion(start: Stance, path: Path, end: Stance, thing: Thing | None = None) -> Motion:
    """Walk along a path, eyes on the way, arms swinging unless one carries something.

    Args:
        start: The state before, at the first point of the path.
        path: Corners of the way.
        end: The state after, at the last point of the path.
        thing: What is held, if known.
    """
    points = [start.position, *path.points[1:-1], end.position]
    steps = gait(route(start.heading_rad, points, end.heading_rad))
    duration = steps.duration_s
    (yaw0, pitch0, far0), (yaw1, pitch1, far1) = _gaze(start), _gaze(end)
    ends_s = max(1e-9, min(0.6, duration / 2))

    def gaze(time_s: float, heading_rad: float) -> tuple[float, float, float]:
        leave = 1.0 - float(eased(time_s / ends_s))
        arrive = float(eased(1.0 - (duration - time_s) / ends_s))
        way = 1.0 - leave - arrive
        lead = steps.stand(time_s + _LEAD_S).heading_rad - heading_rad
        yaw = yaw0 * leave + yaw1 * arrive + lead * (1.0 - arrive) * (1.0 - leave)
        pitch = pitch0 * leave + pitch1 * arrive + _PATH_PITCH_RAD * way
        return yaw, pitch, far0 + (far1 - far0) * float(eased(time_s / duration))

    return _on_foot(start, end, steps, duration, gaze, thing)


def pick_motion(
    start: Stance,
    end: Stance,
    target: Vec3,
    thing: Thing | None = None,
    depth: Depth | None = None,
) -> Motion:
    """Turn to a thing, reach for it, take it and bring it in front of the body.

    Args:
        start: The state before, with an empty hand.
        end: The state after, facing the target and holding it.
        target: Where the hand takes it, in the world; within reach from `end.position`.
        thing: Its outline, if known.
        depth: How deep balls in the world are in furniture, which the arm is to keep out of.
    """
    return _handle((start, end), target, thing, "grasp", depth)


def drop_motion(
    start: Stance,
    end: Stance,
    target: Vec3,
    thing: Thing | None = None,
    depth: Depth | None = None,
) -> Motion:
    """Turn to a spot, put the held thing there and let the arm hang.

    Args:
        start: The state before, with something in the hand.
        end: The state after, facing the spot, with an empty hand.
        target: Where the middle of the thing comes to, in the world.
        thing: Its outline, if known.
        depth: How deep balls in the world are in furniture, which the arm is to keep out of.
    """
    return _handle((start, end), target, thing, "release", depth)


def _handle(
    stances: tuple[Stance, Stance],
    target: Vec3,
    thing: Thing | None,
    kind: Literal["grasp", "release"],
    depth: Depth | None,
) -> Motion:
    start, end = stances
    facing = replace(end, held=start.held)
    local = about_z(-end.heading_rad) @ (target - end.position).array()
    held = Grip.of(thing, end.heading_rad)
    hand = Handling(local, line_of_gaze(end), takes=kind == "grasp", grip=held)
    if depth is not None:
        place, turn = end.position.array(), about_z(end.heading_rad).T
        hand = hand.clear(lambda middles, radius_m: depth(middles @ turn + place, radius_m))

    def inside(time_s: float) -> BodyFrame:
        body = end if time_s >= hand.event_s - 1e-9 else facing
        return BodyFrame(body, hand.pose(time_s), held)

    event = Event(hand.event_s, kind)
    act = Motion(facing, end, hand.duration_s, inside, (event,), thing)
    return look_motion(start, facing, thing).then(act)


def _gaze(body: Stance) -> tuple[float, float, float]:
    """Yaw (relative to the heading), pitch and distance of the gaze."""
    line = line_of_gaze(body)
    pitch = math.atan2(line[2], math.hypot(line[0], line[1]))
    flat = math.hypot(line[0], line[1]) > 1e-6
    yaw = math.atan2(line[1], line[0]) if flat else 0.0
    return yaw, pitch, body.gaze.distance(body.eyes)


def _on_foot(
    start: Stance,
    end: Stance,
    steps: Gait,
    duration_s: float,
    gaze: Callable[[float, float], tuple[float, float, float]],
    thing: Thing | None,
) -> Motion:
    """A motion of the legs, with a gaze that goes its own way."""

    def inside(time_s: float) -> BodyFrame:
        stand = steps.stand(time_s)
        yaw, pitch, far = gaze(time_s, stand.heading_rad)
        yaw = min(max(yaw, -math.radians(150.0)), math.radians(150.0))
        body = Stance(
            Vec3(stand.x, stand.y, start.position.z),
            wrap_angle(stand.heading_rad),
            start.gaze,
            start.held,
        )
        flat = math.cos(pitch)
        line = np.array([flat * math.cos(yaw), flat * math.sin(yaw), math.sin(pitch)])
        ahead = Vec3.of(about_z(stand.heading_rad) @ line) * far
        body = replace(body, gaze=body.eyes + ahead)
        near_end = min(1.0, (duration_s - time_s) / 0.5)
        pose = breathing(steps.pose(time_s), breath(time_s) * float(eased(near_end)))
        pose = gazing(pose, line, blink(time_s) * float(eased(3 * near_end)))
        if body.held is None:
            return BodyFrame(body, pose)
        held = _grip(body, thing)
        return BodyFrame(body, carrying(pose, held), held)

    return Motion(start, end, duration_s, inside, (), thing)
