"""A mind here and a body on a server: one agent, one record, one score."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import ExitStack
from pathlib import Path
from typing import Any

import pytest

import adamo_vh
from adamo_vh.action_server.wire import Create
from adamo_vh.episode.config import EpisodeConfig
from adamo_vh.episode.result import read_result
from adamo_vh.errors import ConfigError, RecordError
from adamo_vh.inference.messages import AIMessage, ToolCall
from adamo_vh.inference.model import ModelKind, Reply, Usage
from adamo_vh.inference.players.scripted import ScriptedModel
from adamo_vh.record.termination import Limits, TerminationReason
from adamo_vh.record.trajectory import Thought, Trajectory, read_trajectory
from adamo_vh.service.app import serving
from adamo_vh.service.hosting import Host, Terms
from adamo_vh.service.judging import fetch_result
from adamo_vh.serving.admission import Rules
from adamo_vh.session.away import AwaySession
from adamo_vh.session.lending import LentWorld
from adamo_vh.session.pooling import Engines

JUDGE = "the-judge-of-these"
LOOK = ToolCall("c", "Look", {"x": 0.5, "y": -1.0, "z": 0.8})
BAD = ToolCall("d", "Look", {"x": "far"})


@pytest.fixture
def server(lent: LentWorld, tmp_path: Path) -> Iterator[tuple[str, Host]]:
    engines = Engines(ready={("s1", "mara", 0): lent.lender})
    host = Host(tmp_path / "served", Terms(limits=Limits(max_steps=12)), engines)
    with ExitStack() as stack:
        stack.callback(host.close_all)
        yield stack.enter_context(serving(host, rules=Rules(1_000_000, judge_token=JUDGE))), host


def config(**more: Any) -> EpisodeConfig:
    limits = Limits(max_steps=12)
    return EpisodeConfig.of(**{"task": "T1", "resolution": "320x180", "limits": limits, **more})


@pytest.mark.parametrize("profile", ["paper", "lean"])
def test_a_model_plays_elsewhere_as_it_does_here(
    server: tuple[str, Host], lent: LentWorld, tmp_path: Path, profile: str
) -> None:
    url, host = server
    here = config(profile=profile, labeling="opaq")
    alone = adamo_vh.run_episode(here, engine=lent.lender.lend(), out=tmp_path / "here")
    seen = Trajectory()
    with AwaySession(here, url, observers=[seen]) as away:
        ended = away.play()
        session = away.body.session
    folder = host.find(session).folder
    result = fetch_result(url, session, JUDGE)
    assert ended.reason is result.termination is alone.termination
    assert (result.score, result.steps, result.answer) == (alone.score, alone.steps, alone.answer)
    assert (result.model, result.model_kind) == ("baseline", ModelKind.OUTSIDE)
    assert (result.profile, result.missing_notes) == (alone.profile, alone.missing_notes)
    one, other = read_trajectory(tmp_path / "here"), read_trajectory(folder)
    assert [a.state_hash for a in one.acts] == [a.state_hash for a in other.acts]
    assert [a.call_id for a in one.acts] == [a.call_id for a in other.acts]
    assert [t.turn.note for t in one.thoughts] == [t.turn.note for t in other.thoughts]
    assert len(seen.thoughts) == len(other.thoughts)


class Priced:
    """A model that says what it took."""

    def __init__(self, *said: AIMessage) -> None:
        self._said = list(said)
        self.info = ScriptedModel("priced", ()).info

    def complete(self, *_: Any) -> Reply:
        return Reply(self._said.pop(0), Usage(1000, 10, 500), 0.25, cost_usd=0.01)


def test_what_a_model_took_is_told_to_the_server(server: tuple[str, Host]) -> None:
    url, host = server
    said = (AIMessage("I look.", (LOOK,), kept="secret"), AIMessage("Hm.", (BAD,)))
    mind = Priced(*said, AIMessage("It is not there."))
    with AwaySession(config(), url, model=mind) as away:
        away.play()
        folder = host.find(away.body.session).folder
    result = read_result(folder)
    assert result is not None and result.model == "priced"
    assert (result.usage.input_tokens, result.usage.cached_tokens) == (3000, 1500)
    assert result.cost_usd == pytest.approx(0.03) and result.model_calls == 3
    thoughts = [e for e in read_trajectory(folder).events if isinstance(e, Thought)]
    assert [thought.turn.note for thought in thoughts] == ["I look.", "Hm.", "It is not there."]
    assert "secret" not in (folder / "events.jsonl").read_text("utf-8")
    refused = read_trajectory(folder).acts[1]
    assert (refused.name, refused.arguments, refused.call_id) == ("Look", {"x": "far"}, "d")


def test_a_mind_that_breaks_leaves_the_episode_to_be_gone_on_with(
    server: tuple[str, Host],
) -> None:
    url, host = server
    with AwaySession(config(), url, model=Priced(AIMessage("", (LOOK,)))) as away:
        ended = away.play()
        session = away.body.session
    assert ended.reason is TerminationReason.BROKEN and "IndexError" in ended.answer
    assert not host.find(session).body.ended
    with pytest.raises(ConfigError, match="not ended"):
        fetch_result(url, session, JUDGE)
    with adamo_vh.connect(url, session=session) as body:
        body.finish("Somebody else ends it.")
    assert fetch_result(url, session, JUDGE).answer == "Somebody else ends it."


def test_a_limit_of_the_server_ends_it_for_both(server: tuple[str, Host]) -> None:
    url, host = server
    looks = [
        AIMessage("", (ToolCall("c", "Look", {"x": n / 10, "y": 0, "z": 1}),)) for n in range(20)
    ]
    with AwaySession(config(), url, model=ScriptedModel("looks", looks)) as away:
        ended = away.play()
        session = away.body.session
    assert ended.reason is TerminationReason.STEP_LIMIT
    assert host.find(session).result().termination is TerminationReason.STEP_LIMIT
    assert fetch_result(url, session, JUDGE).steps == 12


def test_only_a_judge_gets_the_result(server: tuple[str, Host]) -> None:
    url, host = server
    session = host.create(Create("T1")).id
    with pytest.raises(ConfigError, match="token is missing or wrong"):
        fetch_result(url, session, "somebody-else")
    with pytest.raises(ConfigError, match="no such session"):
        fetch_result(url, "none", JUDGE)
    from adamo_vh.episode.result import result_from

    with pytest.raises(RecordError, match="another version"):
        result_from(b"{}", url)
