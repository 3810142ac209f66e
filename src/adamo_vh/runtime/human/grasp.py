"""Which way a hand holds a thing, by the thing's size: how it is turned and where it touches.

Things keep their own turn in the hand, as they do in the world, so the hand goes to where their
sides are. What is large is held with both hands, for the eye alone: nothing else knows of it.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum, auto
from functools import cached_property
from itertools import pairwise

import numpy as np

from adamo_vh.geometry import Array
from adamo_vh.runtime.human.anatomy import GRIP
from adamo_vh.runtime.human.closing import (
    MOST_GAP_M,
    OPPOSED,
    PALM_M,
    around,
    flat,
    mirrored_shape,
    opened,
    pinch_middle,
    pinching,
    round_middle,
    under,
)
from adamo_vh.runtime.human.hand import AXES
from adamo_vh.runtime.human.rotations import about_z

_FLIP = np.array([1.0, -1.0, 1.0])
_DIRECTIONS, _SLICES = 48, 8
_LARGE_M, _WIDE_M = 0.15, 0.28
"""Thinnest side from which on both hands hold something; and something flat."""
_FLAT_M = 0.06
_BESIDE_M = 0.004
"""Corners so near to a slice belong to it too."""
_LEAST_WRAP_M, _MOST_PINCH_M = (0.08, 0.03), 0.07
"""Least height and thickness of what a hand is closed around; most thickness between tips."""


@dataclass(frozen=True, slots=True, eq=False)
class Thing:
    """The outline of a thing, from its middle, slice by slice."""

    edges: Array
    """(S + 1,) heights of the slices, metres."""
    reach: Array
    """(S, D) how far it reaches in directions that go round once, from +X to the left."""

    @classmethod
    def around(cls, points: Array) -> Thing:
        """The outline of (N, 3) points, from the thing's middle."""
        edges = np.linspace(points[:, 2].min(), points[:, 2].max() + 1e-6, _SLICES + 1)
        turns = 2 * np.pi * np.arange(_DIRECTIONS) / _DIRECTIONS
        along = points[:, :2] @ np.stack([np.cos(turns), np.sin(turns)])
        rows = []
        for low, high in pairwise(edges):
            # A slice without corners of its own is as wide as its neighbours.
            near = (points[:, 2] >= low - _BESIDE_M) & (points[:, 2] <= high + _BESIDE_M)
            rows.append(along[near].max(axis=0) if near.any() else along.max(axis=0))
        return cls(edges, np.stack(rows))

    @classmethod
    def box(cls, x: float, y: float, z: float) -> Thing:
        """The outline of a box of these edges."""
        signs = np.stack(np.meshgrid(*[[-0.5, 0.5]] * 3), axis=-1).reshape(-1, 3)
        levels = np.linspace(-0.5, 0.5, 4 * _SLICES)
        corners = np.concatenate([signs * [1, 1, 0] + [0, 0, level] for level in levels])
        return cls.around(corners * [x, y, z])

    def seen_from(self, heading_rad: float) -> Thing:
        """The same in the frame of a body with some heading."""
        places = np.arange(_DIRECTIONS) + heading_rad / (2 * np.pi) * _DIRECTIONS
        low = np.floor(places).astype(int)
        share = places - low
        row = self.reach
        turned = row[:, low % _DIRECTIONS] * (1 - share) + row[:, (low + 1) % _DIRECTIONS] * share
        return Thing(self.edges, turned)

    def mirrored(self) -> Thing:
        """Left and right exchanged."""
        return Thing(self.edges, self.reach[:, -np.arange(_DIRECTIONS)])

    @property
    def height(self) -> float:
        """From bottom to top, metres."""
        return float(self.edges[-1] - self.edges[0])

    def side(self, direction: Array, at_m: float, band_m: float = 0.03) -> float:
        """How far it reaches in a direction (its first two numbers) around a height."""
        place = np.arctan2(direction[1], direction[0]) / (2 * np.pi) * _DIRECTIONS
        low = int(np.floor(place))
        share = place - low
        near = (self.edges[1:] > at_m - band_m) & (self.edges[:-1] < at_m + band_m)
        row = self.reach[near].max(axis=0) if near.any() else self.reach.max(axis=0)
        return float(row[low % _DIRECTIONS] * (1 - share) + row[(low + 1) % _DIRECTIONS] * share)

    def widths(self) -> tuple[float, float]:
        """Its least and largest width, metres."""
        whole = self.reach.max(axis=0)
        both = whole + np.roll(whole, _DIRECTIONS // 2)
        return float(both.min()), float(both.max())


class Way(Enum):
    """How a thing is held."""

    UNKNOWN = auto()
    """Its size is not known: a hand that is half closed."""
    ROUND = auto()
    """Fingers around it, thumb up."""
    TIPS = auto()
    """Between the tips of thumb and fingers, from above."""
    RIM = auto()
    """By its rim, fingers below."""
    BOTH = auto()
    """Between two palms."""
    TRAY = auto()
    """By its rim, with both hands."""

    @property
    def is_two_handed(self) -> bool:
        """Whether the second hand helps."""
        return self in (Way.BOTH, Way.TRAY)


def way_of(thing: Thing) -> Way:
    """How a thing is held, by its size."""
    thin, _ = thing.widths()
    is_flat = thing.height < _FLAT_M
    if thin > (_WIDE_M if is_flat else _LARGE_M):
        return Way.TRAY if is_flat else Way.BOTH
    high, thick = _LEAST_WRAP_M
    if thing.height >= high and thin >= thick:
        return Way.ROUND
    return Way.TIPS if thin <= _MOST_PINCH_M else Way.RIM


_HOME = {
    Way.ROUND: ((0.93, 0.34, -0.10), (0.0, 0.0, 1.0)),
    Way.TIPS: ((0.78, 0.30, -0.55), (0.1, 0.62, 0.60)),
    Way.RIM: ((0.95, 0.20, -0.24), (0.1, -0.85, 0.30)),
    Way.BOTH: ((0.94, -0.26, -0.22), (0.0, 0.0, 1.0)),
    Way.TRAY: ((0.93, 0.35, -0.24), (0.1, -0.85, 0.30)),
}
"""Where a right hand that carries points, and its thumb, in the body frame."""
_THERE = {
    Way.ROUND: ((0.95, 0.15, 0.0), (0.0, 0.0, 1.0)),
    Way.TIPS: ((0.84, 0.20, 0.0), (0.1, 0.62, 0.60)),
    Way.RIM: ((0.95, 0.20, 0.0), (0.1, -0.85, 0.30)),
    Way.BOTH: ((0.95, -0.20, 0.0), (0.0, 0.0, 1.0)),
    Way.TRAY: ((0.93, 0.35, 0.0), (0.1, -0.85, 0.30)),
}
"""The same at the target, in a frame whose first axis goes there; the pitch is by its height."""


@dataclass(frozen=True)
class Grip:
    """How a right hand holds a thing, in the frame of a body."""

    way: Way = Way.UNKNOWN
    thing: Thing | None = None
    """Its outline in the frame of the body."""

    @classmethod
    def of(cls, thing: Thing | None, heading_rad: float) -> Grip:
        """The way to hold a thing of the world.

        Args:
            thing: Its outline with the axes of the world; None if unknown.
            heading_rad: Of the body.
        """
        if thing is None:
            return cls()
        return cls(way_of(thing), thing.seen_from(heading_rad))

    def home(self) -> Array | None:
        """(3, 3) how the hand is turned when it carries; None leaves it to the arm."""
        return None if self.thing is None else _turn(*_HOME[self.way])

    def there(self, target: Array) -> Array | None:
        """(3, 3) how the hand is turned when it is at a target, (3,) in the body frame."""
        if self.thing is None:
            return None
        (x, y, _), thumb = _THERE[self.way]
        low, high = (-0.75, -0.25) if self.way is Way.TIPS else (-0.25, 0.0)
        pitch = float(np.interp(target[2], [0.8, 1.4], [low, high]))
        yaw = float(np.arctan2(target[1], max(0.15, target[0])))
        return about_z(yaw) @ _turn((x, y, pitch), thumb)

    @cached_property
    def offset(self) -> Array:
        """(3,) from the wrist to the thing's middle, in the frame of the joint `hand_r`."""
        thing, turn = self.thing, self.home()
        if thing is None or turn is None:
            return GRIP["r"]
        along, _, palm = (turn @ row for row in AXES["r"])
        up = turn.T @ np.array([0.0, 0.0, 1.0])
        lift = 0.0
        match self.way:
            case Way.ROUND:
                place = round_middle(self._radius_m)
                place[2] = PALM_M + thing.side(-palm, 0.0)
            case Way.TIPS:
                place, lift = pinch_middle(self._gap_m), -max(0.0, thing.height / 2 - 0.022)
            case Way.RIM | Way.TRAY:
                # The rim lies on the fingers' roots, and the thing is level however the hand is.
                ahead = along * [1.0, 1.0, 0.0] / np.hypot(along[0], along[1])
                place = np.array([0.085, 0.0, PALM_M])
                place += (AXES["r"] @ turn.T @ ahead) * thing.side(-along, 0.0, thing.height)
                lift = 0.004 - float(thing.edges[0])
            case _:
                lift = self._low_m
                place = np.array([0.072, 0.0, PALM_M + thing.side(-palm, -lift)])
        return np.asarray(place @ AXES["r"] + lift * up)

    @property
    def _low_m(self) -> float:
        """How far below its middle something large is held."""
        height = self.thing.height if self.thing else 0.0
        return max(0.0, 0.30 * height - 0.02)

    @property
    def _radius_m(self) -> float:
        assert self.thing is not None
        _, _, palm = (_turn(*_HOME[self.way]) @ row for row in AXES["r"])
        return float(np.clip(self.thing.side(-palm, 0.0), 0.008, 0.058))

    @property
    def _gap_m(self) -> float:
        assert self.thing is not None
        turn = _turn(*_HOME[self.way])
        across = turn @ (OPPOSED @ AXES["r"])
        width = self.thing.side(across, 0.0) + self.thing.side(-across, 0.0)
        return float(np.clip(width, 0.003, MOST_GAP_M))

    @cached_property
    def closed(self) -> Array:
        """(15, 3, 3) the right hand's fingers around it."""
        return mirrored_shape(self._fingers())

    @cached_property
    def opened(self) -> Array:
        """(15, 3, 3) the right hand's fingers a moment before and after."""
        return mirrored_shape(opened(self._fingers()))

    def _fingers(self) -> Array:
        match self.way:
            case Way.UNKNOWN:
                return around(20)
            case Way.ROUND:
                return around(round(self._radius_m * 1000))
            case Way.TIPS:
                return pinching(round(self._gap_m * 1000))
            case Way.RIM | Way.TRAY:
                return under(round(1000 * (self.thing.height if self.thing else 0.0)))
            case _:
                return flat()

    def other(self) -> Grip | None:
        """How the left hand helps, as a right hand in the mirror; None if it need not."""
        if self.thing is None or not self.way.is_two_handed:
            return None
        return Grip(self.way, self.thing.mirrored())


def _turn(along: tuple[float, ...], thumb: tuple[float, ...]) -> Array:
    """(3, 3) the turn of a right hand that points somewhere, its thumb towards something else."""
    a = np.array(along) / np.linalg.norm(along)
    b = np.array(thumb) - a * float(a @ np.array(thumb))
    b /= np.linalg.norm(b)
    return np.asarray(np.stack([a, b, np.cross(b, a)], axis=1) @ AXES["r"])
