"""The stance of the body: where it stands, where it looks, what it holds.

This is the state that actions decide. How the figure looks in it, and on the way from one state to
the next, is the matter of `human.motion`.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

from adamo_vh.geometry import Box, Camera, Vec3, wrap_angle
from adamo_vh.observation import BodyState

EYE_HEIGHT_M = 1.6
EYE_FORWARD_M = 0.08
FOV_Y_RAD = math.radians(74.0)
"""What the eyes see vertically: enough for both barrels of the binoculars in the first view of S2,
which stand 53 degrees left of the gaze; labels of print on the tables stay readable."""
REACH_M = 0.9
"""Largest horizontal distance of a target from the body's axis."""
REACH_TOP_M = 2.07
"""Highest point that the hand reaches."""
MAX_PITCH_RAD = math.radians(80.0)


@dataclass(frozen=True, slots=True)
class Stance:
    """How the body stands; every change makes a new one."""

    position: Vec3
    heading_rad: float
    gaze: Vec3
    held: int | None = None

    @property
    def eyes(self) -> Vec3:
        """World position of the eyes."""
        return self._in_world(Vec3(EYE_FORWARD_M, 0.0, EYE_HEIGHT_M))

    def _in_world(self, local: Vec3) -> Vec3:
        cos, sin = math.cos(self.heading_rad), math.sin(self.heading_rad)
        return Vec3(
            self.position.x + cos * local.x - sin * local.y,
            self.position.y + sin * local.x + cos * local.y,
            self.position.z + local.z,
        )

    def state(self, held_box: Box | None = None) -> BodyState:
        """The plain data that others see; the box is that of what the hand holds."""
        held = self.held
        return BodyState(self.position, self.heading_rad, self.gaze, self.eyes, held, held_box)

    def facing(self, point: Vec3) -> tuple[Stance, bool]:
        """Turn to a point, with the torso and then the eyes.

        Returns:
            The new pose, and whether the neck could turn all the way. Where it could not, `gaze`
            is the nearest point that can be looked at from here, at the same distance.
        """
        offset = point - self.position
        flat = math.hypot(offset.x, offset.y)
        heading = math.atan2(offset.y, offset.x) if flat > 0.05 else self.heading_rad
        turned = replace(self, heading_rad=wrap_angle(heading))
        eyes = turned.eyes
        ahead = math.hypot(point.x - eyes.x, point.y - eyes.y)
        # A point between axis and eyes lies behind the eyes: they can only look down at it.
        ahead = ahead if flat > EYE_FORWARD_M else 0.0
        pitch = math.atan2(point.z - eyes.z, ahead)
        if abs(pitch) <= MAX_PITCH_RAD:
            return replace(turned, gaze=point), True
        distance = max(0.3, point.distance(eyes))
        pitch = math.copysign(MAX_PITCH_RAD, pitch)
        return replace(turned, gaze=eyes + _direction(turned.heading_rad, pitch) * distance), False

    def walked(self, end: Vec3, heading_rad: float) -> Stance:
        """Stand at the end of a way, looking straight ahead."""
        moved = replace(self, position=end, heading_rad=wrap_angle(heading_rad))
        return replace(moved, gaze=moved.eyes + _direction(moved.heading_rad, 0.0))

    def camera(self, width_px: int, height_px: int) -> Camera:
        """The view through the eyes."""
        return self.camera_to(self.gaze, FOV_Y_RAD, width_px, height_px)

    def camera_to(
        self, point: Vec3, vertical_fov_rad: float, width_px: int, height_px: int
    ) -> Camera:
        """A view from the eyes, centred on a point, whatever the gaze is."""
        size_px = (width_px, height_px)
        return Camera.towards(self.eyes, point, vertical_fov_rad, size_px, self.heading_rad)


def _direction(yaw_rad: float, pitch_rad: float) -> Vec3:
    return Vec3(
        math.cos(yaw_rad) * math.cos(pitch_rad),
        math.sin(yaw_rad) * math.cos(pitch_rad),
        math.sin(pitch_rad),
    )
