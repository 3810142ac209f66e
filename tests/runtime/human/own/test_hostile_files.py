"""A broken or hostile file gives one line that names the fix, in little time and memory."""

from __future__ import annotations

import json
import random
import struct
import time
from functools import cache

import pytest
from tests.runtime.human.own.rigs import Rig, rig, t_pose

from adamo_vh.errors import FileError
from adamo_vh.runtime.human.own.container import MOST_BYTES
from adamo_vh.runtime.human.own.reading import content_of, own_figure_of


@cache
def sound():
    return rig(Rig("unity", t_pose(), garments=("lids",), plain=True))


def parts(content):
    length = struct.unpack_from("<I", content, 12)[0]
    return json.loads(content[20 : 20 + length]), content[20 + length + 8 :]


def packed(told, binary):
    text = json.dumps(told).encode()
    text += b" " * (-len(text) % 4)
    chunks = struct.pack("<I4s", len(text), b"JSON") + text
    chunks += struct.pack("<I4s", len(binary), b"BIN\0") + binary
    return struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks


def changed(change):
    told, binary = parts(sound())
    change(told)
    return packed(told, binary)


def refusal(content):
    with pytest.raises(FileError) as caught:
        own_figure_of(content, "x.glb")
    text = str(caught.value)
    assert text.startswith("x.glb")
    assert "\n" not in text
    assert len(text) < 900
    return text


def set_in(*path, value):
    def change(told):
        for key in path[:-1]:
            told = told[key]
        told[path[-1]] = value

    return change


def test_the_file_that_is_broken_here_is_sound():
    assert own_figure_of(sound(), "x.glb").figure.triangle_count > 0


@pytest.mark.parametrize(
    ("content", "says"),
    [
        (b"", "no GLB"),
        (b"Kaydara FBX Binary", "FBX"),
        (b'{"asset": {}}', ".gltf"),
        (b"glTF", "ends early"),
        (struct.pack("<4sII", b"glTF", 1, 20) + bytes(8), "version 1"),
        (struct.pack("<4sII", b"glTF", 2, 20) + bytes(8), "no JSON"),
        (b"glTF" + b"\xff" * 40, "version"),
    ],
)
def test_no_glb(content, says):
    assert says in refusal(content)


def test_a_file_that_ends_early():
    for share in (0.1, 0.5, 0.9, 0.99):
        assert "ends early" in refusal(sound()[: int(len(sound()) * share)])


NAN, BIG = float("nan"), 2**31 - 1


@pytest.mark.parametrize(
    ("change", "says"),
    [
        (
            set_in("buffers", value=[{"uri": "../../etc/passwd", "byteLength": 4}]),
            "none is fetched",
        ),
        (set_in("buffers", value=[{"uri": "http://x.invalid/a", "byteLength": 4}]), "none is"),
        (set_in("buffers", 0, "byteLength", value=BIG), "ends early"),
        (set_in("nodes", 1, "children", value=[0]), "two parents|circle"),
        (set_in("nodes", 3, "children", value=[3]), "two parents|circle"),
        (set_in("nodes", 1, "translation", value=[NAN, 0, 0]), "is wrong"),
        (set_in("nodes", 1, "translation", value=[1e300, 0, 0]), "infinitely"),
        (set_in("nodes", 1, "children", value=[9999]), "missing"),
        (set_in("nodes", 1, "children", value=-1), "wrong"),
        (set_in("accessors", 1, "count", value=BIG), "too much|most|beyond"),
        (set_in("accessors", 2, "count", value=3), "another number"),
        (set_in("accessors", 1, "byteOffset", value=BIG), "beyond"),
        (set_in("accessors", 1, "bufferView", value=999), "missing"),
        (set_in("accessors", 1, "type", value="SCALAR"), "another type"),
        (set_in("bufferViews", 1, "byteStride", value=1), "stride"),
        (set_in("bufferViews", 1, "byteOffset", value=BIG), "missing"),
        (set_in("skins", 0, "joints", value=[]), "no bones"),
        (set_in("skins", 0, "joints", value=[99999]), "missing"),
        (set_in("meshes", value=[]), "missing"),
        (set_in("meshes", 0, "primitives", 0, "attributes", value={}), "no positions"),
        (set_in("meshes", 0, "primitives", 0, "mode", value=0), "no triangles"),
        (set_in("extensionsRequired", value=["KHR_draco_mesh_compression"]), "without Draco"),
        (set_in("extensionsRequired", value=["EVIL_\u001b[31m"]), "EVIL"),
        (set_in("nodes", value=[{}] * 50_000), "wrong"),
        (set_in("nodes", value="x"), "wrong"),
        (set_in("nodes", 0, "matrix", value=[1.0]), "wrong"),
    ],
)
def test_what_is_wrong_is_told(change, says):
    assert any(one in refusal(changed(change)) for one in says.split("|"))


def test_a_vertex_far_away():
    told, binary = parts(sound())
    view = told["bufferViews"][told["accessors"][1]["bufferView"]]
    at = view["byteOffset"]
    broken = binary[:at] + struct.pack("<f", 5e4) + binary[at + 4 :]
    assert "away from its body" in refusal(packed(told, broken))


def test_values_that_are_no_numbers():
    told, binary = parts(sound())
    view = told["bufferViews"][told["accessors"][1]["bufferView"]]
    at = view["byteOffset"]
    broken = binary[:at] + struct.pack("<f", float("nan")) + binary[at + 4 :]
    assert "NaN" in refusal(packed(told, broken))


def test_corners_and_bones_that_are_not_there():
    told, binary = parts(sound())
    primitive = told["meshes"][0]["primitives"][0]
    for array, width in ((primitive["indices"], 4), (primitive["attributes"]["JOINTS_0"], 8)):
        at = told["bufferViews"][told["accessors"][array]["bufferView"]]["byteOffset"]
        broken = binary[:at] + b"\xff" * width + binary[at + width :]
        assert "missing" in (text := refusal(packed(told, broken))) or "does not have" in text


def test_many_arrays_over_the_same_bytes_take_no_memory():
    def change(told):
        target = {"POSITION": told["meshes"][0]["primitives"][0]["attributes"]["POSITION"]}
        names = [f"mouthOpen{i}" for i in range(1999)]
        told["meshes"][0]["primitives"][0]["targets"] = [target] * 1999
        told["meshes"][0]["extras"] = {"targetNames": names}

    assert own_figure_of(changed(change), "x.glb").figure.triangle_count > 0


def test_a_long_chain_of_bones_takes_no_long_time():
    def change(told):
        first = len(told["nodes"])
        count = 15_000
        told["nodes"] += [{"children": [first + i + 1]} for i in range(count)] + [{}]
        told["nodes"][1]["children"].append(first)
        told["skins"][0]["joints"] += list(range(first, first + 1000))
        del told["skins"][0]["inverseBindMatrices"]

    began = time.perf_counter()
    assert own_figure_of(changed(change), "x.glb").figure.triangle_count > 0
    assert time.perf_counter() - began < 20


def test_one_mesh_in_many_places_is_refused():
    def change(told):
        told["nodes"] += [{"mesh": 0} for _ in range(3000)]

    assert "the most" in refusal(changed(change))


def test_deep_json_is_refused():
    text = b'{"asset":' + b"[" * 100_000 + b"]" * 100_000 + b"}"
    text += b" " * (-len(text) % 4)
    content = struct.pack("<4sII", b"glTF", 2, 20 + len(text))
    refusal(content + struct.pack("<I4s", len(text), b"JSON") + text)


def test_any_damage_gives_one_line():
    rng = random.Random(3)
    told, binary = parts(sound())
    for _ in range(60):
        text = bytearray(json.dumps(told).encode())
        for _ in range(rng.randint(1, 8)):
            at = rng.randrange(len(text))
            text[at : at + rng.randint(0, 3)] = bytes(rng.choices(b'0123456789-.e[]{},:"', k=2))
        text += b" " * (-len(text) % 4)
        chunks = struct.pack("<I4s", len(text), b"JSON") + bytes(text)
        chunks += struct.pack("<I4s", len(binary), b"BIN\0") + binary
        content = struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks
        told_of = ""
        try:
            own_figure_of(content, "x.glb")
        except FileError as error:
            told_of = str(error)
        assert "\n" not in told_of


def test_a_map_that_names_one_node_twice():
    told, binary = parts(rig(Rig("nothing", vrm="1", garments=("lids",), plain=True)))
    bones = told["extensions"]["VRMC_vrm"]["humanoid"]["humanBones"]
    bones["leftHand"] = bones["rightHand"]
    assert "is both" in refusal(packed(told, binary))
    bones["leftTentacle"] = bones["spine"]
    bones["leftHand"] = {"node": "x"}
    assert "leftHand" in refusal(packed(told, binary))


def test_a_large_file_is_not_read_whole(tmp_path):
    path = tmp_path / "x.glb"
    with path.open("wb") as file:
        file.truncate(MOST_BYTES + 10)
    with pytest.raises(FileError, match="100 MB"):
        content_of(path)


def test_a_file_that_is_not_there(tmp_path):
    with pytest.raises(FileError, match="cannot be read"):
        content_of(tmp_path / "none.glb")


def test_bones_that_nobody_knows_are_passed_over():
    told, binary = parts(rig(Rig("nothing", vrm="1", garments=("lids",), plain=True)))
    bones = told["extensions"]["VRMC_vrm"]["humanoid"]["humanBones"]
    bones |= {"leftTentacle": bones["leftHand"], "leftIndex99": bones["spine"], "": {"node": 1}}
    report = own_figure_of(packed(told, binary), "x.glb").report
    assert not {"leftTentacle", "leftIndex99", ""} & {*report.bones}


@pytest.mark.parametrize("kind", [5120, 5122])
def test_bones_with_negative_numbers(kind):
    told, binary = parts(sound())
    primitives = (one for mesh in told["meshes"] for one in mesh["primitives"])
    array = next(
        one["attributes"]["JOINTS_0"] for one in primitives if "JOINTS_0" in one["attributes"]
    )
    accessor = told["accessors"][array]
    accessor["componentType"] = kind
    at = told["bufferViews"][accessor["bufferView"]]["byteOffset"] + accessor.get("byteOffset", 0)
    broken = binary[:at] + b"\xff\xff" + binary[at + 2 :]
    assert "negative" in refusal(packed(told, broken))
