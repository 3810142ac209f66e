"""Every command explains itself, and takes nothing that it does not know."""

from __future__ import annotations

import inspect
import json
import re
from typing import Any

import pytest
import typer
from typer.testing import CliRunner

import adamo_vh
from adamo_vh.cli.app import app
from adamo_vh.cli.kept_help import keep_help

ROOT = typer.main.get_command(app)
runner = CliRunner(env={"COLUMNS": "200", "NO_COLOR": "1", "TERM": "dumb"})


def commands(group: Any, path: tuple[str, ...] = ()) -> dict[str, Any]:
    """All commands by their words, groups with their members."""
    if not hasattr(group, "commands"):
        return {" ".join(path): group}
    found = {" ".join(path): group} if path else {}
    for name, command in group.commands.items():
        found |= commands(command, (*path, name))
    return found


COMMANDS = commands(ROOT)


def test_no_help_is_lost_where_docstrings_are() -> None:
    made = [command.callback for command in app.registered_commands]
    said = {command: command.__doc__ for command in made if command is not None}
    try:
        for command in said:
            command.__doc__ = None
        keep_help(app)
        for info in app.registered_commands:
            assert info.callback is not None
            assert info.help == inspect.cleandoc(str(said[info.callback]))
    finally:
        for command, doc in said.items():
            command.__doc__ = doc
        for info in app.registered_commands:
            info.help = None


def test_the_commands_are_those_that_the_guide_names() -> None:
    top = {name for name in COMMANDS if " " not in name}
    assert top >= {
        "run", "chat", "replay", "report", "doctor", "figure", "serve-model", "tasks", "scenes",
        "models", "cache",
    }  # fmt: skip


@pytest.mark.parametrize("name", COMMANDS)
def test_a_command_tells_what_it_does_and_each_of_its_options(name: str) -> None:
    done = runner.invoke(app, [*name.split(), "--help"])
    assert done.exit_code == 0, done.output
    assert "Usage: " in done.output
    command = COMMANDS[name]
    assert (command.help or "").strip(), name
    for parameter in command.params:
        if getattr(parameter, "hidden", False) or not parameter.opts[0].startswith("--"):
            continue
        assert parameter.opts[0] in done.output, parameter.opts
        assert getattr(parameter, "help", ""), f"{name} {parameter.opts[0]} says nothing"


@pytest.mark.parametrize("name", COMMANDS)
def test_help_is_plain_words_for_people(name: str) -> None:
    text = runner.invoke(app, [*name.split(), "--help"]).output
    assert not re.search(r"\b(TODO|FIXME|None\b.*None)\b", text)
    assert "\x1b" not in text


@pytest.mark.parametrize("name", COMMANDS)
def test_an_unknown_option_is_refused_by_name(name: str) -> None:
    done = runner.invoke(app, [*name.split(), "--no-such-thing"])
    assert done.exit_code == 2
    assert "--no-such-thing" in done.output


@pytest.mark.parametrize("arguments", [["fly"], ["models", "fly"], ["cache", "fly"]])
def test_an_unknown_command_is_refused(arguments: list[str]) -> None:
    done = runner.invoke(app, arguments)
    assert done.exit_code == 2
    assert "fly" in done.output


def test_the_version_is_told() -> None:
    done = runner.invoke(app, ["--version"])
    assert done.exit_code == 0
    assert adamo_vh.__version__ in done.output


SHAPES = {
    "tasks": ("tasks", {"id", "prompt"}),
    "scenes": ("scenes", {"name", "objects"}),
}


@pytest.mark.parametrize("name", SHAPES)
def test_lists_are_one_json_object(name: str) -> None:
    key, fields = SHAPES[name]
    done = runner.invoke(app, [name, "--json"])
    assert done.exit_code == 0, done.output
    rows = json.loads(done.stdout)[key]
    assert rows
    for row in rows:
        assert fields <= set(row)
        assert set(row) == set(rows[0])


def test_text_and_json_name_the_same_things() -> None:
    text = runner.invoke(app, ["tasks"]).output
    tasks = json.loads(runner.invoke(app, ["tasks", "--json"]).stdout)["tasks"]
    assert all(re.search(rf"\b{task['id']}\b", text) for task in tasks)
