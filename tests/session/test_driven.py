"""A body driven from outside: its episode is that of a model which makes the same calls."""

from __future__ import annotations

import dataclasses
import json
import time
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import pytest

import adamo_vh
from adamo_vh.action import Code, Outcome, action_name
from adamo_vh.action_server import ActionServer, LocalActionServer
from adamo_vh.action_server.protocol import execute_call
from adamo_vh.benchmark.oracle import Oracle
from adamo_vh.benchmark.tasks import task as find_task
from adamo_vh.cognition.agent import Agent, AgentConfig
from adamo_vh.episode.config import EpisodeConfig
from adamo_vh.episode.result import read_result
from adamo_vh.errors import ConfigError, EngineError, EpisodeOverError
from adamo_vh.inference.messages import AIMessage, ToolCall
from adamo_vh.inference.model import ModelKind, Reply, Usage
from adamo_vh.inference.players.scripted import ScriptedModel
from adamo_vh.inference.registry import create_model
from adamo_vh.perception import Labeling, PerceptionConfig
from adamo_vh.record.termination import Limits, TerminationReason
from adamo_vh.record.trajectory import Acted, Thought, read_trajectory
from adamo_vh.report.page import PAGE
from adamo_vh.session.driven import DrivenBody
from adamo_vh.session.lending import LentWorld
from adamo_vh.session.verifying import verify_run

TINY = (320, 180)
LOOK = {"x": 0.5, "y": -1.0, "z": 0.8}


def settings(task: str | None = None, **more: Any) -> EpisodeConfig:
    instruction = None if task else "Look around."
    return EpisodeConfig.of(instruction, task=task, **{"resolution": TINY, **more})


def driven(lent: LentWorld, task: str | None = None, out: Path | None = None, **more: Any) -> Any:
    return DrivenBody.begin(settings(task, **more), out, lender=lent.lender)


def acts_of(folder: Path) -> Sequence[Acted]:
    return read_trajectory(folder).acts


def all_in(value: Any) -> Any:
    """Every value within an answer."""
    if dataclasses.is_dataclass(value):
        for item in dataclasses.fields(value):
            yield from all_in(getattr(value, item.name))
    elif isinstance(value, Mapping):
        for inner in value.values():
            yield from all_in(inner)
    elif isinstance(value, list | tuple):
        for inner in value:
            yield from all_in(inner)
    else:
        yield value


def oracle_calls(lent: LentWorld, task: str, labeling: str) -> list[ToolCall]:
    """What the oracle does for a task, as calls of a model."""
    server = LocalActionServer(
        lent, resolution=TINY, perception=PerceptionConfig(labeling=Labeling(labeling))
    )
    server.observe()
    oracle = Oracle(find_task(task).conditions, server.tag, server.body.info)
    calls: list[ToolCall] = []
    while (action := oracle.next_action(lent.state(), server.seen)) is not None:
        calls.append(
            ToolCall(f"c{len(calls)}", action_name(type(action)), dataclasses.asdict(action))
        )
        server.execute(action)
    lent.reset(0)
    return calls


@pytest.mark.parametrize(
    ("task", "profile", "labeling"), [("T1", "paper", "sem"), ("T8", "lean", "opaq")]
)
def test_the_same_calls_make_the_same_episode(
    lent: LentWorld, tmp_path: Path, task: str, profile: str, labeling: str
) -> None:
    calls = oracle_calls(lent, task, labeling)
    more = {"profile": profile, "labeling": labeling}
    model = ScriptedModel(
        "oracle", [*(AIMessage("", (c,)) for c in calls), *2 * [AIMessage("Done.")]]
    )
    one = adamo_vh.run_episode(settings(task, **more), model=model, engine=lent, out=tmp_path / "1")
    with driven(lent, task, tmp_path / "2", **more) as body:
        for call in calls:
            body.call(call.name, call.arguments)
        body.finish("Done.")
        other = body.result()
    hashes = [[act.state_hash for act in acts_of(tmp_path / name)] for name in ("1", "2")]
    assert hashes[0] == hashes[1] and len(hashes[0]) == len(calls) > 1
    assert (one.score, one.steps, one.answer) == (other.score, other.steps, other.answer)
    assert other.model_kind is ModelKind.OUTSIDE and other.completion == 1.0
    assert read_result(tmp_path / "2") == other
    assert verify_run(tmp_path / "2", engine=lent).problems == ()
    assert "a program from outside" in (tmp_path / "2" / PAGE).read_text("utf-8")


def test_an_agent_drives_it_as_any_action_server(lent: LentWorld, tmp_path: Path) -> None:
    limits = Limits(max_steps=5)
    config = settings("T1", labeling="opaq", limits=limits)
    alone = adamo_vh.run_episode(config, model="baseline", engine=lent, out=tmp_path / "1")
    with driven(lent, "T1", tmp_path / "2", labeling="opaq") as body:
        server: ActionServer = body
        mind = Agent(
            create_model("baseline"), server, body.system_prompt, AgentConfig(limits=limits)
        )
        ended = mind.run(body.instruction)
        body.finish(ended.answer, ended.reason)
        assert ended.reason is body.result().termination is alone.termination
        assert (body.result().score, body.steps) == (alone.score, alone.steps)
    hashes = [[act.state_hash for act in acts_of(tmp_path / name)] for name in ("1", "2")]
    assert hashes[0] == hashes[1]


def test_every_tool_of_the_profile_is_there(lent: LentWorld) -> None:
    with driven(lent) as body:
        assert [tool.name for tool in body.tools] == ["Look", "Walk", "Pick", "Drop"]
    with driven(lent, profile="lean") as body:
        names = [tool.name for tool in body.tools]
        assert names == ["Look", "Walk", "Pick", "Drop", "Inspect", "Survey", "Finish"]
        seen = body.call("Look", {**LOOK, "note": "The table.", "confidence": 1})
        tag = seen.observation.objects[0].tag
        assert len(body.call("Inspect", {"object": tag}).pictures) == 1
        assert len(body.call("Survey", {}).pictures) == 1
        said = body.call("Finish", {"answer": "Done."})
        assert body.ended and said.feedback.outcome is Outcome.DONE


@pytest.mark.parametrize(
    ("name", "arguments", "code"),
    [
        ("Fly", {}, Code.UNKNOWN_TOOL),
        ("", None, Code.UNKNOWN_TOOL),
        ("Look", None, Code.BAD_ARGUMENT),
        ("Look", {"x": "far"}, Code.BAD_ARGUMENT),
        ("Look", {"x": {"a": [[1]]}, "y": float("nan"), "z": "\ud800"}, Code.BAD_ARGUMENT),
        ("Pick", {"object": "Key_34"}, Code.NOT_SEEN),
        ("Pick", {"object": "unicorn_1"}, Code.UNKNOWN_TAG),
        ("Drop", {"object": "Plate_57", **LOOK}, Code.HAND_EMPTY),
        ("Walk", {"x": 99, "y": 0, "z": 0}, Code.OUTSIDE_ROOM),
    ],
)
def test_a_wrong_call_is_refused_and_changes_nothing(
    lent: LentWorld, tmp_path: Path, name: str, arguments: Any, code: str
) -> None:
    out = tmp_path / "run"
    with driven(lent, out=out) as body:
        before = body.observe().state_hash
        done = body.call(name, arguments)
        assert (done.feedback.outcome, done.feedback.code) == (Outcome.REFUSED, code)
        assert (done.state_hash, body.steps) == (before, 1)
        body.finish("Nothing was done.")
    assert verify_run(out, engine=lent).problems == ()


def test_a_view_can_be_had_again_and_is_no_event(lent: LentWorld, tmp_path: Path) -> None:
    with driven(lent, out=tmp_path / "run") as body:
        first = body.observe()
        assert body.observe() is first
        looked = body.call("Look", LOOK)
        assert body.observe().observation is looked.observation
        assert looked.observation.objects[0].tag in body.state_text()
    kinds = [event.type for event in read_trajectory(tmp_path / "run").events]
    assert kinds == ["started", "observed", "thought", "acted", "observed"]


@pytest.mark.parametrize(
    ("limits", "reason"),
    [
        (Limits(max_steps=2), TerminationReason.STEP_LIMIT),
        (Limits(max_seconds=0.0), TerminationReason.TIME_LIMIT),
        (Limits(max_repeats=2), TerminationReason.LOOP),
    ],
)
def test_a_limit_ends_it_and_it_stays_ended(
    lent: LentWorld, tmp_path: Path, limits: Limits, reason: TerminationReason
) -> None:
    with driven(lent, "T1", tmp_path / "run", limits=limits) as body:
        for _ in range(2):
            if reason is not TerminationReason.TIME_LIMIT:
                body.call("Look", LOOK)
        with pytest.raises(EpisodeOverError, match="has ended"):
            body.call("Look", LOOK)
        assert body.ended
        record = (tmp_path / "run" / "events.jsonl").read_bytes()
        for ask in (
            body.observe,
            lambda: body.say("x"),
            lambda: body.think("x"),
            lambda: body.load("saved-1"),
            lambda: body.finish("x"),
        ):
            with pytest.raises(EpisodeOverError):
                ask()
        assert (tmp_path / "run" / "events.jsonl").read_bytes() == record
        assert body.result().termination is reason and body.result().completion == 0.0


def test_thoughts_are_recorded_before_the_calls_that_they_lead_to(
    lent: LentWorld, tmp_path: Path
) -> None:
    with driven(lent, out=tmp_path / "run") as body:
        body.think("I look at the table.")
        body.call("Look", LOOK)
        calls = (ToolCall("a", "Walk", {"x": "0.5", "y": 0, "z": 0}), ToolCall("b", "Look", LOOK))
        body.think(Reply(AIMessage("Both.", calls), Usage(100, 20), 1.5, cost_usd=0.25))
        body.call("Walk", {"x": 0.5, "y": 0, "z": 0})
        body.call("Look", LOOK)
        body.finish("I looked.")
        result = body.result()
    thoughts = [e for e in read_trajectory(tmp_path / "run").events if isinstance(e, Thought)]
    assert [thought.turn.note for thought in thoughts] == ["I look at the table.", "Both."]
    assert [act.call_id for act in acts_of(tmp_path / "run")] == ["call-1", "a", "b"]
    assert (result.usage.total_tokens, result.model_calls, result.steps) == (120, 2, 3)


def test_a_claimed_wait_is_at_most_the_time_that_passed(lent: LentWorld) -> None:
    with driven(lent, "T1", limits=Limits(max_seconds=4.0)) as body:
        body.think(Reply(AIMessage("", ()), waited_s=1e9))
        until = time.monotonic() + 30
        while not body.expire() and time.monotonic() < until:
            time.sleep(0.2)
        assert body.expire()


def test_free_play_goes_back_to_any_saved_state(lent: LentWorld, tmp_path: Path) -> None:
    out = tmp_path / "run"
    with driven(lent, out=out) as body:
        start = body.observe()
        looked = body.call("Look", LOOK)
        body.call("Walk", {"x": 0, "y": 0, "z": 0})
        assert body.load(looked.saved) == looked.state_hash
        assert body.load(start.saved) == start.state_hash
        assert body.call("Look", LOOK).state_hash == looked.state_hash
        with pytest.raises(ConfigError, match="no saved state 'saved-99'"):
            body.load("saved-99")
        body.finish("Back and forth.")
    assert verify_run(out, engine=lent).problems == ()


def test_a_scored_episode_never_goes_back(lent: LentWorld) -> None:
    with driven(lent, "T1") as body:
        start = body.observe()
        looked = body.call("Look", LOOK)
        assert body.load(looked.saved) == looked.state_hash
        with pytest.raises(ConfigError, match="where it stands"):
            body.load(start.saved)
        assert not body.ended and body.steps == 1


def test_a_player_cannot_make_his_episode_uncounted(lent: LentWorld, tmp_path: Path) -> None:
    with driven(lent, "T1", tmp_path / "run") as body:
        for reason in (TerminationReason.BROKEN, TerminationReason.RUN_BUDGET):
            with pytest.raises(ConfigError, match="leave it"):
                body.finish("", reason)
        body.finish("", TerminationReason.LOOP, "I went in circles.")
    result = read_result(tmp_path / "run")
    assert result is not None and result.termination is TerminationReason.LOOP
    assert result.completion == 0.0


def test_what_is_left_stays_unfinished_and_can_be_shown(lent: LentWorld, tmp_path: Path) -> None:
    with driven(lent, "T1", tmp_path / "run") as body:
        body.call("Look", LOOK)
    assert read_result(tmp_path / "run") is None
    assert "unfinished" in (tmp_path / "run" / PAGE).read_text("utf-8").lower()


def test_a_player_learns_nothing_but_what_a_model_would(lent: LentWorld) -> None:
    """No snapshot, no state, and no score is in what an answer holds."""
    with driven(lent, "T1", profile="lean") as body:
        answers = [body.observe(), body.call("Look", LOOK), body.call("Pick", {"object": "x_1"})]
        answers.append(body.call("Survey", {}))
        answers.append(execute_call(body, "Finish", None))
    texts = [value for answer in answers for value in all_in(answer) if isinstance(value, str)]
    assert max(len(text) for text in texts) < 500
    assert not any("engine" in text or "completion" in text for text in texts)
    assert all(answer.saved.startswith("saved-") for answer in answers)


def test_a_judge_sees_state_and_score_at_any_time(lent: LentWorld) -> None:
    calls = oracle_calls(lent, "T1", "sem")
    with driven(lent, "T1") as body:
        assert body.completion() == 0.0
        assert body.state().hash() == body.observe().state_hash
        for call in calls:
            body.call(call.name, call.arguments)
        assert body.completion() == 1.0
    with driven(lent) as body:
        assert body.completion() is None


def test_sessions_share_an_engine(lent: LentWorld) -> None:
    with driven(lent, "T1") as one, driven(lent) as other:
        before = other.observe().state_hash
        one.call("Walk", {"x": 0, "y": 0, "z": 0})
        assert other.call("Look", LOOK).state_hash != before
        assert one.call("Walk", {"x": 0, "y": 0, "z": 0}).feedback.walked_m == 0.0


def test_a_dead_engine_breaks_the_episode(lent: LentWorld, tmp_path: Path) -> None:
    world = lent.lender.lend()
    body = DrivenBody.begin(settings("T1"), tmp_path / "run", engine=world)
    world.close()
    with pytest.raises(EngineError, match="given back"):
        body.call("Look", LOOK)
    assert body.ended
    body.close()
    result = read_result(tmp_path / "run")
    assert result is not None and result.termination is TerminationReason.BROKEN
    assert result.score is None


def test_model_and_memory_are_the_players_own(lent: LentWorld) -> None:
    with pytest.raises(ConfigError, match="his own model"):
        DrivenBody.begin(settings(), engine=lent, model=create_model("baseline"))


def test_the_manifest_says_who_played(lent: LentWorld, tmp_path: Path) -> None:
    with DrivenBody.begin(settings(), tmp_path / "r", player="my bot", lender=lent.lender):
        pass
    manifest = json.loads((tmp_path / "r" / "manifest.json").read_bytes())
    assert (manifest["model_name"], manifest["model_kind"]) == ("my bot", "outside")
    assert manifest["engine"] == ""
