"""What can be handed to a session, what it refuses before the first call, and what breaks it."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from importlib import resources
from pathlib import Path
from typing import Annotated, Any

import pytest
from pydantic import Field
from tests.cli.process import adamo
from tests.fake_provider import FakeProvider, completion

import adamo_vh
from adamo_vh.action import Code, Feedback, Outcome, ToolSchema
from adamo_vh.action_server import PAPER_TOOLS, Tool, ToolContext
from adamo_vh.benchmark.conditions import Holds
from adamo_vh.benchmark.tasks import TASKS
from adamo_vh.cognition.budget import Budget
from adamo_vh.cognition.memory.protocol import Memory
from adamo_vh.cognition.memory.short_term import ShortTermMemory
from adamo_vh.cognition.profile import Profile
from adamo_vh.engine import ObjectMoved, SceneInfo
from adamo_vh.episode.config import EpisodeConfig
from adamo_vh.episode.result import read_manifest
from adamo_vh.errors import ConfigError, EngineError, ModelConfigError, RecordError
from adamo_vh.geometry import Vec3
from adamo_vh.inference.messages import AIMessage, Message, SystemMessage, ToolCall
from adamo_vh.inference.model import ModelInfo, ModelKind, Reply, Sampling
from adamo_vh.inference.players.scripted import ScriptedModel
from adamo_vh.observation import Frame
from adamo_vh.perception import TextForm
from adamo_vh.record.run_folder import EVENTS, SCENE, SCRIPT
from adamo_vh.record.termination import Stop, TerminationReason
from adamo_vh.record.trajectory import Event, Happened, LeftOut, read_trajectory
from adamo_vh.runtime.builtin import BuiltinEngine
from adamo_vh.session.session import Session

SMALL = (320, 180)


def says(name: str, note: str = "", **arguments: Any) -> AIMessage:
    return AIMessage(note, (ToolCall(f"id_{name}", name, arguments),))


LOOK = says("Look", "I look.", x=0.5, y=-1.0, z=0.8)


def model(*replies: AIMessage) -> ScriptedModel:
    return ScriptedModel("scripted", replies)


def run(here: Any, *replies: AIMessage, **more: Any) -> adamo_vh.EpisodeResult:
    more = {"model": model(*replies), "resolution": SMALL, "engine": here, **more}
    return adamo_vh.run_episode(more.pop("instruction", "Look"), **more)


class Elsewhere:
    """An engine that somebody else made: the built-in one under another name."""

    def __init__(self, inner: BuiltinEngine) -> None:
        self._inner = inner

    @property
    def scene(self) -> SceneInfo:
        return replace(self._inner.scene, name="yard", source="a yard of ours")

    def __getattr__(self, name: str) -> Any:
        return getattr(self._inner, name)


def test_an_engine_is_recorded_as_what_it_says(tmp_path: Path, engine: BuiltinEngine) -> None:
    here = run(Elsewhere(engine), LOOK, out=tmp_path / "own")
    assert here.scene == "yard"
    manifest = read_manifest(tmp_path / "own")
    assert (manifest.config.scene, manifest.engine) == ("yard", "Elsewhere")
    with pytest.raises(RecordError, match=r"Elsewhere.*hand it in again"):
        adamo_vh.replay_episode(tmp_path / "own")
    again = adamo_vh.replay_episode(tmp_path / "own", engine=Elsewhere(engine))
    assert again.mismatches == ()
    with pytest.raises(ConfigError, match=r"engine is of scene 'yard'.*'s2'"):
        run(Elsewhere(engine), LOOK, scene="s2")


def test_the_built_in_engine_needs_no_handing_in(tmp_path: Path, engine: BuiltinEngine) -> None:
    run(engine, LOOK, out=tmp_path)
    assert read_manifest(tmp_path).engine == ""


class Unasked:
    """A model that must not be asked."""

    info = ModelInfo("unasked", ModelKind.SCRIPTED)

    def complete(
        self, messages: Sequence[Message], tools: Sequence[ToolSchema], sampling: Sampling
    ) -> Reply:
        raise AssertionError("it was asked")


def test_a_task_without_its_objects_is_refused_before_the_first_call(
    engine: BuiltinEngine, tmp_path: Path
) -> None:
    own = replace(TASKS[1], id="OWN", conditions=(Holds(999),))
    with pytest.raises(ConfigError, match=r"OWN needs object 999.*'s1'"):
        run(engine, instruction=None, task=own, model=Unasked(), out=tmp_path / "run")
    assert not (tmp_path / "run").exists()


def test_an_own_task_is_scored(engine: BuiltinEngine) -> None:
    own = replace(TASKS[1], id="OWN", prompt="Take it")
    result = run(engine, says("Pick", object="Plate_57"), instruction=None, task=own)
    assert (result.task, result.instruction, result.completion) == ("OWN", "Take it", 1.0)


def test_what_is_no_model_is_said_to_be_none(engine: BuiltinEngine) -> None:
    with pytest.raises(ModelConfigError, match=r"object is no model: it lacks complete"):
        run(engine, model=object())


def test_money_without_a_price_is_refused_before_the_first_call(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("ADAMO_VH_NO_REMOTE", "")
    given = ("--model", "openai:nobody@http://127.0.0.1:9/v1", "--budget", "usd=1")
    done = adamo("run", "look", "--tool-calls", "native", *given, cwd=tmp_path)
    assert done.code == 2, done.err
    assert "No price is known" in done.err
    assert not list((tmp_path / "runs").glob("*"))
    film = tmp_path / "film.webm"
    film.write_bytes(b"of an earlier run")
    for words in (["run", "look", "--video", str(film)], ["chat"]):
        done = adamo(*words, *given, "--out", "out", cwd=tmp_path, said=b"look\n")
        assert done.code == 2 and "No price is known" in done.err
        assert not (tmp_path / "out").exists()
    assert film.read_bytes() == b"of an earlier run"


def test_a_price_is_asked_for_before_a_probe_is_paid(tmp_path: Path) -> None:
    with FakeProvider([completion("red, blue")]) as server:
        for out in (None, tmp_path):
            begin = partial(Session.begin, cap=Budget(usd=1.0), out=out)
            with pytest.raises(ConfigError, match="No price is known"):
                begin(EpisodeConfig("Look", model=server.uri()))
        assert not server.requests and not list(tmp_path.iterdir())


def test_resume_takes_no_setting_that_it_would_not_heed(tmp_path: Path) -> None:
    done = adamo("run", "--resume", ".", "--task", "T9", "--seed", "0", cwd=tmp_path)
    assert done.code == 2
    assert "takes no --task, --seed" in done.err


@dataclass(frozen=True, slots=True)
class Wave:
    """Wave with the free hand."""

    times: Annotated[int, Field(description="How often.")]


def wave(context: ToolContext, action: Wave) -> Feedback:
    if action.times > 9:
        raise ZeroDivisionError("an arm too few")
    return Feedback(Outcome.DONE, Code.OK, f"Done: waved {action.times} times.")


OWN_TOOLS = (*PAPER_TOOLS, Tool(Wave, wave))


def test_a_replay_names_the_tool_that_is_missing(tmp_path: Path, engine: BuiltinEngine) -> None:
    run(engine, says("Wave", times=2), says("Nonsense"), tools=OWN_TOOLS, out=tmp_path)
    with pytest.raises(RecordError, match=r"recorded with the tool Wave, .*hand it in"):
        adamo_vh.replay_episode(tmp_path)
    report = adamo_vh.replay_episode(tmp_path, tools=OWN_TOOLS, engine=engine)
    assert (report.steps, report.mismatches) == (2, ())


def test_a_conversation_goes_on_past_a_tool_that_failed(
    tmp_path: Path, engine: BuiltinEngine
) -> None:
    """What broke an earlier instruction is not tried again on the way back."""
    replies = (says("Wave", times=10), says("Wave", times=2))
    config = EpisodeConfig.of("Wave", resolution=SMALL)
    parts: Any = {"engine": engine, "tools": OWN_TOOLS}
    with Session.begin(config, tmp_path, model=model(*replies), **parts) as session:
        assert session.say("Wave").reason is TerminationReason.BROKEN
        assert session.say("Wave less").reason is TerminationReason.ANSWERED
    before = (tmp_path / EVENTS).read_bytes()
    with Session.resume(tmp_path, model=model(), **parts) as session:
        assert (tmp_path / EVENTS).read_bytes() == before
        assert session.say("Thanks").reason is TerminationReason.ANSWERED


class Crashing:
    """A model that breaks in a way nobody foresaw."""

    info = ModelInfo("crashing", ModelKind.SCRIPTED)

    def complete(
        self, messages: Sequence[Message], tools: Sequence[ToolSchema], sampling: Sampling
    ) -> Reply:
        raise RuntimeError("out of ideas")


class Dead(Elsewhere):
    """An engine that dies when its body is to walk, and answers nothing any more."""

    def __getattr__(self, name: str) -> Any:
        if name in ("state", "snapshot") and self._dead:
            raise EngineError("it is gone")
        return super().__getattr__(name)

    _dead = False


def test_whatever_raises_breaks_the_episode_and_nothing_else(
    tmp_path: Path, engine: BuiltinEngine
) -> None:
    crashed = run(engine, model=Crashing(), out=tmp_path / "model")
    assert crashed.termination is TerminationReason.BROKEN
    assert "failed in complete(): RuntimeError: out of ideas" in crashed.answer
    assert read_trajectory(tmp_path / "model").ended is not None
    tool = run(engine, says("Wave", times=10), tools=OWN_TOOLS, out=tmp_path / "tool")
    assert "failed in Wave: ZeroDivisionError: an arm too few" in tool.answer
    dead = Dead(engine)

    class Killing(ScriptedModel):
        def complete(self, *given: Any) -> Reply:
            dead._dead = True
            return super().complete(*given)

    gone = run(dead, model=Killing("k", (LOOK,)), out=tmp_path / "dead")
    assert (gone.termination, gone.completion) == (TerminationReason.BROKEN, None)
    assert "it is gone" in gone.answer


def test_an_interrupt_is_not_caught(engine: BuiltinEngine) -> None:
    class Interrupted(Crashing):
        def complete(self, *given: Any) -> Reply:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        run(engine, model=Interrupted())


class Faulty:
    """An observer that fails at every event."""

    def notify(self, event: Event, frame: Frame | None = None) -> None:
        raise UnicodeEncodeError("latin-1", "é", 0, 1, "cannot be shown")


def test_the_fault_of_an_observer_is_reported_once(engine: BuiltinEngine) -> None:
    with pytest.warns(UserWarning, match="Faulty failed, and the episode goes on") as told:
        result = run(engine, LOOK, observers=[Faulty()])
    assert result.termination is TerminationReason.ANSWERED
    assert len([w for w in told if "Faulty" in str(w.message)]) == 1


class AtOnce:
    """A guard with one thing to say."""

    def notify(self, event: Event, frame: Frame | None = None) -> None:
        """Nothing is counted."""

    def stop(self) -> Stop | None:
        return Stop(TerminationReason.LOOP, "Enough.")


def test_a_guard_says_why(engine: BuiltinEngine) -> None:
    result = run(engine, LOOK, guards=[AtOnce()])
    assert (result.termination, result.why) == (TerminationReason.LOOP, "Enough.")


class Forgetful(ShortTermMemory):
    """Tells the model something of its own first."""

    def messages(self) -> list[Message]:
        return [SystemMessage("Remember nothing."), *super().messages()]


def test_a_memory_can_be_handed_in(engine: BuiltinEngine) -> None:
    heard: list[Sequence[Message]] = []

    class Listening(ScriptedModel):
        def complete(self, messages: Sequence[Message], *rest: Any) -> Reply:
            heard.append(messages)
            return super().complete(messages, *rest)

    def made(text: str, k: int, profile: Profile, form: TextForm) -> Memory:
        return Forgetful(text, k, profile, form)

    run(engine, model=Listening("l", ()), memory=made)
    assert heard[0][0] == SystemMessage("Remember nothing.")


class Letters:
    """A labeling of one's own: A57."""

    described = "A tag is a letter and a number."

    def tag(self, object_id: int, class_name: str) -> str:
        return f"{class_name[0]}{object_id}"

    def short(self, object_id: int, class_name: str) -> str:
        return self.tag(object_id, class_name)

    def resolve(self, text: str, known: Mapping[int, str]) -> int | None:
        return next((i for i, name in known.items() if self.tag(i, name) == text), None)


def test_a_labeling_can_be_handed_in(tmp_path: Path, engine: BuiltinEngine) -> None:
    result = run(engine, says("Pick", object="P57"), labeling=Letters(), out=tmp_path)
    assert result.final.body.held == 57
    with pytest.raises(RecordError, match=r"\(Letters\); hand it in again"):
        adamo_vh.replay_episode(tmp_path)
    assert result.own_labeling == "Letters"
    assert "<span>labeling</span> Letters" in (tmp_path / "episode.html").read_text()
    again = adamo_vh.replay_episode(tmp_path, labeling=Letters(), engine=engine)
    assert again.mismatches == ()


def test_what_happens_in_the_world_is_on_record_and_happens_again(
    tmp_path: Path, engine: BuiltinEngine
) -> None:
    config = EpisodeConfig.of("Look", resolution=SMALL)
    with Session.begin(config, tmp_path, engine=engine, model=model(LOOK)) as session:
        session.say("Look")
        session.apply(ObjectMoved(57, Vec3(-1.5, -2.0, 0.0)))
        left = session.say("And now?")
    events = read_trajectory(tmp_path).events
    (happened,) = [event for event in events if isinstance(event, Happened)]
    assert happened.event == ObjectMoved(57, Vec3(-1.5, -2.0, 0.0))
    assert adamo_vh.replay_episode(tmp_path, engine=engine).mismatches == ()
    before = (tmp_path / EVENTS).read_bytes()
    with Session.resume(tmp_path, engine=engine, model=model()) as session:
        assert (tmp_path / EVENTS).read_bytes() == before
        assert session.say("Well?").state_hash == left.state_hash


def test_calls_are_told_apart_by_their_ids(tmp_path: Path, engine: BuiltinEngine) -> None:
    both = AIMessage("", tuple(replace(LOOK.calls[0], id=f"c{i}") for i in range(2)))
    run(engine, both, out=tmp_path)
    recorded = read_trajectory(tmp_path)
    assert [act.call_id for act in recorded.acts] == ["c0"]
    assert [e.call_id for e in recorded.events if isinstance(e, LeftOut)] == ["c1"]
    assert [wish.call.id for wish in recorded.thoughts[0].turn.wishes] == ["c0", "c1"]


def test_own_files_go_with_the_run(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, engine: BuiltinEngine
) -> None:
    room = resources.files("adamo_vh.runtime.scenes").joinpath("s1_tabletop.toml")
    (tmp_path / "here").mkdir()
    (tmp_path / "here" / "room.toml").write_bytes(room.read_bytes())
    script = [{"tool": "Look", "args": LOOK.calls[0].arguments}]
    (tmp_path / "here" / "look.json").write_text(json.dumps(script))
    monkeypatch.chdir(tmp_path / "here")
    adamo_vh.run_episode(
        "Look", model="scripted:look.json", scene="room.toml", resolution=SMALL, out="run"
    )
    assert (Path("run") / SCENE).is_file()
    assert (Path("run") / SCRIPT).is_file()
    Path("room.toml").unlink()
    Path("look.json").unlink()
    monkeypatch.chdir(tmp_path)
    assert adamo_vh.replay_episode("here/run").mismatches == ()
    events = (Path("here/run") / EVENTS).read_bytes().splitlines(keepends=True)
    (Path("here/run") / EVENTS).write_bytes(b"".join(events[:2]))
    (Path("here/run") / "result.json").unlink()
    assert adamo_vh.resume_episode("here/run").steps == 1


def test_a_new_budget_holds_from_now_on(tmp_path: Path, engine: BuiltinEngine) -> None:
    run(engine, LOOK, LOOK, out=tmp_path)
    lines = (tmp_path / EVENTS).read_bytes().splitlines(keepends=True)
    (tmp_path / EVENTS).write_bytes(b"".join(lines[:5]))
    (tmp_path / "result.json").unlink()
    after = adamo_vh.resume_episode(
        tmp_path, model=model(LOOK), engine=engine, budget=adamo_vh.Budget(calls=1)
    )
    assert after.termination is TerminationReason.BUDGET
    assert read_manifest(tmp_path).config.budget == adamo_vh.Budget(calls=1)


def test_a_name_from_another_package_is_looked_up(
    engine: BuiltinEngine, monkeypatch: pytest.MonkeyPatch
) -> None:
    from adamo_vh.session import bodies

    class Point:
        def __init__(self, loads: Callable[..., Any] | Tool) -> None:
            self.load = lambda: loads

    found = {
        bodies.ENGINES: {"yard": Point(lambda rest, figure: (rest, figure))},
        bodies.TOOLS: {"wave": Point(Tool(Wave, wave))},
    }
    monkeypatch.setattr(bodies, "offered_by_others", found.__getitem__)
    made: Any = adamo_vh.create_engine("yard:big", "ken")
    assert made == ("big", "ken")
    result = run(engine, says("Wave", times=1), added_tools=("wave",))
    assert result.calls == {"Wave": 1}
    with pytest.raises(ConfigError, match=r"no tool 'jump' .*\(wave\)"):
        run(engine, added_tools=("jump",))
