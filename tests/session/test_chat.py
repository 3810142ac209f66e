"""Conversations: one world, one memory, and a record that can be gone on with."""

from __future__ import annotations

from pathlib import Path

import pytest
from tests.cli.process import adamo

from adamo_vh.cognition.budget import Budget, BudgetGuard, Ledger
from adamo_vh.cognition.profile import PROFILES
from adamo_vh.episode.config import EpisodeConfig
from adamo_vh.errors import RecordError
from adamo_vh.record.run_folder import EVENTS
from adamo_vh.record.termination import TerminationReason
from adamo_vh.record.trajectory import Trajectory, read_trajectory
from adamo_vh.session.runs import replay_episode, run_episode
from adamo_vh.session.session import Session

SMALL = (640, 360)


def config(instruction: str = "Pick the plate", profile: str = "paper") -> EpisodeConfig:
    return EpisodeConfig(instruction, resolution=SMALL, profile=PROFILES[profile])


@pytest.mark.parametrize("profile", ["paper", "lean"])
def test_the_second_instruction_knows_the_first(tmp_path: Path, profile: str) -> None:
    with Session.begin(config(profile=profile), tmp_path) as session:
        first = session.say("Pick the plate")
        second = session.say("Put the plate on the floor")
    assert [first.reason, second.reason] == [TerminationReason.ANSWERED] * 2
    recorded = read_trajectory(tmp_path)
    assert recorded.instructions == ["Pick the plate", "Put the plate on the floor"]
    dropped = [act for act in recorded.acts if act.name == "Drop"]
    assert "on the floor" in dropped[-1].feedback.text
    page = (tmp_path / "episode.html").read_text(encoding="utf-8")
    assert "Put the plate on the floor" in page
    assert replay_episode(tmp_path).mismatches == ()


def test_a_conversation_is_gone_on_with_where_it_was_left(tmp_path: Path) -> None:
    with Session.begin(config(), tmp_path) as session:
        left = session.say("Pick the plate")
    heard = Trajectory()
    before = (tmp_path / EVENTS).read_bytes()
    with Session.resume(tmp_path, observers=[heard]) as session:
        assert (tmp_path / EVENTS).read_bytes() == before
        assert heard.events == []
        ended = session.say("Put the plate on the floor")
    assert ended.state_hash != left.state_hash
    assert heard.instructions == ["Put the plate on the floor"]
    assert read_trajectory(tmp_path).instructions[0] == "Pick the plate"


def test_an_interrupted_instruction_is_finished_on_the_way_back(tmp_path: Path) -> None:
    with Session.begin(config("Pick the plate and place it on the floor"), tmp_path) as session:
        whole = session.say("Pick the plate and place it on the floor")
    lines = (tmp_path / EVENTS).read_bytes().splitlines(keepends=True)
    (tmp_path / EVENTS).write_bytes(b"".join(lines[:5]))
    with Session.resume(tmp_path):
        pass
    ended = read_trajectory(tmp_path).ended
    assert ended is not None
    assert ended.state_hash == whole.state_hash


def test_any_episode_can_become_a_conversation(tmp_path: Path) -> None:
    run_episode(task="T2", resolution=SMALL, out=tmp_path)
    with Session.resume(tmp_path) as session:
        ended = session.say("Put the plate on the floor")
    assert ended.reason is TerminationReason.ANSWERED


def test_a_budget_holds_for_the_whole_conversation(tmp_path: Path) -> None:
    guard = BudgetGuard(Budget(), Ledger(), Budget(calls=3))
    with Session.begin(config(), tmp_path, guards=[guard]) as session:
        session.say("Pick the plate")
        ended = session.say("Put the plate on the floor")
    assert ended.reason is TerminationReason.RUN_BUDGET
    assert "3 of 3 model calls are used" in ended.why
    assert len(read_trajectory(tmp_path).thoughts) == 3


def test_no_conversation_is_begun_on_top_of_another(tmp_path: Path) -> None:
    Session.begin(config(), tmp_path).close()
    with Session.begin(config(), tmp_path / "other") as session:
        session.say("Pick the plate")
    with pytest.raises(RecordError, match="already holds"):
        Session.begin(config(), tmp_path / "other")
    with pytest.raises(RecordError):
        Session.resume(tmp_path / "nothing")


def test_the_command_talks_through_a_pipe(tmp_path: Path) -> None:
    run = adamo("chat", "--out", "talk", cwd=tmp_path, said=b"Pick the key\n\n")
    assert run.code == 0, run.err
    assert "Key_34" in run.out
    assert "adamo-vh chat --resume" in run.out
