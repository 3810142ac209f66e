"""What a model is drawn of: the meshes of its geoms and the skins of its figure, ready to call."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from adamo_vh.observation import NOTHING
from adamo_vh.runtime import opengl as gl
from adamo_vh.runtime.opengl import call

if TYPE_CHECKING:
    import mujoco

_HIDDEN_GROUP = 3
"""Geom groups from here on are not drawn."""
_CLEAR_BELOW = 0.995
"""Less opaque than this is drawn as glass."""
_UNSET = np.array([0.5, 0.5, 0.5, 1.0], np.float32)
"""The colour of a geom or skin that leaves it to its material."""


class Parts:
    """The drawn geoms, small ones first, so that what they hide need not be shaded; then the skins.

    All lists and arrays are in that order; a part's number in labels is its place in it, from 1.
    Lives in the graphics thread.
    """

    def __init__(
        self,
        model: mujoco.MjModel,
        context: mujoco.MjrContext,
        object_of_geom: NDArray[np.int16],
    ) -> None:
        """Record how each part is drawn.

        Args:
            model: The compiled world.
            context: What MuJoCo uploaded of it.
            object_of_geom: (ngeom,) object id of each geom, or `NOTHING`.
        """
        import mujoco

        meshes = model.geom_type == mujoco.mjtGeom.mjGEOM_MESH.value
        drawn = np.flatnonzero(meshes & (model.geom_group < _HIDDEN_GROUP))
        self.geoms = drawn[np.argsort(model.geom_rbound[drawn], kind="stable")]
        """(N,) the geom of each part that is one."""
        skins = np.ones(model.nskin, bool)
        moves = model.body_weldid[model.geom_bodyid[self.geoms]] != 0
        self.moves = np.concatenate([moves, skins])
        self.casts = np.concatenate([model.geom_castshadow[self.geoms].astype(bool), skins])
        self.skin_group = model.skin_group.copy()
        """(S,) the group of each skin."""
        material = np.concatenate([model.geom_matid[self.geoms], model.skin_matid])
        own = np.concatenate([model.geom_rgba[self.geoms], model.skin_rgba])
        theirs = np.where(material[:, np.newaxis] < 0, own, model.mat_rgba[material])
        rgba = np.where((own == _UNSET).all(axis=1)[:, np.newaxis], theirs, own)
        texture = np.where(material < 0, -1, model.mat_texid[material, _rgb_role()])
        self.textured: list[bool] = (texture >= 0).tolist()
        """Which show a picture."""
        owner = np.concatenate([object_of_geom[self.geoms], np.full(model.nskin, NOTHING)])
        self.clear = rgba[:, 3] < _CLEAR_BELOW
        """Which are see-through."""
        see_through = np.unique(owner[self.clear & (owner != NOTHING)])
        self.of_glass = np.isin(owner, see_through) | self.clear
        """Which are see-through, or belong to an object that is so somewhere."""
        self.glass = frozenset(int(i) for i in see_through)
        """The objects that are see-through somewhere."""
        self.object_of = np.full(max(256, len(owner) + 1), NOTHING, np.int16)
        """Object id by number in labels."""
        self.object_of[1 : len(owner) + 1] = owner
        self.shapes = [int(context.baseMesh + 2 * model.geom_dataid[geom]) for geom in self.geoms]
        """The display list of each geom's bare mesh."""
        self.first_look: int = call("GenLists", "i", "u")(len(owner))
        """The display list of the first part, with its material; the others follow."""
        for number in range(len(owner)):
            call("NewList", "uu")(self.first_look + number, gl.COMPILE)
            _set_material(model, int(material[number]), rgba[number])
            if texture[number] >= 0:
                name = int(context.texture[texture[number]])
                call("BindTexture", "uu")(gl.TEXTURE_2D, name)
            if number < len(self.geoms):
                call("CallList", "u")(self.shapes[number])
            call("EndList")()

    def __len__(self) -> int:
        """How many there are."""
        return len(self.textured)


def _rgb_role() -> int:
    import mujoco

    return int(mujoco.mjtTextureRole.mjTEXROLE_RGB.value)


def _set_material(model: mujoco.MjModel, material: int, rgba: NDArray[np.float32]) -> None:
    emission, specular, shininess = 0.0, 0.5, 0.5
    if material >= 0:
        emission = float(model.mat_emission[material])
        specular = float(model.mat_specular[material])
        shininess = float(model.mat_shininess[material])
    red, green, blue, alpha = map(float, rgba)
    call("Color4f", "ffff")(red, green, blue, alpha)
    glow = gl.floats(emission * red, emission * green, emission * blue, 1.0)
    call("Materialfv", "uup")(gl.FRONT, gl.EMISSION, glow)
    call("Materialfv", "uup")(gl.FRONT, gl.SPECULAR, gl.floats(specular, specular, specular, 1.0))
    call("Materialf", "uuf")(gl.FRONT, gl.SHININESS, shininess * 128.0)
