"""What OpenEnv's clients send is read strictly, and what they are told fits its schema."""

from __future__ import annotations

from typing import Any

import jsonschema
import pytest

from adamo_vh.errors import ConfigError
from adamo_vh.service.openenv import catalog
from adamo_vh.service.openenv.messages import (
    Action,
    CallTool,
    ListTools,
    Observation,
    Reset,
    Shown,
    State,
    Told,
    plain,
    read,
    schemas,
)

TOLD = Told(
    "Pick the plate.",
    "# Symbolic state",
    "Done: you look.",
    "done",
    "ok",
    Shown("image/jpeg", "AAAA", 16, 9),
    (Shown("image/png", "BBBB", 8, 8),),
    ("Plate_57",),
)


def test_an_action_is_a_call_unless_it_says_otherwise() -> None:
    assert read(Action, {"tool_name": "Look"}) == CallTool("Look")
    assert read(Action, {"type": "list_tools"}) == ListTools()
    whole = {"type": "call_tool", "tool_name": "Pick", "arguments": {"object": "x"}}
    assert read(Action, {**whole, "metadata": {"note": "n"}}) == CallTool(
        "Pick", {"object": "x"}, {"note": "n"}
    )


@pytest.mark.parametrize(
    ("told", "match"),
    [
        ({}, "tool_name: Field required"),
        ({"tool_name": 3}, "tool_name: "),
        ({"tool_name": "x" * 2000}, "at most 1000"),
        ({"tool_name": "Look", "arguments": [1]}, "arguments: "),
        ({"tool_name": "Look", "now": True}, "now: Unexpected keyword"),
        ({"type": "jump"}, "does not match any of the expected tags"),
        ([], "message: "),
        (None, "message: "),
    ],
)
def test_a_wrong_action_names_its_field(told: Any, match: str) -> None:
    with pytest.raises(ConfigError, match=match):
        read(Action, told)


@pytest.mark.parametrize(
    "told",
    [
        {"seed": "many"},
        {"seed": 2**31},
        {"labeling": "blue"},
        {"profile": "fast"},
        {"index": -1},
        {"variation": 1.5},
        {"instruction": "x" * 30_000},
        {"saved": "..."},
    ],
)
def test_a_wrong_reset_is_refused(told: Any) -> None:
    with pytest.raises(ConfigError, match=next(iter(told))):
        read(Reset, told)


def test_what_is_told_fits_the_schema() -> None:
    published = schemas()
    jsonschema.validate(plain(Observation("Look", TOLD, "abc")), published["observation"])
    jsonschema.validate(plain(State("abc", 3, "T1", "s1", True)), published["state"])
    jsonschema.validate({"type": "call_tool", "tool_name": "Look"}, published["action"])
    with pytest.raises(jsonschema.ValidationError):
        jsonschema.validate({"type": "jump"}, published["action"])


def test_nothing_of_the_room_is_in_a_state() -> None:
    assert set(plain(State())) == {"episode_id", "step_count", "task", "scene", "done"}


def test_a_seed_chooses_a_task() -> None:
    assert catalog.drawn(None) == catalog.drawn(0) == "T1"
    assert {catalog.drawn(seed) for seed in range(15)} == {f"T{n}" for n in range(1, 16)}


def test_an_entry_of_a_split_is_a_scene_and_a_task() -> None:
    assert catalog.chosen("S2", 7) == ("s2", "T8")
    with pytest.raises(ConfigError, match="has tasks 0 to 14, and no 15"):
        catalog.chosen("S2", 15)
    with pytest.raises(ConfigError, match="Splits: S1, S2"):
        catalog.chosen("train", 0)
