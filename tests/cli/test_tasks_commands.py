"""`adamo-vh tasks check` on good and bad files."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from tests.cli.process import adamo, walk

from adamo_vh.benchmark.tasks.reading import read_task

GOOD = """
id = "CUP"
prompt = "Put the cup on the floor"
units = ["pick", "drop", "tag", "floor"]
conditions = [{ on_floor = 45 }]
"""


def test_a_sound_task(tmp_path: Path) -> None:
    path = tmp_path / "cup.toml"
    path.write_text(GOOD)
    check = ("tasks", "check", str(path), "--scene", "s1", "--random", "2", "--json")
    done = adamo(*check, cwd=tmp_path)
    told = json.loads(done.out)
    assert (done.code, told["task"], told["sound"]) == (0, "CUP", True)
    assert [(row["scene"], row["labeling"]) for row in told["scenes"]] == [
        ("s1", "sem"), ("s1", "opaq"),
    ]  # fmt: skip
    assert told["computed"]["total"] == 4


def test_an_unsound_task(tmp_path: Path) -> None:
    path = tmp_path / "cup.toml"
    path.write_text(GOOD.replace("on_floor = 45", 'on = { object = 45, surface = "table" }'))
    check = ("tasks", "check", str(path), "--scene", "s1", "--random", "0")
    done = adamo(*check, cwd=tmp_path)
    assert done.code == 1
    assert "FAIL s1 sem" in done.out
    assert "is so at the start: 45 on table" in done.out


@pytest.mark.parametrize(
    ("text", "told"),
    [
        (GOOD.replace('"CUP"', "CUP"), "line 2"),
        (GOOD.replace("45", '"cup"'), "conditions[0].on_floor: must be a whole number"),
    ],
)
def test_a_wrong_file_is_one_line(tmp_path: Path, text: str, told: str) -> None:
    path = tmp_path / "cup.toml"
    path.write_text(text)
    done = adamo("tasks", "check", str(path), cwd=tmp_path)
    assert (done.code, done.out) == (2, "")
    assert told in done.err and len(done.err.strip().splitlines()) == 1


def test_tasks_are_generated_into_files(tmp_path: Path) -> None:
    draw = ("tasks", "generate", "--seed", "31", "--count", "1", "--scene", "s1", "--random", "1")
    told, no_count, no_split, no_scene = walk(
        [
            [*draw, "--json"],
            ["tasks", "generate", "--count", "0"],
            ["tasks", "generate", "--split", "train"],
            ["tasks", "generate", "--scene", "s9"],
        ],
        cwd=tmp_path,
    )
    assert told.code == 0, told.all
    (row,) = json.loads(told.out)["tasks"]
    task = read_task(tmp_path / row["file"])
    assert (row["id"], row["file"]) == ("DEV-31-001", "tasks/dev-31/DEV-31-001.toml")
    assert (task.prompt, list(task.scenes)) == (row["prompt"], row["scenes"])
    assert row["computed"]["total"] == task.computed.total
    assert (no_count.code, "use 1 to 1000" in no_count.err) == (2, True)
    assert (no_split.code, "use dev or test" in no_split.err) == (2, True)
    assert (no_scene.code, "no scene 's9'" in no_scene.err) == (2, True)
