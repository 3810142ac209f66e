"""What any 3D engine must offer to carry an agent, and the world's state as plain data.

An engine is a `World` with one `Body` or several in it. It knows bodies and physics, and nothing of
tags, prompts, models or tasks. The built-in one is `adamo_vh.runtime.builtin.BuiltinEngine`; others
follow the same two protocols, and `adamo-vh conformance` tells what they lack.
"""

from __future__ import annotations

import hashlib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import Literal, Protocol

from adamo_vh.action import Outcome
from adamo_vh.errors import EngineError
from adamo_vh.geometry import Array, Box, Vec3
from adamo_vh.observation import BodyState, Percept

FLOOR = "floor"
"""Name of the floor as a support."""


MOST_VARIATIONS = 999_999
"""Largest number of a variation."""


def named(scene: str, variation: int) -> str:
    """A scene with its variation, as people read it: "s1", "s1 variation 7"."""
    return f"{scene} variation {variation}" if variation else scene


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
    """What is public about a scene: its name, origin, extent and named floor areas."""

    name: str
    x_min: float
    y_min: float
    x_max: float
    y_max: float
    height_m: float
    areas: tuple[Area, ...]
    source: str = ""
    """Where it comes from: "built-in", the path of a file, or what an engine says of itself."""
    digest: str = ""
    """Digest over all that decides how it starts and looks: furniture, objects, lights, figure.
    Empty if the engine does not say; two scenes with the same digest give the same episode."""
    variation: int = 0
    """Which variation of the scene it is; 0 is the scene as it stands."""

    @property
    def full_name(self) -> str:
        """Its name, with the variation that it is."""
        return named(self.name, self.variation)

    def nearest(self, point: Vec3) -> Vec3:
        """The point of the room that is nearest to a point: itself, if it is inside."""
        return Vec3(
            min(max(point.x, self.x_min), self.x_max),
            min(max(point.y, self.y_min), self.y_max),
            min(max(point.z, 0.0), self.height_m),
        )

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
class WorldSurface:
    """A horizontal rectangle in the world that carries things."""

    support: str
    """Name that feedback and states use: "table", "shelf/top", "floor"."""
    center: Vec3
    half_x: float
    half_y: float
    yaw_rad: float


@dataclass(frozen=True, slots=True)
class FurnitureOutline:
    """A piece of furniture, which never moves, seen from above."""

    name: str
    points: tuple[tuple[float, float], ...]
    """Corners of its convex outline, x and y in metres, counter-clockwise."""
    bottom_m: float
    """Height of its lowest point: a lamp may hang over a table."""
    top_m: float
    surfaces: tuple[WorldSurface, ...] = ()
    """What it carries things on."""


@dataclass(frozen=True, slots=True)
class WorldState:
    """The whole truth. Privileged: for checkers, oracles, diagnosis and snapshots only."""

    scene: SceneInfo
    objects: tuple[ObjectState, ...]
    """Ordered by id."""
    body: BodyState
    furniture: tuple[FurnitureOutline, ...] = ()
    """For drawings and oracles; no part of the hash. May be empty: not every engine knows."""

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
        lines = [self.scene.full_name]
        for item in self.objects:
            lines.append(f"{item.id} {_pose(item.box)} {item.support} {item.held}")
        body = self.body
        lines.append(f"body {_point(body.position)} {_rounded(3, body.heading_rad)[0]}")
        lines.append(f"eyes {_point(body.eyes)} gaze {_point(body.gaze)} held {body.held}")
        return hashlib.sha256("\n".join(lines).encode()).hexdigest()


@lru_cache(maxsize=1024)
def _pose(box: Box) -> str:
    """Where a box is, for the hash; most are where they were a step ago."""
    q = box.orientation
    sign = -1.0 if (q.w, q.x, q.y, q.z) < (0.0, 0.0, 0.0, 0.0) else 1.0
    turn = _rounded(3, q.w * sign, q.x * sign, q.y * sign, q.z * sign)
    return f"{_point(box.center)} {turn}"


def _rounded(digits: int, *values: float) -> list[float]:
    # Equal numbers of any type are spelt alike.
    return [float(round(value, digits)) + 0.0 for value in values]


def _point(point: Vec3) -> list[float]:
    return _rounded(4, point.x, point.y, point.z)


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
    stopped_s: float | None = None
    """Simulated seconds of motion after which it was stopped on request; None if it was not."""


@dataclass(frozen=True, slots=True)
class BodyInfo:
    """What is always true of a body: who it is, how large, and how far it reaches."""

    figure: str
    """Who it looks like, e.g. "mara"."""
    radius_m: float
    """Free floor that it needs around its axis."""
    eye_height_m: float
    fov_y_rad: float
    """Vertical field of view of its eyes."""
    reach_m: float
    """Largest horizontal distance of its axis from what it handles."""
    reach_top_m: float
    """Highest point that its hand reaches."""
    correction_m: float
    """How far from the wished point it may put a thing down; nothing free nearer is a refusal."""


@dataclass(frozen=True, slots=True)
class ObjectMoved:
    """Somebody else puts an object down elsewhere: at the free place nearest to a point."""

    object_id: int
    point: Vec3
    type: Literal["object_moved"] = "object_moved"


@dataclass(frozen=True, slots=True)
class ObjectTaken:
    """Somebody else takes an object out of the room."""

    object_id: int
    type: Literal["object_taken"] = "object_taken"


@dataclass(frozen=True, slots=True)
class ObjectAdded:
    """Somebody else brings an object in, and puts it at the free place nearest to a point."""

    object_id: int
    point: Vec3
    type: Literal["object_added"] = "object_added"


@dataclass(frozen=True, slots=True)
class LightChanged:
    """A light of the scene becomes brighter or darker."""

    light: int
    """Its number in the scene, from 0."""
    diffuse: float
    """How bright it is then, 0 (off) to 1."""
    type: Literal["light_changed"] = "light_changed"


WorldEvent = ObjectMoved | ObjectTaken | ObjectAdded | LightChanged
"""What happens to a world without its bodies; `type` tells them apart in a record."""


class Body(Protocol):
    """One body in a world: what it senses and what it can do.

    Nothing here tells more than the body can know: what leads to the model goes through it.
    """

    @property
    def info(self) -> BodyInfo:
        """What is always true of it."""
        ...

    def state(self) -> BodyState:
        """Where it stands and looks now, and what it feels in its hand."""
        ...

    def see(self, width_px: int, height_px: int) -> Percept:
        """See the room through its eyes."""
        ...

    def closeup(
        self, point: Vec3, vertical_fov_rad: float, width_px: int, height_px: int
    ) -> Percept:
        """See a part of the room larger, from the same eyes through a narrower angle.

        Body and gaze stay as they are; the picture is centred on the point.
        """
        ...

    def rays(self, origin: Vec3, directions: Array) -> Sequence[Vec3 | None]:
        """First hits of rays from a point; the body itself and what it holds are ignored.

        Args:
            origin: Start of all rays, metres.
            directions: (N, 3) unit vectors.

        Returns:
            One point, or None where nothing was hit, for each direction.
        """
        ...

    def look(self, point: Vec3) -> BodyReport:
        """Turn body and gaze to a point."""
        ...

    def walk(self, point: Vec3) -> BodyReport:
        """Walk to the reachable place that is nearest to a point."""
        ...

    def pick(self, object_id: int) -> BodyReport:
        """Take an object into the hand, walking closer if needed."""
        ...

    def drop(self, point: Vec3) -> BodyReport:
        """Put the held object down at a point, walking closer if needed."""
        ...

    def say(self, text: str) -> None:
        """Deliver the agent's final answer."""
        ...


class World(Protocol):
    """A room, the things in it, and its bodies: the whole truth, and the way back to any state."""

    @property
    def scene(self) -> SceneInfo:
        """Name, origin, extent and areas of the loaded scene."""
        ...

    @property
    def object_names(self) -> Mapping[int, str]:
        """Class of every interactable object, by id; labelings make tags of it."""
        ...

    @property
    def bodies(self) -> Mapping[str, Body]:
        """Its bodies by name, the one that acts in an episode first."""
        ...

    def reset(self, seed: int) -> None:
        """Put the world and its bodies back to their start. Same seed, same world."""
        ...

    def state(self) -> WorldState:
        """The whole truth, as plain data."""
        ...

    def snapshot(self) -> bytes:
        """Everything that decides what happens next: world, bodies, what they hold.

        Empty, if it keeps no states; see `adamo_vh.abilities`.
        """
        ...

    def restore(self, snapshot: bytes) -> None:
        """Go back to a snapshot, also of another process; the same calls give the same states.

        Raises:
            EngineError: It is damaged or belongs to another scene.
        """
        ...

    def apply(self, event: WorldEvent) -> None:
        """Let something happen that no body of this world does; everything is at rest afterwards.

        Raises:
            EngineError: This engine cannot do it, or not now; nothing changed.
        """
        ...

    def close(self) -> None:
        """Free graphics and memory; the world cannot be used afterwards."""
        ...


def acting_body(world: World) -> Body:
    """The body that acts in an episode: the first one.

    Raises:
        EngineError: The world has none, or is no `World` at all.
    """
    parts = ("scene", "object_names", "bodies", "reset", "state", "snapshot", "restore", "apply")
    if lacking := [name for name in parts if not hasattr(world, name)]:
        raise EngineError(
            f"{type(world).__name__} is no engine: it lacks {', '.join(lacking)} "
            "(see adamo_vh.engine.World)."
        )
    for body in world.bodies.values():
        return body
    raise EngineError(f"Scene {world.scene.name!r} has no body: an engine needs at least one.")
