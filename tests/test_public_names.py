"""The public surface: complete, spelled alike everywhere, and found by help and dir."""

from __future__ import annotations

import ast
import pydoc
from importlib.metadata import version
from pathlib import Path

import pytest

import adamo_vh


def test_every_public_name_can_be_had() -> None:
    assert sorted(adamo_vh.__all__) == adamo_vh.__all__
    for name in adamo_vh.__all__:
        assert getattr(adamo_vh, name) is not None
    assert set(adamo_vh.__all__) <= set(dir(adamo_vh))


def test_type_checkers_know_the_same_names() -> None:
    tree = ast.parse(Path(adamo_vh.__file__).read_text(encoding="utf-8"))
    block = next(node for node in tree.body if isinstance(node, ast.If))
    told = {
        alias.asname: f"{node.module}.{alias.name}"
        for node in ast.walk(block)
        if isinstance(node, ast.ImportFrom)
        for alias in node.names
    }
    assert told == {name: f"adamo_vh.{home}.{name}" for name, home in adamo_vh._HOME.items()}


@pytest.mark.parametrize(
    "name",
    ["World", "Body", "Model", "Reply", "Tool", "Task", "Labeling", "Session", "Memory", "Budget"],
)
def test_what_can_be_handed_in_is_public(name: str) -> None:
    assert name in adamo_vh.__all__


def test_help_shows_them() -> None:
    told = pydoc.plain(pydoc.render_doc(adamo_vh))
    for name in ("run_episode", "class Session", "class EpisodeConfig", "VERSION"):
        assert name in told


def test_an_unknown_name_is_said_to_be_unknown() -> None:
    with pytest.raises(AttributeError, match="no attribute 'nothing'"):
        adamo_vh.nothing  # noqa: B018


def test_the_version_is_that_of_the_distribution() -> None:
    assert adamo_vh.__version__ == version("adamo-vh")
