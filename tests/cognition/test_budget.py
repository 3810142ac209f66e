"""A cap stops within one call, an unknown price never counts as 0, and a forecast warns first."""

from __future__ import annotations

import threading
from collections.abc import Sequence

import pytest
from hypothesis import given
from hypothesis import strategies as st

from adamo_vh.action import Code, Feedback, Outcome, ToolSchema
from adamo_vh.action_server import LocalActionServer
from adamo_vh.cognition.agent import Agent
from adamo_vh.cognition.budget import Budget, BudgetGuard, Ledger
from adamo_vh.cognition.forecast import forecast
from adamo_vh.errors import ConfigError
from adamo_vh.geometry import Vec3
from adamo_vh.inference.messages import AIMessage, Message, ToolCall
from adamo_vh.inference.model import ModelInfo, ModelKind, Reply, Rung, Sampling, Usage
from adamo_vh.observation import AgentState
from adamo_vh.record.termination import TerminationReason
from adamo_vh.record.trajectory import Acted, Started, Thought, Trajectory
from adamo_vh.record.turn import Turn
from adamo_vh.runtime.builtin import BuiltinEngine

AMOUNTS = st.integers(0, 10**6)


def thought(
    tokens: int = 0,
    usd: float | None = None,
    seconds: float = 0.0,
    *,
    rung: Rung | None = Rung.NATIVE,
    estimated: bool = False,
) -> Thought:
    usage = Usage(tokens, 0, estimated=estimated)
    reply = Reply(AIMessage(""), usage, seconds, 9.0, cost_usd=usd, rung=rung)
    return Thought(0, "", 1, Turn(reply))


def reason(guard: BudgetGuard) -> TerminationReason | None:
    stop = guard.stop()
    return stop.reason if stop else None


def why(guard: BudgetGuard) -> str:
    stop = guard.stop()
    return stop.why if stop else ""


@given(st.lists(st.tuples(AMOUNTS, AMOUNTS, st.floats(0, 10), st.integers(0, 3)), max_size=20))
def test_a_ledger_is_the_sum_of_what_was_spent(
    entries: list[tuple[int, int, float, int]],
) -> None:
    ledger = Ledger()
    for tokens_in, out, usd, calls in entries:
        ledger.spend(Usage(tokens_in, out), usd, calls=calls, seconds=usd)
    spent = ledger.spent
    assert spent.tokens == sum(a + b for a, b, _, _ in entries)
    assert spent.usd == pytest.approx(sum(usd for _, _, usd, _ in entries))
    assert spent.calls == sum(calls for _, _, _, calls in entries)
    assert spent.seconds == pytest.approx(spent.usd)
    assert spent.unpriced == 0


def test_several_threads_may_share_a_ledger() -> None:
    ledger = Ledger()

    def work() -> None:
        for _ in range(500):
            ledger.spend(Usage(1, 1), 0.001, seconds=0.5)
            ledger.pass_time(0.5)

    threads = [threading.Thread(target=work) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    spent = ledger.spent
    assert (spent.tokens, spent.calls, spent.unpriced) == (4000, 2000, 0)
    assert spent.usd == pytest.approx(2.0)
    assert spent.seconds == pytest.approx(2000.0)


@pytest.mark.parametrize(
    ("budget", "words"),
    [
        (Budget(tokens=1000), "1,200 of 1,000 tokens are used"),
        (Budget(usd=0.01), "0.0300 of 0.01 US dollars are used"),
        (Budget(calls=1), "1 of 1 model calls are used"),
        (Budget(seconds=2), "2.5 of 2 seconds are used"),
    ],
)
def test_a_cap_that_is_reached_is_said_in_words(budget: Budget, words: str) -> None:
    ledger = Ledger()
    assert ledger.exceeded(budget) is None
    ledger.spend(Usage(1000, 200), 0.03, seconds=2.5)
    assert ledger.exceeded(budget) == words
    assert ledger.exceeded(Budget()) is None


def test_a_budget_of_nothing_allows_no_call() -> None:
    for budget in (Budget(tokens=0), Budget(usd=0), Budget(calls=0), Budget(seconds=0)):
        assert budget
        assert reason(BudgetGuard(budget)) is TerminationReason.BUDGET
    assert not Budget()


@pytest.mark.parametrize("amount", [-1, float("nan"), float("inf")])
def test_a_budget_that_is_no_amount_is_refused(amount: float) -> None:
    with pytest.raises(ConfigError, match="usd must be 0 or more"):
        Budget(usd=amount)


def test_an_unknown_price_ends_an_episode_that_has_a_budget_of_money() -> None:
    guard = BudgetGuard(Budget(usd=100.0))
    assert guard.stop() is None
    guard.notify(thought(10, usd=None))
    assert reason(guard) is TerminationReason.BUDGET
    assert "price of 1 of 1 calls is not known" in why(guard)
    assert "prices.toml" in why(guard)
    unpriced = BudgetGuard(Budget(tokens=100))
    unpriced.notify(thought(10, usd=None))
    assert unpriced.stop() is None


def test_a_remote_reply_without_usage_or_price_is_not_free() -> None:
    guard = BudgetGuard(Budget(usd=100.0))
    guard.notify(thought(0, usd=None, rung=Rung.NATIVE))
    assert reason(guard) is TerminationReason.BUDGET


@pytest.mark.parametrize("estimated", [False, True])
def test_players_without_a_provider_cost_nothing(estimated: bool) -> None:
    guard = BudgetGuard(Budget(usd=0.01))
    tokens = 5000 if estimated else 0
    guard.notify(thought(tokens, usd=None, rung=None, estimated=estimated))
    assert guard.stop() is None
    assert guard.spent.usd == 0


def test_a_call_that_would_surely_not_fit_is_not_made() -> None:
    guard = BudgetGuard(Budget(tokens=1000))
    guard.notify(thought(450, usd=0.0))
    assert guard.stop() is None
    guard.notify(thought(451, usd=0.0))
    assert reason(guard) is TerminationReason.BUDGET
    assert "901 of 1,000 tokens are used, and the next call reads about 451" in why(guard)


def test_thinking_and_acting_take_time_and_waiting_does_not() -> None:
    guard = BudgetGuard(Budget(seconds=3.0))
    guard.notify(thought(1, usd=0.0, seconds=2.0))
    assert guard.stop() is None
    state = AgentState(Vec3(0, 0, 0), 0.0, Vec3(1, 0, 1), Vec3(0, 0, 1.6))
    feedback = Feedback(Outcome.DONE, Code.OK, "Done.")
    guard.notify(Acted(1, "c1", "Look", {}, feedback, state, "hash", "", 1.5))
    assert reason(guard) is TerminationReason.BUDGET
    assert guard.spent.seconds == 3.5


def test_a_run_is_stopped_for_all_its_episodes_and_an_episode_for_itself() -> None:
    ledger, run = Ledger(), Budget(tokens=1000)
    first = BudgetGuard(Budget(tokens=600), ledger, run)
    first.notify(thought(300, usd=0.0))
    first.notify(thought(301, usd=0.0))
    assert reason(first) is TerminationReason.BUDGET
    second = BudgetGuard(Budget(tokens=600), ledger, run)
    assert second.stop() is None
    second.notify(thought(400, usd=0.0))
    assert reason(second) is TerminationReason.BUDGET
    third = BudgetGuard(Budget(tokens=600), ledger, run)
    assert reason(third) is TerminationReason.RUN_BUDGET
    assert "whole run" in why(third)
    assert ledger.spent.tokens == 1001


def test_every_instruction_has_its_own_budget() -> None:
    guard = BudgetGuard(Budget(calls=1))
    guard.notify(thought(5, usd=0.0))
    assert reason(guard) is TerminationReason.BUDGET
    guard.notify(Started("And now?", "", "", ""))
    assert guard.stop() is None


class Spending:
    """A model that looks about for ever, at a price."""

    def __init__(self, usd: float | None = 0.01) -> None:
        self.info = ModelInfo("spending", ModelKind.VLM)
        self.asked, self._usd = 0, usd

    def complete(
        self, messages: Sequence[Message], tools: Sequence[ToolSchema], sampling: Sampling
    ) -> Reply:
        self.asked += 1
        where = {"x": 0.1 * self.asked, "y": -1.0, "z": 0.8}
        message = AIMessage("On.", (ToolCall(f"c{self.asked}", "Look", where),))
        return Reply(message, Usage(900, 100), cost_usd=self._usd, rung=Rung.NATIVE)


@pytest.mark.parametrize(
    ("budget", "usd", "asked"),
    [
        (Budget(calls=2), 0.01, 2),
        (Budget(tokens=3000), 0.01, 3),
        (Budget(tokens=3950), 0.01, 4),
        (Budget(tokens=3850), 0.01, 3),  # a fourth call would not fit, from its input alone
        (Budget(usd=0.025), 0.01, 3),
        (Budget(usd=5.0), None, 1),
    ],
)
def test_an_episode_stops_within_one_call_of_its_cap(
    engine: BuiltinEngine, budget: Budget, usd: float | None, asked: int
) -> None:
    model, trajectory = Spending(usd), Trajectory()
    server = LocalActionServer(engine, resolution=(480, 270))
    guard = BudgetGuard(budget)
    agent = Agent(model, server, "rules", guards=[guard], observers=[trajectory])
    ended = agent.run("Look about")
    assert ended.reason is TerminationReason.BUDGET
    assert ended.reason.is_scored
    assert model.asked == asked
    assert guard.spent.calls == asked
    assert ended.why


def test_a_forecast_adds_up_a_growing_prompt() -> None:
    # By hand: 4 calls read 1000, 1200, 1400, 1600 and write 50 each; 2 and 8 calls likewise.
    expected = forecast("openai:gpt-4o", 4, 1000, 200, 50, episodes=10, seconds_per_call=5.0)
    assert expected.tokens_typical == 10 * (5200 + 200)
    assert expected.tokens_low == 10 * (2200 + 100)
    assert expected.tokens_high == 10 * (8 * 1000 + 200 * 28 + 400)
    assert expected.calls == 40
    assert expected.seconds == 200.0
    assert expected.usd == pytest.approx(10 * (5200 * 2.5e-6 + 200 * 10e-6))
    assert expected.text() == (
        "10 episodes with openai:gpt-4o: about 40 model calls, 54 k tokens (23 k to 140 k), "
        "about $0.15 (at most about $0.38), 3 min of model time."
    )


def test_a_forecast_without_a_price_says_so() -> None:
    expected = forecast("baseline", 5, 1000, 100, 10)
    assert expected.usd is None
    assert "no price known" in expected.text()
    assert expected.warns(Budget(tokens=10**6)) is None
    warning = expected.warns(Budget(usd=3.0))
    assert warning is not None
    assert "No price is known for baseline" in warning


def test_long_requests_are_forecast_at_their_own_price() -> None:
    short = forecast("google:gemini-2.5-pro", 1, 100_000, 0, 0).usd
    long = forecast("google:gemini-2.5-pro", 1, 300_000, 0, 0).usd
    assert short == pytest.approx(0.125)
    assert long == pytest.approx(0.75)


def test_a_forecast_warns_of_a_budget_that_is_too_small() -> None:
    expected = forecast("openai:gpt-4o", 4, 1000, 200, 50, episodes=10, seconds_per_call=5.0)
    assert expected.warns(Budget()) is None
    assert expected.warns(Budget(tokens=200_000, usd=1.0, calls=80, seconds=400)) is None
    for budget, words in (
        (Budget(tokens=50_000), "tokens (50 k) will not be enough: about 54 k expected"),
        (Budget(tokens=100_000), "tokens (100 k) may not be enough"),
        (Budget(usd=0.10), "money ($0.1) will not be enough"),
        (Budget(calls=60), "calls (60) may not be enough"),
        (Budget(seconds=60), "time (60 s) will not be enough"),
    ):
        assert words in (expected.warns(budget) or "")


@given(st.floats(1, 40), AMOUNTS, st.integers(0, 5000), st.integers(0, 4000), st.integers(0, 50))
def test_a_forecast_is_a_range_around_the_expected(
    calls: float, first: int, growth: int, output: int, episodes: int
) -> None:
    expected = forecast("baseline", calls, first, growth, output, episodes)
    assert 0 <= expected.tokens_low <= expected.tokens_typical <= expected.tokens_high


def test_a_forecast_of_nonsense_is_refused() -> None:
    for numbers in ((0, 1, 1, 1), (1, -1, 1, 1), (1, 1, 1, -1)):
        with pytest.raises(ConfigError, match="forecast"):
            forecast("baseline", *numbers)
