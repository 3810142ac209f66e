"""The body of the built-in engine: what it sees, where it walks, what it takes and puts down."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from functools import partial

from adamo_vh.action import Code, Outcome
from adamo_vh.engine import BodyInfo, BodyReport, SceneInfo
from adamo_vh.geometry import Array, Solid, Vec3
from adamo_vh.observation import BodyState, Percept
from adamo_vh.runtime import physics
from adamo_vh.runtime.embodiment import EYE_HEIGHT_M, FOV_Y_RAD, REACH_M, REACH_TOP_M, Stance
from adamo_vh.runtime.human.motion import drop_motion, look_motion, pick_motion, walk_motion
from adamo_vh.runtime.navigation import BODY_RADIUS_M, FloorMap, Path, Ways
from adamo_vh.runtime.placement import MAX_CORRECTION_M, Spot, free_spots, spread
from adamo_vh.runtime.stage import Stage
from adamo_vh.runtime.turns import Turns, in_turn
from adamo_vh.runtime.world import CompiledWorld

_AS_ASKED_M = 0.05
"""A body or an object that ends this close to the wish counts as done, not corrected."""
_REACH_MARGIN_M = 0.02
_SHOULDERS_M = (1.35, 0.7)
"""Heights from which a line to the target must be free: upright, or crouching."""
_OVERHEAD_M = 1.75
"""What is higher does not keep the body off: it can stand below."""
_MAX_SPOT_CHECKS = 60
_MOMENT_DIGITS = 4
"""Of the seconds after which an action was stopped."""


class BuiltinBody:
    """A virtual human in a compiled world. Implements `adamo_vh.engine.Body`."""

    def __init__(
        self,
        world: CompiledWorld,
        room: SceneInfo,
        stage: Stage,
        start: Stance,
        figure: str,
        turns: Turns,
    ) -> None:
        """Stand in a world.

        Args:
            world: Is changed by what the body does.
            room: Its extent.
            stage: Shows it.
            start: How the body stands.
            figure: Who it is.
            turns: Lets one call at a time in.
        """
        self.stance = start
        self.said: list[str] = []
        """What it was told to say since the last reset."""
        self.turns = turns
        self._world = world
        self._room = room
        self._stage = stage
        self._info = BodyInfo(
            figure,
            BODY_RADIUS_M,
            EYE_HEIGHT_M,
            FOV_Y_RAD,
            REACH_M,
            REACH_TOP_M,
            MAX_CORRECTION_M,
        )
        self._known_ways: tuple[object, Ways] | None = None

    @property
    def info(self) -> BodyInfo:
        """What is always true of it."""
        return self._info

    @in_turn
    def state(self) -> BodyState:
        """Where it stands and looks now, and what it feels in its hand."""
        return self.stance.state(self._world.box_of(self.stance.held))

    # --- perceive ---------------------------------------------------------------------------

    @in_turn
    def see(self, width_px: int, height_px: int) -> Percept:
        """See the room through its eyes."""
        camera = self.stance.camera(width_px, height_px)
        return self._stage.view(self.stance, camera, from_the_eyes=True)

    @in_turn
    def closeup(
        self, point: Vec3, vertical_fov_rad: float, width_px: int, height_px: int
    ) -> Percept:
        """See a part of the room larger; body and gaze stay as they are."""
        camera = self.stance.camera_to(point, vertical_fov_rad, width_px, height_px)
        return self._stage.detail(self.stance, camera)

    @in_turn
    def rays(self, origin: Vec3, directions: Array) -> Sequence[Vec3 | None]:
        """First hits of rays; the held object is ignored (rays do not see the figure)."""
        return physics.raycast(self._world, origin, directions, self.stance.held)

    # --- act --------------------------------------------------------------------------------

    @in_turn
    def look(self, point: Vec3) -> BodyReport:
        """Turn body and gaze to a point."""
        begun_s = self._stage.shown_s
        end, exact = self.stance.facing(point)
        motion = partial(look_motion, self.stance, end)
        self._move(self._stage.perform(end, motion, self.stance.held))
        if self.stance != end:
            return replace(self._cancelled(begun_s), point=self.stance.gaze)
        if exact:
            return BodyReport(Outcome.DONE, Code.OK, end.gaze)
        return BodyReport(Outcome.CORRECTED, Code.GAZE_LIMITED, end.gaze)

    @in_turn
    def walk(self, point: Vec3) -> BodyReport:
        """Walk to the reachable place that is nearest to a point."""
        begun_s = self._stage.shown_s
        path = self._ways().to_nearest(point)
        if not self._walk(path):
            return self._cancelled(begun_s, path)
        walked = path.length_m
        if path.end.horizontal_distance(point) <= _AS_ASKED_M:
            return BodyReport(Outcome.DONE, Code.OK, path.end, walked_m=walked)
        return BodyReport(Outcome.CORRECTED, Code.STOPPED_SHORT, path.end, walked_m=walked)

    @in_turn
    def pick(self, object_id: int) -> BodyReport:
        """Take an object into the hand, walking closer if needed."""
        if self.stance.held is not None:
            return BodyReport(Outcome.REFUSED, Code.HAND_FULL)
        if object_id in self._world.absent:
            return BodyReport(Outcome.REFUSED, Code.GONE)
        begun_s, target = self._stage.shown_s, self._world.box(object_id).center
        path = self.way_to(target, BODY_RADIUS_M if target.z < _OVERHEAD_M else 0.0)
        if path is None:
            return self._unreachable(target)
        if not self._walk(path):
            return self._cancelled(begun_s, path)
        facing, _ = self.stance.facing(target)
        holding = replace(facing, held=object_id)
        motion = partial(pick_motion, self.stance, holding, target, depth=self._depth)
        self._move(self._stage.perform(holding, motion, object_id))
        if self.stance.held is None:
            return self._cancelled(begun_s, path)
        physics.settle(self._world, object_id)
        code = Code.REPOSITIONED if path.length_m > 0 else Code.OK
        return BodyReport(Outcome.DONE, code, target, walked_m=path.length_m)

    @in_turn
    def drop(self, point: Vec3) -> BodyReport:
        """Put the held object down at the free spot nearest to a point."""
        begun_s, held = self._stage.shown_s, self.stance.held
        if held is None:
            return BodyReport(Outcome.REFUSED, Code.HAND_EMPTY)
        shape = Solid.around(self._world.box(held))
        spots = free_spots(point, shape, self._world.surfaces, self.obstacles(held))
        if not spots:
            return BodyReport(Outcome.REFUSED, Code.NO_FREE_SPOT)
        chosen = self._reachable_spot(spots, math.hypot(shape.half_x, shape.half_y))
        if chosen is None:
            return self._unreachable(point)
        spot, path = chosen
        if not self._walk(path):
            return self._cancelled(begun_s, path)
        facing, _ = self.stance.facing(spot.center)
        free = replace(facing, held=None)
        motion = partial(drop_motion, self.stance, free, spot.center, depth=self._depth)
        self._move(self._stage.perform(free, motion, held, spot.center))
        if self.stance.held is not None:
            return self._cancelled(begun_s, path)
        physics.put_down(self._world, held, spot.center, None)
        rest = self._world.box(held).center
        support = physics.supports(self._world, None)[held]
        as_asked = spot.distance_m <= _AS_ASKED_M and rest.horizontal_distance(point) <= _AS_ASKED_M
        if as_asked:
            code = Code.REPOSITIONED if path.length_m > 0 else Code.OK
            return BodyReport(Outcome.DONE, code, rest, support, path.length_m)
        return BodyReport(Outcome.CORRECTED, Code.PLACED_ELSEWHERE, rest, support, path.length_m)

    def say(self, text: str) -> None:
        """Deliver the agent's final answer."""
        self.said.append(text)

    # --- parts of the actions ---------------------------------------------------------------

    def _depth(self, middles: Array, radius_m: float) -> Array:
        """How deep balls are in furniture."""
        return physics.gathered(self._world.solids).depth(middles, radius_m)

    def obstacles(self, excluded: int | None) -> list[Solid]:
        """Everything that something put down must keep clear of, but one object."""
        return [*self._world.solids, *physics.solids_on(self._world, excluded)]

    def floor(self) -> FloorMap:
        """Where the body can stand now."""
        low = [s for s in physics.solids_on(self._world, self.stance.held) if s.z_min < 0.3]
        return FloorMap(self._room, [*self._world.solids, *low])

    def _ways(self) -> Ways:
        """All ways from where the body stands; kept until the world changes."""
        key = (self._world.data.qpos.tobytes(), self.stance.position, self.stance.held)
        if self._known_ways is None or self._known_ways[0] != key:
            self._known_ways = (key, self.floor().ways_from(self.stance.position))
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

    def way_to(self, target: Vec3, keep_off_m: float = BODY_RADIUS_M) -> Path | None:
        """The shortest way to a place from which a target can be handled; stay if this is one."""
        here = self.stance.position
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
        there = self.stance.walked(end, heading)
        motion = partial(walk_motion, self.stance, path, there)
        self._move(self._stage.perform(there, motion, self.stance.held))
        return self.stance == there

    def _unreachable(self, target: Vec3) -> BodyReport:
        """A refusal that names the nearest place that could be walked to."""
        nearest = self._ways().to_nearest(target).end
        return BodyReport(Outcome.REFUSED, Code.UNREACHABLE, nearest)

    def _cancelled(self, begun_s: float, path: Path | None = None) -> BodyReport:
        """A stop on request: where it stands, how far it walked, and after how long.

        Args:
            begun_s: What the stage had shown when the action began.
            path: Where it was walking, or had walked.
        """
        here = self.stance.position
        walked = path.walked_to(here) if path else 0.0
        stopped = round(self._stage.shown_s - begun_s, _MOMENT_DIGITS)
        return BodyReport(
            Outcome.CORRECTED, Code.CANCELLED, here, walked_m=walked, stopped_s=stopped
        )

    def _move(self, stance: Stance) -> None:
        """Take a new stance, and bring the held object to the hand."""
        import mujoco

        self.stance = stance
        if stance.held is not None:
            physics.place(self._world, stance.held, self._stage.hand(stance))
            mujoco.mj_forward(self._world.model, self._world.data)
