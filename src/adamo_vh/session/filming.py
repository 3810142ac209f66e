"""What a film needs of the built-in engine: the moments of its actions, from any camera."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import AbstractContextManager
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from adamo_vh.engine import SceneInfo
from adamo_vh.geometry import Array, Camera, Vec3
from adamo_vh.observation import BodyState
from adamo_vh.runtime.stage import MOMENTS_PER_S

if TYPE_CHECKING:
    from adamo_vh.runtime.builtin import BuiltinEngine


class FilmSet:
    """An engine while it is filmed. Looking at it changes nothing about the episode."""

    moments_per_s = MOMENTS_PER_S
    """How often an action that is watched is shown."""

    def __init__(self, engine: BuiltinEngine) -> None:
        """Look at an engine."""
        self.engine = engine

    @classmethod
    def of(cls, scene: str, figure: str, variation: int = 0) -> FilmSet:
        """The built-in engine with a scene or one of its variations, made to be filmed.

        Raises:
            SceneError: The scene is unknown or wrong.
            ConfigError: No figure has this name.
        """
        from adamo_vh.session.variations import built_in_engine

        return cls(built_in_engine(scene, figure, variation))

    @property
    def scene(self) -> SceneInfo:
        """The room."""
        return self.engine.scene

    def watch(self, moment: Callable[[], None] | None) -> None:
        """Be called at every shown moment of an action; None ends it."""

        def watcher(_: float) -> bool:
            if moment is not None:
                moment()
            return True

        self.engine.stage.watch(None if moment is None else watcher)

    def body(self) -> BodyState:
        """How the figure stands at this moment."""
        return self.engine.stage.shown(self.engine.body.stance).body.state()

    def figure(self) -> tuple[BodyState, Vec3, Vec3]:
        """The body, where the figure's eyes are, and where her right hand is, at this moment."""
        shown = self.engine.stage.shown(self.engine.body.stance)
        return shown.body.state(), shown.eyes, shown.hand

    def rays(self, origin: Vec3, directions: Array) -> Sequence[Vec3 | None]:
        """Where rays first meet something that can be seen, but the figure and what she holds."""
        return self.engine.body.rays(origin, directions)

    def picture(self, camera: Camera) -> NDArray[np.uint8]:
        """(H, W, 3) this moment, from any camera."""
        return self.engine.stage.picture(self.engine.body.stance, camera)

    def eyes(self, width_px: int, height_px: int) -> NDArray[np.uint8]:
        """(H, W, 3) the moment of the last picture, through the eyes of the figure as it is drawn.

        They go down with her when she crouches. The eyes that the agent sees through stay at their
        height over the feet, whatever the figure does.
        """
        from adamo_vh.runtime.embodiment import FOV_Y_RAD

        stance = self.engine.body.stance
        shown = self.engine.stage.shown(stance)
        size_px, heading = (width_px, height_px), shown.body.heading_rad
        camera = Camera.towards(shown.eyes, shown.body.gaze, FOV_Y_RAD, size_px, heading)
        return self.engine.stage.picture(stance, camera, head=False, again=True)

    def idling(self, seconds: float) -> AbstractContextManager[None]:
        """Show the figure some seconds into standing still: it breathes and blinks."""
        return self.engine.stage.idling(self.engine.body.stance, seconds)
