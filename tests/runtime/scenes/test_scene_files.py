"""Scene files: S1 is what the paper says, and wrong files are told apart clearly."""

from __future__ import annotations

from pathlib import Path

import pytest

from adamo_vh.errors import SceneError
from adamo_vh.runtime.scenes import load_scene, parse_scene, scene_names

S1_PLACES = {
    0: (0.076, -1.353), 2: (-0.360, -0.850), 3: (-0.174, -0.853), 4: (-0.174, -0.603),
    5: (-0.360, -1.155), 8: (0.076, -0.853), 18: (-0.174, -1.353), 19: (0.076, -1.603),
    20: (-0.420, -1.350), 21: (0.076, -0.353), 23: (-0.424, -1.603), 27: (-0.174, -1.103),
    30: (0.076, -1.103), 34: (-0.174, -1.603), 36: (0.326, -1.603), 37: (0.326, -1.103),
    45: (-0.424, -0.353), 50: (0.326, -1.353), 57: (0.326, -0.603),
}  # fmt: skip

MINIMAL = """
name = "mine"
title = "Mine"
[room]
asset = "room"
x_min = -2
x_max = 2
y_min = -2
y_max = 2
height_m = 2.5
[agent]
position = [0, 0]
heading_deg = 0
gaze = [1, 0, 1]
[[lights]]
position = [0, 0, 2.4]
target = [0, 0, 0]
diffuse = 0.5
[[furniture]]
name = "desk"
asset = "dining_table"
position = [1, 0]
[[objects]]
id = 1
asset = "cup"
on = "desk"
position = [1, 0]
"""


def test_s1_is_the_tabletop_of_the_paper() -> None:
    scene = load_scene("s1")
    room = scene.room
    assert (room.x_min, room.x_max, room.y_min, room.y_max) == (-3, 3, -5, 3)
    assert room.height_m == 3.2
    assert scene.agent.position == (-2, -1)
    assert scene.agent.gaze == (0.51, -1.25, 1.17)
    assert [(p.asset, p.position) for p in scene.furniture] == [("dining_table", (-0.05, -1.0))]
    assert {item.id: item.position for item in scene.objects} == S1_PLACES
    corners = {(area.min, area.max) for area in scene.areas if area.kind == "corner"}
    assert corners == {
        ((-3, -5), (-2, -4)),
        ((2, -5), (3, -4)),
        ((-3, 2), (-2, 3)),
        ((2, 2), (3, 3)),
    }


@pytest.mark.parametrize("name", scene_names())
def test_built_in_scenes_load(name: str) -> None:
    scene = load_scene(name)
    assert scene.info().name == name
    assert sum(light.shadow for light in scene.lights) == 1


def test_a_scene_of_ones_own_loads_from_a_file(tmp_path: Path) -> None:
    path = tmp_path / "mine.toml"
    path.write_text(MINIMAL)
    assert load_scene(str(path)).name == "mine"


@pytest.mark.parametrize(
    ("before", "after", "part"),
    [
        ("name =", "name", "not valid TOML"),
        ('asset = "cup"', 'asset = "../../etc/passwd"', "objects[0].asset"),
        ('asset = "cup"', 'asset = "spaceship"', "objects[0].asset: unknown; one of"),
        ('on = "desk"', 'on = "moon"', "objects[0].on: 'moon' is no furniture; one of desk"),
        ("position = [1, 0]\n[[objects]]", "position = [9, 0]\n[[objects]]", "outside the room"),
        ("x_max = 2", "x_max = -2", "room: smaller"),
        ("x_max = 2", "x_max = 18.5", "room: 20.5 x 4 m is too large; make no side longer than 20"),
        ("y_max = 2", "y_max = 50", "room: 4 x 52 m is too large"),
        ("x_max = 2", "x_max = 1e9", "room.x_max"),
        ("diffuse = 0.5", "diffuse = 7", "lights[0].diffuse"),
        ("diffuse = 0.5", "diffuse = nan", "lights[0].diffuse"),
        ("id = 1", "id = -1", "objects[0].id"),
        ("id = 1", "id = 1\nweight = 3", "objects[0].weight"),
        ('name = "desk"', 'name = "floor"', "furniture[0].name"),
    ],
)
def test_wrong_files_name_the_field(before: str, after: str, part: str) -> None:
    assert before in MINIMAL
    with pytest.raises(SceneError, match=r"mine\.toml") as caught:
        parse_scene(MINIMAL.replace(before, after, 1), "mine.toml")
    assert part in str(caught.value)


def test_two_objects_with_one_id_are_refused() -> None:
    extra = '[[objects]]\nid = 1\nasset = "plate"\non = "desk"\nposition = [1, 0.3]\n'
    with pytest.raises(SceneError, match=r"objects\[1\].id: 1 is taken"):
        parse_scene(MINIMAL + extra, "mine.toml")


def test_an_unknown_scene_names_the_known_ones() -> None:
    with pytest.raises(SceneError, match="s1"):
        load_scene("s99")


def test_a_huge_or_binary_file_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "big.toml"
    path.write_bytes(b"#" * 2_000_000)
    with pytest.raises(SceneError, match="larger"):
        load_scene(str(path))
    path.write_bytes(b"\xff\xfe\x00")
    with pytest.raises(SceneError, match="UTF-8"):
        load_scene(str(path))
