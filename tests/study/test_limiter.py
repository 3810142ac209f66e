"""One pace for all who ask a provider: threads, processes, and those that were killed."""

from __future__ import annotations

import json
import sqlite3
import subprocess
import sys
import threading
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest

from adamo_vh.errors import ConfigError, FileError
from adamo_vh.inference.messages import HumanMessage, TextPart
from adamo_vh.inference.model import Reply, Sampling
from adamo_vh.inference.remote.gate import Passage, through
from adamo_vh.inference.remote.provider import ProviderModel
from adamo_vh.inference.remote.retry import Failure, RetryPolicy
from adamo_vh.model_server.fault_rules import Faults, Rule, What
from adamo_vh.model_server.model_serving import serve_model
from adamo_vh.model_server.openai_endpoint import Served
from adamo_vh.study import limiter as module
from adamo_vh.study.limiter import LIMITS, Limiter, Rates

ASK = (HumanMessage((TextPart("Hello"),)),)
POLICY = RetryPolicy(max_tries=4, max_wait_s=3.0, base_s=0.01, timeout_s=20.0)
FULL = Failure("Too many requests.", True, None, status=429)


@pytest.fixture(autouse=True)
def offline(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("ADAMO_VH_NO_REMOTE", "1")


@pytest.fixture
def file(tmp_path: Path) -> Path:
    return tmp_path / LIMITS


def short_window(monkeypatch: pytest.MonkeyPatch, seconds: float) -> None:
    monkeypatch.setattr(module, "_WINDOW_S", seconds)
    monkeypatch.setattr(module, "_POLL_S", (0.02, 0.1))


def test_no_more_are_on_their_way_than_allowed(file: Path) -> None:
    limiters = [Limiter(file, Rates(concurrent=3)) for _ in range(2)]
    lock, now, most = threading.Lock(), 0, 0

    def request(number: int) -> None:
        nonlocal now, most
        ticket = limiters[number % 2].acquire("p", 10)
        with lock:
            now += 1
            most = max(most, now)
        time.sleep(0.05)
        with lock:
            now -= 1
        limiters[number % 2].settle(ticket, 10)

    with ThreadPoolExecutor(12) as pool:
        list(pool.map(request, range(12)))
    assert (most, now) == (3, 0)


def test_requests_a_minute_are_kept(file: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    short_window(monkeypatch, 0.6)
    limiter = Limiter(file, Rates(requests=4))
    times = []
    for _ in range(10):
        limiter.settle(limiter.acquire("p", 1), 1)
        times.append(time.time())
    assert all(later - earlier > 0.5 for earlier, later in zip(times, times[4:], strict=False))
    begun = time.monotonic()
    limiter.settle(limiter.acquire("another", 1), 1)
    assert time.monotonic() - begun < 0.3


def test_tokens_a_minute_are_those_that_were_used(
    file: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    short_window(monkeypatch, 0.8)
    limiter = Limiter(file, Rates(tokens=1000))
    limiter.settle(limiter.acquire("p", 900), 100)  # It took less than was thought.
    assert limiter.acquire("p", 800).waited_s < 0.3
    waited = limiter.acquire("p", 300)
    assert waited.waited_s > 0.3


def test_a_request_larger_than_the_limit_goes_alone(
    file: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    short_window(monkeypatch, 0.4)
    limiter = Limiter(file, Rates(tokens=1000))
    assert limiter.acquire("p", 5000).waited_s < 0.2
    assert limiter.acquire("p", 5000).waited_s > 0.2


def test_a_complaint_halves_the_pace_once_and_answers_bring_it_back(file: Path) -> None:
    limiter = Limiter(file, Rates(concurrent=16))
    tickets = [limiter.acquire("p", 1) for _ in range(8)]
    for ticket in tickets[:4]:
        limiter.settle(ticket, 0, FULL)
    # Eight were on their way: all four complaints are about the same pace.
    assert limiter.allowed("p") == 4
    assert limiter.allowed("another") == 16
    for ticket in tickets[4:]:
        limiter.settle(ticket, 1)
    for _ in range(8):
        limiter.settle(limiter.acquire("p", 1), 1)
    assert 5 <= limiter.allowed("p") < 8
    for _ in range(9):
        limiter.settle(limiter.acquire("p", 1), 0, FULL)
    assert limiter.allowed("p") == 1
    assert limiter.acquire("p", 1).waited_s < 1


def test_when_to_come_back_holds_for_all(file: Path) -> None:
    one, other = Limiter(file), Limiter(file)
    one.settle(one.acquire("p", 1), 0, Failure("Later.", True, 0.6, status=429))
    assert other.acquire("another", 1).waited_s < 0.3
    assert 0.3 < other.acquire("p", 1).waited_s < 2.0


def test_other_faults_say_nothing_about_the_pace(file: Path) -> None:
    limiter = Limiter(file, Rates(concurrent=8))
    limiter.settle(limiter.acquire("p", 1), 0, Failure("Broken.", True, None, status=500))
    assert limiter.allowed("p") == 8


def test_a_killed_process_holds_nothing(file: Path) -> None:
    code = (
        "import os, signal, sys; from pathlib import Path; "
        "from adamo_vh.study.limiter import Limiter, Rates; "
        "Limiter(Path(sys.argv[1]), Rates(concurrent=1)).acquire('p', 1); "
        "os.kill(os.getpid(), signal.SIGKILL)"
    )
    killed = subprocess.run([sys.executable, "-c", code, str(file)], check=False)
    assert killed.returncode < 0
    assert Limiter(file, Rates(concurrent=1)).acquire("p", 1).waited_s < 2


def test_what_cannot_be_shared_is_said(tmp_path: Path) -> None:
    (tmp_path / LIMITS).write_text("no database, " * 100)
    with pytest.raises(FileError, match=r"limits\.sqlite.*may be deleted while nothing runs"):
        Limiter(tmp_path / LIMITS).acquire("p", 1)
    with pytest.raises(FileError, match="cannot be used"):
        Limiter(tmp_path / "nowhere" / LIMITS).acquire("p", 1)
    for wrong in ({"concurrent": 0}, {"requests": -1}, {"tokens": 0}):
        with pytest.raises(ConfigError, match="use a whole number from 1"):
            Rates(**wrong)


# --- requests on the wire -------------------------------------------------------------------


class Seen:
    """When requests were answered."""

    def __init__(self) -> None:
        self.times: list[float] = []

    def __call__(self, served: Served) -> None:
        self.times.append(time.monotonic())


def ask(uri: str, limiter: Limiter | None) -> Reply:
    model = ProviderModel(uri, POLICY)
    try:
        with through(limiter):
            return model.complete(ASK, (), Sampling())
    finally:
        model.close()


def too_many(*requests: int, retry_after_s: int | None = None) -> Faults:
    rule = Rule(what=What.ERROR, status=429, requests=requests, retry_after_s=retry_after_s)
    return Faults(fault=(rule,))


@pytest.fixture
def hello(tmp_path: Path) -> str:
    script = tmp_path / "hello.json"
    script.write_text(json.dumps([]))
    return f"scripted:{script}"


def test_waiting_for_leave_is_waiting_and_no_lost_time(hello: str, file: Path) -> None:
    limiter = Limiter(file, Rates(concurrent=1))
    with serve_model(hello, faults=too_many(2)) as served:
        ask(served.uri, None)  # Loads the libraries.
        ticket = limiter.acquire(served.uri.partition("@")[2], 1)
        # Longer than an answer may lose to faults: there is one, and it is tried again.
        held_s = POLICY.max_wait_s + 1.0
        threading.Timer(held_s, limiter.settle, (ticket, 1)).start()
        reply = ask(served.uri, limiter)
    assert reply.waited_s > POLICY.max_wait_s
    assert reply.seconds < 2.0
    assert reply.requests == 2


def test_what_the_server_asks_for_holds_for_other_models(hello: str, file: Path) -> None:
    limiter = Limiter(file)
    seen = Seen()
    faults = too_many(1, retry_after_s=1)
    with serve_model(hello, faults=faults, watch=seen) as served, ThreadPoolExecutor(2) as pool:
        first = pool.submit(ask, served.uri, limiter)
        while not seen.times:
            time.sleep(0.01)
        time.sleep(0.2)
        second = pool.submit(ask, served.uri, limiter)
        replies = [first.result(), second.result()]
    assert [reply.requests for reply in replies] == [2, 1]
    assert all(reply.waited_s > 0.5 for reply in replies)
    assert all(later - seen.times[0] > 0.9 for later in seen.times[1:])


def test_two_processes_keep_one_pace(hello: str, file: Path) -> None:
    code = """
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from adamo_vh.inference.messages import HumanMessage, TextPart
from adamo_vh.inference.model import Sampling
from adamo_vh.inference.remote.gate import through
from adamo_vh.inference.remote.provider import ProviderModel
from adamo_vh.study.limiter import Limiter, Rates
uri, file = sys.argv[1:]
limiter = Limiter(Path(file), Rates(concurrent=2))
def ask(_):
    with through(limiter):
        ask = (HumanMessage((TextPart("Hello"),)),)
        return ProviderModel(uri).complete(ask, (), Sampling()).requests
with ThreadPoolExecutor(4) as pool:
    print(sum(pool.map(ask, range(4))))
"""
    slow = Faults(fault=(Rule(what=What.SLOW, seconds=0.4, every=1),))
    seen = Seen()
    with serve_model(hello, faults=slow, watch=seen) as served:
        command = [sys.executable, "-c", code, served.uri, str(file)]
        both = [subprocess.Popen(command, stdout=subprocess.PIPE) for _ in range(2)]
        said = [process.communicate()[0] for process in both]
    assert [int(text) for text in said] == [4, 4]
    # Two at once, each at least 0.4 s: never three within 0.4 s.
    arrived = sorted(seen.times)
    assert all(b - a > 0.35 for a, b in zip(arrived, arrived[2:], strict=False))
    with sqlite3.connect(file) as database:
        assert database.execute("SELECT count(*) FROM requests").fetchone() == (8,)


def test_without_a_gate_nothing_is_estimated() -> None:
    passage = Passage("p", lambda: 1 // 0)
    assert passage.enter() == 0.0
    passage.leave(5, None)
