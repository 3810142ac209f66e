"""Whatever words a server refuses pictures with, what it does tells what it takes."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from tests.brain import Brain
from tests.fake_provider import Canned, FakeProvider, Json, completion, fault

from adamo_vh.errors import ProviderError
from adamo_vh.inference.messages import HumanMessage, TextPart
from adamo_vh.inference.model import Sampling, Usage
from adamo_vh.inference.remote.capabilities import Support
from adamo_vh.inference.remote.probe import probe, two_colours
from adamo_vh.inference.remote.provider import ProviderModel
from adamo_vh.inference.remote.retry import RetryPolicy

QUICK = RetryPolicy(max_tries=2, max_wait_s=2.0, base_s=0.001, timeout_s=5.0)
FIRST, SECOND = two_colours("red", "blue"), two_colours("green", "black")

WORDINGS = (
    (400, 'can only concatenate str (not "list") to str'),
    (400, "'list object' has no attribute 'startswith'"),
    (400, "messages.1.content: Input should be a valid string"),
    (400, "messages[1]: unknown variant `image_url`, expected `text` at line 1 column 114708"),
    (400, "this model does not support image input (ref: b8bd630e)"),
    (400, "Unsupported content part type for text-only server: image_url"),
    (400, "json: cannot unmarshal array into Go struct field ChatRequest.messages.content"),
    (400, "Item 1 has the wrong kind."),
    (404, "No endpoints found that support image input"),
    (415, ""),
    (422, "data did not match any variant of untagged enum MessageContent"),
    (500, "unhandled template error in row 12"),
    (500, "Cannot process this kind of input"),
    (501, "Diese Eingabe wird nicht verarbeitet."),
)


@pytest.fixture(autouse=True)
def own_cache(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("ADAMO_VH_CACHE_DIR", str(tmp_path))


def taking(
    most: int, refusal: Canned, answer: Callable[[Json], Canned]
) -> Callable[[Json], Canned]:
    """A server that takes so many pictures a prompt."""
    return lambda request: (
        refusal if str(request).count("'image_url': {") > most else answer(request)
    )


def prompt(*pictures: object) -> list[HumanMessage]:
    return [HumanMessage((TextPart("Now?"), picture)) for picture in pictures]  # type: ignore[arg-type]


@pytest.mark.parametrize(("status", "words"), WORDINGS)
def test_a_refusal_in_any_words_is_a_verdict_of_the_probe(status: int, words: str) -> None:
    with FakeProvider(taking(0, fault(status, words), Brain())) as server:
        found = probe(server.uri(), QUICK)
    assert (found.pictures, found.is_complete) == (Support.REFUSED, True)


@pytest.mark.parametrize(("status", "words"), WORDINGS)
def test_a_refusal_in_any_words_names_the_switch(status: int, words: str) -> None:
    server = FakeProvider(taking(0, fault(status, words), lambda _: completion("Done.")))
    with (
        server,
        ProviderModel(server.uri(), QUICK) as model,
        pytest.raises(ProviderError, match="--switch pictures=none") as caught,
    ):
        model.complete(prompt(FIRST), (), Sampling())
    assert caught.value.most_pictures == 0
    spent = caught.value.spent
    assert spent.requests == len(server.requests)
    answered = sum(str(request).count("'image_url': {") == 0 for request in server.requests)
    assert spent.usage == Usage(answered * 1200, answered * 34)


@pytest.mark.parametrize("words", ["Item 2 is one too many.", "At most 1 image(s) may be given."])
def test_one_picture_a_prompt_is_found(words: str) -> None:
    with FakeProvider(taking(1, fault(400, words), Brain())) as server:
        found = probe(server.uri(), QUICK)
    assert (found.pictures, found.result_pictures) == (Support.YES, Support.YES)
    assert (found.several_pictures, found.is_complete) == (Support.REFUSED, True)
    server = FakeProvider(taking(1, fault(400, words), lambda _: completion("Done.")))
    with server, ProviderModel(server.uri(), QUICK) as model:
        model.complete(prompt(FIRST), (), Sampling())
        with pytest.raises(ProviderError, match="--switch pictures=1 and"):
            model.complete(prompt(FIRST, SECOND), (), Sampling())


def test_what_was_refused_once_and_then_answered_is_no_refusal() -> None:
    answers = [fault(400, "Hiccup."), completion("I see none."), completion("Red.")]
    with FakeProvider(answers) as server, ProviderModel(server.uri(), QUICK) as model:
        reply = model.complete(prompt(FIRST), (), Sampling())
    assert reply.message.text == "Red."
    assert (reply.requests, reply.usage.input_tokens) == (3, 2400)


@pytest.mark.parametrize(
    "refusal",
    [
        fault(400, "This model's maximum context length is 4096 tokens"),
        fault(401, "bad key"),
        fault(403, "not for you"),
        fault(402, "no credit"),
    ],
)
def test_what_is_about_something_else_is_not_tried_without_pictures(refusal: Canned) -> None:
    server = FakeProvider(taking(0, refusal, lambda _: completion("Done.")))
    with (
        server,
        ProviderModel(server.uri(), QUICK) as model,
        pytest.raises(ProviderError) as caught,
    ):
        model.complete(prompt(FIRST), (), Sampling())
    assert caught.value.most_pictures is None
    assert len(server.requests) == 1


def test_a_fault_of_the_whole_server_is_not_blamed_on_pictures() -> None:
    server = FakeProvider(lambda _: fault(500, "out of order"))
    with (
        server,
        ProviderModel(server.uri(), QUICK) as model,
        pytest.raises(ProviderError, match="out of order") as caught,
    ):
        model.complete(prompt(FIRST, SECOND), (), Sampling())
    assert "pictures" not in str(caught.value)
    assert caught.value.spent.requests == len(server.requests) == 4
