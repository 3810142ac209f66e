"""One sheet for many pictures: each is found where it lies, and nothing shines through."""

from __future__ import annotations

import numpy as np
import pytest

from adamo_vh.runtime.assets.asset import Material
from adamo_vh.runtime.assets.atlas import PLAIN, key, packed, roughness


def painted(name: str, height: int, width: int, value: int, shininess: float = 0.3) -> Material:
    picture = np.full((height, width, 3), value, np.uint8)
    return Material(name, texture=picture, shininess=shininess)


def seen(sheet, spot, u, v):
    """The pixel at a place of a picture; v counts up from the bottom."""
    x, y = spot.placed(np.array([[u, v]], np.float32))[0]
    height, width = sheet.shape[:2]
    return sheet[min(int((1 - y) * height), height - 1), min(int(x * width), width - 1)]


def test_every_picture_is_found_up_to_its_edges():
    materials = [painted(f"m{n}", 20 + 9 * n, 30 + 50 * n, 10 * n + 5) for n in range(12)]
    atlas = packed(materials)
    for number, material in enumerate(materials):
        spot = atlas.spots[key(material)]
        for u, v in ((0.0, 0.01), (1.0, 0.99), (0.5, 0.5)):
            assert seen(atlas.sheet, spot, u, v)[0] == 10 * number + 5


def test_a_picture_stays_the_right_way_up():
    picture = np.zeros((40, 40, 3), np.uint8)
    picture[:20] = 200
    material = Material("half", texture=picture)
    atlas = packed([material, painted("other", 90, 300, 77)])
    spot = atlas.spots[key(material)]
    assert seen(atlas.sheet, spot, 0.5, 0.9)[0] == 200
    assert seen(atlas.sheet, spot, 0.5, 0.1)[0] == 0


def test_what_looks_the_same_is_there_once():
    first, again = painted("a", 16, 16, 9), painted("b", 16, 16, 9)
    assert len(packed([first, again]).spots) == 1
    assert len(packed([first, painted("c", 16, 16, 9, shininess=0.9)]).spots) == 2


def test_a_surface_without_a_picture_is_white_and_as_rough_as_it_is():
    dull, bright = Material("dull", shininess=0.0), Material("bright", shininess=1.0)
    atlas = packed([dull, bright])
    for material in (dull, bright):
        spot = atlas.spots[key(material)]
        assert tuple(seen(atlas.sheet, spot, 0.3, 0.7)) == (255, 255, 255)
        rough = seen(atlas.rough, spot, 0.5, 0.5)[1]
        assert rough / 255 == pytest.approx(roughness(material), abs=0.01)
    assert PLAIN.min() == 255


@pytest.mark.parametrize(("height", "width"), [(540, 2056), (1024, 8), (64, 720)])
def test_large_pictures_are_made_smaller(height, width):
    spot = next(iter(packed([painted("label", height, width, 50)]).spots.values()))
    assert spot.width * 2048 <= 1100
    assert 0 < spot.height <= 1.0
