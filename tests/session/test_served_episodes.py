"""Whole episodes with a model behind its own endpoint: the same moves as in this process."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import threading
from pathlib import Path
from typing import Any

import httpx
import pytest
from typer.testing import CliRunner

import adamo_vh
from adamo_vh.action import Look, Pick, Survey, ToolSchema, tool_schema
from adamo_vh.errors import ProviderError
from adamo_vh.inference.ladder import Ladder
from adamo_vh.inference.ladder.conversation import rewritten
from adamo_vh.inference.ladder.json_form import JsonForm
from adamo_vh.inference.ladder.react_form import ReactForm
from adamo_vh.inference.messages import (
    AIMessage,
    HumanMessage,
    ImagePart,
    Message,
    SystemMessage,
    TextPart,
    ToolCall,
    ToolMessage,
)
from adamo_vh.inference.model import ModelKind, Rung, Sampling
from adamo_vh.inference.players.cassette import taped
from adamo_vh.inference.registry import create_model
from adamo_vh.inference.remote.probe import probe
from adamo_vh.inference.remote.provider import ProviderModel
from adamo_vh.inference.remote.retry import RetryPolicy
from adamo_vh.model_server.fault_rules import Faults, WithoutTools
from adamo_vh.model_server.model_serving import serve_model
from adamo_vh.model_server.openai_messages import ChatRequest
from adamo_vh.model_server.toolless import Form, conversation, written
from adamo_vh.runtime.builtin import BuiltinEngine

QUICK = RetryPolicy(max_tries=2, max_wait_s=2.0, base_s=0.01, timeout_s=20.0)
SMALL = (640, 360)
TOOLS = [tool_schema(action) for action in (Look, Pick, Survey)]
FRAME = ImagePart(b"...", "image/jpeg", 4, 3)


def compare(engine: BuiltinEngine, model: Any, **settings: Any) -> adamo_vh.EpisodeResult:
    """Play an episode with the baseline here and with a served one, and compare."""
    here = adamo_vh.run_episode(engine=engine, **settings)
    there = adamo_vh.run_episode(model=model, engine=engine, **settings)
    assert (there.state_hash, there.steps) == (here.state_hash, here.steps)
    assert (there.completion, there.answer) == (here.completion, here.answer)
    return there


@pytest.mark.parametrize("task", ["T1", "T4", "T8"])
def test_the_baseline_plays_the_same_over_the_network(engine: BuiltinEngine, task: str) -> None:
    with serve_model("baseline") as served:
        result = compare(engine, ProviderModel(served.uri, QUICK), task=task, resolution=SMALL)
    assert result.completion == 1.0
    assert result.tokens > 0


@pytest.mark.parametrize("task", ["T4", "T8"])
def test_it_plays_the_lean_profile_the_same(engine: BuiltinEngine, task: str) -> None:
    with serve_model("baseline") as served:
        model = ProviderModel(served.uri, QUICK, several_calls=True)
        result = compare(engine, model, task=task, profile="lean", resolution=SMALL)
    assert result.completion == 1.0


def test_its_eyes_see_the_same_over_the_network(engine: BuiltinEngine) -> None:
    with serve_model("baseline") as served:
        model = ProviderModel(served.uri, QUICK)
        result = compare(engine, model, task="T4", labeling="opaq", resolution=(1280, 720))
    assert result.completion == 1.0


@pytest.mark.parametrize("rung", [Rung.SCHEMA, Rung.REACT])
@pytest.mark.parametrize("task", ["T4", "T8"])
def test_without_tools_it_plays_the_same(engine: BuiltinEngine, task: str, rung: Rung) -> None:
    with serve_model("baseline", tools=False) as served:
        model = Ladder(ProviderModel(served.uri, QUICK), rung)
        assert compare(engine, model, task=task, resolution=SMALL).completion == 1.0


def test_a_schema_that_is_ignored_is_answered_in_text(engine: BuiltinEngine) -> None:
    rules = Faults(without_tools=WithoutTools(schema="ignore"))
    with serve_model("baseline", tools=False, faults=rules) as served:
        model = Ladder(ProviderModel(served.uri, QUICK), Rung.SCHEMA)
        assert compare(engine, model, task="T4", resolution=SMALL).completion == 1.0


def test_without_tools_a_request_with_tools_is_refused_or_answered_in_prose() -> None:
    prompt = [HumanMessage((TextPart("Pick up the key"),))]
    with serve_model("baseline", tools=False) as served:
        model = ProviderModel(served.uri, QUICK)
        with pytest.raises(ProviderError, match="does not support tools"):
            model.complete(prompt, TOOLS, Sampling())
    rules = Faults(without_tools=WithoutTools(tools="prose"))
    with serve_model("baseline", tools=False, faults=rules) as served:
        reply = ProviderModel(served.uri, QUICK).complete(prompt, TOOLS, Sampling())
    assert reply.message.calls == ()
    assert reply.message.text.startswith("Evidence: ")


@pytest.mark.parametrize(
    ("tools", "schema", "rung"),
    [
        (True, "obey", Rung.NATIVE),
        (False, "obey", Rung.SCHEMA),
        (False, "ignore", Rung.REACT),
    ],
)
@pytest.mark.parametrize("asked", ["refuse", "prose"])
def test_a_probe_finds_out_what_the_endpoint_can_do(
    tools: bool, schema: Any, rung: Rung, asked: Any
) -> None:
    rules = Faults(without_tools=WithoutTools(asked, schema))
    with serve_model("baseline", tools=tools, faults=rules) as served:
        found = probe(served.uri, QUICK)
    assert found.rung is rung
    assert found.pictures == "yes"
    assert found.result_pictures == ("yes" if tools else "untested")


def request(messages: list[Message], schema: Any = None) -> ChatRequest:
    return ChatRequest(
        "m", tuple(messages), (), Sampling(), schema, None, False, False, frozenset()
    )


@pytest.mark.parametrize("form", [JsonForm(), ReactForm()])
def test_a_conversation_told_as_text_is_read_back(form: Any) -> None:
    call = ToolCall("a", "Look", {"x": 0.0, "y": 1.5, "z": 0.8})
    asked: list[Message] = [
        SystemMessage("# The world\n\nThe room spans x from -4 to 4 and y from -4 to 4."),
        SystemMessage("# Symbolic state\n\n## Visible objects\n- Key_34: at (0, 1, 0.8)"),
        HumanMessage((TextPart("Take the key."), FRAME)),
        AIMessage("Evidence: none.\nMemory: hand empty.", (call,)),
        ToolMessage("a", "Look", "Done: you look there.", (FRAME,)),
        HumanMessage((TextPart("New view after your Look."), FRAME)),
        AIMessage("I have it."),
        HumanMessage((TextPart("Now put it down."),)),
    ]
    told = rewritten(asked, TOOLS, form)
    given = conversation(request(told), True, WithoutTools())
    assert [type(m) for m in given.messages] == [type(m) for m in asked]
    assert list(given.messages[:3]) == asked[:3]
    said, result = given.messages[3], given.messages[4]
    assert isinstance(said, AIMessage) and isinstance(result, ToolMessage)
    assert (said.text, said.calls[0].name) == ("Evidence: none.\nMemory: hand empty.", "Look")
    assert said.calls[0].arguments == call.arguments
    assert result == ToolMessage(said.calls[0].id, "Look", "Done: you look there.", (FRAME,))
    assert list(given.messages[5:]) == asked[5:]
    assert [tool.name for tool in given.tools] == ["Look", "Pick", "Survey"]
    properties = given.tools[0].parameters["properties"]
    assert properties["x"] == {"type": "number", "description": "World X in metres."}
    assert given.tools[0].parameters["required"] == ["x", "y", "z"]
    assert given.form is (Form.STEP if form.name == "schema" else Form.REACT)


def test_what_could_not_be_read_is_asked_again_as_if_never_said() -> None:
    asked: list[Message] = [SystemMessage("Rules."), HumanMessage((TextPart("Take it."),))]
    told = rewritten(asked, TOOLS, ReactForm())
    repair = HumanMessage((TextPart("Your last message could not be read."),))
    given = conversation(request([*told, AIMessage("Hm..."), repair]), True, WithoutTools())
    assert list(given.messages) == [*asked, repair]


@pytest.mark.parametrize("form", [Form.STEP, Form.REACT])
def test_what_is_written_without_tools_can_be_read(form: Form) -> None:
    reader = JsonForm() if form is Form.STEP else ReactForm()
    call = ToolCall("a", "Pick", {"object": "Key_34"})
    step = reader.read(written(AIMessage("I see it.", (call,)), form).text, TOOLS)
    assert getattr(step, "thought", None) == "I see it."
    assert (getattr(step, "action", None), getattr(step, "args", None)) == (
        "Pick",
        {"object": "Key_34"},
    )
    final = reader.read(written(AIMessage("Done."), form).text, TOOLS)
    assert (getattr(final, "action", ""), getattr(final, "answer", "")) == (None, "Done.")
    broken = ToolCall("a", "Pick", None, '{"object": ')
    assert not hasattr(reader.read(written(AIMessage("x", (broken,)), form).text, TOOLS), "action")


def test_the_tools_of_a_step_come_from_its_schema_too() -> None:
    own = ToolSchema("Wave", "Wave.", {"type": "object", "properties": {}, "required": []})
    schema = JsonForm().schema([own]).parameters
    given = conversation(request([HumanMessage((TextPart("x"),))], schema), False, WithoutTools())
    assert [tool.name for tool in given.tools] == ["Wave"]
    assert given.form is Form.STEP


def test_a_script_is_served_too(engine: BuiltinEngine, tmp_path: Path) -> None:
    path = tmp_path / "script.json"
    path.write_text(json.dumps([{"note": "Mine.", "tool": "Pick", "args": {"object": "34"}}]))
    with serve_model(f"scripted:{path}") as served:
        model = ProviderModel(served.uri, QUICK)
        assert model.info.kind is ModelKind.VLM
        result = adamo_vh.run_episode(task="T1", model=model, engine=engine, resolution=SMALL)
    assert (result.completion, result.answer) == (1.0, "The script is finished.")


def test_the_random_player_is_served_too() -> None:
    with serve_model("random:3") as served:
        reply = ProviderModel(served.uri, QUICK).complete(
            [HumanMessage((TextPart("x"),))], TOOLS, Sampling()
        )
    assert reply.message.calls


def test_a_cassette_is_served_and_refuses_another_prompt(
    engine: BuiltinEngine, tmp_path: Path
) -> None:
    settings: dict[str, Any] = {"task": "T4", "engine": engine, "resolution": SMALL}
    recorder = taped(create_model("baseline"), tmp_path / "tape")
    recorded = adamo_vh.run_episode(model=recorder, **settings)
    with serve_model(f"cassette:{tmp_path / 'tape'}") as served:
        played = adamo_vh.run_episode(model=ProviderModel(served.uri, QUICK), **settings)
    assert (played.completion, played.state_hash) == (1.0, recorded.state_hash)
    with serve_model(f"cassette:{tmp_path / 'tape'}") as served:
        prompt = [HumanMessage((TextPart("Something else"),))]
        with pytest.raises(ProviderError, match="HTTP 400"):
            ProviderModel(served.uri, QUICK).complete(prompt, TOOLS, Sampling())


@pytest.mark.parametrize("stop", [signal.SIGINT, signal.SIGTERM])
def test_the_command_serves_until_it_is_stopped(tmp_path: Path, stop: signal.Signals) -> None:
    command = [sys.executable, "-u", "-m", "adamo_vh", "serve-model", "baseline", "--port", "0"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True, cwd=tmp_path) as process:
        assert process.stdout is not None
        address = process.stdout.readline().split()[-1]
        asked = {"model": "m", "messages": [{"role": "user", "content": "x"}]}
        answer = httpx.post(f"{address}/chat/completions", json=asked)
        assert answer.status_code == 200
        os.kill(process.pid, stop)
        patience = threading.Timer(60, process.kill)
        patience.start()
        rest = process.stdout.read()
        patience.cancel()
    assert process.returncode == 0
    assert "200  text" in rest
    assert rest.endswith("stopped\n")


def test_the_command_explains_itself() -> None:
    from adamo_vh.cli.app import app

    shown = CliRunner().invoke(app, ["serve-model", "--help"], env={"COLUMNS": "200"}).output
    for word in ("baseline", "loopback", "--no-tools", "--faults", "retry_after_s", "every"):
        assert word in shown
