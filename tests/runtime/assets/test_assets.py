"""What every asset promises: its size, its looks, its collision shape, its place in MuJoCo."""

from __future__ import annotations

import time
from dataclasses import dataclass, fields, replace
from functools import cache
from pathlib import Path

import mujoco
import numpy as np
import pytest
from numpy.typing import NDArray

from adamo_vh.runtime.assets import bake, catalog, kit
from adamo_vh.runtime.assets.asset import Asset, Collider, Material
from adamo_vh.runtime.assets.mujoco_parts import COLLISION_GROUP, VISUAL_GROUP, add_asset


@dataclass(frozen=True)
class Promise:
    """What a scene counts on."""

    class_name: str
    size: tuple[float, float, float]
    white_parts: bool = False
    label: str | None = None


PROMISES = {
    "lock_brass": Promise("Lock", (0.045, 0.020, 0.077)),
    "flashlight": Promise("Flashlight", (0.180, 0.045, 0.045)),
    "battery_large": Promise("Battery", (0.046, 0.032, 0.077)),
    "tape": Promise("Tape", (0.136, 0.136, 0.043)),
    "screwdriver": Promise("Screwdriver", (0.228, 0.022, 0.021)),
    "peanut_butter": Promise("PeanutButter", (0.109, 0.109, 0.150), label="PEANUT BUTTER"),
    "lock_steel": Promise("Lock", (0.061, 0.026, 0.062)),
    "tomato_soup": Promise("TomatoSoup", (0.070, 0.070, 0.105), True, "TOMATO SOUP"),
    "pills": Promise("Pills", (0.055, 0.055, 0.085), True, "PILLS"),
    "binoculars": Promise("Binoculars", (0.192, 0.173, 0.069)),
    "painkiller": Promise("Painkiller", (0.046, 0.046, 0.112), True, "PAINKILLER"),
    "lighter": Promise("Lighter", (0.070, 0.022, 0.090)),
    "battery_small": Promise("Battery", (0.022, 0.023, 0.082)),
    "key": Promise("Key", (0.055, 0.024, 0.002)),
    "wine_bottle": Promise("WineBottle", (0.063, 0.064, 0.241), True, "RED WINE"),
    "glass": Promise("Glass", (0.100, 0.100, 0.143)),
    "cup": Promise("Cup", (0.149, 0.105, 0.131)),
    "indoor_plant": Promise("IndoorPlant", (0.250, 0.250, 0.340)),
    "plate": Promise("Plate", (0.250, 0.250, 0.030), True),
    # Further things that a variation may put among them; none has white parts or a label.
    "banana": Promise("Banana", (0.185, 0.078, 0.036)),
    "apple": Promise("Apple", (0.078, 0.078, 0.088)),
    "pumpkin": Promise("Pumpkin", (0.170, 0.170, 0.150)),
    "rubber_duck": Promise("RubberDuck", (0.090, 0.110, 0.105)),
    "toy_car": Promise("ToyCar", (0.066, 0.130, 0.056)),
    "teapot": Promise("Teapot", (0.230, 0.140, 0.150)),
    "wooden_spoon": Promise("WoodenSpoon", (0.280, 0.058, 0.020)),
    "scissors": Promise("Scissors", (0.190, 0.086, 0.012)),
    "remote_control": Promise("RemoteControl", (0.046, 0.170, 0.020)),
    "hammer": Promise("Hammer", (0.290, 0.120, 0.034)),
}
EVERYTHING = [*catalog.OBJECTS, *catalog.FURNITURE]
MILLIMETRE = 1e-3
MAX_TRIANGLES = 5000


built = cache(catalog.build)


@pytest.fixture
def asset(request: pytest.FixtureRequest) -> Asset:
    return built(request.param)


DECORATION = {"Curtains", "PendantLamp", "Picture", "Rug"}
"""Hangs out of reach or lies flat: nothing can touch it."""

every_asset = pytest.mark.parametrize("asset", EVERYTHING, indirect=True)
every_object = pytest.mark.parametrize("asset", list(catalog.OBJECTS), indirect=True)


# --- looks ----------------------------------------------------------------------------------


def test_every_object_has_a_promise() -> None:
    assert set(catalog.OBJECTS) == set(PROMISES)


@pytest.mark.parametrize("name", PROMISES)
def test_object_is_what_scenes_count_on(name: str) -> None:
    asset, promise = built(name), PROMISES[name]
    assert asset.class_name == promise.class_name
    assert asset.size == promise.size
    assert asset.looks.white_parts == promise.white_parts
    assert asset.looks.label == promise.label


@every_asset
def test_parts_span_exactly_the_declared_size(asset: Asset) -> None:
    lower, upper = bounds(asset)
    np.testing.assert_allclose(upper - lower, asset.size, atol=1e-6)


@every_object
def test_objects_have_their_origin_in_the_middle(asset: Asset) -> None:
    lower, upper = bounds(asset)
    np.testing.assert_allclose(lower + upper, 0.0, atol=1e-6)


@every_object
def test_only_objects_with_white_parts_have_light_pixels(asset: Asset) -> None:
    near_white = [
        (colours(part.material).min(axis=-1) > 0.78).mean() > 0.01
        for part in asset.parts
        if part.material.rgba[3] == 1.0
    ]
    assert any(near_white) == asset.looks.white_parts


@pytest.mark.parametrize("name", EVERYTHING)
def test_only_the_tape_is_blue(name: str) -> None:
    for part in built(name).parts:
        red, green, blue = np.moveaxis(colours(part.material), -1, 0)
        is_blue = ((blue > 1.25 * np.maximum(red, green)) & (blue > 0.2)).mean() > 0.01
        assert is_blue == (name == "tape"), part.material.name


# --- meshes ---------------------------------------------------------------------------------


@every_asset
def test_meshes_are_light_and_sound(asset: Asset) -> None:
    assert sum(len(part.faces) for part in asset.parts) <= MAX_TRIANGLES
    for part in asset.parts:
        count = len(part.vertices)
        assert part.normals.shape == part.vertices.shape == (count, 3)
        assert part.uvs.shape == (count, 2)
        assert part.faces.min() >= 0 and part.faces.max() < count
        assert np.isfinite(part.vertices).all() and np.isfinite(part.uvs).all()
        np.testing.assert_allclose(np.linalg.norm(part.normals, axis=1), 1.0, atol=1e-4)


@every_asset
def test_normals_agree_with_the_winding(asset: Asset) -> None:
    for part in asset.parts:
        a, b, c = np.moveaxis(part.vertices[part.faces].astype(np.float64), 1, 0)
        facing = np.cross(b - a, c - a)
        shading = part.normals[part.faces].mean(axis=1)
        area = np.linalg.norm(facing, axis=1)
        agrees = np.einsum("ij,ij->i", facing, shading) > 0
        assert area[~agrees].sum() <= 0.001 * area.sum()


@every_asset
def test_materials_are_merged_and_named_once(asset: Asset) -> None:
    names = [part.material.name for part in asset.parts]
    assert len(set(names)) == len(names)


# --- collision ------------------------------------------------------------------------------


@every_asset
def test_colliders_stay_within_the_box_and_reach_its_bottom(asset: Asset) -> None:
    bottom, top = bounds(asset)
    if not asset.colliders:
        assert asset.class_name in DECORATION
        return
    lowers, uppers = zip(*(collider_bounds(collider) for collider in asset.colliders), strict=True)
    assert (np.min(lowers, axis=0) >= bottom - MILLIMETRE).all()
    assert (np.max(uppers, axis=0) <= top + MILLIMETRE).all()
    assert np.min(lowers, axis=0)[2] == pytest.approx(bottom[2], abs=MILLIMETRE / 2)


@every_object
def test_mass_is_sensible(asset: Asset) -> None:
    density = asset.mass_kg / float(np.prod(asset.size))
    assert 0.005 <= asset.mass_kg <= 4.0
    assert 20.0 <= density <= 9000.0


@every_object
def test_object_rests_as_it_was_put(asset: Asset) -> None:
    spec = mujoco.MjSpec()
    spec.option.timestep = 0.002
    spec.worldbody.add_geom(type=mujoco.mjtGeom.mjGEOM_PLANE, size=(1, 1, 0.1))
    body = spec.worldbody.add_body(name="asset", pos=(0, 0, asset.size[2] / 2))
    body.add_freejoint()
    add_asset(spec, body, asset, "asset")
    model = spec.compile()
    data = mujoco.MjData(model)
    mujoco.mj_step(model, data, nstep=500)
    x, y, z, w, *_ = data.qpos
    assert np.hypot(x, y) < 2 * MILLIMETRE
    assert z == pytest.approx(asset.size[2] / 2, abs=MILLIMETRE)
    assert 2 * np.degrees(np.arccos(min(1.0, abs(w)))) < 2.0
    assert model.body_mass[1] == pytest.approx(asset.mass_kg, rel=1e-6)


# --- in MuJoCo ------------------------------------------------------------------------------


@every_asset
def test_visuals_land_where_the_vertices_say(asset: Asset) -> None:
    spec = mujoco.MjSpec()
    body = spec.worldbody.add_body(name="asset")
    add_asset(spec, body, asset, "asset")
    model = spec.compile()
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    drawn = [g for g in range(model.ngeom) if model.geom_group[g] == VISUAL_GROUP]
    assert len(drawn) == len(asset.parts)
    for geom, part in zip(drawn, asset.parts, strict=True):
        mesh = model.geom_dataid[geom]
        start, count = model.mesh_vertadr[mesh], model.mesh_vertnum[mesh]
        local = model.mesh_vert[start : start + count]
        world = local @ data.geom_xmat[geom].reshape(3, 3).T + data.geom_xpos[geom]
        np.testing.assert_allclose(world, part.vertices, atol=2e-6)
        start, count = model.mesh_faceadr[mesh], model.mesh_facenum[mesh]
        assert sorted(map(tuple, model.mesh_face[start : start + count])) == sorted(
            map(tuple, part.faces)
        )
        assert model.geom_contype[geom] == model.geom_conaffinity[geom] == 0
        # No convex hull: it would cost more than all the rest of the compilation.
        assert model.mesh_graphadr[mesh] == -1
    colliding = np.flatnonzero(model.geom_contype)
    assert (model.geom_group[colliding] == COLLISION_GROUP).all()


def test_pictures_stand_upright() -> None:
    """An asset's picture has its top row first, the model's has its bottom row first."""
    asset = built("tomato_soup")
    spec = mujoco.MjSpec()
    add_asset(spec, spec.worldbody.add_body(), asset, "asset")
    model = spec.compile()
    pictures = [p.material.texture for p in asset.parts if p.material.texture is not None]
    for i, picture in enumerate(pictures):
        start, count = model.tex_adr[i], picture.size
        stored = model.tex_data[start : start + count].reshape(picture.shape)
        np.testing.assert_array_equal(stored, picture[::-1])


def test_inside_of_glass_is_drawn_before_its_outside() -> None:
    """MuJoCo draws faces in order: the other way round, the front wall would hide the back one."""
    inner, outer = kit.sphere(0.04), kit.sphere(0.05)
    wall = kit.merge((outer, replace(inner, normals=-inner.normals, faces=inner.faces[:, ::-1])))
    glass = replace(built("key"), parts=(wall.part(Material("clear", (0.8, 0.8, 0.8, 0.3))),))
    spec = mujoco.MjSpec()
    add_asset(spec, spec.worldbody.add_body(), glass, "glass")
    model = spec.compile()
    radius = np.linalg.norm(wall.vertices[model.mesh_face].mean(axis=1), axis=1)
    half = len(radius) // 2
    assert radius[:half].max() < 0.042 < radius[half:].min()


def test_the_same_asset_can_be_added_twice() -> None:
    spec = mujoco.MjSpec()
    for name in ("key_34", "key_35"):
        add_asset(spec, spec.worldbody.add_body(name=name), built("key"), name)
    assert spec.compile().nmesh == 2 * len(built("key").parts)


def test_all_assets_together_compile_quickly() -> None:
    spec = mujoco.MjSpec()
    for name in EVERYTHING:
        add_asset(spec, spec.worldbody.add_body(name=name), built(name), name)
    start = time.process_time()
    spec.compile()
    assert time.process_time() - start < 1.0


def test_an_unknown_name_is_a_key_error() -> None:
    with pytest.raises(KeyError):
        catalog.build("unicorn")


# --- cache ----------------------------------------------------------------------------------


@pytest.fixture
def cache_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv("ADAMO_VH_CACHE_DIR", str(tmp_path))
    return tmp_path


@pytest.mark.parametrize("name", EVERYTHING)
def test_cached_asset_equals_the_built_one(name: str, cache_folder: Path) -> None:
    bake.load_asset(name)
    assert bake.cache_file(name).is_relative_to(cache_folder)
    assert bake.cache_file(name).is_file()
    assert_same(bake.load_asset(name), built(name))


@pytest.mark.parametrize(
    "damage",
    [
        lambda content: b"",
        lambda content: b"not an archive",
        lambda content: content[: len(content) // 2],
        lambda content: content[:200] + b"\xff" * 200 + content[400:],
        lambda content: content[:-100] + b"\0" * 100,
    ],
    ids=["empty", "text", "truncated", "overwritten head", "overwritten tail"],
)
def test_damaged_cache_is_rebuilt(damage: object, cache_folder: Path) -> None:
    assert callable(damage)
    bake.load_asset("key")
    path = bake.cache_file("key")
    whole = path.read_bytes()
    path.write_bytes(damage(whole))
    assert_same(bake.load_asset("key"), built("key"))
    assert path.stat().st_size == len(whole)
    assert {file.name for file in path.parent.iterdir()} - {"in-use.lock"} == {"key.npz"}


def test_a_cache_of_foreign_content_is_rebuilt(cache_folder: Path) -> None:
    path = bake.cache_file("key")
    path.parent.mkdir(parents=True)
    np.savez(path, something=np.zeros(3))
    assert_same(bake.load_asset("key"), built("key"))


def test_a_folder_that_cannot_be_written_costs_only_time(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    blocked = tmp_path / "a file"
    blocked.write_text("in the way")
    monkeypatch.setenv("ADAMO_VH_CACHE_DIR", str(blocked))
    assert_same(bake.load_asset("key"), built("key"))


# --- measures -------------------------------------------------------------------------------


def bounds(asset: Asset) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    points = np.concatenate([part.vertices for part in asset.parts]).astype(np.float64)
    return points.min(axis=0), points.max(axis=0)


def collider_bounds(collider: Collider) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    flat = np.zeros(9)
    mujoco.mju_quat2Mat(flat, np.array(collider.quaternion, dtype=np.float64))
    turn, size = flat.reshape(3, 3), np.array(collider.size)
    axis = np.abs(turn[:, 2])
    match collider.shape:
        case "box":
            half = np.abs(turn) @ size
        case "cylinder":
            half = size[0] * np.sqrt(np.maximum(0.0, 1.0 - axis**2)) + size[1] * axis
        case "capsule":
            half = size[0] + size[1] * axis
        case "sphere":
            half = np.full(3, size[0])
        case _:
            half = np.linalg.norm(turn * size, axis=1)
    return np.array(collider.position) - half, np.array(collider.position) + half


def colours(material: Material) -> NDArray[np.float64]:
    """(..., 3) sRGB of every texel, tinted, in [0, 1]."""
    tint = np.array(material.rgba[:3])
    if material.texture is None:
        return tint[None]
    return np.asarray(material.texture / 255.0 * tint)


def assert_same(asset: Asset, other: Asset) -> None:
    for name in ("class_name", "size", "colliders", "mass_kg", "looks", "surfaces"):
        assert getattr(asset, name) == getattr(other, name)
    assert len(asset.parts) == len(other.parts)
    for part, twin in zip(asset.parts, other.parts, strict=True):
        for name in ("vertices", "normals", "uvs", "faces"):
            np.testing.assert_array_equal(getattr(part, name), getattr(twin, name))
            assert getattr(part, name).dtype == getattr(twin, name).dtype
        for item in fields(Material):
            np.testing.assert_equal(
                getattr(part.material, item.name), getattr(twin.material, item.name)
            )
