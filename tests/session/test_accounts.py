"""What an episode takes is counted, forecast and capped, over a real socket."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from tests.fake_provider import Canned, FakeProvider, Json, call, completion, fault

import adamo_vh
from adamo_vh.cognition.budget import Budget, BudgetGuard, Ledger
from adamo_vh.cognition.profile import PROFILES
from adamo_vh.episode.config import EpisodeConfig
from adamo_vh.episode.result import read_manifest, read_result
from adamo_vh.errors import CassetteError, ConfigError
from adamo_vh.inference.cost.tokens import OPENAI_TILES, estimate_image, metered
from adamo_vh.inference.model import ModelInfo, ModelKind
from adamo_vh.inference.players.scripted import ScriptedModel
from adamo_vh.inference.registry import create_model
from adamo_vh.inference.remote.provider import ProviderModel
from adamo_vh.record.termination import TerminationReason
from adamo_vh.record.trajectory import read_trajectory
from adamo_vh.runtime.builtin import BuiltinEngine
from adamo_vh.session.forecasting import forecast_episodes
from adamo_vh.session.session import Session

SMALL = (640, 360)
PRICED = '["openai:tiny-vlm@*"]\ninput = 2.5\ncached = 1.25\noutput = 10.0\n'


def looks(count: int = 50):
    """Endless looking round, each time somewhere else."""
    for number in range(count):
        yield completion("I look.", [call("Look", {"x": number * 0.05, "y": -1, "z": 0.8})], 200)


@pytest.fixture
def prices(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    path = tmp_path / "prices.toml"
    path.write_text(PRICED)
    monkeypatch.setenv("ADAMO_VH_PRICES", str(path))
    return path


def run(engine: BuiltinEngine, budget: Budget, guards=()):
    with FakeProvider(looks()) as server:
        result = adamo_vh.run_episode(
            task="T1",
            model=ProviderModel(server.uri()),
            engine=engine,
            resolution=SMALL,
            budget=budget,
            guards=guards,
        )
        return result, len(server.requests)


@pytest.mark.parametrize(
    ("budget", "requests", "told"),
    [
        (Budget(tokens=4000), 3, "3,702 of 4,000 tokens are used"),
        (Budget(tokens=2468), 2, "2,468 of 2,468 tokens are used"),
        (Budget(calls=2), 2, "2 of 2 model calls are used"),
        (Budget(usd=0.006), 2, "of 0.006 US dollars are used"),
    ],
)
def test_a_cap_stops_in_time(
    engine: BuiltinEngine, prices: Path, budget: Budget, requests: int, told: str
) -> None:
    result, sent = run(engine, budget)
    assert result.termination is TerminationReason.BUDGET
    assert sent == result.model_calls == requests
    assert told in result.why
    assert result.completion == 0.0


def test_the_price_of_an_episode_is_that_of_its_tokens(engine: BuiltinEngine, prices: Path) -> None:
    result, _ = run(engine, Budget(calls=2))
    assert result.usage.cached_tokens == 400
    each = (1000 * 2.5 + 200 * 1.25 + 34 * 10) / 1e6
    assert result.cost_usd == pytest.approx(2 * each)


def test_an_unknown_price_is_not_nothing(engine: BuiltinEngine) -> None:
    result, sent = run(engine, Budget(usd=100.0))
    assert result.cost_usd is None
    assert (result.termination, sent) == (TerminationReason.BUDGET, 1)
    assert "price of 1 of 1 calls is not known" in result.why


def test_the_budget_of_a_run_is_shared_by_its_episodes(engine: BuiltinEngine) -> None:
    ledger = Ledger()
    first, sent = run(engine, Budget(calls=2), [BudgetGuard(Budget(), ledger, Budget(calls=3))])
    assert (first.termination, sent) == (TerminationReason.BUDGET, 2)
    second, sent = run(engine, Budget(), [BudgetGuard(Budget(), ledger, Budget(calls=3))])
    assert (second.termination, sent) == (TerminationReason.RUN_BUDGET, 1)
    assert second.completion is None  # to be run again, not counted as a failure


def test_a_forecast_comes_before_the_first_request(engine: BuiltinEngine, prices: Path) -> None:
    config = EpisodeConfig.of(task="T4", resolution=SMALL)
    with FakeProvider([completion("I cannot.")]) as server:
        model = ProviderModel(server.uri())
        ahead = Session.begin(config, engine=engine, model=model).forecast()
        assert len(server.requests) == 0
    assert ahead is not None
    assert ahead.calls == 3
    assert ahead.usd is not None
    # The baseline costs nothing.
    assert Session.begin(config, engine=engine).forecast() is None


def test_a_forecast_is_near_to_what_is_used(engine: BuiltinEngine) -> None:
    """The oracle's number of calls is that of the forecast; the tokens must agree as well."""
    uri = "openai:gpt-4o"
    config = EpisodeConfig("x", task="T8", model=uri, resolution=SMALL)
    ahead = forecast_episodes(config, engine)
    result = adamo_vh.run_episode(
        task="T8", model=metered(create_model("baseline")), engine=engine, resolution=SMALL
    )
    each = result.usage.input_tokens / result.model_calls
    assert ahead.tokens_typical / ahead.calls == pytest.approx(each, rel=0.35)
    assert ahead.usd is not None


def test_lean_takes_fewer_tokens_for_the_same_task(engine: BuiltinEngine) -> None:
    spent = {}
    for name in ("paper", "lean"):
        model = metered(create_model("baseline"))
        result = adamo_vh.run_episode(task="T8", model=model, engine=engine, profile=name)
        assert result.completion == 1.0
        spent[name] = result.usage.input_tokens
    assert spent["lean"] < spent["paper"]
    assert estimate_image(1920, 1080, OPENAI_TILES) == 1105


@pytest.mark.parametrize("profile", sorted(PROFILES))
def test_a_cassette_plays_the_episode_again(
    engine: BuiltinEngine, tmp_path: Path, profile: str
) -> None:
    first = adamo_vh.run_episode(
        task="T4",
        engine=engine,
        resolution=SMALL,
        profile=profile,
        out=tmp_path / "run",
        record=True,
    )
    again = adamo_vh.run_episode(
        task="T4",
        model=f"cassette:{tmp_path / 'run'}",
        engine=engine,
        resolution=SMALL,
        profile=profile,
    )
    assert again.state_hash == first.state_hash
    assert again.completion == first.completion == 1.0
    other = adamo_vh.run_episode(
        task="T2",
        model=f"cassette:{tmp_path / 'run'}",
        engine=engine,
        resolution=SMALL,
        profile=profile,
    )
    assert other.termination is TerminationReason.BROKEN
    assert CassetteError.__name__ in other.answer
    assert "+Pick the plate" in other.answer


def test_a_resumed_recording_has_every_call_once(tmp_path: Path) -> None:
    folder = tmp_path / "run"
    whole = adamo_vh.run_episode(task="T4", resolution=SMALL, out=folder, record=True)
    events = (folder / "events.jsonl").read_bytes().splitlines(keepends=True)
    (folder / "events.jsonl").write_bytes(b"".join(events[:4]))
    (folder / "result.json").unlink()
    resumed = adamo_vh.resume_episode(folder)
    assert resumed.state_hash == whole.state_hash
    again = adamo_vh.run_episode(task="T4", model=f"cassette:{folder}", resolution=SMALL)
    assert again.state_hash == whole.state_hash


def test_a_recording_needs_a_folder() -> None:
    with pytest.raises(ConfigError, match="needs a run folder"):
        adamo_vh.run_episode(task="T1", record=True)


def test_the_profile_is_on_record(engine: BuiltinEngine, tmp_path: Path) -> None:
    adamo_vh.run_episode(
        task="T1",
        engine=engine,
        resolution=SMALL,
        profile="lean",
        switches={"plan": 1},
        out=tmp_path,
    )
    assert read_manifest(tmp_path).config.profile.plan == 1
    result = read_result(tmp_path)
    assert result is not None
    assert result.profile == "lean (plan=1)"


def test_what_a_lost_answer_took_is_counted_although_the_episode_broke(
    engine: BuiltinEngine, tmp_path: Path
) -> None:
    """The first answer is no step and cost tokens; the server refuses the repair turn."""
    unreadable = completion('{"thought": broken')
    too_long = fault(400, "request (60000 tokens) exceeds the available context size")
    with FakeProvider([unreadable, too_long]) as server:
        result = adamo_vh.run_episode(
            task="T1",
            model=server.uri(),
            tool_calls="schema",
            engine=engine,
            resolution=SMALL,
            out=tmp_path / "run",
        )
    assert result.termination is TerminationReason.BROKEN and result.completion is None
    assert (result.requests, result.tokens, result.model_calls) == (2, 1234, 0)
    read = read_result(tmp_path / "run")
    assert read is not None and (read.requests, read.tokens) == (2, 1234)


def broken_twice(engine: BuiltinEngine, folder: Path) -> None:
    """An episode that broke, and broke again where it went on; each time an answer was paid."""
    unreadable = completion('{"thought": broken')
    too_long = fault(400, "request (60000 tokens) exceeds the available context size")
    look = completion(
        json.dumps({"thought": "On.", "action": {"name": "Look", "args": {"x": 1, "y": 1, "z": 1}}})
    )
    with FakeProvider([look, unreadable, too_long, unreadable, too_long]) as server:
        adamo_vh.run_episode(
            "Look",
            model=server.uri(),
            tool_calls="schema",
            engine=engine,
            resolution=SMALL,
            out=folder,
        )
        adamo_vh.resume_episode(folder)


def test_what_a_broken_episode_paid_stays_on_record_when_it_goes_on(
    engine: BuiltinEngine, tmp_path: Path
) -> None:
    broken_twice(engine, tmp_path)
    twice = read_result(tmp_path)
    assert twice is not None and (twice.requests, twice.tokens) == (5, 3 * 1234)
    after = adamo_vh.resume_episode(tmp_path, model=ScriptedModel("scripted", ()))
    assert after.termination is TerminationReason.ANSWERED
    assert (after.requests, after.tokens) == (6, 3 * 1234)
    recorded = read_trajectory(tmp_path)
    assert [spent.requests for spent in recorded.lost] == [2, 2]
    assert adamo_vh.replay_episode(tmp_path).mismatches == ()


def test_what_a_broken_episode_paid_counts_against_its_budget(
    engine: BuiltinEngine, tmp_path: Path
) -> None:
    broken_twice(engine, tmp_path)
    capped = adamo_vh.resume_episode(
        tmp_path, budget=Budget(tokens=3 * 1234), model=ScriptedModel("scripted", ())
    )
    assert capped.termination is TerminationReason.BUDGET
    assert "3,702 of 3,702 tokens are used" in capped.why


def test_a_conversation_remembers_what_a_broken_instruction_paid(
    engine: BuiltinEngine, tmp_path: Path
) -> None:
    broken_twice(engine, tmp_path)
    with Session.resume(tmp_path, model=ScriptedModel("scripted", ())) as session:
        session.say("Look again")
        before = session.trajectory
    ledger = Ledger()
    guard = BudgetGuard(Budget(), ledger, Budget())
    again = Session.resume(tmp_path, model=ScriptedModel("scripted", ()), guards=(guard,))
    again.close()
    assert again.trajectory.events == before.events
    assert ledger.spent.tokens == 3 * 1234


def test_a_server_that_counts_nothing_is_stopped_by_an_estimate(
    engine: BuiltinEngine, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    prices = tmp_path / "prices.toml"
    prices.write_text(PRICED)
    monkeypatch.setenv("ADAMO_VH_PRICES", str(prices))

    def uncounted(request: Json) -> Canned:
        turn = sum(message["role"] == "assistant" for message in request["messages"])
        answer = completion("On.", [call("Look", {"x": 0.1 * turn, "y": 1, "z": 1}, f"c{turn}")])
        assert isinstance(answer.body, dict)
        return Canned({name: value for name, value in answer.body.items() if name != "usage"})

    for budget in (Budget(tokens=5000), Budget(usd=0.02)):
        with FakeProvider(uncounted) as server:
            result = adamo_vh.run_episode(
                task="T4",
                model=server.uri(),
                tool_calls="native",
                engine=engine,
                resolution=SMALL,
                budget=budget,
            )
        assert result.termination is TerminationReason.BUDGET
        assert result.usage.estimated and result.tokens > 1000
        assert result.cost_usd is not None and result.cost_usd > 0.001


def test_an_own_model_that_gives_nothing_breaks_the_episode_by_its_name(
    engine: BuiltinEngine,
) -> None:
    class Nothing:
        info = ModelInfo("nothing", ModelKind.VLM)

        def complete(self, messages: object, tools: object, sampling: object) -> None:
            return None

    result = adamo_vh.run_episode(
        task="T4",
        model=Nothing(),  # type: ignore[arg-type]
        engine=engine,
        resolution=SMALL,
    )
    assert result.termination is TerminationReason.BROKEN and result.completion is None
    assert "The model Nothing gave None" in result.answer
