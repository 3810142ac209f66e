"""Prompts are files, rendered strictly, and change only on purpose."""

from __future__ import annotations

from pathlib import Path

import pytest

from adamo_vh.action import Drop, Look, Pick, Walk
from adamo_vh.benchmark.conditions import NEAR_M
from adamo_vh.cognition.instructions import system_prompt
from adamo_vh.cognition.profile import profile
from adamo_vh.cognition.prompts import render
from adamo_vh.errors import ConfigError
from adamo_vh.perception import Labeling
from adamo_vh.runtime.scenes import load_scene

GOLDEN = Path(__file__).parent / "golden"
ACTIONS = (Look, Walk, Pick, Drop)


@pytest.mark.parametrize("labeling", list(Labeling))
def test_the_system_prompt_is_as_agreed(labeling: Labeling) -> None:
    rendered = system_prompt(load_scene("s1").info(), labeling, ACTIONS, NEAR_M)
    golden = GOLDEN / f"system_s1_{labeling}.md"
    assert rendered + "\n" == golden.read_text(encoding="utf-8")


@pytest.mark.parametrize(
    ("switch", "labeling"), [("pictures", Labeling.OPAQ), ("state", Labeling.SEM)]
)
def test_the_system_prompt_without_pictures_or_state_is_as_agreed(
    switch: str, labeling: Labeling
) -> None:
    chosen = profile("paper", {switch: "none"})
    rendered = system_prompt(load_scene("s1").info(), labeling, ACTIONS, NEAR_M, chosen)
    golden = GOLDEN / f"system_s1_no_{switch}.md"
    assert rendered + "\n" == golden.read_text(encoding="utf-8")


def test_a_missing_variable_is_an_error() -> None:
    with pytest.raises(ConfigError, match=r"not_executed\.md: 'why' is undefined"):
        render("not_executed")


def test_braces_in_values_are_not_rendered_again() -> None:
    assert "{{ why }}" in render("not_executed", why="{{ why }}")
