"""The built-in engine: MuJoCo physics, headless pictures and the body behind `Engine`."""

from __future__ import annotations

import math
import zlib
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cache, partial
from typing import TYPE_CHECKING

import numpy as np
from pydantic import TypeAdapter, ValidationError

from adamo_vh.action import Code, Outcome
from adamo_vh.engine import BodyReport, ObjectState, SceneInfo, WorldState
from adamo_vh.errors import EngineError
from adamo_vh.geometry import Array, Camera, Vec3
from adamo_vh.observation import BodyState, Percept
from adamo_vh.runtime import physics
from adamo_vh.runtime.embodiment import REACH_M, REACH_TOP_M, Body
from adamo_vh.runtime.human.looks import VARIANTS, load_figure
from adamo_vh.runtime.human.motion import drop_motion, look_motion, pick_motion, walk_motion
from adamo_vh.runtime.inspection.settled import settled_world
from adamo_vh.runtime.navigation import BODY_RADIUS_M, FloorMap, Path, Ways
from adamo_vh.runtime.placement import Spot, free_spots, spread
from adamo_vh.runtime.scenes.scene import Scene, load_scene
from adamo_vh.runtime.solids import Solid
from adamo_vh.runtime.stage import Stage
from adamo_vh.runtime.world import World

if TYPE_CHECKING:
    import mujoco

_AS_ASKED_M = 0.05
"""A body or an object that ends this close to the wish counts as done, not corrected."""
_REACH_MARGIN_M = 0.02
_SHOULDERS_M = (1.35, 0.7)
"""Heights from which a line to the target must be free: upright, or crouching."""
_OVERHEAD_M = 1.75
"""What is higher does not keep the body off: it can stand below."""
_MAX_SPOT_CHECKS = 60
_MAX_SNAPSHOT_BYTES = 5_000_000


@dataclass(frozen=True, slots=True)
class _Snapshot:
    scene: str
    qpos: tuple[float, ...]
    body: Body
    said: tuple[str, ...]

    def pack(self) -> bytes:
        return zlib.compress(_codec().dump_json(self))

    @staticmethod
    def unpack(data: bytes) -> _Snapshot:
        try:
            # A bound on the size: snapshots may come from elsewhere.
            text = zlib.decompressobj().decompress(data, _MAX_SNAPSHOT_BYTES)
            return _codec().validate_json(text)
        except (zlib.error, ValidationError) as error:
            raise EngineError(f"The snapshot is damaged: {error}") from None


@cache
def _codec() -> TypeAdapter[_Snapshot]:
    return TypeAdapter(_Snapshot)


class BuiltinEngine:
    """A scene, its physics and one body. Implements `adamo_vh.engine.Engine`."""

    def __init__(self, scene: str | Scene = "s1", figure: str = VARIANTS[0]) -> None:
        """Load a scene and settle it.

        Args:
            scene: Name of a built-in scene, path of a scene file, or a loaded scene.
            figure: Who the virtual human is, one of `adamo_vh.runtime.human.looks.VARIANTS`.

        Raises:
            SceneError: The scene is unknown or wrong, or the physics cannot take it.
            ConfigError: No figure has this name.
        """
        self._scene = load_scene(scene) if isinstance(scene, str) else scene
        self._info = self._scene.info()
        self._world: World = settled_world(self._scene, load_figure(figure))
        self.stage = Stage(self._world)
        """Draws the world, and lets actions be watched."""
        self._known_ways: tuple[object, Ways] | None = None
        self._said: list[str] = []
        self._settled = self._world.data.qpos.copy()
        self._body = self._start()

    @property
    def scene(self) -> SceneInfo:
        """Name, extent and areas of the loaded scene."""
        return self._info

    @property
    def object_names(self) -> dict[int, str]:
        """Class of every interactable object, by id."""
        return {i: item.class_name for i, item in self._world.objects.items()}

    @property
    def said(self) -> tuple[str, ...]:
        """What the body was told to say since the last reset."""
        return tuple(self._said)

    def _start(self) -> Body:
        start = self._scene.agent
        position = Vec3(*start.position, 0.0)
        gaze = Vec3(*start.gaze)
        return Body(position, math.radians(start.heading_deg), gaze)

    def reset(self, seed: int) -> None:
        """Put the world and the body back to their start.

        The scene has no random part, so every seed gives the same world.
        """
        self._set(self._settled, self._start(), ())

    # --- perceive ---------------------------------------------------------------------------

    def capture(self, width_px: int, height_px: int) -> Percept:
        """See the room through the body's eyes."""
        camera = self._body.camera(width_px, height_px)
        return self.stage.view(self._body, camera, from_the_eyes=True)

    def closeup(
        self, point: Vec3, vertical_fov_rad: float, width_px: int, height_px: int
    ) -> Percept:
        """See a part of the room larger; body and gaze stay as they are."""
        camera = self._body.camera_to(point, vertical_fov_rad, width_px, height_px)
        return self.stage.detail(self._body, camera)

    def view(self, camera: Camera) -> Percept:
        """The world, with the body in it, from any camera."""
        return self.stage.view(self._body, camera, from_the_eyes=False)

    @property
    def world(self) -> World:
        """The compiled scene: objects, surfaces, solids."""
        return self._world

    @property
    def data(self) -> mujoco.MjData:
        """The MuJoCo state, for measuring and for own views."""
        return self._world.data

    def raycast(self, origin: Vec3, directions: Array) -> Sequence[Vec3 | None]:
        """First hits of rays; the held object is ignored (rays do not see the figure)."""
        return physics.raycast(self._world, origin, directions, self._body.held)

    def body(self) -> BodyState:
        """The body now."""
        return self._body.state()

    # --- act --------------------------------------------------------------------------------

    @property
    def figure(self) -> Body:
        """The body's state, for the stage."""
        return self._body

    def look_at(self, point: Vec3) -> BodyReport:
        """Turn body and gaze to a point."""
        body, exact = self._body.facing(point)
        motion = partial(look_motion, self._body, body, self._held_size())
        self._move(self.stage.perform(body, motion, self._body.held))
        if self._body != body:
            return BodyReport(Outcome.CORRECTED, Code.CANCELLED, self._body.gaze)
        if exact:
            return BodyReport(Outcome.DONE, Code.OK, body.gaze)
        return BodyReport(Outcome.CORRECTED, Code.GAZE_LIMITED, body.gaze)

    def walk_to(self, point: Vec3) -> BodyReport:
        """Walk to the reachable place that is nearest to a point."""
        start = self._body.position
        path = self._ways().to_nearest(point)
        if not self._walk(path):
            return self._cancelled(start)
        walked = path.length_m
        if path.end.horizontal_distance(point) <= _AS_ASKED_M:
            return BodyReport(Outcome.DONE, Code.OK, path.end, walked_m=walked)
        return BodyReport(Outcome.CORRECTED, Code.STOPPED_SHORT, path.end, walked_m=walked)

    def pick(self, object_id: int) -> BodyReport:
        """Take an object into the hand, walking closer if needed."""
        if self._body.held is not None:
            return BodyReport(Outcome.REFUSED, Code.HAND_FULL)
        start, target = self._body.position, self._world.box(object_id).center
        path = self.way_to(target, BODY_RADIUS_M if target.z < _OVERHEAD_M else 0.0)
        if path is None:
            return self._unreachable(target)
        if not self._walk(path):
            return self._cancelled(start)
        facing, _ = self._body.facing(target)
        holding = replace(facing, held=object_id)
        size = self._world.objects[object_id].size
        motion = partial(pick_motion, self._body, holding, target, size)
        self._move(self.stage.perform(holding, motion, object_id))
        if self._body.held is None:
            return self._cancelled(start)
        physics.settle(self._world, object_id)
        code = Code.REPOSITIONED if path.length_m > 0 else Code.OK
        return BodyReport(Outcome.DONE, code, target, walked_m=path.length_m)

    def drop(self, point: Vec3) -> BodyReport:
        """Put the held object down at the free spot nearest to a point."""
        held, start = self._body.held, self._body.position
        if held is None:
            return BodyReport(Outcome.REFUSED, Code.HAND_EMPTY)
        shape = Solid.around(self._world.box(held))
        spots = free_spots(point, shape, self._world.surfaces, self._obstacles(held))
        if not spots:
            return BodyReport(Outcome.REFUSED, Code.NO_FREE_SPOT)
        chosen = self._reachable_spot(spots, math.hypot(shape.half_x, shape.half_y))
        if chosen is None:
            return self._unreachable(point)
        spot, path = chosen
        if not self._walk(path):
            return self._cancelled(start)
        facing, _ = self._body.facing(spot.center)
        free = replace(facing, held=None)
        motion = partial(drop_motion, self._body, free, spot.center, self._held_size())
        self._move(self.stage.perform(free, motion, held, spot.center))
        if self._body.held is not None:
            return self._cancelled(start)
        physics.place(self._world, held, spot.center + Vec3(0.0, 0.0, 0.001))
        physics.settle(self._world, None)
        rest = self._world.box(held).center
        support = physics.supports(self._world, None)[held]
        as_asked = spot.distance_m <= _AS_ASKED_M and rest.horizontal_distance(point) <= _AS_ASKED_M
        if as_asked:
            code = Code.REPOSITIONED if path.length_m > 0 else Code.OK
            return BodyReport(Outcome.DONE, code, rest, support, path.length_m)
        return BodyReport(Outcome.CORRECTED, Code.PLACED_ELSEWHERE, rest, support, path.length_m)

    def say(self, text: str) -> None:
        """Deliver the agent's final answer through the body."""
        self._said.append(text)

    # --- parts of the actions ---------------------------------------------------------------

    def _solids_on(self, excluded: int | None) -> list[Solid]:
        return [Solid.around(self._world.box(i)) for i in self._world.objects if i != excluded]

    def _obstacles(self, held: int) -> list[Solid]:
        return [*self._world.solids, *self._solids_on(held)]

    def floor(self) -> FloorMap:
        """Where the body can stand now."""
        low = [s for s in self._solids_on(self._body.held) if s.z_min < 0.3]
        return FloorMap(self._info, [*self._world.solids, *low])

    def _ways(self) -> Ways:
        """All ways from where the body stands; kept until the world changes."""
        key = (self._world.data.qpos.tobytes(), self._body.position, self._body.held)
        if self._known_ways is None or self._known_ways[0] != key:
            self._known_ways = (key, self.floor().ways_from(self._body.position))
        return self._known_ways[1]

    def _can_reach(self, place: Vec3, target: Vec3) -> bool:
        """Whether no furniture is between the body at a place and a target."""
        if target.z > REACH_TOP_M:
            return False
        for height in _SHOULDERS_M:
            origin = Vec3(place.x, place.y, height)
            if physics.line_is_free(self._world, origin, target):
                return True
        return False

    def way_to(self, target: Vec3, keep_off_m: float) -> Path | None:
        """The shortest way to a place from which a target can be handled; stay if this is one."""
        here = self._body.position
        distance = here.horizontal_distance(target)
        if keep_off_m <= distance <= REACH_M and self._can_reach(here, target):
            return Path((here,))
        ways = self._ways()
        return ways.to_standing_place(
            target, REACH_M - _REACH_MARGIN_M, keep_off_m, lambda p: self._can_reach(p, target)
        )

    def _reachable_spot(self, spots: Sequence[Spot], radius_m: float) -> tuple[Spot, Path] | None:
        for count, spot in enumerate(spread(spots)):
            if count >= _MAX_SPOT_CHECKS:
                return None
            path = self.way_to(spot.center, BODY_RADIUS_M + radius_m + 0.01)
            if path is not None:
                return spot, path
        return None

    def _walk(self, path: Path) -> bool:
        """Walk a path; False if the body was stopped on the way."""
        if path.length_m <= 0:
            return True
        before, end = path.points[-2], path.points[-1]
        heading = math.atan2(end.y - before.y, end.x - before.x)
        there = self._body.walked(end, heading)
        motion = partial(walk_motion, self._body, path, there, self._held_size())
        self._move(self.stage.perform(there, motion, self._body.held))
        return self._body == there

    def _unreachable(self, target: Vec3) -> BodyReport:
        """A refusal that names the nearest place that could be walked to."""
        nearest = self._ways().to_nearest(target).end
        return BodyReport(Outcome.REFUSED, Code.UNREACHABLE, nearest)

    def _cancelled(self, start: Vec3) -> BodyReport:
        here = self._body.position
        walked = here.horizontal_distance(start)
        return BodyReport(Outcome.CORRECTED, Code.CANCELLED, here, walked_m=walked)

    def _held_size(self) -> Vec3 | None:
        held = self._body.held
        return None if held is None else self._world.objects[held].size

    def _move(self, body: Body) -> None:
        """Take a new state, and bring the held object to the hand."""
        import mujoco

        self._body = body
        if body.held is not None:
            physics.place(self._world, body.held, self.stage.hand(body))
            mujoco.mj_forward(self._world.model, self._world.data)

    # --- truth ------------------------------------------------------------------------------

    def state(self) -> WorldState:
        """The whole truth, as plain data."""
        held = self._body.held
        supports = physics.supports(self._world, held)
        objects = tuple(
            ObjectState(i, item.class_name, self._world.box(i), supports[i], i == held)
            for i, item in self._world.objects.items()
        )
        return WorldState(self._info, objects, self._body.state(), self._world.furniture)

    def snapshot(self) -> bytes:
        """World, body and what was said, as compressed JSON."""
        qpos = tuple(float(v) for v in self._world.data.qpos)
        return _Snapshot(self._info.name, qpos, self._body, tuple(self._said)).pack()

    def restore(self, snapshot: bytes) -> None:
        """Go back to a snapshot.

        Raises:
            EngineError: It is damaged or belongs to another scene.
        """
        kept = _Snapshot.unpack(snapshot)
        if kept.scene != self._info.name or len(kept.qpos) != self._world.model.nq:
            raise EngineError(
                f"The snapshot is of scene {kept.scene!r}, the engine has {self._info.name!r}."
            )
        self._set(np.array(kept.qpos), kept.body, kept.said)

    def _set(self, qpos: Array, body: Body, said: tuple[str, ...]) -> None:
        import mujoco

        data = self._world.data
        mujoco.mj_resetData(self._world.model, data)
        data.qpos[:] = qpos
        mujoco.mj_forward(self._world.model, data)
        self._body = body
        self._said = list(said)

    def close(self) -> None:
        """Free graphics memory."""
        self.stage.close()
