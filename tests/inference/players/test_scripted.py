"""A script answers in order, ends by itself, and says what is wrong with its file."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from adamo_vh.errors import ConfigError
from adamo_vh.inference.messages import AIMessage, ToolCall
from adamo_vh.inference.model import ModelKind, Sampling, Usage
from adamo_vh.inference.players.scripted import FINISHED, ScriptedModel, load_script
from adamo_vh.inference.registry import create_model

PICK = {"tool": "Pick", "args": {"object": "Plate_57"}, "note": "The plate is in view."}
LOOK: dict[str, Any] = {"tool": "Look", "args": {"x": 1.5, "y": 0, "z": 0.8}}


def script(folder: Path, entries: object) -> Path:
    path = folder / "plan.json"
    path.write_text(json.dumps(entries))
    return path


def test_a_script_answers_in_order_and_then_finishes(tmp_path: Path) -> None:
    path = script(tmp_path, [PICK, LOOK, {"note": "The plate is in my hand."}])
    model = create_model(f"scripted:{path}")
    replies = [model.complete((), (), Sampling()) for _ in range(5)]
    assert [reply.message for reply in replies] == [
        AIMessage(
            "The plate is in view.",
            (ToolCall("call_1", "Pick", {"object": "Plate_57"}, '{"object": "Plate_57"}'),),
        ),
        AIMessage("", (ToolCall("call_2", "Look", LOOK["args"], '{"x": 1.5, "y": 0, "z": 0.8}'),)),
        AIMessage("The plate is in my hand."),
        AIMessage(FINISHED),
        AIMessage(FINISHED),
    ]
    assert all(reply.usage == Usage() and reply.waited_s == 0 for reply in replies)


def test_a_script_is_named_after_its_uri_and_never_passes_for_a_vlm(tmp_path: Path) -> None:
    path = script(tmp_path, [PICK])
    model = create_model(f"scripted:{path}")
    assert model.info.name == f"scripted:{path}"
    assert model.info.kind is ModelKind.SCRIPTED


def test_the_same_file_gives_the_same_messages(tmp_path: Path) -> None:
    path = script(tmp_path, [PICK, LOOK])
    assert load_script(path) == load_script(path)


def test_recorded_messages_replay_unchanged() -> None:
    recorded = (AIMessage("n", (ToolCall("x9", "Look", None, "{oops"),)), AIMessage("Done."))
    model = ScriptedModel("replay:runs/7", recorded, ModelKind.REPLAY)
    assert model.info.kind is ModelKind.REPLAY
    assert [model.complete((), (), Sampling()).message for _ in recorded] == list(recorded)


@pytest.mark.parametrize(
    ("entries", "fix"),
    [
        ({"tool": "Pick"}, "must be a JSON list"),
        (["Pick"], "entry 1: must be an object"),
        ([PICK, {"tool": "Pick", "args": "x"}], 'entry 2: "args" must be an object'),
        ([{"tool": "Pick"}], 'entry 1: "args" must be an object'),
        ([{"tool": 5, "args": {}}], 'entry 1: "tool" must be the name of a tool'),
        ([{"args": {"x": 1}}], 'give a "tool"'),
        ([{}], 'give a "tool"'),
        ([{"note": 3}], '"note" must be a text'),
        ([{"tool": "Pick", "arguments": {}}], "unknown key 'arguments'"),
    ],
)
def test_a_wrong_script_names_the_file_the_entry_and_the_fix(
    tmp_path: Path, entries: object, fix: str
) -> None:
    path = script(tmp_path, entries)
    with pytest.raises(ConfigError) as caught:
        load_script(path)
    assert str(path) in str(caught.value)
    assert fix in str(caught.value)


def test_a_missing_script_and_broken_json_are_named(tmp_path: Path) -> None:
    with pytest.raises(ConfigError, match=r"gone\.json cannot be read"):
        load_script(tmp_path / "gone.json")
    (tmp_path / "broken.json").write_text("[{")
    with pytest.raises(ConfigError, match=r"broken\.json is not valid JSON"):
        load_script(tmp_path / "broken.json")
