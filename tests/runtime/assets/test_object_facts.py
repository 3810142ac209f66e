"""The household objects by number: what a benchmark on them counts on, in whatever scene."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from adamo_vh.runtime.assets import catalog
from adamo_vh.runtime.assets.asset import Asset, Part
from adamo_vh.runtime.scenes import load_scene, scene_names

NUMBERS = {
    0: "lock_brass",
    2: "flashlight",
    3: "battery_large",
    4: "tape",
    5: "screwdriver",
    8: "peanut_butter",
    18: "lock_steel",
    19: "tomato_soup",
    20: "pills",
    21: "binoculars",
    23: "painkiller",
    27: "lighter",
    30: "battery_small",
    34: "key",
    36: "wine_bottle",
    37: "glass",
    45: "cup",
    50: "indoor_plant",
    57: "plate",
}
LABELLED = {8: "PEANUT BUTTER", 19: "TOMATO SOUP", 20: "PILLS", 23: "PAINKILLER", 36: "RED WINE"}
WITH_WHITE = {19, 20, 23, 36, 57}
SCENES = scene_names()
built = cache(catalog.build)


@cache
def objects(scene: str) -> dict[int, Asset]:
    return {item.id: built(item.asset) for item in load_scene(scene).objects}


@pytest.mark.parametrize("scene", SCENES)
def test_a_number_means_the_same_object_in_every_scene(scene: str) -> None:
    assert {item.id: item.asset for item in load_scene(scene).objects} == NUMBERS


@pytest.mark.parametrize("scene", SCENES)
def test_what_carries_text_or_white_is_agreed_by_number(scene: str) -> None:
    looks = {number: asset.looks for number, asset in objects(scene).items()}
    assert {n: look.label for n, look in looks.items() if look.label} == LABELLED
    assert {n for n, look in looks.items() if look.white_parts} == WITH_WHITE


def volume(number: int) -> float:
    return float(np.prod(built(NUMBERS[number]).size))


@pytest.mark.parametrize(("smaller", "larger"), [(30, 3), (0, 18)], ids=["batteries", "locks"])
def test_of_two_of_a_kind_one_is_plainly_larger(smaller: int, larger: int) -> None:
    assert built(NUMBERS[smaller]).class_name == built(NUMBERS[larger]).class_name
    assert volume(larger) > 1.2 * volume(smaller)


def test_the_key_is_by_far_the_smallest() -> None:
    assert min(NUMBERS, key=volume) == 34
    assert all(volume(number) > 5 * volume(34) for number in NUMBERS if number != 34)


# --- meshes and pixels ----------------------------------------------------------------------


Texels = NDArray[np.float64]


def painted(number: int) -> list[Texels]:
    """(N, 3) sRGB in [0, 1] of each material of an object that is not glass."""
    found = []
    for part in objects(SCENES[0])[number].parts:
        material = part.material
        if material.rgba[3] < 1.0:
            continue
        tint = np.array(material.rgba[:3])
        picture = tint if material.texture is None else material.texture / 255.0 * tint
        found.append(np.asarray(picture, np.float64).reshape(-1, 3))
    return found


def area(part: Part) -> Texels:
    """Twice the area of each triangle, square metres."""
    a, b, c = np.moveaxis(part.vertices[part.faces].astype(np.float64), 1, 0)
    return np.asarray(np.linalg.norm(np.cross(b - a, c - a), axis=1))


SAID: dict[int, tuple[str, Callable[[Any, Any, Any], Any]]] = {
    4: ("blue", lambda r, g, b: (b > 1.3 * r) & (b > 1.2 * g)),
    5: ("red", lambda r, g, b: (r > 1.6 * g) & (r > 1.6 * b)),
    45: ("orange", lambda r, g, b: (r > 1.2 * g) & (g > 1.3 * b)),
    50: ("green", lambda r, g, b: (g > 1.1 * r) & (g > 1.3 * b)),
    57: ("red", lambda r, g, b: (r > 1.6 * g) & (r > 1.6 * b)),
}


@pytest.mark.parametrize("number", SAID)
def test_it_has_the_colour_that_it_is_called_by(number: int) -> None:
    word, has = SAID[number]
    assert word in objects(SCENES[0])[number].looks.colours
    assert max(has(*texels.T).mean() for texels in painted(number)) > 0.3


@pytest.mark.parametrize("number", [2, 21])
def test_black_things_are_dark(number: int) -> None:
    assert "black" in objects(SCENES[0])[number].looks.colours
    assert any((texels.max(axis=1) < 0.35).mean() > 0.5 for texels in painted(number))


def test_only_the_glass_is_mostly_seen_through() -> None:
    clear = set()
    for number, asset in objects(SCENES[0]).items():
        glass = sum(area(part).sum() for part in asset.parts if part.material.rgba[3] < 0.6)
        if glass > 0.5 * sum(area(part).sum() for part in asset.parts):
            clear.add(number)
    assert clear == {37}


@pytest.mark.parametrize("number", NUMBERS)
def test_no_object_is_drawn_with_slivers_or_loose_points(number: int) -> None:
    for part in objects(SCENES[0])[number].parts:
        used = np.unique(part.faces)
        assert len(used) == len(part.vertices), part.material.name
        assert (area(part) > 0).mean() > 0.98, part.material.name


@pytest.mark.parametrize("number", NUMBERS)
def test_texture_coordinates_stay_in_the_picture(number: int) -> None:
    for part in objects(SCENES[0])[number].parts:
        if part.material.texture is None:
            continue
        assert part.uvs.min() >= -1e-6 and part.uvs.max() <= 1 + 1e-6, part.material.name


# --- furniture ------------------------------------------------------------------------------


@pytest.mark.parametrize("name", catalog.FURNITURE)
def test_furniture_stands_on_the_floor_and_has_the_size_of_furniture(name: str) -> None:
    asset = built(name)
    assert min(asset.size) >= 0.001 and max(asset.size) <= 4.0
    for surface in asset.surfaces:
        x, y, z = surface.center
        half_x, half_y = surface.half_size
        assert abs(x) + half_x <= asset.size[0] / 2 + 0.01
        assert abs(y) + half_y <= asset.size[1] / 2 + 0.01
        assert 0.0 < z <= asset.size[2] + 0.001
    names = [surface.name for surface in asset.surfaces]
    assert len(set(names)) == len(names)


@pytest.mark.parametrize("name", catalog.FURNITURE)
def test_a_surface_is_held_up_by_something_that_can_be_touched(name: str) -> None:
    asset = built(name)
    for surface in asset.surfaces:
        height = surface.center[2]
        tops = [
            collider.position[2] + collider.size[2]
            for collider in asset.colliders
            if collider.shape == "box" and collider.quaternion == (1.0, 0.0, 0.0, 0.0)
        ] + [
            collider.position[2] + collider.size[1]
            for collider in asset.colliders
            if collider.shape == "cylinder" and collider.quaternion == (1.0, 0.0, 0.0, 0.0)
        ]
        assert any(abs(top - height) < 0.005 for top in tops), surface.name
