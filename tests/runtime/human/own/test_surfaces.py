"""Colours, pictures and what is transparent of them."""

from __future__ import annotations

import io
from typing import Any

import numpy as np
import pytest
from PIL import Image
from tests.runtime.human.own.rigs import Rig, written

from adamo_vh.runtime.assets.glb_writing import FLOAT, INDICES, INT, SHORT, VERTICES
from adamo_vh.runtime.human.looks import load_figure
from adamo_vh.runtime.human.own.cutting import cut
from adamo_vh.runtime.human.own.reading import own_figure_of

SQUARE = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])
FACES = np.array([[0, 1, 2], [0, 2, 3]])
RED, CLEAR = (200, 30, 20, 255), (0, 0, 0, 0)


def disc(size=64):
    """(H, W) solid in the middle."""
    y, x = np.mgrid[:size, :size] / (size - 1) - 0.5
    return (np.hypot(x, y) < 0.4).astype(np.float32)


def area(cutting, uvs):
    at = np.einsum("nk,nki->ni", cutting.shares, uvs[cutting.parents])
    a, b, c = (at[cutting.faces[:, k]] for k in range(3))
    u, v = b - a, c - a
    return float((u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]).sum() / 2)


def test_a_disc_is_cut_out_of_a_square():
    cutting = cut(FACES, SQUARE, disc(), 0.5, 10_000)
    assert area(cutting, SQUARE) == pytest.approx(np.pi * 0.16, rel=0.04)
    np.testing.assert_allclose(cutting.shares.sum(axis=1), 1.0)


def test_what_is_solid_stays_and_what_is_clear_goes():
    whole = cut(FACES, SQUARE, np.ones((8, 8), np.float32), 0.5, 1000)
    assert len(whole.faces) == 2
    assert len(whole.parents) == 4
    assert len(cut(FACES, SQUARE, np.zeros((8, 8), np.float32), 0.5, 1000).faces) == 0


def test_no_more_triangles_than_there_is_room_for():
    few = cut(FACES, SQUARE, disc(), 0.5, 12)
    many = cut(FACES, SQUARE, disc(), 0.5, 10_000)
    assert len(few.faces) <= 20 < len(many.faces)


def test_a_picture_that_repeats_is_cut_everywhere():
    cutting = cut(FACES, SQUARE * 2 - 0.5, disc(), 0.5, 100_000)
    assert area(cutting, SQUARE * 2 - 0.5) == pytest.approx(4 * np.pi * 0.16, rel=0.1)


def painted(picture, material=None, *, uvs=SQUARE, texture=None, colours=None):
    """A figure of shoes with a square of one material on its head."""
    writer = written(Rig("unity", garments=("shoes",), plain=True), load_figure("mara"))
    points = np.array([[-0.1, 0, 0], [0.1, 0, 0], [0.1, 0.2, 0], [-0.1, 0.2, 0]])
    head = next(i for i, n in enumerate(writer.json["nodes"]) if n["name"] == "Head")
    told = {"pbrMetallicRoughness": {}, "name": "card", **(material or {})}
    if picture is not None:
        image = writer.add("images", {"bufferView": writer.view(picture), "mimeType": "image/png"})
        use = writer.add("textures", {"source": image, **(texture or {})})
        told["pbrMetallicRoughness"].setdefault("baseColorTexture", {"index": use})
    primitive: dict[str, Any] = {
        "attributes": {
            "POSITION": writer.accessor(points, "VEC3", FLOAT, VERTICES),
            "TEXCOORD_0": writer.accessor(uvs, "VEC2", FLOAT, VERTICES),
        },
        "indices": writer.accessor(FACES.ravel(), "SCALAR", INT, INDICES),
        "material": writer.add("materials", told),
    }
    if colours is not None:
        number = writer.accessor(colours, f"VEC{colours.shape[1]}", FLOAT, VERTICES)
        primitive["attributes"]["COLOR_0"] = number
    mesh = writer.add("meshes", {"name": "card", "primitives": [primitive]})
    node = writer.add("nodes", {"name": "card", "mesh": mesh})
    writer.json["nodes"][head].setdefault("children", []).append(node)
    return own_figure_of(writer.file(), "x.glb")


def card(made):
    return next((g for g in made.figure.garments if g.name.endswith("card")), None)


def png(colour=RED, size=(8, 8), kind="PNG"):
    content = io.BytesIO()
    picture = Image.new("RGBA", size, colour)
    (picture if kind == "PNG" else picture.convert("RGB")).save(content, kind)
    return content.getvalue()


def test_pictures_are_kept():
    made = card(painted(png()))
    np.testing.assert_array_equal(made.material.texture, np.full((8, 8, 3), RED[:3], np.uint8))
    assert len(made.faces) == 2


@pytest.mark.parametrize("kind", ["JPEG", "WEBP"])
def test_other_kinds_of_pictures_are_read(kind):
    texture = card(painted(png(kind=kind))).material.texture
    assert np.abs(texture.astype(int) - RED[:3]).max() < 12


def test_a_colour_is_what_screens_show():
    grey = {"pbrMetallicRoughness": {"baseColorFactor": [0.2140, 0.2140, 0.2140, 1.0]}}
    assert card(painted(None, grey)).material.rgba == pytest.approx((0.5, 0.5, 0.5, 1.0), abs=1e-3)


def test_what_shines_by_itself_is_as_bright_as_the_file_says():
    black = {"pbrMetallicRoughness": {"baseColorFactor": [0.0, 0.0, 0.0, 1.0]}}
    shining = card(painted(None, black | {"emissiveFactor": [1.0, 1.0, 1.0]})).material
    assert shining.rgba == (1.0, 1.0, 1.0, 1.0) and shining.emission == 1.0
    assert card(painted(None, black)).material.emission == 0.0
    with_picture = painted(png(), {"emissiveFactor": [1.0, 1.0, 1.0]})
    assert card(with_picture).material.emission == 0.0


def test_the_older_kind_of_material_is_read():
    older = {"extensions": {"KHR_materials_pbrSpecularGlossiness": {"diffuseFactor": [1, 0, 0, 1]}}}
    assert card(painted(None, older)).material.rgba == (1.0, 0.0, 0.0, 1.0)


def test_a_two_sided_surface_has_a_back():
    made = card(painted(None, {"doubleSided": True}))
    assert len(made.faces) == 4
    np.testing.assert_allclose(made.normals[:4], -made.normals[4:])


def half_clear():
    picture = Image.new("RGBA", (64, 64), CLEAR)
    picture.paste(RED, (0, 0, 32, 64))
    content = io.BytesIO()
    picture.save(content, "PNG")
    return content.getvalue()


@pytest.mark.parametrize("mode", ["MASK", "BLEND"])
def test_what_is_transparent_is_not_there(mode):
    made = card(painted(half_clear(), {"alphaMode": mode}))
    width = np.ptp(made.vertices[np.unique(made.faces), 0])
    whole = np.ptp(card(painted(half_clear())).vertices[:, 0])
    assert width == pytest.approx(whole / 2, rel=0.1)


def test_what_is_hardly_there_is_left_out_and_told():
    thin = {"alphaMode": "BLEND", "pbrMetallicRoughness": {"baseColorFactor": [1, 1, 1, 0.2]}}
    made = painted(None, thin)
    assert card(made) is None
    assert any("see-through" in note for note in made.report.notes)


def test_a_picture_is_moved_as_the_file_says():
    use = {
        "index": 0,
        "extensions": {"KHR_texture_transform": {"offset": [0.25, 0.5], "scale": [2.0, 1.0]}},
    }
    made = card(painted(png(), {"pbrMetallicRoughness": {"baseColorTexture": use}}))
    np.testing.assert_allclose(made.uvs[:, 0].max(), 2.25)
    np.testing.assert_allclose(made.uvs[:, 1].max(), 0.5)


@pytest.mark.parametrize(
    ("picture", "says"),
    [
        (b"no picture at all", "cannot be read"),
        (b"\x89PNG\r\n\x1a\n" + b"\xff" * 40, "cannot be read"),
        (png()[:45], "cannot be read"),
        (png(size=(9000, 2)), "9000x2"),
    ],
)
def test_a_bad_picture_costs_no_more_than_itself(picture, says):
    made = painted(picture)
    assert card(made).material.texture is None
    assert any(says in note for note in made.report.notes)


def test_a_large_picture_is_made_smaller():
    assert card(painted(png(size=(2048, 512)))).material.texture.shape == (256, 1024, 3)


@pytest.mark.parametrize("texture", [{"source": 99}, {"source": None}])
def test_a_missing_picture_is_told(texture):
    assert any("is missing" in note for note in painted(png(), texture=texture).report.notes)


def test_short_indices_and_weights_as_bytes_are_read():
    writer = written(Rig("unity", garments=("shoes",), plain=True), load_figure("mara"))
    attributes = writer.json["meshes"][0]["primitives"][0]["attributes"]
    shoes = next(g for g in load_figure("mara").garments if g.name == "shoes")
    attributes["WEIGHTS_0"] = writer.shares(shoes.weights, "VEC4", SHORT)
    made = own_figure_of(writer.file(), "x.glb").figure.garments[0]
    np.testing.assert_allclose(
        np.sort(made.weights, axis=1), np.sort(shoes.weights, axis=1)[:, :], atol=1e-3
    )


@pytest.mark.parametrize("width", [3, 4])
def test_colours_of_vertices_are_painted(width):
    colours = np.tile([[0.2140, 0.0, 1.0, 1.0]], (4, 1))[:, :width]
    made = card(painted(None, colours=colours))
    assert len(made.vertices) == 4
    texture = made.material.texture
    assert np.abs(texture.reshape(-1, 3).astype(int) - [128, 0, 255]).max() < 6


def test_where_the_colour_changes_each_triangle_has_its_own():
    colours = np.array([[1.0, 0, 0], [1.0, 0, 0], [0, 0, 1.0], [0, 0, 1.0]])
    made = card(painted(None, colours=colours))
    assert len(made.vertices) == 6
    height, width, _ = made.material.texture.shape
    at = made.uvs[made.faces[:, 0]]
    seen = [made.material.texture[int((1 - v) * height), int(u * width)].tolist() for u, v in at]
    assert sorted(colour[0] > colour[2] for colour in seen) == [False, True]


def test_a_picture_comes_before_colours_of_vertices():
    made = card(painted(png(), colours=np.zeros((4, 3))))
    assert made.material.texture[0, 0].tolist() == list(RED[:3])
