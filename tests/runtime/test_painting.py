"""One pass gives the ids that MuJoCo itself draws, and the same picture whatever came before."""

from __future__ import annotations

import ctypes
import sys
import threading
from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from adamo_vh.engine import LightChanged
from adamo_vh.geometry import Camera, Vec3
from adamo_vh.observation import NOTHING
from adamo_vh.runtime.builtin import BuiltinEngine
from adamo_vh.runtime.graphics import in_graphics_thread, open_gl
from adamo_vh.runtime.opengl import call

SMALL = (320, 180)
PLACES = ((0.0, 0.0), (1.4, -1.2), (-1.5, 1.0))


@pytest.fixture(scope="module", params=["s1", "s2"])
def scene(request: pytest.FixtureRequest) -> Iterator[BuiltinEngine]:
    made = BuiltinEngine(request.param)
    yield made
    made.close()


def drawn_by_mujoco(engine: BuiltinEngine, *flags: str) -> NDArray[np.uint8]:
    """The scene that was drawn last, as MuJoCo's own renderer shows it, without smoothing."""
    import mujoco

    scene, model = engine.stage.renderer._scene, engine.world.model
    kept = scene.flags.copy()
    scene.flags[mujoco.mjtRndFlag.mjRND_SHADOW.value] = False
    for flag in flags:
        scene.flags[getattr(mujoco.mjtRndFlag, flag).value] = True

    def draw() -> NDArray[np.uint8]:
        gl = open_gl(*SMALL)
        gl.make_current()
        model.vis.quality.offsamples = 0
        context = mujoco.MjrContext(model, mujoco.mjtFontScale.mjFONTSCALE_50.value)
        mujoco.mjr_setBuffer(mujoco.mjtFramebuffer.mjFB_OFFSCREEN.value, context)
        rect = mujoco.MjrRect(0, 0, *SMALL)
        pixels = np.empty((SMALL[1], SMALL[0], 3), np.uint8)
        mujoco.mjr_render(rect, scene, context)
        mujoco.mjr_readPixels(pixels, None, rect, context)
        context.free()
        gl.free()
        return pixels[::-1]

    try:
        return in_graphics_thread(draw)
    finally:
        scene.flags[:] = kept


def ids_of_mujoco(engine: BuiltinEngine) -> NDArray[np.int16]:
    """The object of each pixel, from MuJoCo's own renderer."""
    import mujoco

    pixels = drawn_by_mujoco(engine, "mjRND_SEGMENT", "mjRND_IDCOLOR")
    scene = engine.stage.renderer._scene
    table = np.full(256, NOTHING, np.int16)
    for geom in scene.geoms[: scene.ngeom]:
        if geom.segid >= 0 and geom.objtype == mujoco.mjtObj.mjOBJ_GEOM.value:
            table[geom.segid + 1] = engine.world.object_of_geom[geom.objid]
    ids: NDArray[np.int16] = table[pixels[:, :, 0]]
    return ids


def go_to(engine: BuiltinEngine, place: tuple[float, float]) -> Camera:
    """Stand somewhere and look at the middle of the room."""
    engine.reset(0)
    engine.body.walk(Vec3(*place, 0.0))
    engine.body.look(Vec3(0.2, 0.1, 0.6))
    return engine.body.stance.camera(*SMALL)


@pytest.mark.parametrize("place", PLACES)
def test_ids_are_those_of_mujoco_pixel_by_pixel(
    scene: BuiltinEngine, place: tuple[float, float]
) -> None:
    go_to(scene, place)
    front = scene.capture(*SMALL).id_layers[0]
    assert (front == ids_of_mujoco(scene)).all()


@pytest.mark.parametrize("place", PLACES)
def test_colours_are_those_of_mujoco(scene: BuiltinEngine, place: tuple[float, float]) -> None:
    """Light, textures and glass; but for shadows, whose edges are softer here, and outlines."""
    camera = go_to(scene, place)
    ours = scene.stage.renderer.color(scene.data, camera, shadow=False).astype(int)
    theirs = drawn_by_mujoco(scene).astype(int)
    off = np.abs(ours - theirs).max(axis=2)
    assert np.median(off) <= 1
    assert (off > 3).mean() < 0.06
    # Outlines are mixed, so where they are off a neighbour's colour is near.
    spread = [np.roll(theirs, (dy, dx), (0, 1)) for dy in (-1, 0, 1) for dx in (-1, 0, 1)]
    low, high = np.min(spread, axis=0) - 3, np.max(spread, axis=0) + 3
    inside = ((ours >= low) & (ours <= high)).all(axis=2)[1:-1, 1:-1]
    assert inside.mean() > 0.999


@pytest.mark.parametrize("place", PLACES)
def test_what_is_left_out_cannot_be_seen(
    scene: BuiltinEngine, place: tuple[float, float], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Parts outside of the view are not drawn; drawing all of them gives the same picture."""
    go_to(scene, place)
    scene.body.look(Vec3(-2.4, 2.4, 1.4))
    camera, renderer = scene.body.stance.camera(*SMALL), scene.stage.renderer
    brush = renderer._painter._brush
    chosen = renderer.draw(scene.data, camera)
    left_out = 0

    def every(*how: Any) -> NDArray[np.bool_]:
        nonlocal left_out
        left_out += int((~in_view(*how)).sum())
        return np.ones(len(renderer._painter.parts), bool)

    in_view = brush.in_view
    monkeypatch.setattr(brush, "in_view", every)
    whole = renderer.draw(scene.data, camera)
    assert left_out > 0
    assert (whole.rgb == chosen.rgb).all()
    assert [
        (layer.ids == other.ids).all()
        for layer, other in zip(whole.layers, chosen.layers, strict=True)
    ] == [True] * len(chosen.layers)


def test_what_casts_a_shadow_only_darkens(scene: BuiltinEngine) -> None:
    camera, renderer = go_to(scene, PLACES[0]), scene.stage.renderer
    shadowed = renderer.color(scene.data, camera).astype(int)
    casts = renderer._painter.parts.casts
    kept = casts.copy()
    casts[:] = False
    lit = renderer.color(scene.data, camera).astype(int)
    casts[:] = kept
    assert (shadowed <= lit).all()
    darker = (lit - shadowed).max(axis=2) > 10
    assert 0.01 < darker.mean() < 0.5
    assert (renderer.color(scene.data, camera) == shadowed).all()


def look_at_glass(engine: BuiltinEngine) -> int:
    """Go where the drinking glass is seen large."""
    engine.reset(0)
    (glass,) = engine.stage.renderer._painter.parts.glass
    at = engine.world.box(glass).center
    engine.body.walk(at)
    engine.body.look(at)
    return glass


def test_behind_the_glass_is_everything_but_the_glass(scene: BuiltinEngine) -> None:
    glass = look_at_glass(scene)
    front, behind = scene.capture(*SMALL).id_layers
    seen = front == glass
    assert seen.sum() > 50
    assert not (behind == glass).any()
    assert (front == behind)[~seen].all()


@pytest.mark.parametrize("shadow", [False, True])
def test_glass_looks_as_in_mujoco(scene: BuiltinEngine, shadow: bool) -> None:
    glass = look_at_glass(scene)
    renderer, camera = scene.stage.renderer, scene.body.stance.camera(*SMALL)
    ours = renderer.draw(scene.data, camera, shadow=shadow)
    theirs = drawn_by_mujoco(scene, *(["mjRND_SHADOW"] if shadow else []))
    seen = ours.layers[0].ids == glass
    off = np.abs(ours.rgb.astype(int) - theirs.astype(int)).max(axis=2)[seen]
    assert np.median(off) <= 2


def test_a_picture_does_not_depend_on_what_was_drawn_before(engine: BuiltinEngine) -> None:
    """Also the shadow of what stands still, which is kept, follows its light and what moved."""

    def drawn() -> bytes:
        engine.stage.forget()
        return engine.capture(*SMALL).rgb.tobytes()

    first = drawn()
    engine.stage.close()
    assert drawn() == first
    model = engine.world.model
    model.light_pos[0] += (0.4, 0.3, 0.0)
    moved = drawn()
    engine.stage.close()
    assert drawn() == moved != first
    model.light_pos[0] -= (0.4, 0.3, 0.0)
    engine.apply(LightChanged(0, 0.1))
    assert drawn() not in (first, moved)
    engine.reset(0)
    assert drawn() == first


def test_a_picture_grows_and_shrinks(engine: BuiltinEngine) -> None:
    small = engine.capture(*SMALL)
    large = engine.capture(640, 360)
    again = engine.capture(*SMALL)
    assert large.rgb.shape == (360, 640, 3)
    assert (again.rgb == small.rgb).all()
    assert set(np.unique(small.id_layers[0])) - set(np.unique(large.id_layers[0])) == set()


@pytest.fixture
def many_small_arrays() -> Iterator[None]:
    """Other threads, which go on at every chance, make arrays of a matrix's size and fill them."""
    done = threading.Event()

    def make() -> None:
        while not done.is_set():
            kept = [np.full(16, 7.0, np.float32) for _ in range(200)]
            kept += [np.full(2, 99, np.float32) for _ in range(200)]

    usual = sys.getswitchinterval()
    threads = [threading.Thread(target=make) for _ in range(3)]
    sys.setswitchinterval(1e-6)
    for thread in threads:
        thread.start()
    yield
    done.set()
    for thread in threads:
        thread.join()
    sys.setswitchinterval(usual)


def test_other_threads_do_not_write_over_what_is_drawn_with(
    engine: BuiltinEngine, request: pytest.FixtureRequest
) -> None:
    def pictures(count: int) -> set[bytes]:
        engine.stage.picture(engine.body.stance, engine.body.stance.camera(64, 36))
        camera = engine.body.stance.camera(160, 90)
        return {engine.stage.picture(engine.body.stance, camera).tobytes() for _ in range(count)}

    alone = pictures(1)
    request.getfixturevalue("many_small_arrays")
    assert pictures(12) == alone


def test_the_address_of_an_array_is_not_taken_without_the_array() -> None:
    numbers = np.zeros(16, np.float32)
    with pytest.raises(ctypes.ArgumentError, match="not the address"):
        call("LoadMatrixf", "p")(numbers.ctypes.data)
