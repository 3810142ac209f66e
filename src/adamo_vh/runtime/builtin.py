"""The built-in engine: MuJoCo physics, headless pictures and one body behind `World`."""

from __future__ import annotations

import hashlib
import math
from collections.abc import Mapping
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from adamo_vh.engine import ObjectState, SceneInfo, WorldEvent, WorldState
from adamo_vh.geometry import Array, Camera, Vec3
from adamo_vh.observation import Percept
from adamo_vh.runtime import physics
from adamo_vh.runtime.builtin_body import BuiltinBody
from adamo_vh.runtime.embodiment import Stance
from adamo_vh.runtime.graphics import check_process, load_mujoco
from adamo_vh.runtime.happenings import Happenings
from adamo_vh.runtime.human.looks import VARIANTS, load_figure
from adamo_vh.runtime.inspection.settled import settled_world
from adamo_vh.runtime.scenes.scene import Scene, load_scene, scene_names
from adamo_vh.runtime.snapshot import Snapshot
from adamo_vh.runtime.stage import Stage
from adamo_vh.runtime.turns import Turns, in_turn
from adamo_vh.runtime.world import CompiledWorld

if TYPE_CHECKING:
    import mujoco

AGENT = "agent"
"""Name of the body."""


class BuiltinEngine:
    """A scene, its physics and one body. Implements `adamo_vh.engine.World`.

    Every call may come from any thread; calls from several threads wait for each other.
    """

    def __init__(
        self, scene: str | Scene = "s1", figure: str = VARIANTS[0], origin: str = ""
    ) -> None:
        """Load a scene and settle it.

        Args:
            scene: Name of a built-in scene, path of a scene file, or a loaded scene.
            figure: Who the virtual human is, one of `adamo_vh.runtime.human.looks.VARIANTS`, or
                the path of an own one.
            origin: Name or path of the scene that a loaded one was made of.

        Raises:
            SceneError: The scene is unknown or wrong, or the physics cannot take it.
            ConfigError: No figure has this name.
            FileError: An own figure cannot be used.
        """
        self._scene = load_scene(scene) if isinstance(scene, str) else scene
        check_process()
        load_mujoco()
        given = origin or (scene if isinstance(scene, str) else "")
        looks = load_figure(figure)
        self._info = _described(self._scene, given, looks.sha256 or figure)
        self._world: CompiledWorld = settled_world(self._scene, looks)
        self.turns = Turns()
        self.stage = Stage(self._world)
        """Draws the world, and lets actions be watched."""
        self._settled = self._world.data.qpos.copy()
        self.body = BuiltinBody(
            self._world, self._info, self.stage, self._start(), figure, self.turns
        )
        """The one body."""
        self._happenings = Happenings(self._world, self.body)
        self._known_state: tuple[object, WorldState] | None = None

    @property
    def scene(self) -> SceneInfo:
        """Name, origin, extent and areas of the loaded scene."""
        return self._info

    @property
    def object_names(self) -> dict[int, str]:
        """Class of every interactable object, by id."""
        return {i: item.class_name for i, item in self._world.objects.items()}

    @property
    def bodies(self) -> Mapping[str, BuiltinBody]:
        """Its one body, by name."""
        return {AGENT: self.body}

    def _start(self) -> Stance:
        start = self._scene.agent
        position = Vec3(*start.position, 0.0)
        gaze = Vec3(*start.gaze)
        return Stance(position, math.radians(start.heading_deg), gaze)

    @in_turn
    def reset(self, seed: int) -> None:
        """Put the world and the body back to their start.

        The scene has no random part, so every seed gives the same world.
        """
        self._happenings.undo(frozenset(), self._world.brightness)
        self._set(self._settled, self._start(), ())

    @in_turn
    def apply(self, event: WorldEvent) -> None:
        """Let something happen that the body does not do; everything is at rest afterwards.

        Objects of the scene can be moved, taken out and brought back in, and its lights changed.
        Objects that the scene does not have cannot be added, and what is in the hand stays there.

        Raises:
            EngineError: It cannot be done, or not now; nothing changed.
        """
        self._happenings.apply(event)

    # --- pictures ---------------------------------------------------------------------------

    def capture(self, width_px: int, height_px: int) -> Percept:
        """See the room through the body's eyes: short for `body.see`."""
        return self.body.see(width_px, height_px)

    @in_turn
    def view(self, camera: Camera) -> Percept:
        """The world, with the body in it, from any camera."""
        return self.stage.view(self.body.stance, camera, from_the_eyes=False)

    @property
    def world(self) -> CompiledWorld:
        """The compiled scene: objects, surfaces, solids."""
        return self._world

    @property
    def data(self) -> mujoco.MjData:
        """The MuJoCo state, for measuring and for own views."""
        return self._world.data

    # --- truth ------------------------------------------------------------------------------

    @in_turn
    def state(self) -> WorldState:
        """The whole truth, as plain data."""
        world = self._world
        # Every answer of the action server asks for it several times.
        key = (world.data.qpos.tobytes(), self.body.stance, frozenset(world.absent))
        if self._known_state is None or self._known_state[0] != key:
            self._known_state = (key, self._state())
        return self._known_state[1]

    def _state(self) -> WorldState:
        held = self.body.stance.held
        supports = physics.supports(self._world, held)
        objects = tuple(
            ObjectState(
                item.id,
                item.class_name,
                self._world.box(item.id),
                supports[item.id],
                item.id == held,
            )
            for item in self._world.present()
        )
        return WorldState(self._info, objects, self.body.state(), self._world.furniture)

    @in_turn
    def snapshot(self) -> bytes:
        """World, body and what was said, as compressed JSON."""
        qpos = tuple(float(v) for v in self._world.data.qpos)
        absent = tuple(sorted(self._world.absent))
        said = tuple(self.body.said)
        lights = self._happenings.lights
        return Snapshot(self._world.name, qpos, self.body.stance, said, absent, lights).pack()

    @in_turn
    def restore(self, snapshot: bytes) -> None:
        """Go back to a snapshot.

        Raises:
            EngineError: It is damaged or belongs to another scene.
        """
        kept = Snapshot.unpack(snapshot, self._world)
        self._happenings.undo(frozenset(kept.absent), kept.lights or self._world.brightness)
        self._set(np.array(kept.qpos), kept.body, kept.said)

    def _set(self, qpos: Array, stance: Stance, said: tuple[str, ...]) -> None:
        import mujoco

        data = self._world.data
        mujoco.mj_resetData(self._world.model, data)
        data.qpos[:] = qpos
        mujoco.mj_forward(self._world.model, data)
        self.body.stance = stance
        self.body.said = list(said)

    @in_turn
    def close(self) -> None:
        """Free graphics memory."""
        self.stage.close()


def _described(scene: Scene, given: str, looks: str) -> SceneInfo:
    """What the engine says of its scene, with its origin and its digest."""
    source = "built-in" if given.lower() in scene_names() else given or "given"
    digest = hashlib.sha256(repr((scene, looks)).encode()).hexdigest()
    return replace(scene.info(), source=source, digest=digest)
