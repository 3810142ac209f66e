"""Draw parts of a model where they are now, with the camera and lights that are set."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from adamo_vh.geometry import Array
from adamo_vh.runtime import opengl as gl
from adamo_vh.runtime.opengl import call
from adamo_vh.runtime.parts import Parts
from adamo_vh.runtime.shading import VERTEX, fragment

if TYPE_CHECKING:
    import mujoco


class Program:
    """How pixels are shaded, with the numbers of its settings."""

    def __init__(self, *, texture: bool, shadow: bool) -> None:
        """Compile it.

        Args:
            texture: For parts that show a picture.
            shadow: Look shadows up.
        """
        self.name = gl.program(VERTEX.lstrip(), fragment(texture=texture, shadow=shadow))
        self.part = gl.uniform(self.name, "part")
        self._lights = gl.uniform(self.name, "lights")
        self._caster = gl.uniform(self.name, "caster")
        self._to_shadow = gl.uniform(self.name, "to_shadow")
        call("UseProgram", "u")(self.name)
        for number, name in enumerate(("picture", "shadow")):
            call("Uniform1i", "ii")(gl.uniform(self.name, name), number)

    def set(self, lights: int, caster: int, to_shadow: Array) -> None:
        """Set what is the same for a whole picture.

        Args:
            lights: How many there are.
            caster: Which of them casts shadows; -1 for none.
            to_shadow: (4, 4) shadow map from camera.
        """
        matrix = np.ascontiguousarray(to_shadow, np.float32)
        call("UseProgram", "u")(self.name)
        call("Uniform1i", "ii")(self._lights, lights)
        call("Uniform1i", "ii")(self._caster, caster)
        call("UniformMatrix4fv", "iibp")(self._to_shadow, 1, 1, matrix)


Programs = Mapping[bool, Program]
"""For parts without and with a picture on them."""


class Brush:
    """Draws the parts of one model. Lives in the graphics thread."""

    def __init__(self, model: mujoco.MjModel, parts: Parts, context: mujoco.MjrContext) -> None:
        """Draw nothing yet.

        Args:
            model: The compiled world.
            parts: What there is to draw.
            context: What MuJoCo uploaded of it.
        """
        self._parts, self._context = parts, context
        self.at = np.zeros((len(parts), 3), np.float32)
        """(N, 3) the middle of each part."""
        radius = model.geom_rbound[parts.geoms], np.zeros(model.nskin)
        self.radius = np.concatenate(radius)
        """(N,) how far each part reaches from there."""
        self.turns = np.zeros((len(parts.geoms), 4, 4), np.float32)
        """(G, 4, 4) how the geoms are turned, column by column as OpenGL has it."""
        self.turns[:, 3, 3] = 1.0
        self._corners = [3 * int(count) for count in model.skin_facenum]

    def start(self, data: mujoco.MjData, scene: mujoco.MjvScene) -> None:
        """Take over where everything is now."""
        geoms = self._parts.geoms
        self.at[: len(geoms)] = data.geom_xpos[geoms]
        rotations = data.geom_xmat[geoms].reshape(-1, 3, 3)
        self.turns[:, :3, :3] = rotations.transpose(0, 2, 1)
        vertices, normals = np.ravel(scene.skinvert), np.ravel(scene.skinnormal)
        for skin in range(scene.nskin):
            first, count = int(scene.skinvertadr[skin]), int(scene.skinvertnum[skin])
            own = slice(3 * first, 3 * (first + count))
            _upload(self._context.skinvertVBO[skin], vertices[own])
            _upload(self._context.skinnormalVBO[skin], normals[own])
            corners = vertices[own].reshape(-1, 3)
            low, high = corners.min(axis=0), corners.max(axis=0)
            self.at[len(geoms) + skin] = (low + high) / 2
            self.radius[len(geoms) + skin] = np.linalg.norm(high - low) / 2
        call("BindBuffer", "uu")(gl.ARRAY_BUFFER, 0)

    def in_view(self, eye: Array, half_angles: tuple[float, float]) -> NDArray[np.bool_]:
        """(N,) whether anything of each part may be seen.

        Args:
            eye: (4, 4) camera_from_world.
            half_angles: Half of the picture's horizontal and vertical opening, radians.
        """
        before = self.at @ eye[:3, :3].T + eye[:3, 3]
        seen: NDArray[np.bool_] = before[:, 2] < self.radius
        for axis, angle in enumerate(half_angles):
            outside = np.abs(before[:, axis]) * np.cos(angle) + before[:, 2] * np.sin(angle)
            seen &= outside < self.radius
        return seen

    def draw(self, which: NDArray[np.bool_], programs: Programs) -> None:
        """Draw parts with their materials, in order."""
        self.draw_in_order(np.flatnonzero(which), programs)

    def draw_in_order(self, which: NDArray[np.intp], programs: Programs) -> None:
        """Draw parts, given by their places, with their materials."""
        geoms = len(self._parts.geoms)
        for part in which.tolist():
            self._begin(part, programs)
            look = self._parts.first_look + part
            if part < geoms:
                self._put_geom(part, look)
            else:
                call("CallList", "u")(look)
                self._put_skin(part - geoms)

    def draw_shapes(self, which: NDArray[np.bool_]) -> None:
        """Draw the bare shapes of parts."""
        shapes = self._parts.shapes
        for part in np.flatnonzero(which).tolist():
            if part < len(shapes):
                self._put_geom(part, shapes[part])
            else:
                self._put_skin(part - len(shapes))

    def _put_geom(self, part: int, shape: int) -> None:
        call("PushMatrix")()
        call("Translatef", "fff")(*self.at[part].tolist())
        call("MultMatrixf", "p")(self.turns[part])
        call("CallList", "u")(shape)
        call("PopMatrix")()

    def _begin(self, part: int, programs: Programs) -> None:
        program = programs[self._parts.textured[part]]
        call("UseProgram", "u")(program.name)
        number = part + 1
        call("Uniform2f", "iff")(program.part, (number & 255) / 255, (number >> 8) / 255)

    def _put_skin(self, skin: int) -> None:
        context = self._context
        arrays = [
            (gl.VERTEX_ARRAY, context.skinvertVBO, "VertexPointer", (3, gl.FLOAT)),
            (gl.NORMAL_ARRAY, context.skinnormalVBO, "NormalPointer", (gl.FLOAT,)),
            (gl.TEXTURE_COORD_ARRAY, context.skintexcoordVBO, "TexCoordPointer", (2, gl.FLOAT)),
        ]
        for array, buffers, point, kind in arrays:
            buffer = int(buffers[skin])
            if not buffer:
                continue
            call("EnableClientState", "u")(array)
            call("BindBuffer", "uu")(gl.ARRAY_BUFFER, buffer)
            call(point, "iuip" if len(kind) == 2 else "uip")(*kind, 0, None)
        call("BindBuffer", "uu")(gl.ELEMENT_ARRAY_BUFFER, int(context.skinfaceVBO[skin]))
        call("DrawElements", "uiup")(gl.TRIANGLES, self._corners[skin], gl.UNSIGNED_INT, None)
        for array, *_ in arrays:
            call("DisableClientState", "u")(array)
        call("BindBuffer", "uu")(gl.ARRAY_BUFFER, 0)
        call("BindBuffer", "uu")(gl.ELEMENT_ARRAY_BUFFER, 0)


def _upload(buffer: int, values: NDArray[np.float32]) -> None:
    call("BindBuffer", "uu")(gl.ARRAY_BUFFER, int(buffer))
    size = gl.ARRAY_BUFFER, values.nbytes
    call("BufferData", "uzpu")(*size, values, gl.STREAM_DRAW)
