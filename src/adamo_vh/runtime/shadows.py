"""What the light that casts shadows sees: the distance of everything from it.

What stands still is drawn once; each picture starts from a copy of that and adds what can move.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from adamo_vh.geometry import Array
from adamo_vh.runtime import opengl as gl
from adamo_vh.runtime.opengl import call

if TYPE_CHECKING:
    import mujoco

SHADOW_MAP_PX = 2560
_MOST_DEG = 160.0
_SLOPE, _OFFSET = -2.5, -8.0
"""How far a surface's own shadow is kept behind it: see glPolygonOffset."""


class ShadowMap:
    """The map of one model's light. Lives in the graphics thread."""

    def __init__(self) -> None:
        """Make room for it."""
        self._still, self.texture = gl.made("Textures", 2)
        for texture in (self._still, self.texture):
            _prepare(texture)
        self._frames = gl.made("Framebuffers", 2)
        for frame, texture in zip(self._frames, (self._still, self.texture), strict=True):
            call("BindFramebuffer", "uu")(gl.FRAMEBUFFER, frame)
            call("FramebufferTexture2D", "uuuui")(
                gl.FRAMEBUFFER, gl.DEPTH_ATTACHMENT, gl.TEXTURE_2D, texture, 0
            )
            call("DrawBuffer", "u")(gl.NONE)
        self._known = b""
        self._drawn_on: tuple[int, int, int, int] | None = None
        """What of the map is not as that of what stands still: x, y, width and height."""

    def draw(
        self,
        light: mujoco.MjvLight,
        view: tuple[float, float, float],
        known: bytes,
        still: Callable[[], None],
        moving: tuple[Callable[[], None], Array],
    ) -> Array:
        """Draw the map anew.

        Args:
            light: The light.
            view: Opening angle of the map in degrees, and the nearest and farthest distance.
            known: What the map of that which stands still depends on.
            still: Draws what stands still.
            moving: Draws what can move; and (N, 4) balls around it: middle and radius.

        Returns:
            (4, 4) shadow_from_world: what to look up in the map.
        """
        project, see = _projection(*view), _look(light)
        call("MatrixMode", "u")(gl.PROJECTION)
        call("LoadMatrixf", "p")(np.ascontiguousarray(project.T, np.float32))
        call("MatrixMode", "u")(gl.MODELVIEW)
        call("LoadMatrixf", "p")(np.ascontiguousarray(see.T, np.float32))
        # A border of one pixel stays empty: what lies outside of the map is lit.
        call("Viewport", "iiii")(1, 1, SHADOW_MAP_PX - 2, SHADOW_MAP_PX - 2)
        call("Disable", "u")(gl.CULL_FACE)
        call("Enable", "u")(gl.POLYGON_OFFSET_FILL)
        call("PolygonOffset", "ff")(_SLOPE, _OFFSET)
        call("UseProgram", "u")(0)
        known += project.tobytes() + see.tobytes()
        if known != self._known:
            call("BindFramebuffer", "uu")(gl.FRAMEBUFFER, self._frames[0])
            call("Clear", "u")(gl.DEPTH_BUFFER_BIT)
            still()
            self._known = known
            self._drawn_on = (0, 0, SHADOW_MAP_PX, SHADOW_MAP_PX)
        draw, balls = moving
        if self._drawn_on is not None:
            x, y, wide, high = self._drawn_on
            there = (gl.TEXTURE_2D, 0, x, y, 0)
            call("CopyImageSubData", "uuiiiiuuiiiiiii")(
                self._still, *there, self.texture, *there, wide, high, 1
            )
        call("BindFramebuffer", "uu")(gl.FRAMEBUFFER, self._frames[1])
        draw()
        self._drawn_on = _area(balls, project, see)
        call("Enable", "u")(gl.CULL_FACE)
        call("Disable", "u")(gl.POLYGON_OFFSET_FILL)
        return _FROM_CLIP @ project @ see


def _area(balls: Array, project: Array, see: Array) -> tuple[int, int, int, int] | None:
    """The part of the map that balls may be in; None without any.

    Returns:
        Its lowest x and y, its width and its height, pixels.
    """
    if not len(balls):
        return None
    places = balls[:, :3] @ see[:3, :3].T + see[:3, 3]
    radius, away = balls[:, 3], -places[:, 2]
    side = SHADOW_MAP_PX
    if (away <= 2 * radius).any():
        return 0, 0, side, side
    flat = places[:, :2] * [project[0, 0], project[1, 1]]
    # The widest that a ball may be seen at: as if each side of it were at its nearest, or at its
    # farthest where that is nearer to the middle of the map.
    reach = radius[:, None] * [project[0, 0], project[1, 1]]
    near, far = (away - radius)[:, None], (away + radius)[:, None]
    low = np.minimum((flat - reach) / near, (flat - reach) / far).min(axis=0)
    high = np.maximum((flat + reach) / near, (flat + reach) / far).max(axis=0)
    first = np.clip(np.floor((low + 1) / 2 * side) - 2, 0, side).astype(int)
    last = np.clip(np.ceil((high + 1) / 2 * side) + 2, 0, side).astype(int)
    wide, tall = (int(size) for size in np.maximum(last - first, 0))
    return (int(first[0]), int(first[1]), wide, tall) if wide and tall else None


_FROM_CLIP = np.array(
    [[0.5, 0.0, 0.0, 0.5], [0.0, 0.5, 0.0, 0.5], [0.0, 0.0, 1.0, 0.0], [0.0, 0.0, 0.0, 1.0]]
)


def _prepare(texture: int) -> None:
    side = SHADOW_MAP_PX
    call("BindTexture", "uu")(gl.TEXTURE_2D, texture)
    size = (gl.TEXTURE_2D, 0, gl.DEPTH_COMPONENT32F, side, side, 0)
    call("TexImage2D", "uiiiiiuup")(*size, gl.DEPTH_COMPONENT, gl.FLOAT, None)
    for name, value in (
        (gl.TEXTURE_MIN_FILTER, gl.LINEAR),
        (gl.TEXTURE_MAG_FILTER, gl.LINEAR),
        (gl.TEXTURE_WRAP_S, gl.CLAMP_TO_EDGE),
        (gl.TEXTURE_WRAP_T, gl.CLAMP_TO_EDGE),
        (gl.TEXTURE_COMPARE_MODE, gl.COMPARE_R_TO_TEXTURE),
        (gl.TEXTURE_COMPARE_FUNC, gl.GEQUAL),
    ):
        call("TexParameteri", "uui")(gl.TEXTURE_2D, name, value)


def _projection(angle_deg: float, near: float, far: float) -> Array:
    """(4, 4) clip_from_light, with 1 for the nearest and 0 for the farthest distance."""
    scale = 1.0 / math.tan(math.radians(min(angle_deg, _MOST_DEG)) / 2)
    depth = near / (far - near)
    return np.array(
        [[scale, 0, 0, 0], [0, scale, 0, 0], [0, 0, depth, far * depth], [0, 0, -1, 0]], float
    )


def _look(light: mujoco.MjvLight) -> Array:
    """(4, 4) light_from_world."""
    side = np.array([-1, 0, 0] if abs(light.dir[0]) < 0.9 else [0, 1, 0], np.float32)
    up = np.cross(light.dir, side)
    return view_matrix(light.pos, light.dir, up).astype(float)


def view_matrix(
    eye: NDArray[np.float32], forward: NDArray[np.float32], up: NDArray[np.float32]
) -> NDArray[np.float32]:
    """(4, 4) camera_from_world; the camera looks along its -Z.

    Computed in the precision and order of MuJoCo's own, so that an edge falls on the same pixel.
    """
    ahead = _unit(forward)
    right = _unit(np.cross(ahead, up))
    turned = np.stack([right, _unit(np.cross(right, ahead)), -ahead])
    matrix = np.eye(4, dtype=np.float32)
    matrix[:3, :3] = turned
    matrix[:3, 3] = [-(row[0] * eye[0] + row[1] * eye[1] + row[2] * eye[2]) for row in turned]
    return matrix


def _unit(vector: NDArray[np.float32]) -> NDArray[np.float32]:
    x, y, z = np.asarray(vector, np.float32)
    scale: np.float32 = np.float32(1) / np.sqrt(x * x + y * y + z * z)
    return np.array([x * scale, y * scale, z * scale], np.float32)
