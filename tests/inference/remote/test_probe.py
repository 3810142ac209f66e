"""What a probe finds out over a real socket, and what is kept of it."""

from __future__ import annotations

from contextlib import closing
from dataclasses import replace
from pathlib import Path

import pytest
from tests.brain import Brain
from tests.fake_provider import Canned, FakeProvider, Json, completion, fault

from adamo_vh.errors import ModelConfigError, ModelError
from adamo_vh.inference.ladder import Ladder
from adamo_vh.inference.messages import HumanMessage, TextPart
from adamo_vh.inference.model import Rung, Sampling, Usage
from adamo_vh.inference.registry import create_model
from adamo_vh.inference.remote.capabilities import (
    Capabilities,
    Support,
    ToolSupport,
    load_capabilities,
    save_capabilities,
)
from adamo_vh.inference.remote.probe import LAMP, probe
from adamo_vh.inference.remote.retry import RetryPolicy

QUICK = RetryPolicy(max_tries=2, max_wait_s=2.0, base_s=0.001, timeout_s=5.0)


@pytest.fixture(autouse=True)
def own_cache(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv("ADAMO_VH_CACHE_DIR", str(tmp_path))
    return tmp_path


def probed(brain: Brain) -> Capabilities:
    with FakeProvider(brain) as server:
        return probe(server.uri(), QUICK)


def test_a_model_that_can_do_everything_is_asked_five_times() -> None:
    brain = Brain()
    found = probed(brain)
    assert found.rung is Rung.NATIVE
    assert found.tools is ToolSupport.NATIVE
    assert (found.pictures, found.result_pictures) == (Support.YES, Support.YES)
    assert found.schema is Support.YES
    assert found.refused == ()
    assert found.requests == len(brain.asked) == 5
    assert found.usage == Usage(5 * 1200, 5 * 34)
    assert 0 < found.seconds < 10
    assert found.when.endswith("+00:00")


@pytest.mark.parametrize(
    ("tools", "schema", "support", "rung"),
    [
        ("leaked", "obeyed", ToolSupport.LEAKED, Rung.LEAKED),
        ("none", "obeyed", ToolSupport.NONE, Rung.SCHEMA),
        ("400", "obeyed", ToolSupport.REFUSED, Rung.SCHEMA),
        ("500", "obeyed", ToolSupport.REFUSED, Rung.SCHEMA),
        ("400", "400", ToolSupport.REFUSED, Rung.REACT),
        ("none", "ignored", ToolSupport.NONE, Rung.REACT),
    ],
)
def test_it_steps_down_the_ladder(
    tools: str, schema: str, support: ToolSupport, rung: Rung
) -> None:
    found = probed(Brain(tools=tools, schema=schema))
    assert (found.tools, found.rung) == (support, rung)
    assert found.result_pictures is Support.UNTESTED
    assert found.requests <= 6


@pytest.mark.parametrize(("pictures", "support"), [("unseen", "no"), ("500", "refused")])
def test_a_model_that_sees_nothing_is_found_out(pictures: str, support: str) -> None:
    found = probed(Brain(pictures=pictures))
    assert found.pictures == support
    assert found.result_pictures is Support.UNTESTED
    assert found.rung is Rung.NATIVE


def test_a_guess_of_common_colours_is_no_sight() -> None:
    brain = Brain()

    def guess(request: Json) -> Canned:
        answer = brain(request)
        return completion("red, blue") if "left half" in str(request["messages"][-1]) else answer

    with FakeProvider(guess) as server:
        # The colours follow from the URI: no fixed guess fits them all.
        found = [probe(server.uri(name), QUICK).pictures for name in "abcd"]
    assert Support.NO in found


def test_refused_parameters_are_found_and_no_longer_sent() -> None:
    brain = Brain()

    def picky(request: Json) -> Canned:
        if "temperature" in request:
            return fault(400, "Unsupported parameter: 'temperature'", param="temperature")
        return brain(request)

    with FakeProvider(picky) as server:
        model = create_model(server.uri(), QUICK)
        found = model.info.capabilities
        assert found is not None
        assert found.refused == ("temperature",)
        again = create_model(server.uri(), QUICK)
        assert isinstance(again, Ladder) and again.info.capabilities == found
        before = len(server.requests)
        with closing(again.info):
            again.complete([HumanMessage((TextPart("Hi"),))], [], Sampling())
        assert len(server.requests) == before + 1
        assert "temperature" not in server.requests[-1]


@pytest.mark.parametrize(
    "answer", [Canned(cut=True), fault(401, "bad key"), fault(404, "no model")]
)
def test_a_model_that_cannot_be_reached_is_an_error_with_its_fix(
    answer: Canned, own_cache: Path
) -> None:
    with FakeProvider(lambda _: answer) as server, pytest.raises(ModelError) as caught:
        create_model(server.uri(), QUICK)
    assert "cannot be used" in str(caught.value)
    assert not list(own_cache.rglob("*.json"))


def test_a_server_that_is_not_there_is_named() -> None:
    with pytest.raises(ModelError, match="Is it running at that address"):
        probe("openai:tiny@http://127.0.0.1:9/v1", QUICK)


def test_a_server_that_dies_on_the_way_is_not_taken_for_a_poor_one(own_cache: Path) -> None:
    brain = Brain()

    def dying(request: Json) -> Canned:
        return brain(request) if not brain.asked else Canned(cut=True)

    with FakeProvider(dying) as server, pytest.raises(ModelError):
        create_model(server.uri(), QUICK)
    assert not list(own_cache.rglob("*.json"))


def test_a_rate_limit_on_the_way_is_not_taken_for_a_refusal(own_cache: Path) -> None:
    brain = Brain()

    def busy(request: Json) -> Canned:
        return brain(request) if not brain.asked else fault(429, "slow down")

    with FakeProvider(busy) as server, pytest.raises(ModelError, match="slow down"):
        create_model(server.uri(), QUICK)
    assert len(server.requests) == 1 + 2 * QUICK.max_tries  # The second picture, and a plain word
    assert not list(own_cache.rglob("*.json"))


def about(request: Json) -> str:
    """Which question of the probe a request is."""
    if "response_format" in request:
        return "schema"
    if LAMP.name in str(request.get("tools")):
        roles = [message["role"] for message in request["messages"]]
        return "result" if "assistant" in roles else "tool"
    return "pictures" if "image_url" in str(request["messages"]) else "word"


class Shaky:
    """Answers like a mind, but a question with a fault, so many times."""

    def __init__(self, question: str, fault: Canned, times: int) -> None:
        self.brain = Brain()
        self.question, self.fault, self.times = question, fault, times

    def __call__(self, request: Json) -> Canned:
        if about(request) == self.question and self.times > 0:
            self.times -= 1
            return self.fault
        return self.brain(request)


NO_VERDICT = {
    "overload": fault(503, "The server is overloaded."),
    "gateway": fault(502, "bad gateway"),
    "limit": fault(429, "slow down", {"Retry-After": "61"}),
    "reset": Canned(cut=True),
    "slow": Canned(delay_s=2.0),
    "account": fault(402, "tool calls take credit"),
    "key": fault(403, "images are not for you"),
    "too long": fault(400, "this model's maximum context length is 8 tokens, tools included"),
    "other": fault(400, "your organisation must be verified"),
    "empty": completion(""),
}


@pytest.mark.parametrize("why", NO_VERDICT)
@pytest.mark.parametrize("question", ["pictures", "tool", "schema"])
def test_a_question_that_a_passing_fault_swallowed_is_asked_again(question: str, why: str) -> None:
    if why == "slow" and question != "tool":
        pytest.skip("one is enough")
    times = 1 if why in ("limit", "account", "key", "too long", "other", "empty") else 2
    retry = replace(QUICK, timeout_s=1.0) if why == "slow" else QUICK
    with FakeProvider(Shaky(question, NO_VERDICT[why], times)) as server:
        found = probe(server.uri(), retry)
    assert found.is_complete and found.unanswered == ()
    assert (found.tools, found.pictures) == (ToolSupport.NATIVE, Support.YES)
    assert (found.schema, found.result_pictures) == (Support.YES, Support.YES)


@pytest.mark.parametrize("why", ["overload", "gateway", "limit", "account", "other", "empty"])
def test_what_was_not_answered_is_unknown_and_asked_next_time(why: str) -> None:
    shaky = Shaky("tool", NO_VERDICT[why], 99)
    with FakeProvider(shaky) as server:
        with pytest.raises(ModelError, match=r"not answered .*--tool-calls native"):
            create_model(server.uri(), QUICK)
        found = load_capabilities(server.uri())
        assert found is not None
        assert (found.tools, found.rung, found.is_complete) == (ToolSupport.UNKNOWN, None, False)
        assert (found.pictures, found.schema) == (Support.YES, Support.YES)
        assert found.result_pictures is Support.UNKNOWN
        assert "tool calls: " in found.unanswered[0]
        before, shaky.times = len(server.requests), 0
        model = create_model(server.uri(), QUICK)
        # Only what was unknown is asked: the tool, and the picture in its result.
        assert [about(r) for r in server.requests[before:]] == ["tool", "result"]
        known = model.info.capabilities
        assert known is not None and known.is_complete
        assert (model.info.rung, known.result_pictures) == (Rung.NATIVE, Support.YES)
        create_model(server.uri(), QUICK)
        assert len(server.requests) == before + 2


def test_a_picture_that_was_not_answered_stops_no_run() -> None:
    with FakeProvider(Shaky("pictures", fault(502, "bad gateway"), 99)) as server:
        model = create_model(server.uri(), QUICK)
    known = model.info.capabilities
    assert known is not None
    assert (known.pictures, known.result_pictures) == (Support.UNKNOWN, Support.UNKNOWN)
    assert model.info.rung is Rung.NATIVE


@pytest.mark.parametrize(
    ("question", "status", "words"),
    [
        ("tool", 404, "No endpoints found that support tool use."),
        ("tool", 400, "registry.ollama.ai/library/x does not support tools"),
        ("tool", 400, ""),
        ("tool", 422, "Unprocessable Entity"),
        ("pictures", 404, "No endpoints found that support image input"),
        ("pictures", 400, "messages[0]: unknown variant `image_url`, expected `text`"),
        ("pictures", 422, "Input should be a valid string"),
    ],
)
def test_an_error_about_the_feature_is_an_answer(question: str, status: int, words: str) -> None:
    with FakeProvider(Shaky(question, fault(status, words), 99)) as server:
        found = probe(server.uri(), QUICK)
    refused = found.tools if question == "tool" else found.pictures
    assert refused == Support.REFUSED
    assert found.is_complete


def test_what_was_found_is_stored_for_the_next_time() -> None:
    brain = Brain(tools="400")
    with FakeProvider(brain) as server:
        first = create_model(server.uri(), QUICK)
        asked = len(brain.asked)
        second = create_model(server.uri(), QUICK)
    assert len(brain.asked) == asked
    assert isinstance(first, Ladder) and isinstance(second, Ladder)
    assert first.info.rung is second.info.rung is Rung.SCHEMA
    assert first.info.capabilities == second.info.capabilities == load_capabilities(server.uri())


@pytest.mark.parametrize(
    ("tools", "rung"), [("native", Rung.NATIVE), ("schema", Rung.SCHEMA), ("react", Rung.REACT)]
)
def test_a_way_that_is_named_is_taken_without_a_probe(tools: str, rung: Rung) -> None:
    model = create_model("openai:tiny@http://127.0.0.1:9/v1", tools=tools)
    assert isinstance(model, Ladder)
    assert (model.info.rung, model.info.capabilities) == (rung, None)


def test_an_unknown_way_is_refused_with_a_list() -> None:
    with pytest.raises(ModelConfigError, match="auto, native, schema, react"):
        create_model("openai:tiny@http://127.0.0.1:9/v1", tools="magic")


FOUND = Capabilities(
    "openai:a@http://127.0.0.1:9/v1",
    Rung.REACT,
    ToolSupport.NONE,
    Support.NO,
    Support.YES,
    Support.UNTESTED,
    ("top_p",),
    5,
    Usage(1, 2, 3, 4),
    1.5,
    "2026-01-01T00:00:00+00:00",
)


def test_a_damaged_or_foreign_file_is_ignored(own_cache: Path) -> None:
    save_capabilities(FOUND)
    assert load_capabilities(FOUND.uri) == FOUND
    assert load_capabilities("openai:b@http://127.0.0.1:9/v1") is None
    (file,) = (own_cache / "models").iterdir()
    whole = file.read_bytes()
    for damaged in (whole[:40], b"", b"\xff\xfe", whole.replace(b"react", b"magic")):
        file.write_bytes(damaged)
        assert load_capabilities(FOUND.uri) is None
    save_capabilities(replace(FOUND, uri=FOUND.uri))
    assert load_capabilities(FOUND.uri) == FOUND


def test_a_cache_that_cannot_be_written_is_no_error(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    blocked = tmp_path / "file"
    blocked.write_text("")
    monkeypatch.setenv("ADAMO_VH_CACHE_DIR", str(blocked))
    save_capabilities(FOUND)
    assert load_capabilities(FOUND.uri) is None
