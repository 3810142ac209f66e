"""Draw a model in one pass: colours, and with them what each pixel shows.

MuJoCo uploads meshes, textures and skins, and keeps a scene of lights and skins up to date. Its own
`mjr_render` draws everything three times for one light with shadows, and again for ids.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from adamo_vh.errors import RenderingError
from adamo_vh.geometry import Array
from adamo_vh.runtime import opengl as gl
from adamo_vh.runtime import textures
from adamo_vh.runtime.brush import Brush, Program, Programs
from adamo_vh.runtime.canvas import COLOURS, LABELS, Canvas
from adamo_vh.runtime.opengl import call
from adamo_vh.runtime.parts import Parts
from adamo_vh.runtime.shadows import ShadowMap, view_matrix

if TYPE_CHECKING:
    import mujoco


@dataclass(frozen=True, slots=True, eq=False)
class Painting:
    """Pictures of one moment, (H, W, 4) with the bottom row first, until the next is painted."""

    colours: NDArray[np.uint8]
    labels: NDArray[np.uint8]
    """What each pixel shows; see `adamo_vh.runtime.shading`."""
    behind: NDArray[np.uint8] | None
    """The labels without glass, if glass may be in view."""


class Painter:
    """What one model is drawn with. Lives in the graphics thread and in a context of its own."""

    def __init__(self, model: mujoco.MjModel, object_of_geom: NDArray[np.int16]) -> None:
        """Upload a model into the current context.

        Args:
            model: The compiled world.
            object_of_geom: (ngeom,) object id of each geom, or `NOTHING`.
        """
        self.context = _uploaded(model)
        self.parts = Parts(model, self.context, object_of_geom)
        self._brush = Brush(model, self.parts, self.context)
        self._map = ShadowMap()
        self._canvas = Canvas()
        self._programs: dict[bool, Programs] = {
            shadow: {texture: Program(texture=texture, shadow=shadow) for texture in (False, True)}
            for shadow in (False, True)
        }
        _set_up(self._map.texture)
        self._places = np.empty(0)
        self._roams = self.parts.moves.copy()
        """Which parts have been elsewhere already; skins always count as such."""
        self._roams[: len(self.parts.geoms)] = False
        self._shadow_of = np.eye(4)

    def check(self) -> None:
        """Make sure that nobody has freed what this draws with.

        Raises:
            RenderingError: Somebody has.
        """
        context = self.context
        things = [
            ("Framebuffer", self._canvas.frame),
            ("List", context.basePlane),
            ("List", self.parts.first_look),
            ("Texture", self._map.texture),
        ]
        if context.ntexture:
            things += [("Texture", int(context.texture[i])) for i in (0, context.ntexture - 1)]
        if not all(call(f"Is{kind}", "u", "b")(name) for kind, name in things):
            raise RenderingError(
                "Another OpenGL user of this process has freed what the engine draws with: "
                "its pictures would be wrong. Make a new engine."
            )

    def paint(
        self,
        data: mujoco.MjData,
        scene: mujoco.MjvScene,
        size: tuple[int, int],
        *,
        groups: NDArray[np.bool_],
        shadow: bool,
        again: bool = False,
    ) -> Painting:
        """Draw what the scene's camera sees.

        Args:
            data: The state of the world.
            scene: MuJoCo's scene of it.
            size: Width and height of the picture, pixels.
            groups: Which groups of skins to draw.
            shadow: Draw shadows.
            again: Take the shadows of the picture before, which was of the same moment.
        """
        parts, brush = self.parts, self._brush
        brush.start(data, scene)
        shown = np.ones(len(parts), bool)
        shown[len(parts.geoms) :] = groups[parts.skin_group]
        casters = [i for i in range(scene.nlight) if scene.lights[i].castshadow]
        caster = casters[0] if shadow and casters else -1
        if caster >= 0 and not again:
            self._shadow_of = self._shadows(scene, caster, shown)
        to_shadow = np.eye(4) if caster < 0 else self._shadow_of
        self._canvas.begin(*size)
        eye, half_angles = _aim(scene, size)
        _set_lights(scene)
        to_world = np.asarray(np.linalg.inv(eye), float)
        for shadowed, programs in self._programs.items():
            for program in programs.values():
                program.set(scene.nlight, caster if shadowed else -1, to_shadow @ to_world)
        shown &= brush.in_view(eye, half_angles)
        programs = self._programs[caster >= 0]
        brush.draw(shown & ~parts.of_glass, programs)
        behind = None
        if (shown & parts.of_glass).any():
            behind = self._canvas.read(LABELS).copy()
            brush.draw(shown & parts.of_glass & ~parts.clear, programs)
            self._draw_clear(np.flatnonzero(shown & parts.clear), to_world[:3, 3])
        return Painting(self._canvas.read(COLOURS), self._canvas.read(LABELS), behind)

    def _shadows(self, scene: mujoco.MjvScene, caster: int, shown: NDArray[np.bool_]) -> Array:
        """Draw the shadow map of a light; what to look up in it, from the world."""
        parts, brush = self.parts, self._brush
        light, eye = scene.lights[caster], scene.camera[0]
        self._watch_parts()
        still, moving = parts.casts & ~self._roams, parts.casts & self._roams & shown
        angle = 2 * light.cutoff * self.context.shadowScale
        return self._map.draw(
            light,
            (angle, eye.frustum_near, eye.frustum_far),
            brush.at[still].tobytes() + brush.turns[still[: len(parts.geoms)]].tobytes(),
            partial(brush.draw_shapes, still),
            (
                partial(brush.draw_shapes, moving),
                np.column_stack([brush.at[moving], brush.radius[moving]]),
            ),
        )

    def _watch_parts(self) -> None:
        """Note what is elsewhere than before: from now on it is drawn anew each time."""
        geoms, brush = len(self.parts.geoms), self._brush
        places = np.column_stack([brush.at[:geoms], brush.turns.reshape(geoms, 16)])
        if len(self._places):
            self._roams[:geoms] |= (places != self._places).any(axis=1)
        self._places = places

    def _draw_clear(self, which: NDArray[np.intp], eye: Array) -> None:
        """Draw what is see-through, the near before the far and back again, as MuJoCo does."""
        brush, programs = self._brush, self._programs[False]
        away = np.linalg.norm(brush.at[which] - eye, axis=1) - brush.radius[which]
        inwards = which[np.argsort(away, kind="stable")]
        self._canvas.draw_into(COLOURS)
        call("DepthMask", "b")(0)
        call("Enable", "u")(gl.BLEND)
        brush.draw_in_order(inwards, programs)
        brush.draw_in_order(inwards[::-1], programs)
        call("Disable", "u")(gl.BLEND)
        call("DepthMask", "b")(1)
        self._canvas.draw_into(LABELS)
        brush.draw_in_order(inwards, programs)


def _uploaded(model: mujoco.MjModel) -> mujoco.MjrContext:
    """A model's meshes and textures in OpenGL, without what MuJoCo itself would draw on."""
    import mujoco

    vis = model.vis
    kept = vis.quality.offsamples, vis.quality.shadowsize
    sizes = vis.global_.offwidth, vis.global_.offheight
    vis.quality.offsamples = vis.quality.shadowsize = 0
    vis.global_.offwidth = vis.global_.offheight = 1
    try:
        with textures.left_out(model):
            context = mujoco.MjrContext(model, mujoco.mjtFontScale.mjFONTSCALE_50.value)
        textures.upload(model, context)
        return context
    finally:
        vis.quality.offsamples, vis.quality.shadowsize = kept
        vis.global_.offwidth, vis.global_.offheight = sizes


def _set_up(shadow_map: int) -> None:
    """Set what is the same for all pictures."""
    for name in (gl.DEPTH_TEST, gl.CULL_FACE):
        call("Enable", "u")(name)
    for name in (gl.LIGHTING, gl.FOG, gl.ALPHA_TEST, gl.BLEND, gl.STENCIL_TEST, gl.MULTISAMPLE):
        call("Disable", "u")(name)
    # Distances fall from 1 to 0, which spends the precision of floats evenly.
    call("ClipControl", "uu")(gl.LOWER_LEFT, gl.ZERO_TO_ONE)
    call("DepthFunc", "u")(gl.GEQUAL)
    call("ClearDepth", "d")(0.0)
    call("FrontFace", "u")(gl.CCW)
    call("BlendFunc", "uu")(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA)
    call("ActiveTexture", "u")(gl.TEXTURE1)
    call("BindTexture", "uu")(gl.TEXTURE_2D, shadow_map)
    call("ActiveTexture", "u")(gl.TEXTURE0)


def _aim(scene: mujoco.MjvScene, size: tuple[int, int]) -> tuple[Array, tuple[float, float]]:
    """Look through the scene's camera.

    Returns:
        (4, 4) camera_from_world, and half of the horizontal and vertical opening, radians.
    """
    left, right = scene.camera
    top, near, far = left.frustum_top, left.frustum_near, left.frustum_far
    side = 0.5 * size[0] / size[1] * (top - left.frustum_bottom)
    call("MatrixMode", "u")(gl.PROJECTION)
    call("LoadIdentity")()
    call("Translatef", "fff")(0.0, 0.0, 0.5)
    call("Scalef", "fff")(1.0, 1.0, -0.5)
    call("Frustum", "dddddd")(-side, side, left.frustum_bottom, top, near, far)
    call("MatrixMode", "u")(gl.MODELVIEW)
    eye = view_matrix((left.pos + right.pos) / 2, left.forward, left.up)
    call("LoadMatrixf", "p")(np.ascontiguousarray(eye.T))
    return eye.astype(float), (math.atan(side / near), math.atan(top / near))


def _set_lights(scene: mujoco.MjvScene) -> None:
    import mujoco

    set_one, set_all = call("Lightf", "uuf"), call("Lightfv", "uup")
    for number in range(scene.nlight):
        light, name = scene.lights[number], gl.LIGHT0 + number
        for what, values in (
            (gl.AMBIENT, light.ambient),
            (gl.DIFFUSE, light.diffuse),
            (gl.SPECULAR, light.specular),
        ):
            set_all(name, what, gl.floats(*values, 1.0))
        if light.type == mujoco.mjtLightType.mjLIGHT_DIRECTIONAL:
            set_one(name, gl.SPOT_CUTOFF, 180.0)
            set_all(name, gl.POSITION, gl.floats(*-light.dir, 0.0))
        else:
            set_one(name, gl.SPOT_EXPONENT, light.exponent)
            set_one(name, gl.SPOT_CUTOFF, light.cutoff)
            set_all(name, gl.SPOT_DIRECTION, gl.floats(*light.dir, 0.0))
            set_all(name, gl.POSITION, gl.floats(*light.pos, 1.0))
