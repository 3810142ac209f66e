"""`adamo-vh figure check`, and `--figure FILE` where a figure is taken."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from PIL import Image
from tests.cli.process import adamo
from tests.runtime.human.own.rigs import Rig, rig, t_pose

from adamo_vh.record.run_folder import FIGURE, MANIFEST


@pytest.fixture
def me(tmp_path: Path) -> str:
    told = Rig("nothing", t_pose(), vrm="1", garments=("lids", "shoes"), plain=True)
    (tmp_path / "me.vrm").write_bytes(rig(told))
    return "me.vrm"


def test_what_is_used_and_missing_is_told(me: str, tmp_path: Path) -> None:
    done = adamo("figure", "check", me, cwd=tmp_path)
    assert done.code == 0, done.err
    lines = dict(line.split(maxsplit=1) for line in done.out.splitlines())
    assert lines["skeleton"].startswith("VRM 1.0")
    assert "+Y up, facing +Z, rest pose T" in lines["stands"]
    assert "A. Tester" in lines["licence"]
    assert "the face" in done.out
    assert lines["usable:"] == "--figure me.vrm"


def test_it_is_drawn_and_told_as_json(me: str, tmp_path: Path) -> None:
    done = adamo("figure", "check", me, "--out", "me.png", "--json", cwd=tmp_path)
    told = json.loads(done.out)
    assert told["bones"]["hips"] == "node 0"
    assert told["unit"] == "metres"
    assert told["picture"] == "me.png"
    assert Image.open(tmp_path / "me.png").size[1] == 640


@pytest.mark.parametrize(
    ("words", "says"),
    [
        (("figure", "check", "x.fbx"), "name it .glb or .vrm"),
        (("figure", "check", "none.glb"), "cannot be read"),
        (("figure", "check", "bad.glb"), "no GLB"),
        (("figure", "check", "me.vrm", "--out", "x.jpg"), "name it x.png"),
        (("run", "Look", "--figure", "bad.glb"), "no GLB"),
        (("run", "Look", "--figure", "none.vrm"), "cannot be read"),
        (("run", "Look", "--figure", "bob"), "a file of your own"),
        (("studio", "--figure", "bad.glb", "--port", "0"), "no GLB"),
    ],
)
def test_a_wrong_file_gives_one_line(
    me: str, tmp_path: Path, words: tuple[str, ...], says: str
) -> None:
    (tmp_path / "bad.glb").write_bytes(b"nothing of the kind")
    done = adamo(*words, cwd=tmp_path)
    assert done.code == 2
    assert says in done.err
    assert len(done.err.strip().splitlines()) == 1


def test_an_episode_is_played_and_replayed_with_it(me: str, tmp_path: Path) -> None:
    size = ("--resolution", "160x90")
    done = adamo("run", "--task", "T2", "--figure", me, "--out", "run", *size, cwd=tmp_path)
    assert done.code == 0, done.err
    assert json.loads((tmp_path / "run" / MANIFEST).read_bytes())["figure_sha256"]
    (tmp_path / me).unlink()
    assert "Same" in adamo("replay", "run", cwd=tmp_path).out
    (tmp_path / "run" / FIGURE).unlink()
    said = adamo("replay", "run", cwd=tmp_path)
    assert said.code == 0
    assert "mara stands in" in said.err


def test_an_own_figure_can_be_exported_with_our_clips(me: str, tmp_path: Path) -> None:
    done = adamo("figure", "export", "out.glb", "--who", me, cwd=tmp_path)
    assert "clips walk, reach, idle" in done.out
    assert adamo("figure", "check", "out.glb", cwd=tmp_path).code == 0
