"""A scene as files: whoever loads them finds the same things at the same places."""

from __future__ import annotations

import json
import struct
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from typer.testing import CliRunner

from adamo_vh.cli.app import app
from adamo_vh.engine import WorldState
from adamo_vh.runtime.builtin import BuiltinEngine
from adamo_vh.runtime.scenes.exporting import export_scene
from adamo_vh.runtime.scenes.scene import load_scene


@pytest.fixture(scope="module")
def exported(
    s1_engine: BuiltinEngine, tmp_path_factory: pytest.TempPathFactory
) -> tuple[Path, dict[str, Any], WorldState]:
    s1_engine.reset(0)
    folder = tmp_path_factory.mktemp("export") / "s1"
    state = s1_engine.state()
    written = export_scene(load_scene("s1"), state, s1_engine.body.info, folder)
    assert {path.name for path in written} == {path.name for path in folder.iterdir()}
    return folder, json.loads(written[0].read_text()), state


def glb(path: Path) -> tuple[dict[str, Any], bytes]:
    data = path.read_bytes()
    magic, version, total = struct.unpack_from("<4sII", data)
    assert (magic, version, total) == (b"glTF", 2, len(data))
    length = struct.unpack_from("<I", data, 12)[0]
    return json.loads(data[20 : 20 + length]), data[28 + length :]


def positions(path: Path) -> Any:
    told, binary = glb(path)
    found = []
    for part in told["meshes"][0]["primitives"]:
        accessor = told["accessors"][part["attributes"]["POSITION"]]
        start = told["bufferViews"][accessor["bufferView"]]["byteOffset"]
        count = accessor["count"]
        found.append(np.frombuffer(binary, "<f4", 3 * count, start).reshape(count, 3))
    return np.concatenate(found)


def test_everything_in_the_scene_is_told(exported: Any) -> None:
    _, told, state = exported
    assert told["scene"]["name"] == "s1" and "tabletop" in told["scene"]["title"].lower()
    assert [item["id"] for item in told["objects"]] == [item.id for item in state.objects]
    assert {piece["name"] for piece in told["furniture"]} == {f.name for f in state.furniture}
    for piece in told["furniture"]:
        assert piece["surfaces"] and piece["solids"] and len(piece["points"]) >= 3
    assert told["start"]["position"]["z"] == 0.0
    assert told["body"]["eye_height_m"] == 1.6
    assert sum(light["shadow"] for light in told["lights"]) <= 1


def test_every_mesh_is_there_and_fills_its_box(exported: Any) -> None:
    folder, told, _ = exported
    for item in told["objects"]:
        size = item["box"]["size"]
        corners = positions(folder / item["mesh"])
        low, high = corners.min(axis=0), corners.max(axis=0)
        # glTF has y up: x, z and y of the box.
        assert high - low == pytest.approx([size["x"], size["z"], size["y"]], abs=0.004)
        assert (high + low) / 2 == pytest.approx([0, 0, 0], abs=0.004)
    shell = positions(folder / told["mesh"])
    room = told["scene"]
    assert shell[:, 0].min() <= room["x_min"] + 0.01
    assert -shell[:, 2].max() <= room["y_min"] + 0.01
    for piece in told["furniture"]:
        assert positions(folder / piece["mesh"])[:, 1].max() == pytest.approx(
            piece["top_m"], abs=0.01
        )


def test_textures_are_inside(exported: Any) -> None:
    folder, told, _ = exported
    pictures = 0
    for item in told["objects"]:
        inside, binary = glb(folder / item["mesh"])
        for picture in inside.get("images", ()):
            start = inside["bufferViews"][picture["bufferView"]]["byteOffset"]
            assert binary[start : start + 4] == b"\x89PNG"
            pictures += 1
    assert pictures >= 5


def test_the_command_exports_a_scene(tmp_path: Path, bare_scene: str) -> None:
    done = CliRunner().invoke(
        app, ["scenes", "export", bare_scene, "--out", str(tmp_path / "s1")], catch_exceptions=False
    )
    assert done.exit_code == 0 and "meshes" in done.stdout and "MB" in done.stdout
    told = json.loads((tmp_path / "s1" / "scene.json").read_text())
    assert told["format"] == 1 and told["scene"]["variation"] == 0
