"""Points, poses, boxes, outlines and the camera, in the one world frame.

World frame: right-handed, metres, X right, Y forward at yaw 90 degrees, Z up, floor at z = 0.
Angles are radians, counter-clockwise seen from above; yaw 0 faces +X. Pixels: origin top left,
u to the right, v down, pixel centres at half integers.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Plan = tuple[float, float]
"""x and y of a point seen from above."""


@dataclass(frozen=True, slots=True)
class Vec3:
    """A point or vector in metres."""

    x: float
    y: float
    z: float

    @classmethod
    def of(cls, values: Array | tuple[float, ...] | list[float]) -> Vec3:
        """Build from any sequence of three numbers."""
        x, y, z = values
        return cls(float(x), float(y), float(z))

    def array(self) -> Array:
        """The same as a (3,) float64 array."""
        return np.array([self.x, self.y, self.z])

    def __add__(self, other: Vec3) -> Vec3:
        return Vec3(self.x + other.x, self.y + other.y, self.z + other.z)

    def __sub__(self, other: Vec3) -> Vec3:
        return Vec3(self.x - other.x, self.y - other.y, self.z - other.z)

    def __mul__(self, factor: float) -> Vec3:
        return Vec3(self.x * factor, self.y * factor, self.z * factor)

    def norm(self) -> float:
        """Euclidean length in metres."""
        return math.sqrt(self.x * self.x + self.y * self.y + self.z * self.z)

    def distance(self, other: Vec3) -> float:
        """Euclidean distance in metres."""
        return (self - other).norm()

    def horizontal_distance(self, other: Vec3) -> float:
        """Distance in the floor plane in metres."""
        return math.hypot(self.x - other.x, self.y - other.y)

    def rounded(self, digits: int = 3) -> Vec3:
        """Each coordinate rounded; negative zero becomes zero."""
        return Vec3(*(round(v, digits) + 0.0 for v in (self.x, self.y, self.z)))

    def text(self, digits: int = 2, between: str = ", ") -> str:
        """The point in words: "(x, y, z)", with so many digits, and never "-0.00"."""
        return _text(self, digits, between)

    def __str__(self) -> str:
        return self.text()


@lru_cache(maxsize=4096)
def _text(point: Vec3, digits: int, between: str) -> str:
    """A point in words; most points of a room are told again in every turn."""
    # Rounding first turns -0.001 into 0.00.
    told = point.rounded(digits)
    return f"({between.join(f'{value:.{digits}f}' for value in (told.x, told.y, told.z))})"


@dataclass(frozen=True, slots=True)
class Quaternion:
    """A unit rotation quaternion, scalar first."""

    w: float = 1.0
    x: float = 0.0
    y: float = 0.0
    z: float = 0.0

    @classmethod
    def from_yaw(cls, yaw_rad: float) -> Quaternion:
        """Rotation about +Z."""
        return cls(math.cos(yaw_rad / 2), 0.0, 0.0, math.sin(yaw_rad / 2))

    def array(self) -> Array:
        """(4,) float64, scalar first, as MuJoCo has it."""
        return np.array([self.w, self.x, self.y, self.z])

    def matrix(self) -> Array:
        """(3, 3) rotation matrix, world_from_local."""
        w, x, y, z = self.w, self.x, self.y, self.z
        return np.array(
            [
                [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
                [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
                [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
            ]
        )

    @property
    def yaw_rad(self) -> float:
        """Heading of the rotated X axis, in (-pi, pi]."""
        return math.atan2(2 * (self.w * self.z + self.x * self.y), 1 - 2 * (self.y**2 + self.z**2))


@dataclass(frozen=True, slots=True)
class Box:
    """An oriented box: the local bounding box of a thing, placed in the world."""

    center: Vec3
    """Centre in the world, metres."""
    size: Vec3
    """Full edge lengths along the local axes, metres; they do not change when the thing turns."""
    orientation: Quaternion = Quaternion()
    """world_from_local rotation."""

    @property
    def volume_m3(self) -> float:
        """Volume in cubic metres; invariant under rotation."""
        return self.size.x * self.size.y * self.size.z

    def corners(self) -> Array:
        """(8, 3) corner points in the world, metres."""
        signs = np.array([[sx, sy, sz] for sx in (-1, 1) for sy in (-1, 1) for sz in (-1, 1)])
        local = signs * self.size.array() / 2
        return np.asarray(local @ self.orientation.matrix().T + self.center.array())

    @property
    def bottom_z(self) -> float:
        """Lowest z of the box, metres."""
        return float(self.corners()[:, 2].min())

    @property
    def top_z(self) -> float:
        """Highest z of the box, metres."""
        return float(self.corners()[:, 2].max())

    @property
    def radius_m(self) -> float:
        """Radius of the upright cylinder around the centre that holds the box, metres."""
        offsets = self.corners()[:, :2] - self.center.array()[:2]
        return float(np.hypot(offsets[:, 0], offsets[:, 1]).max())


@dataclass(frozen=True, slots=True)
class Solid:
    """An upright prism over an oriented rectangle: how placement and navigation see things."""

    x: float
    y: float
    half_x: float
    half_y: float
    yaw_rad: float
    z_min: float
    z_max: float

    @classmethod
    def around(cls, box: Box) -> Solid:
        """The prism that holds an oriented box, aligned with its heading."""
        yaw = box.orientation.yaw_rad
        cos, sin = math.cos(yaw), math.sin(yaw)
        corners = box.corners()
        offset = corners[:, :2] - [box.center.x, box.center.y]
        along, across = offset @ [cos, sin], offset @ [-sin, cos]
        return cls(
            box.center.x,
            box.center.y,
            float(np.abs(along).max()),
            float(np.abs(across).max()),
            yaw,
            float(corners[:, 2].min()),
            float(corners[:, 2].max()),
        )

    def distance(self, points: Array) -> Array:
        """Horizontal distance of points from the rectangle; 0 inside.

        Args:
            points: (N, 2) metres.

        Returns:
            (N,) metres.
        """
        cos, sin = math.cos(self.yaw_rad), math.sin(self.yaw_rad)
        offset = points - np.array([self.x, self.y])
        along = np.abs(offset @ [cos, sin]) - self.half_x
        across = np.abs(offset @ [-sin, cos]) - self.half_y
        return np.asarray(np.hypot(np.maximum(along, 0), np.maximum(across, 0)))

    def overlaps_height(self, z_min: float, z_max: float) -> bool:
        """Whether the height ranges share more than 2 mm, or half of what is thinner than 4 mm."""
        shared = min(self.z_max, z_max) - max(self.z_min, z_min)
        return shared > min(0.002, (self.z_max - self.z_min) / 2, (z_max - z_min) / 2)

    @property
    def radius_m(self) -> float:
        """Radius of the upright cylinder around the centre that holds the prism, metres."""
        return math.hypot(self.half_x, self.half_y)


@dataclass(frozen=True, slots=True)
class Camera:
    """A pinhole camera without roll."""

    position: Vec3
    """Optical centre, world metres."""
    yaw_rad: float
    """Heading of the optical axis."""
    pitch_rad: float
    """Elevation of the optical axis; positive looks up."""
    fov_y_rad: float
    """Vertical field of view."""
    width_px: int
    height_px: int

    @classmethod
    def towards(
        cls,
        eyes: Vec3,
        point: Vec3,
        fov_y_rad: float,
        size_px: tuple[int, int],
        yaw_rad: float = 0.0,
    ) -> Camera:
        """A camera at the eyes with a point in the middle of its picture.

        Args:
            eyes: Optical centre, metres.
            point: What it is aimed at, metres.
            fov_y_rad: Vertical field of view.
            size_px: Width and height of the picture.
            yaw_rad: Its heading where the point is straight above or below.
        """
        line = point - eyes
        flat = math.hypot(line.x, line.y)
        yaw = math.atan2(line.y, line.x) if flat > 1e-6 else yaw_rad
        return cls(eyes, yaw, math.atan2(line.z, flat), fov_y_rad, *size_px)

    @property
    def focal_px(self) -> float:
        """Focal length in pixels (square pixels, principal point in the middle)."""
        return self.height_px / 2 / math.tan(self.fov_y_rad / 2)

    @property
    def world_from_camera(self) -> Array:
        """(3, 3) rotation whose columns are the camera's right, down and forward in the world."""
        cy, sy = math.cos(self.yaw_rad), math.sin(self.yaw_rad)
        cp, sp = math.cos(self.pitch_rad), math.sin(self.pitch_rad)
        right, down, forward = (sy, -cy, 0.0), (cy * sp, sy * sp, -cp), (cy * cp, sy * cp, sp)
        return np.array([right, down, forward]).T

    def project(self, points: Array) -> Array:
        """Project world points.

        Args:
            points: (N, 3) world metres.

        Returns:
            (N, 3): u and v in pixels and the depth along the optical axis in metres. Points
            behind the camera have a depth <= 0 and meaningless pixels.
        """
        local = (np.asarray(points) - self.position.array()) @ self.world_from_camera
        depth = local[:, 2]
        safe = np.where(np.abs(depth) < 1e-9, 1e-9, depth)
        u = self.width_px / 2 + self.focal_px * local[:, 0] / safe
        v = self.height_px / 2 + self.focal_px * local[:, 1] / safe
        return np.stack([u, v, depth], axis=1)

    def rays(self, pixels: Array) -> Array:
        """Unit directions in the world through pixels.

        Args:
            pixels: (N, 2) u and v.

        Returns:
            (N, 3) unit vectors.
        """
        pixels = np.asarray(pixels)
        local = np.stack(
            [
                (pixels[:, 0] - self.width_px / 2) / self.focal_px,
                (pixels[:, 1] - self.height_px / 2) / self.focal_px,
                np.ones(len(pixels)),
            ],
            axis=1,
        )
        world = local @ self.world_from_camera.T
        return np.asarray(world / np.linalg.norm(world, axis=1, keepdims=True))


def wrap_angle(angle_rad: float) -> float:
    """The same angle in (-pi, pi]."""
    return math.pi - (math.pi - angle_rad) % (2 * math.pi)


def gaps(candidates: Array, shape: Solid, obstacles: Sequence[Solid]) -> Array:
    """How far a rectangle stays from obstacles when its centre is put at each candidate.

    The separating axis test on both rectangles' axes: positive values are lower bounds of the gap,
    negative ones mean overlap.

    Args:
        candidates: (N, 2) centres in metres.
        shape: The rectangle to place; its own position does not matter.
        obstacles: What to stay clear of.

    Returns:
        (N,) metres; infinity where there are no obstacles.
    """
    smallest = np.full(len(candidates), np.inf)
    own = _heading_axes(shape.yaw_rad)
    for other in obstacles:
        theirs = _heading_axes(other.yaw_rad)
        axes = np.concatenate([own, theirs])
        extent = np.abs(axes @ own.T) @ [shape.half_x, shape.half_y]
        extent = extent + np.abs(axes @ theirs.T) @ [other.half_x, other.half_y]
        offset = candidates - np.array([other.x, other.y])
        apart = (np.abs(offset @ axes.T) - extent).max(axis=1)
        smallest = np.minimum(smallest, apart)
    return smallest


def _heading_axes(yaw_rad: float) -> Array:
    cos, sin = math.cos(yaw_rad), math.sin(yaw_rad)
    return np.array([[cos, sin], [-sin, cos]])


def hull(points: Iterable[Plan]) -> list[Plan]:
    """Convex hull of points of a plane by monotone chains.

    Returns:
        Its corners, counter-clockwise where x goes right and y up; all points, if they are on one
        line.
    """
    ordered = sorted(set(points))

    def chain(way: Iterable[Plan]) -> list[Plan]:
        kept: list[Plan] = []
        for point in way:
            while len(kept) > 1 and _turn(kept[-2], kept[-1], point) <= 0:
                kept.pop()
            kept.append(point)
        return kept[:-1]

    return [*chain(ordered), *chain(reversed(ordered))] or ordered


def _turn(a: Plan, b: Plan, c: Plan) -> float:
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
