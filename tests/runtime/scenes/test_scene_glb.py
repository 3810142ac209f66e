"""A scene as one GLB: all of it is there, where it belongs, and little enough to draw."""

from __future__ import annotations

import gzip
import json
import struct
from functools import cache
from typing import Any

import numpy as np
import pytest

from adamo_vh.engine import WorldState
from adamo_vh.runtime.builtin import BuiltinEngine
from adamo_vh.runtime.human.looks import load_figure
from adamo_vh.runtime.scenes.glb import Drawn, scene_glb
from adamo_vh.runtime.scenes.scene import load_scene
from adamo_vh.session.figures import figure_glb


@cache
def written(scene: str) -> tuple[Drawn, WorldState]:
    engine = BuiltinEngine(scene)
    try:
        state = engine.state()
    finally:
        engine.close()
    return scene_glb(load_scene(scene), state.objects), state


def read(raw: bytes) -> tuple[dict[str, Any], bytes]:
    assert struct.unpack_from("<4sII", raw) == (b"glTF", 2, len(raw))
    length = struct.unpack_from("<I", raw, 12)[0]
    return json.loads(raw[20 : 20 + length]), raw[28 + length :]


@pytest.mark.parametrize("name", ["s1", "s2"])
def test_everything_is_there_at_its_place(name):
    drawn, state = written(name)
    told, _ = read(drawn.content)
    nodes = {node["name"]: node for node in told["nodes"]}
    expected = {"world", "room"} | {f"furniture/{piece.name}" for piece in state.furniture}
    assert set(nodes) == expected | {f"object/{item.id}" for item in state.objects}
    assert told["scenes"][0]["nodes"] == [told["nodes"].index(nodes["world"])]
    for item in state.objects:
        box, node = item.box, nodes[f"object/{item.id}"]
        place = [box.center.x, box.center.y, box.center.z]
        assert node["translation"] == pytest.approx(place, abs=1e-4)
        turn = box.orientation
        assert node["rotation"] == pytest.approx([turn.x, turn.y, turn.z, turn.w], abs=1e-5)


def test_it_stands_upright_for_whoever_reads_gltf():
    drawn, _ = written("s1")
    told, _ = read(drawn.content)
    x, y, z, w = next(node["rotation"] for node in told["nodes"] if node["name"] == "world")
    up = np.array([2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)])
    np.testing.assert_allclose(up, [0, 1, 0], atol=1e-9)


@pytest.mark.parametrize("name", ["s1", "s2"])
def test_it_keeps_within_what_a_page_can_load_and_draw(name):
    drawn, _ = written(name)
    figure = load_figure()
    # Half of it again for a shadow of everything.
    assert 2 * (drawn.calls + len(figure.garments)) <= 160
    assert drawn.triangles + figure.triangle_count <= 125_000
    loaded = len(gzip.compress(drawn.content, 6)) + len(gzip.compress(figure_glb("mara"), 6))
    assert loaded < 2_500_000


def test_pieces_of_the_same_kind_share_their_mesh_and_all_their_wood():
    told, _ = read(written("s2")[0].content)
    chairs = {n["mesh"] for n in told["nodes"] if n["name"].startswith("furniture/chair")}
    assert len(chairs) == 1
    names = [material["name"] for material in told["materials"]]
    assert names.count("oak") == 1 and names.count("painted") == 1


def test_every_accessor_lies_within_the_file():
    drawn, _ = written("s2")
    told, binary = read(drawn.content)
    sizes = {5120: 1, 5121: 1, 5123: 2, 5125: 4, 5126: 4}
    widths = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}
    for accessor in told["accessors"]:
        view = told["bufferViews"][accessor["bufferView"]]
        each = view.get("byteStride", widths[accessor["type"]] * sizes[accessor["componentType"]])
        assert each * accessor["count"] <= view["byteLength"]
        assert view["byteOffset"] % 4 == 0
        assert view["byteOffset"] + view["byteLength"] <= len(binary)
    assert told["extensionsRequired"] == ["KHR_mesh_quantization"]
    for image in told["images"]:
        start = told["bufferViews"][image["bufferView"]]["byteOffset"]
        kind = b"\xff\xd8\xff" if image["mimeType"] == "image/jpeg" else b"\x89PNG"
        assert binary[start:].startswith(kind)


def test_indices_point_at_vertices():
    told, binary = read(written("s1")[0].content)
    for mesh in told["meshes"]:
        for primitive in mesh["primitives"]:
            count = told["accessors"][primitive["attributes"]["POSITION"]]["count"]
            accessor = told["accessors"][primitive["indices"]]
            start = told["bufferViews"][accessor["bufferView"]]["byteOffset"]
            kind = "<u2" if accessor["componentType"] == 5123 else "<u4"
            indices = np.frombuffer(binary, kind, accessor["count"], start)
            assert indices.max() < count and len(indices) % 3 == 0
            assert {told["accessors"][i]["count"] for i in primitive["attributes"].values()} == {
                count
            }
