"""Headless drawing: the colour picture and, for each pixel, which interactable object it shows.

The scene is drawn twice with `mjr_render`: in colour with a shadow and anti-aliasing, then as flat
ids with neither, which costs a sixth of the first and keeps ids from blending at edges. MuJoCo's
own Python `Renderer` decodes ids geom by geom; this one looks one byte a pixel up.
"""

from __future__ import annotations

import math
import weakref
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from adamo_vh.errors import RenderingError
from adamo_vh.geometry import Camera
from adamo_vh.observation import NOTHING
from adamo_vh.runtime.graphics import free_later, in_graphics_thread, is_alive, open_gl
from adamo_vh.runtime.human.skin_mujoco import HEAD_GROUP

if TYPE_CHECKING:
    import mujoco

MSAA_SAMPLES = 4
SHADOW_MAP_PX = 3072
_MAX_GEOMS = 4000

_T = TypeVar("_T")


@dataclass(frozen=True, slots=True, eq=False)
class IdLayer:
    """Which object each pixel shows."""

    ids: NDArray[np.int16]
    """(H, W): object ids, `NOTHING` elsewhere."""
    present: frozenset[int]
    """The ids that occur."""


class SceneRenderer:
    """Draws one MuJoCo model from any camera, in colour and as ids.

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

        self._mujoco = mujoco
        self._model = model
        self._object_of_geom = object_of_geom
        self._gl, self._contexts = in_graphics_thread(partial(_opened, model))
        # MuJoCo would free what it drew with in whatever context is current when it is forgotten.
        self._free = weakref.finalize(self, free_later, partial(_freed, self._gl, self._contexts))
        self._free.atexit = False
        self._scene = mujoco.MjvScene(model, maxgeom=_MAX_GEOMS)
        self._option = mujoco.MjvOption()
        self._camera = mujoco.MjvCamera()
        self._camera.type = mujoco.mjtCamera.mjCAMERA_FREE.value
        self._buffer = np.empty((0, 0, 3), np.uint8)
        material = model.geom_matid
        alpha = np.where(material >= 0, model.mat_rgba[material, 3], model.geom_rgba[:, 3])
        drawn = model.geom_group < 3
        see_through = np.unique(object_of_geom[(alpha < 1) & drawn])
        self._glass = frozenset(int(i) for i in see_through) - {NOTHING}

    def _aim(self, data: mujoco.MjData, camera: Camera) -> mujoco.MjrRect:
        """Point the MuJoCo camera, update the scene, and fit the buffers."""
        mujoco = self._mujoco
        forward = camera.world_from_camera[:, 2]
        self._camera.distance = 1.0
        self._camera.lookat[:] = camera.position.array() + forward
        self._camera.azimuth = math.degrees(camera.yaw_rad)
        self._camera.elevation = math.degrees(camera.pitch_rad)
        self._model.vis.global_.fovy = math.degrees(camera.fov_y_rad)
        mujoco.mjv_updateScene(
            self._model,
            data,
            self._option,
            None,
            self._camera,
            mujoco.mjtCatBit.mjCAT_ALL.value,
            self._scene,
        )
        self._gl.make_current()
        self._check()
        width, height = camera.width_px, camera.height_px
        for context in self._contexts:
            if width > context.offWidth or height > context.offHeight:
                mujoco.mjr_resizeOffscreen(width, height, context)
        return mujoco.MjrRect(0, 0, width, height)

    def _check(self) -> None:
        """Make sure that nobody has freed what this draws with."""
        for context in self._contexts:
            parts = [("Framebuffer", context.offFBO), ("List", context.basePlane)]
            if context.ntexture:
                parts += [("Texture", int(context.texture[i])) for i in (0, context.ntexture - 1)]
            if not all(is_alive(kind, name) for kind, name in parts):
                raise RenderingError(
                    "Another OpenGL user of this process has freed what the engine draws with: "
                    "its pictures would be wrong. Make a new engine."
                )

    def _draw(self, rect: mujoco.MjrRect, context: mujoco.MjrContext) -> NDArray[np.uint8]:
        mujoco = self._mujoco
        mujoco.mjr_setBuffer(mujoco.mjtFramebuffer.mjFB_OFFSCREEN.value, context)
        mujoco.mjr_render(rect, self._scene, context)
        if self._buffer.shape[:2] != (rect.height, rect.width):
            self._buffer = np.empty((rect.height, rect.width, 3), np.uint8)
        mujoco.mjr_readPixels(self._buffer, None, rect, context)
        return self._buffer[::-1]

    def color(
        self, data: mujoco.MjData, camera: Camera, *, head: bool = False, shadow: bool = True
    ) -> NDArray[np.uint8]:
        """Draw the colour picture.

        Args:
            data: The state of the world.
            camera: From where.
            head: Draw the figure's head too; not when the camera is in it.
            shadow: Draw shadows, which draws the whole scene once more.

        Returns:
            (H, W, 3) uint8.

        Raises:
            RenderingError: The renderer was closed, or its graphics memory was freed by others.
        """
        return self._asked(partial(self._color, data, camera, head, shadow))

    def _asked(self, job: Callable[[], _T]) -> _T:
        if not self._free.alive:
            raise RenderingError("The renderer was closed; make a new engine.")
        return in_graphics_thread(job)

    def _color(
        self, data: mujoco.MjData, camera: Camera, head: bool, shadow: bool
    ) -> NDArray[np.uint8]:
        self._option.skingroup[HEAD_GROUP] = head
        rect = self._aim(data, camera)
        self._scene.flags[self._mujoco.mjtRndFlag.mjRND_SHADOW.value] = shadow
        return self._draw(rect, self._contexts[0]).copy()

    def layers(
        self, data: mujoco.MjData, camera: Camera, *, head: bool = False
    ) -> tuple[IdLayer, ...]:
        """Which object each pixel shows: in front and, if glass is in view, without the glass."""
        return self._asked(partial(self._layers, data, camera, head))

    def _layers(self, data: mujoco.MjData, camera: Camera, head: bool) -> tuple[IdLayer, ...]:
        self._option.skingroup[HEAD_GROUP] = head
        rect = self._aim(data, camera)
        front = self._ids(rect)
        glass = self._glass & front.present
        if not glass:
            return (front,)
        rows, columns = _bounds(np.isin(front.ids, list(glass)))
        self._hide_glass()
        self._crop(camera, rows, columns)
        height, width = rows.stop - rows.start, columns.stop - columns.start
        window = self._ids(self._mujoco.MjrRect(0, 0, width, height))
        behind = front.ids.copy()
        behind[rows, columns] = window.ids
        return front, IdLayer(behind, front.present | window.present)

    def _ids(self, rect: mujoco.MjrRect) -> IdLayer:
        flag = self._mujoco.mjtRndFlag
        flags = self._scene.flags
        kept = flags.copy()
        flags[[flag.mjRND_SEGMENT.value, flag.mjRND_IDCOLOR.value]] = True
        flags[flag.mjRND_SHADOW.value] = False
        try:
            return self._decode(self._draw(rect, self._contexts[1]))
        finally:
            flags[:] = kept

    def _hide_glass(self) -> None:
        """Take see-through objects out of the scene; the next aim brings them back."""
        is_geom = self._mujoco.mjtObj.mjOBJ_GEOM.value
        for geom in self._scene.geoms[: self._scene.ngeom]:
            thing = self._object_of_geom[geom.objid] if geom.objtype == is_geom else NOTHING
            if geom.rgba[3] < 1.0 or thing in self._glass:
                geom.size[:] = 0.0
                geom.rgba[3] = 0.0
                geom.segid = -1

    def _crop(self, camera: Camera, rows: slice, columns: slice) -> None:
        """Narrow the view to a window of the picture, given in pixels."""
        for eye in self._scene.camera:
            pixel = (eye.frustum_top - eye.frustum_bottom) / camera.height_px
            top = eye.frustum_top
            eye.frustum_top = top - pixel * rows.start
            eye.frustum_bottom = top - pixel * rows.stop
            middle = (columns.start + columns.stop) / 2 - camera.width_px / 2
            eye.frustum_center = eye.frustum_center + pixel * middle
            eye.frustum_width = pixel * (columns.stop - columns.start) / 2

    def _decode(self, pixels: NDArray[np.uint8]) -> IdLayer:
        import cv2

        count = self._scene.ngeom
        table = np.full(max(256, count + 1), NOTHING, np.int16)
        is_geom = self._mujoco.mjtObj.mjOBJ_GEOM.value
        for geom in self._scene.geoms[:count]:
            if geom.segid >= 0 and geom.objtype == is_geom:
                table[geom.segid + 1] = self._object_of_geom[geom.objid]
        if count < 255:
            # OpenCV looks bytes up ten times faster than numpy.
            index = cv2.extractChannel(pixels, 0)
            histogram = cv2.calcHist([index], [0], None, [256], [0, 256]).ravel()
            ids = cv2.LUT(index, table[:256])
        else:
            wide = pixels[:, :, 0] + pixels[:, :, 1].astype(np.intp) * 256
            histogram = np.bincount(wide.ravel(), minlength=len(table))
            ids = table[wide]
        present = {int(i) for i in table[np.flatnonzero(histogram)]} - {NOTHING}
        return IdLayer(np.asarray(ids, np.int16), frozenset(present))

    def close(self) -> None:
        """Free the graphics memory."""
        self._free()


def _opened(model: mujoco.MjModel) -> tuple[Any, tuple[mujoco.MjrContext, mujoco.MjrContext]]:
    """A context of OpenGL, and in it those for colour and for ids."""
    gl = open_gl(model.vis.global_.offwidth, model.vis.global_.offheight)
    gl.make_current()
    return gl, (_context(model, MSAA_SAMPLES, SHADOW_MAP_PX), _plain_context(model))


def _freed(gl: Any, contexts: tuple[mujoco.MjrContext, ...]) -> None:
    """Free what `_opened` gave, in its own context."""
    gl.make_current()
    for context in contexts:
        context.free()
    gl.free()


def _bounds(mask: NDArray[np.bool_]) -> tuple[slice, slice]:
    """Rows and columns that hold all true pixels; there is at least one."""
    rows, columns = np.flatnonzero(mask.any(axis=1)), np.flatnonzero(mask.any(axis=0))
    return slice(int(rows[0]), int(rows[-1]) + 1), slice(int(columns[0]), int(columns[-1]) + 1)


def _plain_context(model: mujoco.MjModel) -> mujoco.MjrContext:
    """A context for ids, which show no texture: uploading them again would take time and memory."""
    kept = model.tex_width.copy(), model.tex_height.copy()
    model.tex_width[:], model.tex_height[:] = 1, 1
    try:
        return _context(model, 0, 0)
    finally:
        model.tex_width[:], model.tex_height[:] = kept


def _context(model: mujoco.MjModel, samples: int, shadow_px: int) -> mujoco.MjrContext:
    """Upload a model for drawing, with its own anti-aliasing and shadow map."""
    import mujoco

    quality = model.vis.quality
    kept = quality.offsamples, quality.shadowsize
    quality.offsamples, quality.shadowsize = samples, shadow_px
    try:
        return mujoco.MjrContext(model, mujoco.mjtFontScale.mjFONTSCALE_100.value)
    finally:
        quality.offsamples, quality.shadowsize = kept
