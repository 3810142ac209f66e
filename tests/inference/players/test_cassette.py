"""A recorded episode runs again without its model, and any change of the prompt is shown."""

from __future__ import annotations

import dataclasses
import json
import re
import socket
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import pytest

from adamo_vh.action import Look, Pick, ToolSchema, tool_schema
from adamo_vh.action_server import LocalActionServer
from adamo_vh.cognition.agent import Agent
from adamo_vh.cognition.instructions import system_prompt
from adamo_vh.errors import CassetteError, RecordError
from adamo_vh.inference.baseline import BaselineModel
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
from adamo_vh.inference.model import Model, ModelInfo, ModelKind, Reply, Rung, Sampling, Usage
from adamo_vh.inference.players.cassette import CALLS, Cassette, taped
from adamo_vh.perception import Labeling
from adamo_vh.record.trajectory import Ended, Trajectory
from adamo_vh.runtime.builtin import BuiltinEngine

TOOLS = [tool_schema(Look), tool_schema(Pick)]
FRAME = ImagePart(b"first frame", "image/jpeg", 480, 270)
PICK = ToolCall("call_7", "Pick", {"object": "Plate_57"}, '{"object":"Plate_57"}')
FIRST: tuple[Message, ...] = (
    SystemMessage("You live in a room.\nYou have a body."),
    HumanMessage((TextPart("Pick the plate."), FRAME)),
)
SECOND: tuple[Message, ...] = (
    *FIRST,
    AIMessage("I see it.", (PICK,), kept="signature"),
    ToolMessage("call_7", "Pick", "Done: you hold Plate_57.", (FRAME,)),
)
REPLIES = (
    Reply(
        AIMessage("I see it.", (PICK,), kept="signature"),
        Usage(1234, 20, 1000, 5),
        1.5,
        0.25,
        2,
        0.003,
        {"temperature": 0.0, "top_p": None},
        Rung.NATIVE,
    ),
    Reply(AIMessage("I hold the plate."), Usage(1300, 9), unreadable=""),
)


class Answering:
    """A model that answers from a list, with everything a reply can say."""

    def __init__(self, replies: Sequence[Reply] = REPLIES) -> None:
        self.info = ModelInfo("openai:gpt-4o", ModelKind.VLM)
        self._replies = list(replies)

    def complete(
        self, messages: Sequence[Message], tools: Sequence[ToolSchema], sampling: Sampling
    ) -> Reply:
        return self._replies.pop(0)


def ask(model: Model, messages: Sequence[Message] = FIRST) -> Reply:
    return model.complete(messages, TOOLS, Sampling())


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A cassette of two calls."""
    recorder = taped(Answering(), tmp_path / "tape")
    assert (ask(recorder), ask(recorder, SECOND)) == REPLIES
    assert (recorder.info.name, recorder.info.kind) == ("openai:gpt-4o", ModelKind.VLM)
    return tmp_path / "tape"


def test_the_same_requests_get_the_same_replies(folder: Path) -> None:
    cassette = Cassette(folder)
    assert (cassette.info.name, cassette.model) == (f"cassette:{folder}", "openai:gpt-4o")
    assert (cassette.info.kind, len(cassette)) == (ModelKind.VLM, 2)
    assert (ask(cassette), ask(cassette, SECOND)) == REPLIES


def test_pictures_are_kept_by_hash_and_size_alone(folder: Path) -> None:
    text = (folder / CALLS).read_text()
    part = json.loads(text.splitlines()[0])["request"]["messages"][1]["parts"][1]
    assert (part["width_px"], part["height_px"], part["media_type"]) == (480, 270, "image/jpeg")
    assert len(part["sha256"]) == 64
    assert "first frame" not in text


def test_a_picture_with_other_bytes_is_the_same_request(folder: Path) -> None:
    other = dataclasses.replace(FRAME, data=b"drawn elsewhere")
    cassette = Cassette(folder)
    assert ask(cassette, (FIRST[0], HumanMessage((TextPart("Pick the plate."), other))))


def test_every_call_is_on_disk_before_the_next(tmp_path: Path) -> None:
    recorder = taped(Answering(), tmp_path)
    for count, prompt in enumerate((FIRST, SECOND), start=1):
        ask(recorder, prompt)
        assert len(Cassette(tmp_path)) == count


def change(number: int, message: Message) -> tuple[Message, ...]:
    return (*SECOND[: number - 1], message, *SECOND[number:])


@pytest.mark.parametrize(
    ("messages", "parts"),
    [
        (
            change(1, SystemMessage("You live in a room.\nYou have two bodies.")),
            ["message 1 (system) differs", "-You have a body.", "+You have two bodies."],
        ),
        (
            change(2, HumanMessage((TextPart("Pick the plate."), ImagePart(b"", "x", 640, 360)))),
            ["message 2 (human) differs", "-[picture 480 x 270 px]", "+[picture 640 x 360 px]"],
        ),
        (
            change(
                3, AIMessage("I see it.", (dataclasses.replace(PICK, arguments={"object": "4"}),))
            ),
            ["message 3 (ai) differs", '-[call call_7] Pick {"object": "Plate_57"}'],
        ),
        (
            change(4, ToolMessage("call_7", "Pick", "Refused: too far.", (FRAME,))),
            ["message 4 (tool) differs", "+Refused: too far."],
        ),
        (
            change(4, HumanMessage((TextPart("Go on."),))),
            ["message 4 (human) is asked where message 4 (tool) was recorded", "+Go on."],
        ),
        (SECOND[:3], ["message 4 (tool)", "4 messages recorded, 3 asked"]),
        (
            (*SECOND, SystemMessage("And now?")),
            ["message 5 (system)", "+And now?", "4 messages recorded, 5 asked"],
        ),
    ],
)
def test_a_changed_prompt_names_the_message_and_shows_the_difference(
    folder: Path, messages: Sequence[Message], parts: list[str]
) -> None:
    cassette = Cassette(folder)
    ask(cassette)
    with pytest.raises(CassetteError) as error:
        ask(cassette, messages)
    text = str(error.value)
    assert all(part in text for part in [f"{cassette.info.name}, call 2: ", *parts]), text


def test_tools_and_settings_belong_to_the_request(folder: Path) -> None:
    with pytest.raises(CassetteError, match="tool Pick was recorded"):
        Cassette(folder).complete(FIRST, TOOLS[:1], Sampling())
    other = dataclasses.replace(TOOLS[1], description="Take something.")
    with pytest.raises(CassetteError, match=r"tool Pick differs[\s\S]*Take something"):
        Cassette(folder).complete(FIRST, [TOOLS[0], other], Sampling())
    with pytest.raises(CassetteError, match=r'sampling differs[\s\S]*\+ "temperature": 0.5'):
        Cassette(folder).complete(FIRST, TOOLS, Sampling(temperature=0.5))


def test_a_long_difference_is_trimmed(folder: Path) -> None:
    long = SystemMessage("\n".join(f"rule {n}" for n in range(200)))
    with pytest.raises(CassetteError) as error:
        ask(Cassette(folder), (long, FIRST[1]))
    lines = str(error.value).splitlines()
    assert len(lines) == 42
    assert re.fullmatch(r"\.\.\. \d+ more lines", lines[-1])


def test_running_out_of_calls_says_how_many_there_are(folder: Path) -> None:
    cassette = Cassette(folder)
    ask(cassette)
    ask(cassette, SECOND)
    with pytest.raises(CassetteError, match="has 2 calls, and call 3 is asked for"):
        ask(cassette, SECOND)


def test_calls_before_an_interruption_are_skipped(folder: Path) -> None:
    cassette = Cassette(folder)
    cassette.skip(1)
    assert ask(cassette, SECOND) == REPLIES[1]


def test_a_line_that_a_kill_cut_off_is_left_out(folder: Path) -> None:
    path = folder / CALLS
    path.write_bytes(path.read_bytes()[:-20])
    assert len(Cassette(folder)) == 1


def test_a_damaged_line_in_the_middle_is_an_error(folder: Path) -> None:
    path = folder / CALLS
    first, second = path.read_bytes().splitlines(keepends=True)
    path.write_bytes(first[:50] + b"\n" + second)
    with pytest.raises(RecordError, match=r"calls\.jsonl, line 1 is damaged"):
        Cassette(folder)


def test_what_is_no_cassette_is_an_error(tmp_path: Path) -> None:
    with pytest.raises(RecordError, match="is no cassette"):
        Cassette(tmp_path)
    (tmp_path / "cassette.json").write_text('{"version": 99}')
    with pytest.raises(RecordError, match="version 1"):
        Cassette(tmp_path)
    (tmp_path / "cassette.json").write_text('{"version": 1, "model": "m", "kind": "ghost"}')
    with pytest.raises(RecordError, match="damaged"):
        Cassette(tmp_path)


def test_a_recording_is_never_mixed_with_another(folder: Path) -> None:
    with pytest.raises(RecordError, match="already holds a cassette"):
        taped(Answering(), folder)


def test_a_resumed_recording_goes_on_behind_what_was_answered(folder: Path) -> None:
    with (folder / CALLS).open("ab") as file:
        file.write(b'{"number": 3, "half')
    recorder = taped(Answering(REPLIES[1:]), folder, known=1)
    ask(recorder, SECOND)
    cassette = Cassette(folder)
    assert len(cassette) == 2
    assert (ask(cassette), ask(cassette, SECOND)) == REPLIES
    with pytest.raises(RecordError, match="holds 2 calls, and 5 were answered"):
        taped(Answering(), folder, known=5)
    stranger = Answering()
    stranger.info = ModelInfo("openai:other", ModelKind.VLM)
    with pytest.raises(RecordError, match="is a cassette of openai:gpt-4o, not of openai:other"):
        taped(stranger, folder, known=1)


def test_keys_are_not_recorded_and_do_not_matter_to_the_replay(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("SECRET_TOKEN", "hunter2hunter2")
    prompt = (SystemMessage("Do not say hunter2hunter2."),)
    call = ToolCall("c", "Pick", {"object": "hunter2hunter2"}, '{"object": "hunter2hunter2"}')
    ask(taped(Answering([Reply(AIMessage("hunter2hunter2", (call,)))]), tmp_path), prompt)
    assert "hunter2" not in (tmp_path / CALLS).read_text()
    reply = ask(Cassette(tmp_path), prompt)
    assert reply.message.calls[0].arguments == {"object": "[key]"}


def test_a_key_that_only_the_second_machine_has_changes_nothing(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("API_KEY", "a body.")
    assert ask(Cassette(folder)) == REPLIES[0]


def test_text_that_cannot_be_encoded_does_not_stop_a_recording(tmp_path: Path) -> None:
    prompt = (SystemMessage("lone \ud800 half"),)
    ask(taped(Answering(), tmp_path), prompt)
    assert ask(Cassette(tmp_path), prompt) == REPLIES[0]


def play(engine: BuiltinEngine, model: Model, instruction: str) -> tuple[Ended, Trajectory]:
    engine.reset(0)
    trajectory = Trajectory()
    server = LocalActionServer(engine, resolution=(480, 270))
    rules = system_prompt(engine.scene, Labeling.SEM, server.actions, 0.3)
    return Agent(model, server, rules, observers=[trajectory]).run(instruction), trajectory


@pytest.fixture
def no_network(monkeypatch: pytest.MonkeyPatch) -> Callable[..., None]:
    def refuse(*args: Any, **kwargs: Any) -> None:
        raise AssertionError("a socket was opened")

    monkeypatch.setattr(socket.socket, "connect", refuse)
    return refuse


@pytest.mark.usefixtures("no_network")
def test_a_whole_episode_runs_again_from_its_cassette(
    engine: BuiltinEngine, tmp_path: Path
) -> None:
    instruction = "Pick the plate and place it on the floor"
    ended, recorded = play(engine, taped(BaselineModel(), tmp_path), instruction)
    cassette = Cassette(tmp_path)
    again, replayed = play(engine, cassette, instruction)
    assert (again.reason, again.answer, again.state_hash) == (
        ended.reason,
        ended.answer,
        ended.state_hash,
    )
    assert [act.state_hash for act in replayed.acts] == [act.state_hash for act in recorded.acts]
    assert [t.turn.note for t in replayed.thoughts] == [t.turn.note for t in recorded.thoughts]
    assert len(cassette) == len(recorded.thoughts) > 2
    assert cassette.info.kind is ModelKind.RULE_BASED


def test_another_instruction_ends_the_replay_with_what_differs(
    engine: BuiltinEngine, tmp_path: Path
) -> None:
    play(engine, taped(BaselineModel(), tmp_path), "Pick the plate")
    ended, _ = play(engine, Cassette(tmp_path), "Pick the glass")
    assert not ended.reason.is_scored
    for part in ("call 1: message", "(human) differs", "-Pick the plate", "+Pick the glass"):
        assert part in ended.answer


def test_a_cassette_is_found_in_its_run_folder_and_knows_how_it_was_asked(tmp_path: Path) -> None:
    ask(taped(Answering(), tmp_path / "cassette"))
    cassette = Cassette(tmp_path)
    assert (len(cassette), cassette.info.rung) == (1, Rung.NATIVE)
