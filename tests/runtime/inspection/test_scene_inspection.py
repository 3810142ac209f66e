"""`adamo-vh scenes check`: sound scenes pass, and what is wrong is found and named."""

from __future__ import annotations

import json
from importlib import resources
from pathlib import Path
from typing import Any

import pytest
from tests.cli.process import adamo

from adamo_vh.errors import SceneError
from adamo_vh.runtime.builtin import BuiltinEngine
from adamo_vh.runtime.inspection.arrangement import inspect_arrangement
from adamo_vh.runtime.inspection.checks import inspect_scene
from adamo_vh.runtime.inspection.finding import Severity
from adamo_vh.runtime.scenes import load_scene, parse_scene

S1 = (resources.files("adamo_vh.runtime.scenes") / "s1_tabletop.toml").read_text(encoding="utf-8")
HEAD = S1[: S1.index("[[objects]]")]


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
        ("diffuse = 0.24", "diffuse = 0.24\nshadow = true", "lights", "2 lights cast shadows"),
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


def pile(asset: str, count: int) -> str:
    """A scene with so many objects in the same place."""
    items = (
        f'[[objects]]\nid = {i}\nasset = "{asset}"\non = "table"\nposition = [0.0, -1.0]\n'
        for i in range(count)
    )
    return HEAD + "\n".join(items)


@pytest.mark.parametrize("asset", ["tape", "key"])
def test_a_pile_of_objects_is_told_and_never_simulated(asset: str) -> None:
    found = inspect_arrangement(parse_scene(pile(asset, 200), "pile.toml"))
    assert all(finding.blocks and "overlap" in finding.problem for finding in found[:-1])
    assert found[-1].problem.startswith("19880 more")
    assert len(found) == 21


@pytest.mark.parametrize(
    ("text", "part"),
    [
        (pile("tape", 100), "objects[1].position: objects 0 and 1 overlap; move one of them"),
        (S1.replace("[-0.8, -1.0, 0.4]", "[2.6, -1.0, 2.0]", 1), "lights[1].target: the light is"),
        (S1.replace('on = "table"', 'on = "table/top"', 1), "objects[0].on: nothing can lie on"),
    ],
)
def test_what_cannot_be_simulated_is_refused_by_the_engine(text: str, part: str) -> None:
    with pytest.raises(SceneError) as caught:
        BuiltinEngine(parse_scene(text, "mine.toml"))
    assert part in str(caught.value)
    assert "\n" not in str(caught.value)


def test_what_the_physics_refuses_is_an_error_that_names_the_fix(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """So few may be only clumsy, and are tried; MuJoCo logs its failure where it runs."""
    monkeypatch.chdir(tmp_path)
    scene = parse_scene(pile("tape", 9), "pile.toml")
    assert not any(finding.blocks for finding in inspect_arrangement(scene))
    with pytest.raises(SceneError, match="physics cannot take it") as caught:
        BuiltinEngine(scene)
    assert "move apart what touches" in str(caught.value)
    assert "\n" not in str(caught.value)


def test_a_pile_can_be_run_without_a_traceback(tmp_path: Path) -> None:
    path = tmp_path / "pile.toml"
    path.write_text(pile("tape", 100))
    command = ("run", "Pick the tape", "--scene", str(path), "--model", "baseline")
    done = adamo(*command, cwd=tmp_path)
    assert done.code != 0
    assert "objects 0 and 1 overlap; move one of them" in " ".join(done.err.split())


@pytest.mark.parametrize(
    ("before", "after", "where", "part", "blocks"),
    [
        ("[-0.8, -1.0, 0.4]", "[2.6, -1.0, 2.0]", "lights[1].target", "at itself", True),
        ('on = "table"', 'on = "table/top"', "objects[0].on", "nothing can lie on", True),
        ("[0.326, -0.603]", "[0.430, -0.603]", "objects[18].position", "past the edge", False),
    ],
)
def test_the_file_alone_tells(before: str, after: str, where: str, part: str, blocks: bool) -> None:
    assert before in S1
    (found,) = inspect_arrangement(parse_scene(S1.replace(before, after, 1), "mine.toml"))
    assert (found.where, found.blocks) == (where, blocks)
    assert part in found.problem


def test_out_of_time_is_said(engine: BuiltinEngine) -> None:
    (found,) = inspect_scene(load_scene("s1"), engine, time_limit_s=-1.0)
    assert found.severity is Severity.WARNING
    assert "out of time" in found.problem


def check(path: Path) -> tuple[int, dict[str, Any]]:
    done = adamo("scenes", "check", str(path), "--json", cwd=path.parent)
    return done.code, json.loads(done.out)


def test_the_command_prints_findings_and_writes_pictures(tmp_path: Path) -> None:
    path = tmp_path / "mine.toml"
    path.write_text(S1.replace("[0.326, -0.603]", "[0.076, -0.853]", 1))
    code, found = check(path)
    assert (code, found["ok"]) == (1, False)
    assert found["findings"][0]["severity"] == "error"
    assert [Path(picture).name for picture in found["pictures"]] == ["top.png", "start.png"]
    for picture in found["pictures"]:
        assert (tmp_path / picture).read_bytes()[:4] == b"\x89PNG"


def test_a_field_that_breaks_the_schema_is_a_finding(tmp_path: Path) -> None:
    path = tmp_path / "mine.toml"
    path.write_text(S1.replace("diffuse = 0.24", "diffuse = 7", 1))
    code, found = check(path)
    assert (code, found["scene"], found["pictures"]) == (1, "mine", [])
    assert [finding["where"] for finding in found["findings"]] == ["lights[1].diffuse"]
