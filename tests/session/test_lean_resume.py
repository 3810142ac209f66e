"""A kill at any moment of an episode under `lean`: what was recorded is gone on with."""

from __future__ import annotations

import json
import shutil
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import pytest
from tests.cognition.test_lean_agent import Player, finish, noted, says
from tests.spread import spread

import adamo_vh
from adamo_vh.action import ToolSchema
from adamo_vh.cognition.profile import PROFILES
from adamo_vh.episode.config import EpisodeConfig
from adamo_vh.episode.result import read_result
from adamo_vh.errors import ProviderError, RecordError
from adamo_vh.inference.baseline import BaselineModel
from adamo_vh.inference.messages import AIMessage, Message, ToolCall
from adamo_vh.inference.model import Reply, Sampling
from adamo_vh.record.run_folder import EVENTS, RESULT
from adamo_vh.record.termination import TerminationReason
from adamo_vh.record.trajectory import LeftOut, Trajectory, read_trajectory
from adamo_vh.session.lending import LentWorld
from adamo_vh.session.session import Session

SMALL = (320, 180)
PLACE: dict[str, Any] = {"x": -1.5, "y": -2.5, "z": 0.0}
UNSURE = noted("Pick", 0.2, object="57")
SAID = [
    Reply(AIMessage("")),
    says(noted("Inspect", object="Plate_57"), noted("Survey")),
    says(UNSURE, noted("Drop", object="Plate_57", **PLACE)),
    Reply(AIMessage("Action: Pick["), unreadable="it holds half a call."),
    says(UNSURE, noted("Look", **PLACE), noted("Drop", object="Plate_57", **PLACE), noted("Jump")),
    says(text="All done."),
    says(("Finish", {"answer": "It is done."})),
    finish(0.1),
    finish(),
]
KINDS = [
    "started", "observed", "thought",
    "thought", "acted", "shown", "acted", "shown",
    "thought", "acted", "shown", "left_out",
    "thought",
    "thought", "acted", "acted", "observed", "acted", "acted", "observed",
    "thought", "thought", "thought", "thought", "ended",
]  # fmt: skip


class Live(Player):
    """Goes on where the record stops: knows how much was answered before."""

    def __init__(self, answered: int) -> None:
        super().__init__(SAID[answered:])


@pytest.fixture(scope="module")
def whole(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("lean") / "run"
    result = adamo_vh.run_episode(
        task="T4", model=Live(0), profile="lean", resolution=SMALL, out=folder
    )
    assert (result.completion, result.termination) == (1.0, TerminationReason.ANSWERED)
    return folder


def kinds(folder: Path) -> list[str]:
    return [json.loads(line)["type"] for line in (folder / EVENTS).read_bytes().splitlines()]


def test_every_kind_of_event_is_in_the_record(whole: Path) -> None:
    assert kinds(whole) == KINDS
    assert adamo_vh.replay_episode(whole).mismatches == ()


@pytest.mark.parametrize("kept", spread(range(len(KINDS) + 1), 4))
def test_a_kill_between_any_two_events_loses_nothing(
    whole: Path, tmp_path: Path, kept: int, lent: LentWorld
) -> None:
    folder = tmp_path / "run"
    shutil.copytree(whole, folder)
    before = read_result(folder)
    assert before is not None
    lines = (folder / EVENTS).read_bytes().splitlines(keepends=True)
    half = lines[kept][:30] if kept < len(lines) else b""
    (folder / EVENTS).write_bytes(b"".join(lines[:kept]) + half)
    (folder / RESULT).unlink()
    answered = len(read_trajectory(folder).thoughts)
    after = adamo_vh.resume_episode(folder, model=Live(answered), engine=lent)
    assert after.state_hash == before.state_hash
    assert (after.completion, after.calls) == (before.completion, before.calls)
    assert kinds(folder) == KINDS
    assert (folder / EVENTS).read_bytes().startswith(b"".join(lines[: min(kept, len(lines) - 1)]))


def test_what_ended_with_a_result_has_ended(whole: Path) -> None:
    with pytest.raises(RecordError, match="has ended"):
        adamo_vh.resume_episode(whole, model=Live(len(SAID)))


def test_what_comes_out_otherwise_is_not_written_over(whole: Path, tmp_path: Path) -> None:
    folder = tmp_path / "run"
    shutil.copytree(whole, folder)
    (folder / RESULT).unlink()
    text = (folder / EVENTS).read_text()
    assert '"x":-1.5,"y":-2.5' in text
    text = text.replace('"x":-1.5,"y":-2.5', '"x":-1.7,"y":-2.5')
    (folder / EVENTS).write_text("".join(text.splitlines(keepends=True)[:-1]))
    with pytest.raises(RecordError, match="came out otherwise"):
        adamo_vh.resume_episode(folder, model=Live(len(SAID)))
    assert kinds(folder) == KINDS[:-1]


def test_a_recorded_run_is_said_again_with_what_could_not_be_read(whole: Path) -> None:
    before = read_result(whole)
    again = adamo_vh.run_episode(
        task="T4", model=f"replay:{whole}", profile="lean", resolution=SMALL
    )
    assert before is not None
    assert (again.state_hash, again.unreadable) == (before.state_hash, before.unreadable)
    assert before.unreadable == 2  # The empty reply, and the one that holds half a call.


class Failing(Player):
    """A provider that fails at one call."""

    def __init__(self, answers: Sequence[Reply], at: int) -> None:
        super().__init__(answers)
        self._left = at

    def complete(
        self, messages: Sequence[Message], tools: Sequence[ToolSchema], sampling: Sampling
    ) -> Reply:
        self._left -= 1
        if self._left == -1:
            raise ProviderError("503")
        return super().complete(messages, tools, sampling)


def test_a_conversation_with_a_fault_in_it_is_gone_on_with(tmp_path: Path) -> None:
    """The first instruction broke; on the way back its fault does not eat the next answer."""
    config = EpisodeConfig("Pick the plate", resolution=SMALL, profile=PROFILES["lean"])
    pick = says(noted("Pick", object="Plate_57"))
    with Session.begin(config, tmp_path, model=Failing([pick, finish()], 0)) as session:
        first = session.say("Pick the plate")
        second = session.say("Pick the plate")
    assert first.reason is TerminationReason.BROKEN
    assert second.reason is TerminationReason.ANSWERED
    before = (tmp_path / EVENTS).read_bytes()
    heard = Trajectory()
    with Session.resume(tmp_path, model=BaselineModel(), observers=[heard]) as session:
        assert heard.events == []
        assert session.say("Put the plate on the floor").reason is TerminationReason.ANSWERED
    assert (tmp_path / EVENTS).read_bytes().startswith(before)
    assert adamo_vh.replay_episode(tmp_path).mismatches == ()
    with pytest.raises(RecordError, match="is a conversation"):
        adamo_vh.resume_episode(tmp_path)


def test_an_answer_stays_in_the_memory_of_the_conversation(tmp_path: Path) -> None:
    config = EpisodeConfig("Take it", resolution=SMALL, profile=PROFILES["lean"])
    player = Player([finish(), Reply(AIMessage("Which one?")), Reply(AIMessage("Which one?"))])
    with Session.begin(config, tmp_path, model=player) as session:
        session.say("Take it")
        session.say("Take that")
        session.say("The plate")
    said = [m for m in player.prompts[-1] if isinstance(m, AIMessage)]
    assert [call.name for call in said[0].calls] == ["Finish"]
    assert said[-1].text == "Which one?"


def test_what_was_left_out_is_on_record(tmp_path: Path) -> None:
    calls = tuple(ToolCall("same", "Pick", {"object": "57"}) for _ in range(50))
    player = Player([Reply(AIMessage("All.", calls)), Reply(AIMessage("Done."))])
    adamo_vh.run_episode(
        "Take it", model=player, resolution=SMALL, out=tmp_path, switches={"plan": 3}
    )
    left_out = [e.why for e in read_trajectory(tmp_path).events if isinstance(e, LeftOut)]
    assert len(left_out) == 48
    assert set(left_out) == {
        "an earlier call of this turn did not go as planned",
        "at most 3 actions a turn",
    }
