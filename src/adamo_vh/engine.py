"""What any 3D engine must offer to carry an agent, and the world's state as plain data.

An engine knows bodies and physics. It knows nothing of tags, prompts, models or tasks. The built-in
one is `adamo_vh.runtime.builtin.BuiltinEngine`; others follow the same protocol.
"""

from __future__ import annotations

import hashlib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Protocol

from adamo_vh.action import Outcome
from adamo_vh.geometry import Array, Box, Vec3
from adamo_vh.observation import BodyState, Percept

FLOOR = "floor"
"""Name of the floor as a support."""


def object_support(object_id: int) -> str:
    """Name of an interactable object as a support."""
    return f"object {object_id}"


def supporting_object(support: str) -> int | None:
    """Id of the object that a support name means, or None for furniture and floor."""
    kind, _, number = support.partition(" ")
    return int(number) if kind == "object" and number.isdigit() else None


@dataclass(frozen=True, slots=True)
class Area:
    """A named rectangle on the floor."""

    name: str
    kind: str
    """What it is, e.g. "corner"."""
    x_min: float
    y_min: float
    x_max: float
    y_max: float


@dataclass(frozen=True, slots=True)
class SceneInfo:
    """What is public about a scene: its name, extent and named floor areas."""

    name: str
    x_min: float
    y_min: float
    x_max: float
    y_max: float
    height_m: float
    areas: tuple[Area, ...]

    def contains(self, point: Vec3, margin_m: float = 0.05) -> bool:
        """Whether a point is in the room, up to a margin."""
        between = -margin_m <= point.z <= self.height_m + margin_m
        return between and self.is_within_walls(point, margin_m)

    def is_within_walls(self, point: Vec3, margin_m: float) -> bool:
        """Whether a point is between the walls, up to a margin; a negative one keeps off them."""
        return (
            self.x_min - margin_m <= point.x <= self.x_max + margin_m
            and self.y_min - margin_m <= point.y <= self.y_max + margin_m
        )


@dataclass(frozen=True, slots=True)
class ObjectState:
    """One interactable object, as the simulator knows it."""

    id: int
    class_name: str
    box: Box
    support: str | None
    """What it rests on: furniture ("table", "shelf/top"), "floor", or another object (see
    `object_support`); None if held or in the air."""
    held: bool


@dataclass(frozen=True, slots=True)
class FurnitureOutline:
    """A piece of furniture, which never moves, seen from above."""

    name: str
    points: tuple[tuple[float, float], ...]
    """Corners of its convex outline, x and y in metres, counter-clockwise."""
    bottom_m: float
    """Height of its lowest point: a lamp may hang over a table."""
    top_m: float


@dataclass(frozen=True, slots=True)
class WorldState:
    """The whole truth. Privileged: for checkers, oracles, diagnosis and snapshots only."""

    scene: SceneInfo
    objects: tuple[ObjectState, ...]
    """Ordered by id."""
    body: BodyState
    furniture: tuple[FurnitureOutline, ...] = ()
    """For drawings of the room; no part of the hash. May be empty: not every engine knows."""

    def object(self, object_id: int) -> ObjectState:
        """The object with an id.

        Raises:
            KeyError: No such object.
        """
        for item in self.objects:
            if item.id == object_id:
                return item
        raise KeyError(object_id)

    def hash(self) -> str:
        """Hex digest over all poses, rounded to 0.1 mm and 0.001 rad."""
        lines = [self.scene.name]
        for item in self.objects:
            q = item.box.orientation
            sign = -1.0 if (q.w, q.x, q.y, q.z) < (0.0, 0.0, 0.0, 0.0) else 1.0
            turn = [_rounded(v * sign, 3) for v in (q.w, q.x, q.y, q.z)]
            lines.append(f"{item.id} {_point(item.box.center)} {turn} {item.support} {item.held}")
        body = self.body
        lines.append(f"body {_point(body.position)} {_rounded(body.heading_rad, 3)}")
        lines.append(f"eyes {_point(body.eyes)} gaze {_point(body.gaze)} held {body.held}")
        return hashlib.sha256("\n".join(lines).encode()).hexdigest()


def _rounded(value: float, digits: int) -> float:
    return round(value, digits) + 0.0


def _point(point: Vec3) -> list[float]:
    return [_rounded(v, 4) for v in (point.x, point.y, point.z)]


@dataclass(frozen=True, slots=True)
class BodyReport:
    """How a body primitive went, as data; the action server turns it into a sentence."""

    outcome: Outcome
    code: str
    point: Vec3 | None = None
    """Where the body stopped (walk_to), what the eyes look at (look_at), or where the centre of the
    object's box came to rest (drop). If refused as unreachable, the nearest place to stand."""
    support: str | None = None
    """What the dropped object rests on."""
    walked_m: float = 0.0
    """Length of the path that the body walked."""


class Engine(Protocol):
    """A 3D world with one body in it."""

    @property
    def scene(self) -> SceneInfo:
        """Name, extent and areas of the loaded scene."""
        ...

    @property
    def object_names(self) -> Mapping[int, str]:
        """Class of every interactable object, by id; labelings make tags of it."""
        ...

    def reset(self, seed: int) -> None:
        """Put the world and the body back to their start. Same seed, same world."""
        ...

    def capture(self, width_px: int, height_px: int) -> Percept:
        """See the room through the body's eyes."""
        ...

    def closeup(
        self, point: Vec3, vertical_fov_rad: float, width_px: int, height_px: int
    ) -> Percept:
        """See a part of the room larger, from the same eyes through a narrower angle.

        Body and gaze stay as they are; the picture is centred on the point.
        """
        ...

    def raycast(self, origin: Vec3, directions: Array) -> Sequence[Vec3 | None]:
        """First hits of rays from a point; own body and held object are ignored.

        Args:
            origin: Start of all rays, metres.
            directions: (N, 3) unit vectors.

        Returns:
            One point, or None where nothing was hit, for each direction.
        """
        ...

    def body(self) -> BodyState:
        """The body now."""
        ...

    def look_at(self, point: Vec3) -> BodyReport:
        """Turn body and gaze to a point."""
        ...

    def walk_to(self, point: Vec3) -> BodyReport:
        """Walk to the reachable place that is nearest to a point."""
        ...

    def pick(self, object_id: int) -> BodyReport:
        """Take an object into the hand, walking closer if needed."""
        ...

    def drop(self, point: Vec3) -> BodyReport:
        """Put the held object down at a point, walking closer if needed."""
        ...

    def say(self, text: str) -> None:
        """Deliver the agent's final answer through the body."""
        ...

    def state(self) -> WorldState:
        """The whole truth, as plain data."""
        ...

    def snapshot(self) -> bytes:
        """Everything that decides what happens next: world, body, what it holds."""
        ...

    def restore(self, snapshot: bytes) -> None:
        """Go back to a snapshot, also of another process; the same calls give the same states.

        Raises:
            EngineError: It is damaged or belongs to another scene.
        """
        ...

    def close(self) -> None:
        """Free graphics and memory; the engine cannot be used afterwards."""
        ...
