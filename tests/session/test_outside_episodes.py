"""A mind outside plays an ordinary episode: the same record and score as in this process."""

from __future__ import annotations

import time
from pathlib import Path
from typing import Any

import pytest
from tests.session.test_player_side import assert_blind

from adamo_vh.episode.config import EpisodeConfig
from adamo_vh.episode.result import read_manifest
from adamo_vh.errors import RecordError
from adamo_vh.inference.messages import AIMessage, ToolCall
from adamo_vh.inference.players.scripted import ScriptedModel
from adamo_vh.record.run_folder import RESULT
from adamo_vh.record.termination import Limits, TerminationReason
from adamo_vh.record.trajectory import read_trajectory
from adamo_vh.session.lending import LentWorld
from adamo_vh.session.outside import ENDED, OutsideEpisode
from adamo_vh.session.runs import replay_episode, run_episode

CALLS: list[tuple[str, dict[str, Any]]] = [
    ("Pick", {"object": "Glass_37"}),
    ("Drop", {"object": "Glass_37", "x": -1.2, "y": -1.5, "z": 0.0}),
    ("Pick", {"object": "Plate_57"}),
    ("Drop", {"object": "Plate_57", "x": -1.2, "y": -0.5, "z": 0.0}),
]
"""T8 in scene S1: the glass and the plate onto the floor."""


def _config(profile: str = "paper", **more: Any) -> EpisodeConfig:
    return EpisodeConfig.of(task="T8", resolution="160x90", grid=3, profile=profile, **more)


def test_it_is_the_episode_that_any_model_plays(lent: LentWorld, tmp_path: Path) -> None:
    said = [
        AIMessage(f"Step {n}.", (ToolCall(f"call_{n}", name, arguments),))
        for n, (name, arguments) in enumerate(CALLS, start=1)
    ]
    inside, outside = tmp_path / "inside", tmp_path / "outside"
    model = ScriptedModel("scripted", [*said, AIMessage("Done.")])
    expected = run_episode(_config(), model=model, engine=lent.lender.lend(), out=inside)
    episode = OutsideEpisode.begin(_config(), outside, client="me", engine=lent)
    views = [episode.view()]
    for number, (name, arguments) in enumerate(CALLS, start=1):
        views.append(episode.call(name, arguments, f"Step {number}."))
    assert episode.answer("Done.").text == ENDED and episode.ended
    result = episode.result()
    assert result.strict == expected.strict == 1.0
    assert result.model == "outside:me" and result.state_hash == expected.state_hash
    records = [read_trajectory(folder) for folder in (inside, outside)]
    assert [(a.call_id, a.name, a.arguments, a.state_hash) for a in records[0].acts] == [
        (a.call_id, a.name, a.arguments, a.state_hash) for a in records[1].acts
    ]
    assert [t.state_text for t in records[0].thoughts] == [view.state for view in views]
    assert [view.text for view in views][1:] == [act.feedback.text for act in records[0].acts]
    assert not replay_episode(outside, engine=lent).mismatches
    texts = [f"{view.text}\n{view.state}" for view in views]
    texts += [episode.instruction, repr(views)]
    assert_blind(texts, outside, result)
    # Afterwards nothing changes any more.
    assert episode.call("Look", {"x": 0, "y": 0, "z": 0}).ended and episode.view().ended
    assert episode.tools() == () and episode.system_prompt() == ""


def test_lean_has_its_own_tools_and_asks_back(lent: LentWorld) -> None:
    episode = OutsideEpisode.begin(_config("lean"), engine=lent)
    assert [tool.name for tool in episode.tools()][-1] == "Finish"
    assert "Finish" in episode.system_prompt()
    assert len(episode.view().pictures) == 1
    doubt = {"note": "Is it this one?", "confidence": 0.2}
    asked_back = episode.call("Pick", {"object": "Glass_37", **doubt})
    assert "inspect it first" in asked_back.text and asked_back.pictures
    back = episode.answer("I am done.")
    assert not back.ended and back.text.startswith("Before you finish: call Finish")
    end = {"asked": "a", "verified": "b", "unseen": "c", "answer": "d"}
    assert episode.call("Finish", {**end, "note": "n", "confidence": 1.0}).ended
    assert episode.result().answer == "d"


def test_mistakes_are_feedback(lent: LentWorld) -> None:
    episode = OutsideEpisode.begin(_config(), engine=lent)
    assert "no tool named 'Fly'" in episode.call("Fly", {}).text
    assert "Refused" in episode.call("Look", {"x": "nowhere"}).text
    assert "empty" in episode.answer(" ").text
    assert episode.answer(" ").ended
    assert episode.result().termination is TerminationReason.EMPTY_REPLY


def test_the_last_view_is_free(lent: LentWorld) -> None:
    episode = OutsideEpisode.begin(_config(), engine=lent)
    look = episode.call("Look", {"x": -2, "y": 1, "z": 0.5})
    walk = episode.call("Walk", {"x": -2, "y": 0, "z": 0})
    assert walk.pictures == () and episode.view().pictures == look.pictures
    assert episode.view().text == walk.text
    episode.close()
    assert episode.result().steps == 2


def test_who_is_never_heard_of_again_runs_out_of_time(lent: LentWorld, tmp_path: Path) -> None:
    config = _config(limits=Limits(max_seconds=1.0))
    episode = OutsideEpisode.begin(config, tmp_path / "run", engine=lent)
    result = episode.result()
    assert result.termination is TerminationReason.TIME_LIMIT and result.completion == 0.0
    assert episode.view().ended
    assert result.warnings == (
        "The mind outside let the time run out without a call or an answer.",
    )


def test_who_hangs_up_is_scored_as_it_stands(lent: LentWorld) -> None:
    episode = OutsideEpisode.begin(_config(), engine=lent)
    for name, arguments in CALLS[:2]:
        episode.call(name, arguments)
    episode.hang_up("It went away.")
    result = episode.result()
    assert result.termination is TerminationReason.EMPTY_REPLY and result.completion == 0.5
    assert result.warnings == ("It went away.",)


def test_another_mind_goes_on_after_a_break(lent: LentWorld, tmp_path: Path) -> None:
    folder = tmp_path / "run"
    first = OutsideEpisode.begin(_config(), folder, client="first", engine=lent)
    for name, arguments in CALLS[:2]:
        first.call(name, arguments, "So far.")
    first.close()
    assert first.result().termination is TerminationReason.BROKEN
    assert first.result().completion is None
    second = OutsideEpisode.resume(folder, engine=lent.lender.lend())
    told = second.view()
    assert "(Before: So far. - Pick {" in told.text and "on the floor" in told.text
    assert told.pictures and told.state
    for name, arguments in CALLS[2:]:
        second.call(name, arguments, client="second")
    assert second.answer("Done.", client="second").ended
    result = second.result()
    assert result.strict == 1.0 and result.steps == 4
    assert read_manifest(folder).model_name == "outside:first"
    assert result.warnings == ("outside:second went on with what outside:first had begun.",)
    assert (folder / RESULT).exists()
    with pytest.raises(RecordError, match="has ended"):
        OutsideEpisode.resume(folder, engine=lent.lender.lend()).view()


def test_a_break_does_not_give_the_time_back(lent: LentWorld, tmp_path: Path) -> None:
    config = _config(limits=Limits(max_seconds=3.0))
    first = OutsideEpisode.begin(config, tmp_path / "run", engine=lent)
    first.view()
    time.sleep(1.5)
    first.call("Look", {"x": -2, "y": 1, "z": 0.5})
    first.close()
    began = time.monotonic()
    second = OutsideEpisode.resume(tmp_path / "run", engine=lent.lender.lend())
    assert second.result().termination is TerminationReason.TIME_LIMIT
    assert time.monotonic() - began < 3.0
