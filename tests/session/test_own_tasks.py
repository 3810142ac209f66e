"""Own tasks in episodes: the record holds all that they are scored by, and no state is told."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

import adamo_vh
from adamo_vh.action import ToolSchema
from adamo_vh.benchmark.tasks.reading import parse_task
from adamo_vh.benchmark.tasks.writing import task_text
from adamo_vh.episode.config import EpisodeConfig
from adamo_vh.episode.result import EpisodeResult, judged, read_manifest, read_result
from adamo_vh.errors import ConfigError, RecordError
from adamo_vh.inference.messages import AIMessage, HumanMessage, Message, TextPart, ToolCall
from adamo_vh.inference.model import ModelInfo, ModelKind, Reply, Sampling
from adamo_vh.inference.players.scripted import ScriptedModel
from adamo_vh.record.run_folder import EVENTS, RESULT
from adamo_vh.record.trajectory import Event, Stood, Trajectory, read_trajectory
from adamo_vh.runtime.builtin import BuiltinEngine

FILE = """
id = "TIDY"
prompt = "Put the cup on the floor, and then the plate"
units = ["pick", "drop", "tag", "floor", "pick", "drop", "tag", "floor", "order"]
conditions = [
  { ordered = [{ on_floor = 45 }, { on_floor = 57 }] },
  { nothing_else_moved = true },
]
"""
CUP = ("Cup_45", {"x": -1.6, "y": -0.6, "z": 0.0})
PLATE = ("Plate_57", {"x": -1.6, "y": -1.5, "z": 0.0})


def script(*moves: tuple[str, dict[str, float]], after: int = 0) -> ScriptedModel:
    replies = []
    for n, (tag, place) in enumerate(moves):
        replies.append(AIMessage("I take it.", (ToolCall(f"p{n}", "Pick", {"object": tag}),)))
        call = ToolCall(f"d{n}", "Drop", {"object": tag, **place})
        replies.append(AIMessage("I put it down.", (call,)))
    return ScriptedModel("scripted", (*replies, AIMessage("Done."))[after:])


@pytest.fixture
def file(tmp_path: Path) -> Path:
    path = tmp_path / "tidy.toml"
    path.write_text(FILE)
    return path


def played(engine: BuiltinEngine, file: Path, *moves: Any, **more: Any) -> EpisodeResult:
    return adamo_vh.run_episode(
        task=str(file), engine=engine, model=script(*moves), resolution=(320, 180), **more
    )


def test_a_task_file_is_played_and_scored(engine: BuiltinEngine, file: Path) -> None:
    result = played(engine, file, CUP, PLATE)
    assert (result.task, result.completion, result.strict) == ("TIDY", 1.0, 1.0)
    assert [c.text for c in result.conditions] == [
        "first 45 on floor", "then 57 on floor", "nothing else moved",
    ]  # fmt: skip


def test_the_wrong_order_is_not_complete(engine: BuiltinEngine, file: Path) -> None:
    result = played(engine, file, PLATE, CUP)
    assert [c.satisfied for c in result.conditions] == [True, False, False]


def test_the_record_needs_no_file(engine: BuiltinEngine, file: Path, tmp_path: Path) -> None:
    result = played(engine, file, CUP, PLATE, out=tmp_path / "run")
    file.unlink()
    manifest, recorded = read_manifest(tmp_path / "run"), read_trajectory(tmp_path / "run")
    assert manifest.config.own_task == parse_task(FILE, "x")
    assert judged(manifest, recorded, result.final) == result.score
    kept = read_result(tmp_path / "run")
    assert kept is not None and kept.score == result.score
    assert not adamo_vh.replay_episode(tmp_path / "run", engine=engine).mismatches
    assert (tmp_path / "run" / "episode.html").is_file()


def test_states_are_kept_for_order_alone(engine: BuiltinEngine, file: Path, tmp_path: Path) -> None:
    played(engine, file, CUP, PLATE, out=tmp_path / "run")
    recorded = read_trajectory(tmp_path / "run")
    stood = [event for event in recorded.events if isinstance(event, Stood)]
    assert [e.state_hash for e in stood] == [a.state_hash for a in recorded.acts]
    adamo_vh.run_episode(
        task="T4", engine=engine, model=script(PLATE), resolution=(320, 180), out=tmp_path / "t4"
    )
    events = read_trajectory(tmp_path / "t4").events
    assert not any(isinstance(event, Stood) for event in events)


@pytest.mark.parametrize("damage", ["lost", "changed"])
def test_order_is_never_guessed(
    engine: BuiltinEngine, file: Path, tmp_path: Path, damage: str
) -> None:
    result = played(engine, file, CUP, PLATE, out=tmp_path / "run")
    manifest, recorded = read_manifest(tmp_path / "run"), read_trajectory(tmp_path / "run")
    events: list[Event] = []
    for event in recorded.events:
        if isinstance(event, Stood) and event.step == 2:
            if damage == "lost":
                continue
            events.append(replace(event, changed=()))
        else:
            events.append(event)
    with pytest.raises(RecordError, match=r"step 2 is missing or damaged"):
        judged(manifest, Trajectory(tuple(events)), result.final)


@pytest.mark.parametrize("lines", [2, 5, 6, 7, 9])
def test_it_is_gone_on_with_after_a_kill(
    engine: BuiltinEngine, file: Path, tmp_path: Path, lines: int
) -> None:
    whole = played(engine, file, CUP, PLATE, out=tmp_path / "run")
    before = [event.type for event in read_trajectory(tmp_path / "run").events]
    events = tmp_path / "run" / EVENTS
    events.write_bytes(b"".join(events.read_bytes().splitlines(keepends=True)[:lines]))
    (tmp_path / "run" / RESULT).unlink()
    file.unlink()
    model = script(CUP, PLATE, after=before[:lines].count("thought"))
    again = adamo_vh.resume_episode(tmp_path / "run", engine=engine, model=model)
    assert (again.score, again.state_hash) == (whole.score, whole.state_hash)
    assert [event.type for event in read_trajectory(tmp_path / "run").events] == before


class Reader:
    """A model that keeps all that it is told, and ends at once."""

    info = ModelInfo("reader", ModelKind.SCRIPTED)

    def __init__(self) -> None:
        self.told = ""

    def complete(
        self, messages: Sequence[Message], tools: Sequence[ToolSchema], sampling: Sampling
    ) -> Reply:
        for message in messages:
            parts = message.parts if isinstance(message, HumanMessage) else (message,)
            self.told += " ".join(p.text for p in parts if isinstance(p, TextPart))
        return Reply(AIMessage("Done."))


class Listener:
    """An observer."""

    def __init__(self) -> None:
        self.heard: list[Event] = []

    def notify(self, event: Event, frame: object = None) -> None:
        self.heard.append(event)


def test_neither_conditions_nor_states_are_told(engine: BuiltinEngine, file: Path) -> None:
    reader, listener = Reader(), Listener()
    adamo_vh.run_episode(
        task=str(file), engine=engine, model=reader, resolution=(320, 180), observers=[listener]
    )
    assert "Put the cup on the floor" in reader.told
    for secret in ("TIDY", "on_floor", "nothing else moved", "ordered"):
        assert secret not in reader.told
    played(engine, file, CUP, observers=[listener])
    assert not any(isinstance(event, Stood) for event in listener.heard)


def test_a_task_object_is_recorded_like_a_file(engine: BuiltinEngine, tmp_path: Path) -> None:
    own = parse_task(FILE, "x")
    adamo_vh.run_episode(
        task=own, engine=engine, model=script(CUP), resolution=(320, 180), out=tmp_path / "run"
    )
    assert read_manifest(tmp_path / "run").config.own_task == own


def test_a_task_is_refused_in_a_scene_that_it_does_not_fit(
    engine: BuiltinEngine, file: Path
) -> None:
    file.write_text(FILE.replace("units", 'scenes = ["s2"]\nunits'))
    with pytest.raises(ConfigError, match=r"TIDY is for scene s2, not for 's1'"):
        played(engine, file)
    file.write_text(
        FILE.replace("{ on_floor = 45 }", '{ on = { object = 45, surface = "tall shelf/top" } }')
    )
    with pytest.raises(ConfigError, match=r"a place called 'tall shelf/top'.*'s1' does not have"):
        played(engine, file)


def test_a_configuration_holds_its_task(file: Path) -> None:
    config = EpisodeConfig.of(task=str(file))
    own = parse_task(FILE, "x")
    assert (config.task, config.instruction) == ("TIDY", own.prompt)
    assert config.scored_task == config.own_task == own
    assert EpisodeConfig.of(task="t4").own_task is None
    assert EpisodeConfig.of("Look").scored_task is None
    file.write_text(task_text(own).replace("TIDY", "T4"))
    with pytest.raises(ConfigError, match=r"T4 is not the built-in task of that name"):
        EpisodeConfig.of(task=str(file))
