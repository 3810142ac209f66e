"""A person beside the agent: stops it, forbids a turn, undoes, moves things; all on record."""

from __future__ import annotations

from pathlib import Path

import pytest

from adamo_vh.action import Code
from adamo_vh.adapters.exports.prompts import prompts
from adamo_vh.adapters.exports.recorded import recorded
from adamo_vh.analysis.outcome import outcome_of
from adamo_vh.engine import ObjectMoved
from adamo_vh.episode.config import EpisodeConfig
from adamo_vh.episode.result import EpisodeResult, read_manifest
from adamo_vh.errors import ConfigError, ModelConfigError
from adamo_vh.geometry import Vec3
from adamo_vh.observation import Frame
from adamo_vh.record.run_folder import EVENTS, RESULT
from adamo_vh.record.termination import TerminationReason
from adamo_vh.record.trajectory import (
    Acted,
    Event,
    LeftOut,
    Restored,
    Thought,
    Vetoed,
    read_trajectory,
)
from adamo_vh.record.turn import Turn
from adamo_vh.runtime.builtin import BuiltinEngine
from adamo_vh.session.runs import replay_episode
from adamo_vh.session.session import Session
from adamo_vh.session.verifying import verify_run

PLATE = 57
ON_THE_FLOOR = "Pick the plate and place it on the floor"


def config(instruction: str = ON_THE_FLOOR) -> EpisodeConfig:
    return EpisodeConfig(instruction, resolution=(320, 180))


class StopsAt:
    """Presses Stop at the first event of a kind."""

    def __init__(self, kind: type) -> None:
        self.kind = kind
        self.session: Session | None = None

    def notify(self, event: Event, frame: Frame | None = None) -> None:
        if isinstance(event, self.kind) and self.session is not None:
            self.session.stop()
            self.session = None


def exported(folder: Path) -> int:
    """How many prompts can be told from a record."""
    (episode,) = recorded([folder])
    return len(prompts(episode))


def check_record(folder: Path, engine: BuiltinEngine, result: EpisodeResult) -> None:
    """The record is whole: it can be verified, replayed and gone on with, and stands apart."""
    assert result.assisted and not result.is_ranked
    assert verify_run(folder, engine=engine).problems == ()
    assert replay_episode(folder, engine=engine).mismatches == ()
    row = outcome_of("key", read_manifest(folder), read_trajectory(folder), result)
    assert not row.is_ranked and row.model == "baseline (assisted)"
    assert exported(folder) == len(read_trajectory(folder).thoughts)
    before = (folder / EVENTS).read_bytes()
    with Session.resume(folder, engine=engine) as session:
        assert (folder / EVENTS).read_bytes() == before
        assert session.engine.state().hash() == result.state_hash
        session.say("What do you hold?")
    assert replay_episode(folder, engine=engine).mismatches == ()


def test_what_was_thought_when_it_was_stopped_is_not_done(
    tmp_path: Path, engine: BuiltinEngine
) -> None:
    stops = StopsAt(Thought)
    with Session.begin(config(), tmp_path, engine=engine, observers=[stops]) as session:
        stops.session = session
        before = engine.state().hash()
        ended = session.say(ON_THE_FLOOR)
        assert (ended.reason, ended.steps) == (TerminationReason.STOPPED, 0)
        assert engine.state().hash() == before
        result = session.result()
    (left_out,) = [e for e in read_trajectory(tmp_path).events if isinstance(e, LeftOut)]
    assert left_out.why == "the user stopped you"
    assert "Stopped" in (tmp_path / "episode.html").read_text(encoding="utf-8")
    check_record(tmp_path, engine, result)


def test_after_a_stop_the_next_instruction_is_carried_out(
    tmp_path: Path, engine: BuiltinEngine
) -> None:
    stops = StopsAt(Acted)
    with Session.begin(config(), tmp_path, engine=engine, observers=[stops]) as session:
        stops.session = session
        assert session.say(ON_THE_FLOOR).reason is TerminationReason.STOPPED
        assert session.say("Pick the glass").reason is TerminationReason.ANSWERED
        result = session.result()
    check_record(tmp_path, engine, result)


@pytest.mark.parametrize("seconds", [0.0, 0.7, 2.5])
def test_an_action_that_was_cut_ends_where_it_was_cut(
    tmp_path: Path, engine: BuiltinEngine, seconds: float
) -> None:
    with Session.begin(config(), tmp_path, engine=engine) as session:

        def watch(shown_s: float) -> bool:
            if shown_s >= seconds:
                session.stop()
            return shown_s < seconds

        engine.stage.watcher = watch
        try:
            ended = session.say(ON_THE_FLOOR)
        finally:
            engine.stage.watcher = None
        result = session.result()
    assert ended.reason is TerminationReason.STOPPED
    acts = read_trajectory(tmp_path).acts
    assert acts[-1].feedback.code == Code.CANCELLED
    check_record(tmp_path, engine, result)


def test_a_turn_that_was_forbidden_changes_nothing_and_is_told(
    tmp_path: Path, engine: BuiltinEngine
) -> None:
    asked: list[Turn] = []

    def consent(turn: Turn) -> str:
        asked.append(turn)
        return "That plate is hot." if any(w.call.name == "Pick" for w in turn.wishes) else ""

    with Session.begin(config(), tmp_path, engine=engine, consent=consent) as session:
        ended = session.say(ON_THE_FLOOR)
        result = session.result()
    events = read_trajectory(tmp_path).events
    assert {e.why for e in events if isinstance(e, Vetoed)} == {"That plate is hot."}
    assert all(not turn.ends for turn in asked)
    assert "Pick" not in result.calls
    assert not any(item.held for item in result.final.objects)
    assert not any(word in ended.answer.lower() for word in ("done", "put the plate", "i placed"))
    page = (tmp_path / "episode.html").read_text(encoding="utf-8")
    assert "the user did not allow it: That plate is hot" in page
    check_record(tmp_path, engine, result)


def test_undo_goes_back_instruction_by_instruction(tmp_path: Path, engine: BuiltinEngine) -> None:
    with Session.begin(config(), tmp_path, engine=engine) as session:
        with pytest.raises(ConfigError, match="nothing to undo"):
            session.undo()
        start = engine.state().hash()
        picked = session.say("Pick the plate").state_hash
        session.say("Put the plate on the floor")
        session.undo()
        assert engine.state().hash() == picked
        session.apply(ObjectMoved(2, Vec3(-1.5, -2.0, 0.0)), by_user=True)
        session.undo()
        assert engine.state().hash() == start
        assert not session.can_undo
        again = session.say("What do you hold?")
        assert "nothing" in again.answer.lower()
        result = session.result()
    events = read_trajectory(tmp_path).events
    assert sum(isinstance(e, Restored) for e in events) == 2
    check_record(tmp_path, engine, result)


def test_the_model_is_told_that_its_work_was_undone(engine: BuiltinEngine) -> None:
    from adamo_vh.inference.messages import AIMessage
    from adamo_vh.inference.players.outside import OutsideModel

    person = OutsideModel("human", 60.0)
    person.hang_up("gone")
    with Session.begin(config(), engine=engine, model=person) as session:
        session.say("Look around")
        session.undo()
        session.say("And now?")
        asked = person._last
    assert asked is not None
    told = [str(message) for message in asked.prompt if not isinstance(message, AIMessage)]
    assert any("put everything back" in text for text in told)


def test_what_a_person_moved_is_told_from_what_merely_happened(
    tmp_path: Path, engine: BuiltinEngine
) -> None:
    for by_user in (False, True):
        folder = tmp_path / str(by_user)
        with Session.begin(config(), folder, engine=engine) as session:
            session.say("Pick the glass")
            session.apply(ObjectMoved(PLATE, Vec3(-1.5, -2.0, 0.0)), by_user=by_user)
            session.say("Where is the plate?")
            result = session.result()
        assert result.assisted is by_user
        page = (folder / "episode.html").read_text(encoding="utf-8")
        assert f"Object 57 was moved {'by the user' if by_user else 'from outside'}." in page


def test_a_result_cannot_hide_that_a_person_took_part(
    tmp_path: Path, engine: BuiltinEngine
) -> None:
    with Session.begin(config(), tmp_path, engine=engine) as session:
        session.say("Pick the glass")
        session.undo()
        session.result()
    text = (tmp_path / RESULT).read_text(encoding="utf-8")
    (tmp_path / RESULT).write_text(
        text.replace('"assisted": true', '"assisted": false'), encoding="utf-8"
    )
    problems = verify_run(tmp_path, engine=engine).problems
    assert any("assisted is not what the record gives" in problem for problem in problems)


def test_a_person_plays_in_the_studio_alone(tmp_path: Path) -> None:
    with pytest.raises(ModelConfigError, match="adamo-vh studio"):
        Session.begin(EpisodeConfig("Look", model="human"), tmp_path)
