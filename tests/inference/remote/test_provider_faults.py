"""Faults on every wire: what passes is waited out, what stays is said plainly."""

from __future__ import annotations

import json
import logging
import time
import traceback
from datetime import UTC, datetime, timedelta
from email.utils import format_datetime

import pytest
from hypothesis import given, strategies
from tests.dialects import DIALECTS, Anthropic, Chat, Dialect, Google, Responses, uri
from tests.fake_provider import Canned, FakeProvider, fault
from tests.talk import ASK, NAMES, QUICK, TOOLS, tell

from adamo_vh.errors import ProviderError, RefusedError
from adamo_vh.inference.messages import HumanMessage, TextPart
from adamo_vh.inference.model import Sampling
from adamo_vh.inference.remote.endpoint import NO_REMOTE
from adamo_vh.inference.remote.exchange import Exchange
from adamo_vh.inference.remote.faults import read_exchange, refused_setting
from adamo_vh.inference.remote.provider import ProviderModel
from adamo_vh.inference.remote.retry import RetryPolicy

every_wire = pytest.mark.parametrize("dialect", DIALECTS, ids=NAMES)

KEYS = {
    "OPENAI_API_KEY": "hush-openai-5f0c2b7e91d4",
    "ANTHROPIC_API_KEY": "hush-anthropic-77aa01",
    "GOOGLE_API_KEY": "hush-google-1234567",
}


_BLIND = (*ASK[:2], HumanMessage((TextPart("Pick the plate"),)))
"""Without a picture that might be why."""


def raised(dialect: Dialect, *answers: Canned, retry: RetryPolicy = QUICK) -> tuple[str, int]:
    """What a model says that fails, and how many requests it took."""
    with (
        FakeProvider(answers) as server,
        ProviderModel(uri(dialect, server), retry) as model,
        pytest.raises(ProviderError) as caught,
    ):
        model.complete(_BLIND, TOOLS, Sampling())
    assert caught.value.__cause__ is None and caught.value.__context__ is None
    return str(caught.value), len(server.requests)


@every_wire
@pytest.mark.parametrize("status", [408, 409, 425, 429, 500, 502, 503, 529])
def test_a_passing_fault_takes_one_more_request(dialect: Dialect, status: int) -> None:
    """One, not three: the client libraries do not try again on their own account."""
    told = tell(dialect, [dialect.error(status, "busy"), dialect.answer("ok")])
    assert told.reply.message.text == "ok"
    assert len(told.requests) == told.reply.requests == 2


@every_wire
def test_a_fault_that_stays_takes_one_request_a_try(dialect: Dialect) -> None:
    text, requests = raised(dialect, *[dialect.error(500, "engine on fire")] * 9)
    assert "HTTP 500: engine on fire" in text and "Gave up after 3 of 3 tries" in text
    assert requests == 3


@every_wire
def test_a_reset_is_tried_again(dialect: Dialect) -> None:
    told = tell(dialect, [Canned(cut=True), dialect.answer("ok")])
    assert (told.reply.message.text, told.reply.requests) == ("ok", 2)


@every_wire
def test_a_time_out_is_tried_again(dialect: Dialect) -> None:
    retry = RetryPolicy(max_tries=2, max_wait_s=5.0, base_s=0.001, timeout_s=1.0)
    told = tell(dialect, [Canned(b"{}", delay_s=1.6), dialect.answer("ok")], retry=retry)
    assert told.reply.message.text == "ok"
    assert told.reply.waited_s >= 1.0
    assert told.reply.requests == 2


@every_wire
@pytest.mark.parametrize("body", [b"<html>", b"", b"null", b"[1]", b"{}"])
def test_garbage_under_200_is_tried_again(dialect: Dialect, body: bytes) -> None:
    told = tell(dialect, [Canned(body), dialect.answer("ok")])
    assert (told.reply.message.text, told.reply.requests) == ("ok", 2)


@every_wire
def test_the_wait_that_a_server_asks_for_is_obeyed(dialect: Dialect) -> None:
    slow = Canned(dialect.error(429, "slow down").body, 429, {"retry-after-ms": "150"})
    told = tell(dialect, [slow, dialect.answer("ok")])
    assert told.reply.message.text == "ok"
    assert 0.15 <= told.reply.waited_s < 1.5
    assert told.reply.seconds < 1.0


def test_a_wait_until_a_date_is_obeyed() -> None:
    soon = format_datetime(datetime.now(UTC) + timedelta(seconds=2), usegmt=True)
    told = tell(Chat(), [fault(503, headers={"Retry-After": soon}), Chat().answer("ok")])
    assert 0.5 < told.reply.waited_s < 2.5


@every_wire
def test_a_longer_wait_than_allowed_ends_at_once(dialect: Dialect) -> None:
    slow = Canned(dialect.error(429, "slow down").body, 429, {"Retry-After": "4000"})
    start = time.monotonic()
    text, requests = raised(dialect, slow)
    assert "asked to wait 4000 s" in text
    assert requests == 1 and time.monotonic() - start < 2


def test_google_asks_to_wait_in_its_error_details() -> None:
    detail = {"@type": "type.googleapis.com/google.rpc.RetryInfo", "retryDelay": "4000s"}
    error = {"code": 429, "message": "You exceeded your current quota.", "details": [detail]}
    text, _ = raised(Google(), Canned({"error": error}, 429))
    assert "asked to wait 4000 s" in text


PERMANENT = {
    "no eyes": "image input is not supported - hint: you may need to provide the mmproj",
    "template": "Jinja Exception: Conversation roles must alternate",
    "no template": "Unable to render the chat template",
}


@every_wire
@pytest.mark.parametrize("words", PERMANENT.values(), ids=PERMANENT.keys())
def test_a_permanent_fault_that_is_called_500_ends_at_once(dialect: Dialect, words: str) -> None:
    text, requests = raised(dialect, dialect.error(500, words))
    assert words.split(":", maxsplit=1)[0] in text
    assert requests == 1


@every_wire
@pytest.mark.parametrize("status", [429, 500, 503])
def test_an_error_under_200_is_tried_again_by_its_code(dialect: Dialect, status: int) -> None:
    told = tell(dialect, [dialect.hidden_error(status, "overloaded"), dialect.answer("ok")])
    assert (told.reply.message.text, told.reply.requests) == ("ok", 2)


@every_wire
@pytest.mark.parametrize("status", [400, 401])
def test_an_error_under_200_ends_at_once_by_its_code(dialect: Dialect, status: int) -> None:
    text, requests = raised(dialect, dialect.hidden_error(status, "that will not do"))
    assert "HTTP 200 with an error: that will not do" in text
    assert requests == 1


@pytest.mark.parametrize(("code", "passes"), [("server_error", True), ("invalid_prompt", False)])
def test_a_failed_response_says_by_name_whether_it_passes(code: str, passes: bool) -> None:
    dialect = Responses()
    failed = Canned({"status": "failed", "error": {"code": code, "message": "no"}, "output": []})
    if passes:
        assert tell(dialect, [failed, dialect.answer("ok")]).reply.requests == 2
    else:
        assert raised(dialect, failed)[1] == 1


def test_an_answer_that_broke_off_is_tried_again() -> None:
    choice = {"finish_reason": "error", "message": {"role": "assistant", "content": "I wa"}}
    told = tell(Chat(), [Canned({"choices": [choice]}), Chat().answer("ok")])
    assert (told.reply.message.text, told.reply.requests) == ("ok", 2)


def test_a_blocked_prompt_ends_at_once_and_no_candidates_are_tried_again() -> None:
    blocked = Canned({"promptFeedback": {"blockReason": "PROHIBITED_CONTENT"}})
    text, requests = raised(Google(), blocked)
    assert "blocked the prompt: PROHIBITED_CONTENT" in text and requests == 1
    told = tell(Google(), [Canned({"candidates": []}), Google().answer("ok")])
    assert (told.reply.message.text, told.reply.requests) == ("ok", 2)


@every_wire
@pytest.mark.parametrize("status", [400, 401, 403, 404, 413, 422])
def test_a_refused_request_ends_at_once_with_the_servers_words(
    dialect: Dialect, status: int
) -> None:
    with pytest.raises(RefusedError, match=f"HTTP {status}: the picture is too large"):
        tell(dialect, [dialect.error(status, "the picture is too large")])


TOO_LONG = {
    "openai-chat": "This model's maximum context length is 8192 tokens. However, you requested "
    "12000 tokens (8000 in the messages, 4000 in the completion: max_tokens).",
    "openai-responses": "Your input exceeds the context window of this model.",
    "anthropic": "prompt is too long: 208310 tokens > 200000 maximum",
    "google": "The input token count (1200000) exceeds the maximum number of tokens allowed.",
}


@every_wire
@pytest.mark.parametrize("status", [400, 500])
def test_a_prompt_that_is_too_long_is_called_so(dialect: Dialect, status: int) -> None:
    text, requests = raised(dialect, dialect.error(status, TOO_LONG[dialect.name]))
    assert "The prompt is longer than the model's context." in text
    assert TOO_LONG[dialect.name][:40] in text
    assert requests == 1


def test_used_up_credit_ends_at_once() -> None:
    spent = fault(429, "buy more", code="insufficient_quota")
    assert raised(Chat(), spent)[1] == 1
    detail = {"violations": [{"quotaId": "GenerateRequestsPerDayPerProject"}]}
    spent = Canned({"error": {"code": 429, "message": "quota", "details": [detail]}}, 429)
    assert raised(Google(), spent)[1] == 1
    assert raised(Anthropic(), Anthropic().error(400, "Your credit balance is too low"))[1] == 1


@every_wire
def test_the_key_goes_to_the_server_and_nowhere_else(
    dialect: Dialect,
    monkeypatch: pytest.MonkeyPatch,
    caplog: pytest.LogCaptureFixture,
    capfd: pytest.CaptureFixture[str],
) -> None:
    for name, key in KEYS.items():
        monkeypatch.setenv(name, key)
    caplog.set_level(logging.DEBUG)
    answers = [dialect.error(500, f"echo {key}") for key in KEYS.values()]
    with (
        FakeProvider(answers) as server,
        ProviderModel(uri(dialect, server), QUICK) as model,
        pytest.raises(ProviderError) as caught,
    ):
        model.complete(ASK, TOOLS, Sampling())
    sent = str(server.headers)
    own = KEYS[f"{dialect.name.split('-', maxsplit=1)[0].upper()}_API_KEY"]
    assert [key for key in KEYS.values() if key in sent] == [own]
    trace = "".join(traceback.format_exception(caught.value))
    captured = capfd.readouterr()
    shown = (repr(model), model.info.name, trace, caplog.text, captured.out, captured.err)
    assert not any(key in text for key in KEYS.values() for text in shown)


@pytest.mark.parametrize(
    "key", ["sk-ant-api03-Ab12*****yz", "sk-proj-ab*****yz12", "AIzaSyA-1234567890_abc"]
)
def test_a_key_in_a_servers_words_is_blacked_out(key: str) -> None:
    text, _ = raised(Chat(), fault(401, f"Incorrect API key provided: {key}."))
    assert key[:8] not in text and "[key]" in text
    assert "Check the API key" in text


@pytest.fixture(autouse=True)
def offline(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(NO_REMOTE, "1")


_WORDS = [
    "error",
    "message",
    "detail",
    "code",
    "type",
    "param",
    "choices",
    "status",
    "finish_reason",
    "promptFeedback",
    "blockReason",
    "candidates",
    "loc",
    "msg",
]
_JSON = strategies.recursive(
    strategies.none() | strategies.booleans() | strategies.integers(0, 600) | strategies.text(),
    lambda inner: (
        strategies.lists(inner, max_size=2)
        | strategies.dictionaries(strategies.sampled_from(_WORDS), inner, max_size=4)
    ),
)


@given(_JSON, strategies.sampled_from([200, 400, 422, 429, 500]))
def test_whatever_a_server_answers_can_be_read(body: object, status: int) -> None:
    sent = {"contents": [], "temperature": 0}
    exchange = Exchange(sent=sent, status=status, text=json.dumps(body))
    failure = read_exchange(exchange)
    assert failure is None or failure.text.endswith((".", "!", "?"))
    assert (failure is not None) >= (status != 200)
    assert refused_setting(exchange, ["temperature"]) in (None, "temperature")
