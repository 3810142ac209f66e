"""Headless drawing: the colour picture and, for each pixel, which interactable object it shows.

Both come out of one pass (see `adamo_vh.runtime.painting`); outlines are smoothed afterwards, so
that ids never blend at edges.
"""

from __future__ import annotations

import math
import weakref
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from adamo_vh.errors import RenderingError
from adamo_vh.geometry import Camera
from adamo_vh.observation import NOTHING
from adamo_vh.runtime.graphics import free_later, in_graphics_thread, open_gl
from adamo_vh.runtime.human.skin_mujoco import HEAD_GROUP
from adamo_vh.runtime.painting import Painter, Painting
from adamo_vh.runtime.smoothing import smooth

if TYPE_CHECKING:
    import mujoco

_MAX_GEOMS = 4000


@dataclass(frozen=True, slots=True, eq=False)
class IdLayer:
    """Which object each pixel shows."""

    ids: NDArray[np.int16]
    """(H, W): object ids, `NOTHING` elsewhere."""
    present: frozenset[int]
    """The ids that occur."""


@dataclass(frozen=True, slots=True, eq=False)
class Drawing:
    """A picture, and what it shows."""

    rgb: NDArray[np.uint8]
    """(H, W, 3)."""
    layers: tuple[IdLayer, ...]
    """In front and, if glass is in view, without the glass."""


class SceneRenderer:
    """Draws one MuJoCo model from any camera.

    May be used in any thread, by one at a time, and forgotten in any: the graphics thread draws and
    frees.
    """

    def __init__(self, model: mujoco.MjModel, object_of_geom: NDArray[np.int16]) -> None:
        """Open graphics for a model.

        Args:
            model: The compiled world.
            object_of_geom: (ngeom,) object id of each geom, or `NOTHING`.

        Raises:
            RenderingError: No OpenGL.
        """
        import mujoco

        self._model = model
        self._gl, self._painter = in_graphics_thread(partial(_opened, model, object_of_geom))
        # MuJoCo would free what it drew with in whatever context is current when it is forgotten.
        self._free = weakref.finalize(self, free_later, partial(_freed, self._gl, self._painter))
        self._free.atexit = False
        self._scene = mujoco.MjvScene(model, maxgeom=_MAX_GEOMS)
        self._option = mujoco.MjvOption()
        self._camera = mujoco.MjvCamera()
        self._camera.type = mujoco.mjtCamera.mjCAMERA_FREE.value

    def draw(
        self, data: mujoco.MjData, camera: Camera, *, head: bool = False, shadow: bool = True
    ) -> Drawing:
        """Draw the picture and what it shows.

        Args:
            data: The state of the world.
            camera: From where.
            head: Draw the figure's head too; not when the camera is in it.
            shadow: Draw shadows.

        Raises:
            RenderingError: The renderer was closed, or its graphics memory was freed by others.
        """
        painting = self._painted(data, camera, head=head, shadow=shadow)
        return Drawing(_finished(painting), self._layers(painting))

    def color(
        self,
        data: mujoco.MjData,
        camera: Camera,
        *,
        head: bool = False,
        shadow: bool = True,
        again: bool = False,
    ) -> NDArray[np.uint8]:
        """Only the picture, (H, W, 3); see `draw`.

        Args:
            data: The state of the world.
            camera: From where.
            head: Draw the figure's head too.
            shadow: Draw shadows.
            again: The picture before was of the same moment: take its shadows.
        """
        return _finished(self._painted(data, camera, head=head, shadow=shadow, again=again))

    def layers(
        self, data: mujoco.MjData, camera: Camera, *, head: bool = False
    ) -> tuple[IdLayer, ...]:
        """Only what it would show; see `draw`."""
        return self._layers(self._painted(data, camera, head=head, shadow=False))

    def _painted(
        self,
        data: mujoco.MjData,
        camera: Camera,
        *,
        head: bool,
        shadow: bool,
        again: bool = False,
    ) -> Painting:
        if not self._free.alive:
            raise RenderingError("The renderer was closed; make a new engine.")
        return in_graphics_thread(partial(self._paint, data, camera, head, shadow, again))

    def _paint(
        self, data: mujoco.MjData, camera: Camera, head: bool, shadow: bool, again: bool
    ) -> Painting:
        import mujoco

        self._option.skingroup[HEAD_GROUP] = head
        self._camera.distance = 1.0
        self._camera.lookat[:] = camera.position.array() + camera.world_from_camera[:, 2]
        self._camera.azimuth = math.degrees(camera.yaw_rad)
        self._camera.elevation = math.degrees(camera.pitch_rad)
        self._model.vis.global_.fovy = math.degrees(camera.fov_y_rad)
        every = mujoco.mjtCatBit.mjCAT_ALL.value
        shown = (self._model, data, self._option, None, self._camera)
        mujoco.mjv_updateScene(*shown, every, self._scene)
        self._gl.make_current()
        self._painter.check()
        groups = self._option.skingroup.astype(bool)
        size = camera.width_px, camera.height_px
        given = data, self._scene, size
        return self._painter.paint(*given, groups=groups, shadow=shadow, again=again)

    def _layers(self, painting: Painting) -> tuple[IdLayer, ...]:
        parts = self._painter.parts
        front = _decoded(painting.labels, parts.object_of, len(parts))
        if painting.behind is None or not parts.glass & front.present:
            return (front,)
        return front, _decoded(painting.behind, parts.object_of, len(parts))

    def close(self) -> None:
        """Free the graphics memory."""
        self._free()


def _opened(model: mujoco.MjModel, object_of_geom: NDArray[np.int16]) -> tuple[Any, Painter]:
    """A context of OpenGL, and in it what draws the model."""
    gl = open_gl(1, 1)
    gl.make_current()
    return gl, Painter(model, object_of_geom)


def _freed(gl: Any, painter: Painter) -> None:
    """Free what `_opened` gave, in its own context."""
    gl.make_current()
    painter.context.free()
    gl.free()


def _finished(painting: Painting) -> NDArray[np.uint8]:
    """(H, W, 3) the picture with smooth outlines, top row first."""
    import cv2

    smooth(painting.colours, painting.labels)
    rgb = cv2.flip(cv2.cvtColor(painting.colours, cv2.COLOR_RGBA2RGB), 0)
    return np.asarray(rgb, np.uint8)


def _decoded(labels: NDArray[np.uint8], object_of: NDArray[np.int16], parts: int) -> IdLayer:
    """Which object each pixel shows, top row first."""
    import cv2

    if parts < 255:
        # OpenCV looks bytes up ten times faster than numpy.
        index = cv2.extractChannel(labels, 0)
        histogram = cv2.calcHist([index], [0], None, [256], [0, 256]).ravel()
        ids = cv2.LUT(index, object_of[:256])
    else:
        wide = labels[:, :, 0] + labels[:, :, 1].astype(np.intp) * 256
        histogram = np.bincount(wide.ravel(), minlength=len(object_of))
        ids = object_of[wide]
    present = {int(i) for i in object_of[np.flatnonzero(histogram)]} - {NOTHING}
    return IdLayer(np.asarray(cv2.flip(ids, 0), np.int16), frozenset(present))
