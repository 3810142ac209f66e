"""`adamo scenes check`: sound scenes pass, and what is wrong is found and named."""

from __future__ import annotations

import json
import subprocess
import sys
from importlib import resources
from pathlib import Path

import pytest

from adamo.runtime.builtin import BuiltinEngine
from adamo.runtime.scenes import load_scene, parse_scene
from adamo.runtime.scenes.inspection import Severity, inspect_scene

S1 = (resources.files("adamo.runtime.scenes") / "s1_tabletop.toml").read_text(encoding="utf-8")


def findings(text: str) -> list[tuple[Severity, str, str]]:
    scene = parse_scene(text, "mine.toml")
    engine = BuiltinEngine(scene)
    found = inspect_scene(scene, engine)
    engine.close()
    assert all(finding.fix for finding in found)
    return [(finding.severity, finding.where, finding.problem) for finding in found]


@pytest.mark.parametrize("name", ["s1", pytest.param("s2", marks=pytest.mark.slow)])
def test_built_in_scenes_are_sound(name: str) -> None:
    scene = load_scene(name)
    engine = BuiltinEngine(scene)
    assert inspect_scene(scene, engine) == ()
    engine.close()


@pytest.mark.parametrize(
    ("before", "after", "where", "part"),
    [
        ("[0.326, -0.603]", "[0.076, -0.853]", "objects", "overlap"),
        ("[0.326, -0.603]", "[0.560, -0.603]", "objects[18].position", "does not stay on 'table'"),
        ("position = [-2.0, -1.0]", "position = [-0.05, -1.0]", "agent.position", "not fit"),
        ("diffuse = 0.3", "diffuse = 0.3\nshadow = true", "lights", "2 lights cast shadows"),
        (
            "[[objects]]",
            '[[furniture]]\nname = "twin"\nasset = "dining_table"\nposition = [0.3, -1.0]\n\n'
            "[[objects]]",
            "furniture[1].position",
            "'table' and 'twin' overlap",
        ),
    ],
)
def test_what_is_wrong_is_found(before: str, after: str, where: str, part: str) -> None:
    assert before in S1
    found = findings(S1.replace(before, after, 1))
    assert any(place.startswith(where) and part in problem for _, place, problem in found), found


def test_the_command_prints_findings_and_writes_pictures(tmp_path: Path) -> None:
    path = tmp_path / "mine.toml"
    path.write_text(S1.replace("[0.326, -0.603]", "[0.076, -0.853]", 1))
    done = subprocess.run(
        [sys.executable, "-m", "adamo", "scenes", "check", str(path), "--json"],
        capture_output=True,
        text=True,
        cwd=tmp_path,
        check=False,
    )
    assert done.returncode == 1, done.stderr
    found = json.loads(done.stdout)
    assert found["ok"] is False
    assert found["findings"][0]["severity"] == "error"
    for picture in found["pictures"]:
        assert (tmp_path / picture).read_bytes()[:4] == b"\x89PNG"
