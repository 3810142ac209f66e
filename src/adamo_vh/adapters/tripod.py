"""Where a film's camera stands: the figure in view, her face rather than her back, nothing between.

It stands still and pans; it goes elsewhere when something has come between it and the figure, when
she turns her back to it, or when she has gone too far or come too near.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from adamo_vh.geometry import Array, Camera, Vec3
from adamo_vh.session.filming import FilmSet

FOV_RAD = math.radians(62.0)
_WALL_M = 0.35
_HEIGHTS_M = (1.6, 2.0)
_DISTANCES_M = (2.6, 2.1, 3.2)
_ANGLES_DEG = (45, -45, 25, -25, 70, -70, 100, -100, 140, -140)
_LEAST_M, _MOST_M = 1.5, 4.2
_NEAR_M = 0.9
"""Nothing but the figure should be so near to the lens."""
_BODY_M = 0.3
"""A ray that goes so near to the body has met it, not what stands beside it."""
_BAD, _BETTER = 0.55, 0.25
"""Rating from which another place is looked for, and how much better that must be."""
_LOOKS_EVERY = 6
_SHORT_M = 1.2
"""So far the camera glides; a place further away is shown after a cut."""
_GLIDE, _PAN = 0.1, 0.22
"""Share of the way that the camera and its aim go in each picture."""
_CLOSER_LOOKS = 10


class Tripod:
    """The camera of one film."""

    def __init__(self, film_set: FilmSet, size_px: tuple[int, int]) -> None:
        """Stand nowhere yet.

        Args:
            film_set: What is filmed.
            size_px: Width and height of the picture.
        """
        self._set = film_set
        self._size_px = size_px
        self._at: Vec3 | None = None
        self._goal: Vec3 | None = None
        self._aim = Vec3(0.0, 0.0, 1.0)
        self._count = 0

    def camera(self) -> Camera:
        """The next picture's."""
        points = self._figure()
        aim = Vec3.of(np.mean(points[:3], axis=0))
        if self._at is None or self._goal is None:
            self._at = self._goal = self._chosen(points)
            self._aim = aim
        elif self._count % _LOOKS_EVERY == 0:
            self._look_round(self._at, points, aim)
        self._count += 1
        self._at = self._at + (self._goal - self._at) * _GLIDE
        self._aim = self._aim + (aim - self._aim) * _PAN
        return self._from(self._at, self._aim)

    def _from(self, place: Vec3, aim: Vec3) -> Camera:
        return Camera.towards(place, aim, FOV_RAD, self._size_px)

    def _look_round(self, at: Vec3, points: Array, aim: Vec3) -> None:
        """Stay, glide or cut."""
        now = self.rating(at, points)
        if now < _BAD:
            return
        goal = self._chosen(points)
        if self.rating(goal, points) > now - _BETTER:
            return
        self._goal = goal
        middle = (at + goal) * 0.5
        is_clear = self.rating(middle, points) < max(now, 1.0)
        if at.distance(goal) > _SHORT_M or not is_clear:
            self._at, self._aim = goal, aim

    def _figure(self) -> Array:
        """(5, 3) places of the figure that should be seen: eyes, trunk, hips, knees, hand."""
        body, eyes, hand = self._set.figure()
        x, y = body.position.x, body.position.y
        middle = 0.5 * (eyes.z + 0.35)
        return np.array(
            [
                eyes.array(),
                [(x + eyes.x) / 2, (y + eyes.y) / 2, middle + 0.25],
                [x, y, middle],
                [x, y, 0.45],
                hand.array(),
            ]
        )

    def _chosen(self, points: Array) -> Vec3:
        """The best place for a camera now."""
        scene, body = self._set.scene, self._set.body()
        at = body.position
        places = []
        for distance in _DISTANCES_M:
            for degrees in _ANGLES_DEG:
                angle = body.heading_rad + math.radians(degrees)
                x = at.x + distance * math.cos(angle)
                y = at.y + distance * math.sin(angle)
                x = min(max(x, scene.x_min + _WALL_M), scene.x_max - _WALL_M)
                y = min(max(y, scene.y_min + _WALL_M), scene.y_max - _WALL_M)
                places += [Vec3(x, y, height) for height in _HEIGHTS_M]
        first = sorted(places, key=lambda place: self._hidden(place, points) + self._odd(place))
        return min(first[:_CLOSER_LOOKS], key=lambda place: self.rating(place, points))

    def rating(self, place: Vec3, points: Array) -> float:
        """How bad a place is for the camera; 0 is as good as can be.

        Args:
            place: In the room.
            points: (5, 3) of the figure.
        """
        return self._hidden(place, points) + self._cluttered(place, points) + self._odd(place)

    def _hidden(self, place: Vec3, points: Array) -> float:
        """How much of the figure is behind something."""
        lines = points - place.array()
        far = np.linalg.norm(lines, axis=1)
        met = self._met(place, lines / np.maximum(far, 1e-9)[:, None])
        hidden = met < far - _BODY_M
        return float(hidden @ [1.6, 1.2, 0.7, 0.3, 0.8])

    def _cluttered(self, place: Vec3, points: Array) -> float:
        """How much of the picture is full of what is near."""
        camera = self._from(place, Vec3.of(points[:3].mean(axis=0)))
        up, side = np.meshgrid(np.linspace(-0.9, 0.9, 7), np.linspace(-0.9, 0.9, 9), indexing="ij")
        tall = math.tan(camera.fov_y_rad / 2)
        wide = tall * camera.width_px / camera.height_px
        local = np.stack([wide * side, -tall * up, np.ones_like(up)], axis=-1).reshape(-1, 3)
        lines = local @ camera.world_from_camera.T
        met = self._met(place, lines / np.linalg.norm(lines, axis=1, keepdims=True))
        return 6.0 * float((met < _NEAR_M).mean())

    def _odd(self, place: Vec3) -> float:
        """How unusual a place is: behind her, or too near or far."""
        body = self._set.body()
        line = place - body.position
        far = math.hypot(line.x, line.y)
        angle = math.atan2(line.y, line.x) - body.heading_rad
        behind = max(0.0, -math.cos(angle) + 0.2)
        off = max(0.0, _LEAST_M - far) * 2.0 + max(0.0, far - _MOST_M)
        return 0.5 * behind + off + 0.05 * abs(far - _DISTANCES_M[0])

    def _met(self, place: Vec3, directions: Array) -> Array:
        """(N,) how far rays go; infinite where they meet nothing."""
        ends: Sequence[Vec3 | None] = self._set.rays(place, directions)
        return np.array([math.inf if end is None else end.distance(place) for end in ends])
