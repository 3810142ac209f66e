"""Headless drawing: the colour picture and, for each pixel, which interactable object it shows.

One graphics context is kept and the scene is drawn twice with `mjr_render`: in colour with a
shadow, then as flat ids without shadows, which costs a quarter of the first. The Python `Renderer`
of MuJoCo builds the same picture but decodes ids geom by geom; this one reads one byte a pixel.
"""

from __future__ import annotations

import ctypes
import math
import os
import sys
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from adamo.errors import RenderingError
from adamo.geometry import Camera
from adamo.observation import NOTHING

if TYPE_CHECKING:
    import mujoco

MSAA_SAMPLES = 4
SHADOW_MAP_PX = 2048
_MAX_GEOMS = 4000
_FIX = "install one with 'apt-get install libegl1 libgl1-mesa-dri' (or libosmesa6)"


def open_gl(width_px: int, height_px: int) -> Any:
    """Open an off-screen OpenGL context: EGL, else OSMesa; `MUJOCO_GL` decides where it is set.

    Returns:
        A context with `make_current` and `free`.

    Raises:
        RenderingError: Neither works; names the packages that help.
    """
    asked = os.environ.get("MUJOCO_GL", "").lower()
    backends = [asked] if asked in ("egl", "osmesa") else ["egl", "osmesa"]
    problems = []
    for backend in backends:
        try:
            return _open_backend(backend, width_px, height_px)
        except (ImportError, RuntimeError, AttributeError, OSError, TypeError) as error:
            problems.append(f"{backend}: {error}")
    raise RenderingError(f"No OpenGL to draw with ({'; '.join(problems)}); {_FIX}.")


def _open_backend(backend: str, width_px: int, height_px: int) -> Any:
    library = {"egl": "libEGL.so.1", "osmesa": "libOSMesa.so.8"}[backend]
    if sys.platform == "linux":
        ctypes.CDLL(library)
    if os.environ.get("PYOPENGL_PLATFORM", backend) != backend:
        # PyOpenGL binds to one platform at import; a failed first choice must be unloaded.
        for name in [n for n in sys.modules if n.split(".")[0] == "OpenGL"]:
            del sys.modules[name]
        sys.modules.pop("mujoco.egl", None)
        sys.modules.pop("mujoco.egl.egl_ext", None)
    os.environ["PYOPENGL_PLATFORM"] = backend
    if backend == "egl":
        from mujoco.egl import GLContext
    else:
        from mujoco.osmesa import GLContext
    return GLContext(width_px, height_px)


class SceneRenderer:
    """Draws one MuJoCo model from any camera, in colour and as ids."""

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
        self._object_of_geom = object_of_geom
        self._gl = open_gl(model.vis.global_.offwidth, model.vis.global_.offheight)
        self._gl.make_current()
        self._context: mujoco.MjrContext | None = mujoco.MjrContext(
            model, mujoco.mjtFontScale.mjFONTSCALE_100.value
        )
        mujoco.mjr_setBuffer(mujoco.mjtFramebuffer.mjFB_OFFSCREEN.value, self._context)
        self._scene = mujoco.MjvScene(model, maxgeom=_MAX_GEOMS)
        self._option = mujoco.MjvOption()
        self._camera = mujoco.MjvCamera()
        self._camera.type = mujoco.mjtCamera.mjCAMERA_FREE.value
        self._buffer = np.empty((0, 0, 3), np.uint8)
        material = model.geom_matid
        alpha = np.where(material >= 0, model.mat_rgba[material, 3], model.geom_rgba[:, 3])
        drawn = model.geom_group < 3
        self._glass = np.unique(object_of_geom[(alpha < 1) & drawn])

    def shows_glass(self, ids: NDArray[np.int16]) -> bool:
        """Whether a transparent object is in an id picture, so that others may stand behind it."""
        return any(bool((ids == i).any()) for i in self._glass if i != NOTHING)

    def _aim(self, data: mujoco.MjData, camera: Camera) -> mujoco.MjrRect:
        """Point the MuJoCo camera, update the scene, and fit the buffers."""
        import mujoco

        if self._context is None:
            raise RenderingError("The renderer was closed; make a new engine.")
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
        width, height = camera.width_px, camera.height_px
        if width > self._context.offWidth or height > self._context.offHeight:
            mujoco.mjr_resizeOffscreen(width, height, self._context)
        if self._buffer.shape[:2] != (height, width):
            self._buffer = np.empty((height, width, 3), np.uint8)
        return mujoco.MjrRect(0, 0, width, height)

    def _draw(self, rect: mujoco.MjrRect) -> NDArray[np.uint8]:
        import mujoco

        mujoco.mjr_render(rect, self._scene, self._context)
        mujoco.mjr_readPixels(self._buffer, None, rect, self._context)
        return self._buffer[::-1]

    def color(self, data: mujoco.MjData, camera: Camera) -> NDArray[np.uint8]:
        """Draw the colour picture: (H, W, 3) uint8."""
        rect = self._aim(data, camera)
        return self._draw(rect).copy()

    def ids(
        self, data: mujoco.MjData, camera: Camera, *, through_glass: bool = False
    ) -> NDArray[np.int16]:
        """Draw which object each pixel shows.

        Args:
            data: The state of the world.
            camera: From where.
            through_glass: Leave transparent things out, to see what stands behind them.

        Returns:
            (H, W) int16: object ids, `NOTHING` elsewhere.
        """
        import mujoco

        rect = self._aim(data, camera)
        flags = self._scene.flags
        kept = flags.copy()
        flags[mujoco.mjtRndFlag.mjRND_SEGMENT] = True
        flags[mujoco.mjtRndFlag.mjRND_IDCOLOR] = True
        flags[mujoco.mjtRndFlag.mjRND_SHADOW] = False
        if through_glass:
            self._hide_glass()
        try:
            pixels = self._draw(rect)
        finally:
            flags[:] = kept
        return self._decode(pixels)

    def _hide_glass(self) -> None:
        """Take transparent geoms out of the scene (it is rebuilt at the next drawing)."""
        for geom in self._scene.geoms[: self._scene.ngeom]:
            if geom.rgba[3] < 1.0:
                geom.segid = -1
                geom.rgba[3] = 0.0
                geom.size[:] = 0.0

    def _decode(self, pixels: NDArray[np.uint8]) -> NDArray[np.int16]:
        import mujoco

        count = self._scene.ngeom
        table = np.full(max(256, count + 1), NOTHING, np.int16)
        is_geom = mujoco.mjtObj.mjOBJ_GEOM.value
        for geom in self._scene.geoms[:count]:
            if geom.segid >= 0 and geom.objtype == is_geom:
                table[geom.segid + 1] = self._object_of_geom[geom.objid]
        index: NDArray[Any] = pixels[:, :, 0]
        if count >= 255:
            index = index + pixels[:, :, 1].astype(np.uint16) * 256
        return np.asarray(table[index])

    def close(self) -> None:
        """Free the graphics memory."""
        if self._context is not None:
            self._gl.make_current()
            self._context.free()
            self._context = None
            self._gl.free()
