"""Answers that are odd but whole are taken; what was not counted is estimated and said to be."""

from __future__ import annotations

import gzip
import json
import time
from functools import cache
from typing import Any

import pytest
from tests.dialects import DIALECTS, Chat, Dialect, Google, uri
from tests.fake_provider import Canned, FakeProvider, Json, call, completion, fault
from tests.talk import ASK, NAMES, QUICK, TOOLS, tell

from adamo_vh.errors import ProviderError, RefusedError
from adamo_vh.inference.cost.tokens import OPENAI_TILES, estimate_request
from adamo_vh.inference.ladder import Ladder
from adamo_vh.inference.messages import HumanMessage, SystemMessage, TextPart
from adamo_vh.inference.model import Rung, Sampling, Spent, Usage
from adamo_vh.inference.remote.counts import counted
from adamo_vh.inference.remote.exchange import Exchange
from adamo_vh.inference.remote.faults import read_exchange
from adamo_vh.inference.remote.provider import ProviderModel

every_wire = pytest.mark.parametrize("dialect", DIALECTS, ids=NAMES)

BIG = 10**5000
ODD_COUNTS: tuple[Any, ...] = (None, -3, "many", [], {}, True, float("nan"), 1e300)


def altered(dialect: Dialect, **fields: Any) -> Canned:
    """A good answer with some top fields set otherwise; `...` takes one out."""
    answer = dialect.answer("ok")
    assert isinstance(answer.body, dict)
    body = {**answer.body, **fields}
    return Canned({name: value for name, value in body.items() if value is not ...})


def usage_name(dialect: Dialect) -> str:
    return "usageMetadata" if dialect.name == "google" else "usage"


@every_wire
@pytest.mark.parametrize("usage", [..., None, {}, [], "many", 7], ids=repr)
def test_an_answer_without_a_count_is_taken_and_estimated(dialect: Dialect, usage: Any) -> None:
    told = tell(dialect, [altered(dialect, **{usage_name(dialect): usage})])
    assert (told.reply.message.text, told.reply.requests) == ("ok", 1)
    assert told.reply.usage.estimated
    assert told.reply.usage.input_tokens > 1000 and told.reply.usage.output_tokens > 0


@every_wire
@pytest.mark.parametrize("odd", ODD_COUNTS, ids=repr)
def test_a_count_that_is_none_is_estimated(dialect: Dialect, odd: Any) -> None:
    good = dialect.answer("ok").body
    assert isinstance(good, dict)
    usage = dict.fromkeys(good[usage_name(dialect)], odd)
    told = tell(dialect, [altered(dialect, **{usage_name(dialect): usage})])
    assert (told.reply.message.text, told.reply.requests) == ("ok", 1)
    assert told.reply.usage.estimated and told.reply.usage.input_tokens > 1000


@every_wire
def test_fractions_and_texts_are_counts(dialect: Dialect) -> None:
    good = dialect.answer("ok").body
    assert isinstance(good, dict)
    usage = {
        name: f"{value}.0" if isinstance(value, int) else value
        for name, value in good[usage_name(dialect)].items()
    }
    told = tell(dialect, [altered(dialect, **{usage_name(dialect): usage})])
    plain = tell(dialect, [dialect.answer("ok")])
    assert told.reply.usage == plain.reply.usage
    assert not told.reply.usage.estimated


def test_an_integer_without_end_spoils_nothing() -> None:
    text = json.dumps(Chat().answer("ok").body).replace(": 1200", f": {'9' * 5000}")
    told = tell(Chat(), [Canned(text.encode())])
    assert told.reply.message.text == "ok"
    # It follows from the sum.
    assert told.reply.usage == tell(Chat(), [Chat().answer("ok")]).reply.usage


@pytest.mark.parametrize("reason", ["", None, "eos", "end_turn", "<|im_end|>", 7, ...], ids=repr)
def test_an_odd_reason_for_the_end_loses_no_answer(reason: Any) -> None:
    choice: Json = {"index": 0, "message": {"role": "assistant", "content": "Done"}}
    if reason is not ...:
        choice["finish_reason"] = reason
    told = tell(Chat(), [Canned({**Chat().answer("x").body, "choices": [choice]})])  # type: ignore[dict-item]
    assert (told.reply.message.text, told.reply.requests) == ("Done", 1)


@pytest.mark.parametrize(
    ("body", "usage"),
    [
        ({"usage": {"prompt_tokens": 90, "total_tokens": 100}}, Usage(90, 10)),
        ({"usage": {"completion_tokens": 10, "total_tokens": 100}}, Usage(90, 10)),
        ({"usage": {"total_tokens": 100}}, Usage()),
        ({"usage": {"prompt_tokens": 9, "prompt_cache_hit_tokens": 50}}, Usage(9, 0, 9)),
        ({"usage": None}, None),
        ([], None),
    ],
)
def test_what_a_body_counts_is_read(body: Any, usage: Usage | None) -> None:
    assert counted(body) == usage


def test_an_estimate_is_what_the_estimator_says() -> None:
    told = tell(Chat(), [altered(Chat(), usage=...)])
    assert told.reply.usage.input_tokens == estimate_request(ASK, TOOLS, OPENAI_TILES)


def test_a_prompt_that_the_server_cuts_is_said() -> None:
    long = (SystemMessage("You live in a body. " * 1500), HumanMessage((TextPart("Go."),)))
    cut = altered(Chat(), usage={"prompt_tokens": 4096, "completion_tokens": 9})
    warned = tell(Chat(), [cut], long).reply.warning
    assert "counted 4,096 tokens of a prompt of about" in warned and "--ctx-size" in warned
    whole = altered(Chat(), usage={"prompt_tokens": 7600, "completion_tokens": 9})
    assert tell(Chat(), [whole], long).reply.warning == ""
    assert tell(Chat(), [altered(Chat(), usage=...)], long).reply.warning == ""


@every_wire
def test_an_answer_without_end_is_not_read_to_its_end(dialect: Dialect) -> None:
    with pytest.raises(RefusedError, match="more than 16 MB") as caught:
        tell(dialect, [Canned(b" " * 17_000_000)])
    assert caught.value.spent is not None and caught.value.spent.requests == 1


@cache
def _bomb() -> bytes:
    return gzip.compress(b" " * 300_000_000, compresslevel=9)


@every_wire
def test_a_packed_answer_is_unpacked_to_a_limit(dialect: Dialect) -> None:
    bomb = _bomb()
    started = time.monotonic()
    with pytest.raises(RefusedError, match="more than 16 MB"):
        tell(dialect, [Canned(bomb, headers={"content-encoding": "gzip"})])
    assert time.monotonic() - started < 20
    good = gzip.compress(json.dumps(dialect.answer("ok").body).encode())
    told = tell(dialect, [Canned(good, headers={"content-encoding": "gzip"})])
    assert told.reply.message.text == "ok"


@pytest.mark.parametrize("encoding", ["br", "zstd", "gzip, gzip"])
def test_a_packing_that_was_not_asked_for_is_refused(encoding: str) -> None:
    with pytest.raises(RefusedError, match="was not asked for"):
        tell(Chat(), [Canned(b"x", headers={"content-encoding": encoding})])


@every_wire
def test_a_redirect_is_named_and_not_followed(dialect: Dialect) -> None:
    with FakeProvider(lambda _: Canned(b"", 308, {"location": other})) as server:
        other = "http://me:hush@127.0.0.1:9/elsewhere/v1/chat/completions"
        with (
            ProviderModel(uri(dialect, server), QUICK) as model,
            pytest.raises(RefusedError, match=r"redirects to http://\[key\]@127.0.0.1:9/else"),
        ):
            model.complete(ASK, TOOLS, Sampling())
        assert len(server.requests) == 1


@pytest.mark.parametrize("code", ["²", "４２９", "5e2", 10**30, [], "429 "], ids=repr)
def test_an_odd_code_of_an_error_is_read(code: Any) -> None:
    exchange = Exchange(status=200, text=json.dumps({"error": {"code": code, "message": "no"}}))
    failure = read_exchange(exchange)
    assert failure is not None and "no." in failure.text


@pytest.mark.parametrize(
    "piece", ["input token count ", "Bearer ", "sk-", "top_p ", "'retryDelay': '1", " ", "a"]
)
@pytest.mark.parametrize("status", [400, 500])
def test_a_long_error_is_read_in_no_time(piece: str, status: int) -> None:
    words = piece * (600_000 // len(piece))
    with pytest.raises(ProviderError):
        tell(Chat(), [fault(status, words)] * 3)
    started = time.monotonic()
    exchange = Exchange(status=status, text=json.dumps({"error": {"message": words}}))
    assert read_exchange(exchange) is not None
    assert time.monotonic() - started < 2


@pytest.mark.parametrize("deep", ["[" * 100_000, '{"a":' * 100_000, "[" * 900 + "]" * 900])
def test_deep_answers_and_errors_are_only_faults(deep: str) -> None:
    body = f'{{"error": {{"message": "no"}}, "x": {deep}'.encode()
    for status in (200, 400):
        with pytest.raises(ProviderError):
            tell(Chat(), [Canned(body, status)] * 3)
    with pytest.raises(ProviderError):
        tell(Google(), [Canned(f'{{"candidates": {deep}'.encode())] * 3)


def test_a_key_that_a_server_echoes_is_nowhere_in_the_reply(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setenv("OPENAI_API_KEY", "hush-openai-5f0c2b7e91d4")

    def echo(request: Json) -> Canned:
        key = server.headers[-1]["authorization"].removeprefix("Bearer ")
        calls = [call("Pick", {"object": key})]
        return completion(f"Your key is {key}", calls, reasoning_content=f"I know {key}")

    server = FakeProvider(echo)
    with server, ProviderModel(server.uri(), QUICK) as model:
        reply = model.complete(ASK, TOOLS, Sampling())
    assert reply.message.text == "Your key is [key]"
    assert reply.message.calls[0].arguments == {"object": "[key]"}
    assert "hush-openai" not in repr(reply)


def test_an_ordinary_word_is_no_key(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("KEYBOARD_LAYOUT", "german")
    assert tell(Chat(), [Chat().answer("a german plate")]).reply.message.text == "a german plate"


def test_tokens_of_answers_that_could_not_be_used_are_counted() -> None:
    lost = Canned({"usage": {"prompt_tokens": 500, "completion_tokens": 5}, "choices": []})
    told = tell(Chat(), [lost, Chat().answer("ok")])
    plain = tell(Chat(), [Chat().answer("ok")])
    assert told.reply.usage == plain.reply.usage + Usage(500, 5)
    with pytest.raises(ProviderError) as caught:
        tell(Chat(), [lost] * 3)
    assert isinstance(caught.value.spent, Spent)
    assert (caught.value.spent.usage, caught.value.spent.requests) == (Usage(1500, 15), 3)


def test_a_repair_turn_that_fails_forgets_nothing() -> None:
    first = altered(Chat(), usage={"prompt_tokens": 49_000, "completion_tokens": 1000})
    too_long = fault(400, "request exceeds the available context size")
    with FakeProvider([first, too_long]) as server:
        model = Ladder(ProviderModel(server.uri(), QUICK), Rung.SCHEMA)
        with pytest.raises(RefusedError) as caught:
            model.complete(ASK, TOOLS, Sampling())
        model.info.close()
    spent = caught.value.spent
    assert isinstance(spent, Spent)
    assert (spent.usage, spent.requests) == (Usage(49_000, 1000), 2)
