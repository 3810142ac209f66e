"""The budget of a study: reserved before, settled after, passed by nobody."""

from __future__ import annotations

import multiprocessing
import os
import threading
import time
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest
from tests.study.episodes import record, small_study

from adamo_vh.action import ToolSchema
from adamo_vh.cognition.budget import Budget
from adamo_vh.errors import BudgetError, ConfigError, FileError, ProviderError
from adamo_vh.inference.messages import AIMessage, HumanMessage, Message, TextPart
from adamo_vh.inference.model import (
    Model,
    ModelInfo,
    ModelKind,
    Reply,
    Sampling,
    Spent,
    Usage,
)
from adamo_vh.study.ledger import LEDGER, Amount, StudyLedger, budgeted, check_caps
from adamo_vh.study.plan import plan

PROMPT: list[Message] = [HumanMessage((TextPart("What do you see? " * 50),))]


class Costly:
    """A model of a known price, which takes its time."""

    info = ModelInfo("openai:gpt-4o", ModelKind.VLM)

    def __init__(self, tokens: int = 100, pause_s: float = 0.0) -> None:
        self._usage, self._pause_s = Usage(tokens, 10), pause_s
        self.asked = 0
        self._lock = threading.Lock()

    def complete(
        self, messages: Sequence[Message], tools: Sequence[ToolSchema], sampling: Sampling
    ) -> Reply:
        with self._lock:
            self.asked += 1
        time.sleep(self._pause_s)
        return Reply(AIMessage("Nothing."), self._usage, cost_usd=0.01)


class Failing(Costly):
    """A model whose provider fails after it was paid."""

    def complete(
        self, messages: Sequence[Message], tools: Sequence[ToolSchema], sampling: Sampling
    ) -> Reply:
        error = ProviderError("down")
        error.spent = Spent(Usage(70, 0), 1, 0.002)
        raise error


def _ask(model: Model, most: int = 100) -> Reply:
    return model.complete(PROMPT, (), Sampling(max_tokens=most))


def test_a_call_is_counted_by_what_it_took(tmp_path: Path) -> None:
    ledger = StudyLedger(tmp_path, Budget(tokens=100_000))
    _ask(budgeted(Costly(), "openai:gpt-4o", "a", ledger))
    assert ledger.spent == Amount(1, 110, 0.01)


def test_a_call_that_may_not_fit_is_not_made(tmp_path: Path) -> None:
    ledger = StudyLedger(tmp_path, Budget(tokens=1000))
    costly = Costly()
    with pytest.raises(BudgetError, match=r"0 of 1,000 tokens are used.*may take"):
        _ask(budgeted(costly, "openai:gpt-4o", "a", ledger), most=4000)
    assert (costly.asked, ledger.spent) == (0, Amount())


@pytest.mark.parametrize(
    "budget", [Budget(tokens=2500), Budget(usd=0.05), Budget(calls=5)], ids=str
)
def test_many_at_once_never_pass_the_cap(tmp_path: Path, budget: Budget) -> None:
    costly = Costly(tokens=200, pause_s=0.02)  # No more than is estimated for the prompt.

    def play(number: int) -> bool:
        model = budgeted(costly, "openai:gpt-4o", str(number), StudyLedger(tmp_path, budget))
        try:
            _ask(model)
        except BudgetError:
            return False
        return True

    with ThreadPoolExecutor(8) as pool:
        made = sum(pool.map(play, range(24)))
    spent = StudyLedger(tmp_path).spent
    assert made == costly.asked == spent.calls
    assert 0 < made < 24
    assert spent.tokens <= (budget.tokens or 10**9)
    assert spent.usd <= (budget.usd or 10**9) + 8 * 0.01  # Dearer than estimated: 8 in flight.
    assert spent.calls <= (budget.calls or 10**9)


def test_a_call_waits_for_what_others_may_leave(tmp_path: Path) -> None:
    ledger = StudyLedger(tmp_path, Budget(tokens=1000))
    number = ledger.reserve("a", Amount(1, 900))
    later = threading.Timer(0.5, ledger.settle, (number, Amount(1, 100)))
    later.start()
    begun = time.monotonic()
    ledger.reserve("b", Amount(1, 500))
    assert time.monotonic() - begun > 0.3
    later.join()


def test_what_was_paid_for_no_answer_counts(tmp_path: Path) -> None:
    ledger = StudyLedger(tmp_path, Budget(tokens=100_000))
    with pytest.raises(ProviderError):
        _ask(budgeted(Failing(), "openai:gpt-4o", "a", ledger))
    assert ledger.spent == Amount(1, 70, 0.002)


def _reserve_and_die(folder: str) -> None:
    StudyLedger(Path(folder), Budget(tokens=1000)).reserve("a", Amount(1, 600))
    os._exit(9)


def test_a_call_whose_process_was_killed_counts_with_its_reserve(tmp_path: Path) -> None:
    process = multiprocessing.get_context("spawn").Process(
        target=_reserve_and_die, args=(str(tmp_path),)
    )
    process.start()
    process.join()
    ledger = StudyLedger(tmp_path, Budget(tokens=1000))
    with pytest.raises(BudgetError, match="600 of 1,000"):
        ledger.reserve("b", Amount(1, 500))
    ledger.reserve("b", Amount(1, 400))


def test_a_lost_file_is_made_again_of_what_the_episodes_took(tmp_path: Path) -> None:
    episodes = plan(small_study())
    outcomes = [record(tmp_path, one) for one in episodes[:2]]
    ledger = StudyLedger(tmp_path)
    ledger.begin(outcomes)
    assert ledger.spent.tokens == sum(one.usage.total_tokens for one in outcomes) > 0
    ledger.begin([])
    assert ledger.spent.tokens > 0


def test_a_damaged_file_is_told(tmp_path: Path) -> None:
    (tmp_path / LEDGER).write_bytes(b"x" * 5000)
    with pytest.raises(FileError, match="move it away"):
        StudyLedger(tmp_path, Budget(tokens=5)).reserve("a", Amount(1, 1))


def test_seconds_are_no_budget_of_a_study() -> None:
    with pytest.raises(ConfigError, match=r"--set budget\.seconds"):
        check_caps(Budget(seconds=3))
