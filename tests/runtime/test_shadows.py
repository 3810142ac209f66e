"""Shadows: what stands still is drawn once, and follows whatever it depends on."""

from __future__ import annotations

import math

import numpy as np
import pytest

from adamo_vh.geometry import Camera, Vec3
from adamo_vh.runtime import physics
from adamo_vh.runtime.builtin import BuiltinEngine
from adamo_vh.runtime.shadows import SHADOW_MAP_PX, ShadowMap, _area, _projection

SMALL = (320, 180)
CUP = 45


class Counted:
    """Counts how often what stands still is drawn."""

    def __init__(self, engine: BuiltinEngine, monkeypatch: pytest.MonkeyPatch) -> None:
        self.times = 0
        kept = ShadowMap.draw

        def draw(map_, light, view, known, still, moving):
            def counted() -> None:
                self.times += 1
                still()

            return kept(map_, light, view, known, counted, moving)

        monkeypatch.setattr(ShadowMap, "draw", draw)
        self._engine = engine

    def after_drawing(self) -> int:
        self._engine.stage.forget()
        self._engine.capture(*SMALL)
        return self.times


@pytest.fixture
def counted(engine: BuiltinEngine, monkeypatch: pytest.MonkeyPatch) -> Counted:
    engine.stage.close()
    return Counted(engine, monkeypatch)


def test_what_stands_still_is_drawn_once_and_again_when_a_thing_first_moves(
    engine: BuiltinEngine, counted: Counted
) -> None:
    assert counted.after_drawing() == 1
    engine.body.walk(Vec3(-1.2, -1.0, 0.0))
    engine.body.look(Vec3(0.0, 0.0, 0.7))
    assert counted.after_drawing() == 1
    cup = engine.world.box(CUP).center
    for rise in (0.1, 0.2, 0.3):
        physics.place(engine.world, CUP, cup + Vec3(0.05, 0.0, rise))
        assert counted.after_drawing() == 2


def test_it_is_drawn_again_when_the_light_or_the_furniture_moved(
    engine: BuiltinEngine, counted: Counted
) -> None:
    model = engine.world.model
    counted.after_drawing()
    model.light_pos[0, 2] -= 0.1
    assert counted.after_drawing() == 2
    model.light_pos[0, 2] += 0.1
    assert counted.after_drawing() == 3
    table = next(iter(engine.world.furniture_of_body))
    model.body_pos[table, 0] += 0.1
    assert counted.after_drawing() == 4
    model.body_pos[table, 0] -= 0.1


@pytest.fixture
def from_above(engine: BuiltinEngine) -> Camera:
    cup = engine.world.box(CUP).center
    return Camera(cup + Vec3(-0.25, 0.0, 0.5), 0.0, -1.1, math.radians(60), *SMALL)


def test_the_shadow_of_an_object_goes_where_it_goes(
    engine: BuiltinEngine, from_above: Camera
) -> None:
    renderer = engine.stage.renderer
    before = renderer.draw(engine.data, from_above)
    cup = engine.world.box(CUP).center
    physics.place(engine.world, CUP, cup + Vec3(0.0, 0.12, 0.0))
    engine.stage._pose(engine.stage.shown(engine.body.stance))
    after = renderer.draw(engine.data, from_above)
    shown = [drawn.layers[0].ids == CUP for drawn in (before, after)]
    assert all(mask.sum() > 50 for mask in shown)
    elsewhere = ~shown[0] & ~shown[1]
    change = (after.rgb.astype(int) - before.rgb.astype(int)).max(axis=2)
    assert (change[elsewhere] > 20).sum() > 50, "the old shadow is gone"
    assert (change[elsewhere] < -20).sum() > 50, "the new one is there"


def test_edges_of_shadows_are_soft(engine: BuiltinEngine, from_above: Camera) -> None:
    """Between light and dark lie pixels of neither; MuJoCo's own shadows know only the two."""
    renderer = engine.stage.renderer
    drawn = renderer.color(engine.data, from_above).astype(float).max(axis=2)
    casts = renderer._painter.parts.casts
    kept = casts.copy()
    casts[:] = False
    lit = renderer.color(engine.data, from_above).astype(float).max(axis=2)
    casts[:] = kept
    share = drawn / np.maximum(lit, 1.0)
    darkest = np.quantile(share, 0.02)
    between = (share > darkest + 0.1) & (share < 0.9)
    assert 30 < between.sum() < 0.1 * share.size


def test_a_plain_wall_has_no_edge_where_the_light_looks_no_further() -> None:
    engine = BuiltinEngine("s2")
    rgb = engine.capture(960, 540).rgb
    engine.close()
    # The right wall, from above the plane in which the lamp hangs to below it.
    rows = rgb[150:260, 780:850].mean(axis=(1, 2))
    assert np.abs(rows[3:] - rows[:-3]).max() < 3.0


def test_the_part_of_the_map_that_moves_holds_every_ball() -> None:
    project = np.diag([1.6, 1.6, 0.0, 0.0])
    side = SHADOW_MAP_PX
    balls = np.array([[0.3, -0.2, -2.0, 0.3], [-0.5, 0.4, -3.0, 0.1]])
    x, y, wide, tall = _area(balls, project, np.eye(4)) or (0, 0, 0, 0)
    assert 0 < wide < side and 0 < tall < side
    rng = np.random.default_rng(0)
    for *middle, radius in balls:
        points = rng.normal(size=(400, 3))
        points = middle + radius * points / np.linalg.norm(points, axis=1, keepdims=True)
        pixels = (1.6 * points[:, :2] / -points[:, 2:] + 1) / 2 * side
        assert (pixels >= [x, y]).all() and (pixels <= [x + wide, y + tall]).all()
    assert _area(np.empty((0, 4)), project, np.eye(4)) is None
    near = np.array([[0.0, 0.0, -0.3, 0.2]])
    assert _area(near, project, np.eye(4)) == (0, 0, side, side)


def test_a_thing_that_moves_on_leaves_no_shadow_behind(
    engine: BuiltinEngine, from_above: Camera
) -> None:
    cup = engine.world.box(CUP).center

    def seen(*places: Vec3):
        for place in places:
            physics.place(engine.world, CUP, place)
            engine.stage.picture(engine.body.stance, from_above)
        return engine.stage.picture(engine.body.stance, from_above).copy()

    away, high = cup + Vec3(0.4, 0.3, 0.5), cup + Vec3(0.0, 0.0, 0.25)
    once = seen(away)
    assert (seen(cup, high, cup + Vec3(0.1, 0.05, 0.2), away) == once).all()
    physics.place(engine.world, CUP, cup)


@pytest.mark.parametrize("x", [-4.0, -1.0, 0.0, 1.0, 4.0])
def test_the_part_of_the_map_that_is_drawn_on_holds_all_of_a_ball(x: float) -> None:
    project, see = _projection(120.0, 0.1, 20.0), np.eye(4)
    ball = np.array([[x, 0.5 * x, -3.0, 1.0]])
    area = _area(ball, project, see)
    assert area is not None
    ways = np.random.default_rng(0).normal(size=(20_000, 3))
    skin = ball[0, :3] + ways / np.linalg.norm(ways, axis=1, keepdims=True)
    flat = skin[:, :2] * [project[0, 0], project[1, 1]] / -skin[:, 2:]
    pixels = np.clip((flat + 1) / 2 * SHADOW_MAP_PX, 0, SHADOW_MAP_PX)
    first, size = np.array(area[:2]), np.array(area[2:])
    assert (pixels >= first).all()
    assert (pixels <= first + size).all()
