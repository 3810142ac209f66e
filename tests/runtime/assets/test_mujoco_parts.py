"""How assets become geoms: what casts shadows, and that nothing of a mesh gets lost on the way."""

from __future__ import annotations

from dataclasses import replace

import mujoco
import numpy as np
import pytest

from adamo_vh.runtime.assets import catalog
from adamo_vh.runtime.assets.asset import Asset, Looks, Material, Part
from adamo_vh.runtime.assets.bake import load_asset
from adamo_vh.runtime.assets.kit import box
from adamo_vh.runtime.assets.mujoco_parts import add_asset, is_closed

LAMP = (-1.0, -2.0, 3.0)
BLOCK = box(0.4, 0.6, 0.8, 0.02).part(Material("oak"))


def compiled(*parts: Part, lamp: tuple[float, float, float] | None = LAMP) -> mujoco.MjModel:
    """A model of one asset that does not move."""
    asset = Asset("Block", (0.4, 0.6, 0.8), parts, (), 1.0, Looks("block", ("brown",), "box"))
    spec = mujoco.MjSpec()
    body = spec.worldbody.add_body(name="block")
    add_asset(spec, body, asset, "block", collide=False, shadow_light=lamp)
    return spec.compile()


def test_furniture_casts_shadows_from_its_unlit_sides_only() -> None:
    """A lit side that casts would be speckled by its own shadow."""
    model = compiled(BLOCK)
    lit, unlit = sorted(range(model.ngeom), key=lambda geom: bool(model.geom_castshadow[geom]))
    assert model.geom_castshadow.tolist().count(True) == 1
    assert model.mesh_facenum.sum() == len(BLOCK.faces)
    for geom, away in ((lit, False), (unlit, True)):
        corners = faces_in_world(model, geom)
        normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        assert ((np.einsum("ij,ij->i", normals, corners[:, 0] - LAMP) > 0) == away).all()


@pytest.mark.parametrize("casts", [True, False])
def test_what_moves_is_one_geom_for_each_part(casts: bool) -> None:
    part = replace(BLOCK, material=replace(BLOCK.material, casts_shadow=casts))
    model = compiled(part, lamp=None)
    assert model.ngeom == 1
    assert bool(model.geom_castshadow[0]) == casts


def test_an_open_sheet_casts_from_both_sides() -> None:
    """It has no side in shadow that would stand in for the lit one."""
    lid = replace(BLOCK, faces=BLOCK.faces[: len(BLOCK.faces) // 2])
    assert is_closed(BLOCK) and not is_closed(lid)
    model = compiled(lid)
    assert model.ngeom == 1 and model.geom_castshadow[0]


@pytest.mark.parametrize("name", ["sofa", "chair", "dining_table", "tall_shelf", "sideboard"])
def test_large_furniture_is_closed(name: str) -> None:
    assert name in catalog.FURNITURE
    assert all(is_closed(part) for part in load_asset(name).parts)


def faces_in_world(model: mujoco.MjModel, geom: int) -> np.ndarray:
    """(M, 3, 3) corners of a geom's triangles."""
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    mesh = int(model.geom_dataid[geom])
    first, count = model.mesh_vertadr[mesh], model.mesh_vertnum[mesh]
    turn = data.geom_xmat[geom].reshape(3, 3)
    places = model.mesh_vert[first : first + count] @ turn.T + data.geom_xpos[geom]
    start, faces = model.mesh_faceadr[mesh], model.mesh_facenum[mesh]
    return np.asarray(places[model.mesh_face[start : start + faces]])
