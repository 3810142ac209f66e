"""What can be seen: the figure in its posture, the thing in its hand, and pictures of both.

The engine's logic decides states; the stage shows them, also the moments between two states. It
never changes how an action ends.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager

import numpy as np
from numpy.typing import NDArray

from adamo_vh.geometry import Camera, Vec3
from adamo_vh.observation import Percept, SeenObject
from adamo_vh.runtime import physics
from adamo_vh.runtime.embodiment import Stance
from adamo_vh.runtime.human.face_mujoco import FaceParts
from adamo_vh.runtime.human.grasp import Thing
from adamo_vh.runtime.human.motion import BodyFrame, Motion, idle
from adamo_vh.runtime.human.skin_mujoco import pose_human
from adamo_vh.runtime.rendering import SceneRenderer
from adamo_vh.runtime.world import CompiledWorld

MOMENTS_PER_S = 15
"""How often an action that is watched is shown, unless whoever watches wants it otherwise."""
_OFF_THE_WALL_M = 0.005
"""How near a held thing comes to a wall."""

Watcher = Callable[[float], bool]
"""Is called for every shown moment with the simulated seconds since the action began; what it draws
then is that moment. Returns False to stop the action there."""


class Stage:
    """Shows one world."""

    def __init__(self, world: CompiledWorld) -> None:
        """Prepare; graphics are opened when the first picture is drawn."""
        self._world = world
        self._face = FaceParts.of(world.model, world.figure)
        self._renderer: SceneRenderer | None = None
        self._moment: BodyFrame | None = None
        self._last: tuple[object, Percept] | None = None
        self._outline: tuple[object, Thing] | None = None
        self.watcher: Watcher | None = None
        self.moments_per_s = MOMENTS_PER_S
        """How often an action that is watched is shown."""
        self.shown_s = 0.0
        """Simulated seconds of all motion that was watched so far."""

    def watch(self, watcher: Watcher | None, moments_per_s: int = MOMENTS_PER_S) -> None:
        """Be watched from now on, by one at a time; None ends it."""
        self.watcher = watcher
        self.moments_per_s = moments_per_s

    @property
    def renderer(self) -> SceneRenderer:
        """What draws the world."""
        if self._renderer is None:
            self._renderer = SceneRenderer(self._world.model, self._world.object_of_geom)
        return self._renderer

    def _standing(self, body: Stance) -> BodyFrame:
        """The figure between actions."""
        return idle(body, 0.0, self.thing(body.held))

    def hand(self, body: Stance) -> Vec3:
        """Where what a standing figure holds is: the same for all things, however they are held."""
        return self.held_at(idle(body, 0.0))

    def held_at(self, frame: BodyFrame) -> Vec3:
        """Where the middle of the held thing is: in the hand, but never in a wall."""
        held, hand = frame.body.held, frame.hand
        if held is None:
            return hand
        box, room = self._world.box(held), self._world.room
        half = np.abs(box.orientation.matrix()) @ box.size.array() / 2 + _OFF_THE_WALL_M
        x = min(max(hand.x, room.x_min + half[0]), room.x_max - half[0])
        y = min(max(hand.y, room.y_min + half[1]), room.y_max - half[1])
        return Vec3(float(x), float(y), hand.z)

    def _within_walls(self, frame: BodyFrame) -> BodyFrame:
        """The figure with its hand drawn in where a wall is in the way of what it holds."""
        if frame.body.held is None:
            return frame
        hand = self.held_at(frame)
        return frame if hand == frame.hand else frame.with_hand_at(hand)

    def thing(self, object_id: int | None) -> Thing | None:
        """The outline of an object as it is turned now; None for none."""
        if object_id is None:
            return None
        key = object_id, self._world.box(object_id).orientation
        if self._outline is None or self._outline[0] != key:
            self._outline = key, Thing.around(self._world.surface(object_id))
        return self._outline[1]

    def view(self, body: Stance, camera: Camera, *, from_the_eyes: bool) -> Percept:
        """Draw the world as it is, with the figure in it. An unchanged view is not drawn twice.

        Args:
            body: The state of the body.
            camera: From where.
            from_the_eyes: The camera is in the head, which must not hide the view.
        """
        shown = self.shown(body)
        world = self._world.data.qpos.tobytes(), self._world.model.light_diffuse.tobytes()
        key = (camera, from_the_eyes, shown.body, self._moment is None, world)
        if self._moment is None and self._last is not None and self._last[0] == key:
            return self._last[1]
        percept = self._percept(shown, camera, head=not from_the_eyes, shadow=True)
        self._last = (key, percept)
        return percept

    def detail(self, body: Stance, camera: Camera) -> Percept:
        """Draw a small part of the view from the eyes, without shadows, which show little there."""
        return self._percept(self.shown(body), camera, head=False, shadow=False)

    def _percept(self, shown: BodyFrame, camera: Camera, *, head: bool, shadow: bool) -> Percept:
        data = self._world.data
        self._pose(shown)
        drawn = self.renderer.draw(data, camera, head=head, shadow=shadow)
        present = frozenset[int]().union(*(layer.present for layer in drawn.layers))
        seen = {
            i: SeenObject(i, self._world.objects[i].class_name, self._world.box(i))
            for i in sorted(present)
        }
        body = shown.body.state(self._world.box_of(shown.body.held))
        layers = tuple(layer.ids for layer in drawn.layers)
        return Percept(drawn.rgb, layers, seen, body, camera)

    def picture(
        self, body: Stance, camera: Camera, *, head: bool = True, again: bool = False
    ) -> NDArray[np.uint8]:
        """Only the colour picture of this moment, (H, W, 3).

        Args:
            body: The state of the body.
            camera: From where.
            head: Without it one can look out of it.
            again: The picture before was of the same moment, which saves drawing shadows.
        """
        if not again:
            self._pose(self.shown(body))
        return self.renderer.color(self._world.data, camera, head=head, again=again)

    def shown(self, body: Stance) -> BodyFrame:
        """What is to be seen now: a moment of an action, or the figure between actions."""
        return self._within_walls(self._moment or self._standing(body))

    @contextmanager
    def idling(self, body: Stance, seconds: float) -> Iterator[None]:
        """Show the figure some seconds into standing still: it breathes and blinks."""
        self._moment = idle(body, seconds, self.thing(body.held))
        try:
            yield
        finally:
            self._moment = None

    def forget(self) -> None:
        """Draw the next view even if nothing changed."""
        self._last = None

    def perform(
        self,
        end: Stance,
        make: Callable[[Thing | None], Motion],
        thing: int | None = None,
        rest: Vec3 | None = None,
    ) -> Stance:
        """Let an action be watched, if somebody watches.

        Args:
            end: The body when it is done.
            make: Makes the motion to that end from the outline of the thing; both are costly, so
                it is asked only if it is watched.
            thing: What is taken, put down or carried meanwhile.
            rest: Where it is put down.

        Returns:
            The body at the end of the motion, or where the watcher stopped it.
        """
        if self.watcher is None:
            return end
        motion = make(self.thing(thing))
        data = self._world.data
        kept, before_s = data.qpos.copy(), self.shown_s
        moments = np.arange(0.0, motion.duration_s, 1.0 / self.moments_per_s)
        try:
            for seconds in (*moments.tolist(), motion.duration_s):
                self._moment, self.shown_s = motion.at(seconds), before_s + seconds
                if thing is not None and self._moment.body.held == thing:
                    physics.place(self._world, thing, self.held_at(self._moment))
                elif thing is not None and rest is not None:
                    physics.place(self._world, thing, rest)
                if not self.watcher(seconds):
                    return motion.body_at(seconds)
        finally:
            self._moment = None
            data.qpos[:] = kept
        return end

    def _pose(self, shown: BodyFrame) -> None:
        import mujoco

        pose_human(self._world.model, self._world.data, *shown.joints())
        self._face.follow(shown.pose, shown.look_rad)
        mujoco.mj_kinematics(self._world.model, self._world.data)
        mujoco.mj_camlight(self._world.model, self._world.data)

    def close(self) -> None:
        """Free graphics memory."""
        if self._renderer is not None:
            self._renderer.close()
            self._renderer = None
            self._last = None
