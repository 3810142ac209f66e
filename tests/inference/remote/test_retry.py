"""Faults that pass are waited out under a cap, others end at once; lost time is kept apart."""

from __future__ import annotations

import time

import pytest
from tests.fake_provider import Canned, FakeProvider, completion, fault

from adamo_vh.errors import ConfigError, ProviderError, RefusedError
from adamo_vh.inference.messages import HumanMessage, TextPart
from adamo_vh.inference.model import Reply, Sampling
from adamo_vh.inference.remote.endpoint import NO_REMOTE
from adamo_vh.inference.remote.provider import ProviderModel
from adamo_vh.inference.remote.retry import Failure, RetryPolicy, run_with_retries

ASK = (HumanMessage((TextPart("Pick the plate"),)),)
QUICK = RetryPolicy(max_tries=3, max_wait_s=5.0, base_s=0.001, timeout_s=5.0)


@pytest.fixture(autouse=True)
def offline(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(NO_REMOTE, "1")


def ask(server: FakeProvider, retry: RetryPolicy = QUICK) -> Reply:
    model = ProviderModel(server.uri(), retry)
    try:
        return model.complete(ASK, (), Sampling())
    finally:
        model.close()


PASSING = {
    "408": fault(408),
    "409": fault(409),
    "425": fault(425),
    "429": fault(429),
    "500": fault(500),
    "503": fault(503),
    "529": fault(529),
    "proxy page": Canned(b"<html>Bad Gateway</html>", 502, {"Content-Type": "text/html"}),
    "reset": Canned(cut=True),
    "not JSON": Canned(b"<html>"),
    "not JSON by type": Canned(b"<html>", 200, {"Content-Type": "text/html"}),
    "empty body": Canned(b""),
    "JSON null": Canned(b"null"),
    "JSON list": Canned(b"[1]"),
    "no choices": Canned({"choices": []}),
    "null choices": Canned({"choices": None}),
    "odd choices": Canned({"choices": ["x"]}),
    "no message": Canned({"choices": [{}]}),
    "error under 200": Canned({"error": {"message": "overloaded"}}),
}


@pytest.mark.parametrize("trouble", PASSING.values(), ids=PASSING.keys())
def test_a_passing_fault_is_tried_again(trouble: Canned) -> None:
    with FakeProvider([trouble, completion("ok")]) as server:
        reply = ask(server)
        assert reply.message.text == "ok"
        assert len(server.requests) == 2


@pytest.mark.parametrize("trouble", PASSING.values(), ids=PASSING.keys())
def test_a_fault_that_stays_ends_in_a_provider_error(trouble: Canned) -> None:
    with FakeProvider(lambda _: trouble) as server:
        with pytest.raises(ProviderError, match="Gave up after 3 of 3 tries"):
            ask(server)
        assert len(server.requests) == 3


@pytest.mark.parametrize("status", [400, 401, 402, 403, 404, 413, 418, 422])
def test_a_refused_request_ends_at_once_with_the_servers_message(status: int) -> None:
    with FakeProvider([fault(status, "the image is too large")]) as server:
        with pytest.raises(ProviderError, match=f"HTTP {status}: the image is too large"):
            ask(server)
        assert len(server.requests) == 1


def test_used_up_credit_ends_at_once() -> None:
    with FakeProvider([fault(429, "buy more", code="insufficient_quota")]) as server:
        with pytest.raises(ProviderError, match="buy more"):
            ask(server)
        assert len(server.requests) == 1


def test_retry_after_is_obeyed_and_lost_time_is_kept_apart() -> None:
    slow = Canned(status=429, headers={"retry-after-ms": "150"}, delay_s=0.1)
    with FakeProvider([slow, completion("ok")]) as server:
        start = time.monotonic()
        reply = ask(server)
        total_s = time.monotonic() - start
    assert reply.waited_s >= 0.25
    assert reply.seconds < 0.2
    assert reply.seconds + reply.waited_s <= total_s


def test_retry_after_in_seconds_is_understood() -> None:
    with FakeProvider([fault(429, headers={"Retry-After": "1"}), completion("ok")]) as server:
        assert 1.0 <= ask(server).waited_s < 2.0


def test_a_longer_wait_than_allowed_ends_at_once() -> None:
    with FakeProvider([fault(429, "slow down", headers={"Retry-After": "4000"})]) as server:
        start = time.monotonic()
        with pytest.raises(ProviderError, match="asked to wait 4000 s"):
            ask(server)
        assert time.monotonic() - start < 2
        assert len(server.requests) == 1


def test_the_wait_is_capped_whatever_the_number_of_tries() -> None:
    policy = RetryPolicy(max_tries=1000, max_wait_s=0.3, base_s=0.02, timeout_s=5.0)
    with FakeProvider(lambda _: fault(503)) as server:
        start = time.monotonic()
        with pytest.raises(ProviderError, match="Gave up"):
            ask(server, policy)
        assert time.monotonic() - start < 2
        assert 2 < len(server.requests) < 20


def test_a_server_that_does_not_answer_times_out_and_is_tried_again() -> None:
    stuck = Canned(b"{}", delay_s=0.8)
    policy = RetryPolicy(max_tries=2, max_wait_s=5.0, base_s=0.001, timeout_s=0.3)
    with FakeProvider([stuck, completion("ok")]) as server:
        reply = ask(server, policy)
    assert reply.message.text == "ok"
    assert reply.waited_s >= 0.3


def test_no_server_at_all_is_named() -> None:
    with FakeProvider([]) as server:
        gone = server.uri()
    with pytest.raises(ProviderError, match="Is it running"):
        ProviderModel(gone, QUICK).complete(ASK, (), Sampling())


def test_pauses_double_up_to_a_minute_and_never_undercut_the_server() -> None:
    policy = RetryPolicy(base_s=1.0)
    for failures, most in [(1, 1), (2, 2), (3, 4), (7, 60), (50, 60)]:
        pauses = [policy.pause_s(failures, None) for _ in range(50)]
        assert most / 2 <= min(pauses) <= max(pauses) <= most
        assert len(set(pauses)) > 1
    assert policy.pause_s(1, 30.0) == 30.0


def test_asking_for_less_is_no_retry_but_takes_its_time() -> None:
    outcomes: list[Failure | str] = [
        Failure("no top_p", False, refused="top_p"),
        Failure("no temperature", False, refused="temperature"),
        "ok",
    ]

    def attempt() -> Failure | str:
        time.sleep(0.01)
        return outcomes.pop(0)

    found = run_with_retries(RetryPolicy(max_tries=1), "m", attempt, lambda f: bool(f.refused))
    assert found.value == "ok"
    assert 0.02 <= found.waited_s < 0.5
    with pytest.raises(RefusedError, match="m: bad request"):
        run_with_retries(RetryPolicy(), "m", lambda: Failure("bad request", False))


@pytest.mark.parametrize(
    "limits", [{"max_tries": 0}, {"max_wait_s": -1.0}, {"base_s": -1.0}, {"timeout_s": 0.0}]
)
def test_senseless_limits_are_refused(limits: dict[str, float]) -> None:
    with pytest.raises(ConfigError, match="makes no sense"):
        RetryPolicy(**limits)  # type: ignore[arg-type]
