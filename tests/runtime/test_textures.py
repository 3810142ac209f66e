"""Textures reach OpenGL as they are, with smaller copies that keep their colour."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest

from adamo_vh.runtime import opengl as gl
from adamo_vh.runtime.builtin import BuiltinEngine
from adamo_vh.runtime.graphics import in_graphics_thread
from adamo_vh.runtime.opengl import call
from adamo_vh.runtime.textures import halved, left_out

_TEXTURE_WIDTH, _TEXTURE_HEIGHT = 0x1000, 0x1001


@pytest.mark.parametrize("shape", [(8, 8, 3), (5, 17, 3), (1, 6, 4), (1, 1, 3), (33, 2, 1)])
def test_copies_halve_down_to_one_pixel(shape: tuple[int, int, int]) -> None:
    picture = np.random.default_rng(4).integers(0, 256, shape, np.uint8)
    copies = list(halved(picture))
    assert copies[0] is picture
    for larger, smaller in pairwise(copies):
        assert smaller.shape[:2] == tuple(max(1, side // 2) for side in larger.shape[:2])
        assert smaller.shape[2] == shape[2]
    assert copies[-1].shape[:2] == (1, 1)
    off = picture.mean(axis=(0, 1)) - copies[-1][0, 0]
    assert np.abs(off).max() < 12


def test_every_texture_arrives_whole(engine: BuiltinEngine) -> None:
    engine.stage.renderer.color(engine.data, engine.body.stance.camera(64, 36))
    renderer, model = engine.stage.renderer, engine.world.model

    def sizes() -> list[tuple[int, int]]:
        renderer._gl.make_current()
        found = []
        for texture in range(model.ntex):
            name = int(renderer._painter.context.texture[texture])
            call("BindTexture", "uu")(gl.TEXTURE_2D, name)
            width, height = np.zeros(1, np.int32), np.zeros(1, np.int32)
            ask = call("GetTexLevelParameteriv", "uiup")
            ask(gl.TEXTURE_2D, 0, _TEXTURE_WIDTH, width)
            ask(gl.TEXTURE_2D, 0, _TEXTURE_HEIGHT, height)
            found.append((int(width[0]), int(height[0])))
        return found

    expected = list(zip(model.tex_width.tolist(), model.tex_height.tolist(), strict=True))
    assert in_graphics_thread(sizes) == expected


def test_leaving_textures_out_changes_no_model(engine: BuiltinEngine) -> None:
    model = engine.world.model
    before = model.tex_width.copy(), model.tex_height.copy()
    with left_out(model):
        assert model.tex_width.max() == 1
    assert (model.tex_width == before[0]).all()
    assert (model.tex_height == before[1]).all()
