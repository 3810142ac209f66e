"""The decoding settings that arrive, those that a server refuses, and what is said of them."""

from __future__ import annotations

import pytest
from tests.dialects import DIALECTS, Anthropic, Chat, Dialect, Responses, uri
from tests.fake_provider import Canned, FakeProvider, Json
from tests.talk import ASK, NAMES, QUICK, TOOLS, tell

from adamo_vh.action import Pick, tool_schema
from adamo_vh.errors import ProviderError, RefusedError
from adamo_vh.inference.messages import SystemMessage
from adamo_vh.inference.model import Sampling
from adamo_vh.inference.remote.provider import ProviderModel

every_wire = pytest.mark.parametrize("dialect", DIALECTS, ids=NAMES)

LIMIT = {
    "openai-chat": "max_tokens",
    "openai-responses": "max_output_tokens",
    "anthropic": "max_tokens",
    "google": "maxOutputTokens",
}
TOP_P = {"google": "topP"}


def sent(dialect: Dialect, request: Json) -> Json:
    """The decoding settings in a request's bytes, under our names."""
    found = dialect.settings(request)
    names = {"temperature": "temperature", "top_p": TOP_P.get(dialect.name, "top_p")}
    names["max_tokens"] = LIMIT[dialect.name]
    return {name: found[wire] for name, wire in names.items() if wire in found}


@every_wire
@pytest.mark.parametrize(
    ("sampling", "arrives"),
    [
        (Sampling(), {"temperature": 0, "max_tokens": 4000}),
        (Sampling(0.3, 0.5, 99), {"temperature": 0.3, "top_p": 0.5, "max_tokens": 99}),
        (Sampling(0.0, 0.9), {"temperature": 0, "top_p": 0.9, "max_tokens": 4000}),
        (Sampling(exact=True), {"temperature": 0, "top_p": 0, "max_tokens": 4000}),
    ],
)
def test_what_is_reported_is_what_arrived(
    dialect: Dialect, sampling: Sampling, arrives: Json
) -> None:
    told = tell(dialect, [dialect.answer("ok")], sampling=sampling)
    assert sent(dialect, told.requests[0]) == arrives
    reported = {**told.reply.settings}
    assert reported.pop("parallel_tool_calls", False) is False
    assert reported == arrives


def refusing(dialect: Dialect, name: str, words: str) -> Json:
    """A server that refuses a parameter by name, and what a model does about it."""

    def answer(request: Json) -> Canned:
        found = dialect.settings(request)
        refused = name in found
        return dialect.error(400, words, name) if refused else dialect.answer("ok")

    with FakeProvider(answer) as server, ProviderModel(uri(dialect, server), QUICK) as model:
        first = model.complete(ASK, TOOLS, Sampling(0.3, 0.5))
        again = model.complete(ASK, TOOLS, Sampling(0.3, 0.5))
        return {"first": first, "again": again, "requests": server.requests, "model": model}


@every_wire
@pytest.mark.parametrize("name", ["temperature", "top_p"])
def test_a_refused_parameter_is_dropped_once_and_remembered(dialect: Dialect, name: str) -> None:
    wire = TOP_P.get(dialect.name, name) if name == "top_p" else name
    found = refusing(dialect, wire, f"`{wire}` is not supported with this model.")
    assert (found["first"].requests, found["again"].requests) == (2, 1)
    assert len(found["requests"]) == 3
    assert found["model"].refused == {name}
    other = {"temperature": 0.3, "top_p": 0.5}
    del other[name]
    assert sent(dialect, found["requests"][1]) == {**other, "max_tokens": 4000}
    for reply in (found["first"], found["again"]):
        assert name not in reply.settings
        assert other.items() <= reply.settings.items()


def test_parallel_tool_calls_are_dropped_if_refused() -> None:
    words = "Unrecognized request argument supplied: parallel_tool_calls"
    found = refusing(Chat(), "parallel_tool_calls", words)
    assert found["model"].refused == {"parallel_tool_calls"}
    assert "parallel_tool_calls" not in found["again"].settings


def test_max_tokens_gives_way_to_max_completion_tokens() -> None:
    words = "Unsupported parameter: 'max_tokens' is not supported. Use 'max_completion_tokens'."
    found = refusing(Chat(), "max_tokens", words)
    assert found["model"].refused == {"max_tokens"}
    assert [request.get("max_completion_tokens") for request in found["requests"]] == [
        None,
        4000,
        4000,
    ]
    assert found["again"].settings["max_tokens"] == 4000


def test_a_server_that_knows_neither_limit_gets_none() -> None:
    def answer(request: Json) -> Canned:
        for name in ("max_tokens", "max_completion_tokens"):
            if name in request:
                return Chat().error(422, f"Extra inputs are not permitted: {name}")
        return Chat().answer("ok")

    told = tell(Chat(), answer)
    assert told.reply.requests == 3
    assert told.model.refused == {"max_tokens", "max_completion_tokens"}
    assert "max_tokens" not in told.reply.settings


def test_only_what_a_refusal_is_about_is_dropped() -> None:
    """Some servers echo the whole request, with every parameter in it."""
    about = {"loc": ["body", "top_p"], "msg": "must be in (0, 1]", "input": {"temperature": 0.3}}
    told = tell(
        Chat(),
        [Canned({"detail": [about]}, 422), Chat().answer("ok")],
        sampling=Sampling(0.3, 0.0),
    )
    assert told.model.refused == {"top_p"}
    echo = {"loc": ["body", "messages", 0], "msg": "bad", "input": {"temperature": 0.3}}
    with pytest.raises(RefusedError):
        tell(Chat(), [Canned({"detail": [echo]}, 422)])


def test_of_two_that_exclude_each_other_top_p_goes() -> None:
    words = "`temperature` and `top_p` cannot both be specified for this model. Please use one."
    told = tell(
        Anthropic(),
        [Anthropic().error(400, words), Anthropic().answer("ok")],
        sampling=Sampling(0.3, 0.5),
    )
    assert told.model.refused == {"top_p"}
    assert sent(Anthropic(), told.requests[1]) == {"temperature": 0.3, "max_tokens": 4000}


@every_wire
def test_what_is_known_to_be_refused_is_never_sent(dialect: Dialect) -> None:
    told = tell(
        dialect,
        [dialect.answer("ok")],
        sampling=Sampling(0.3, 0.5),
        refused=("temperature", "parallel_tool_calls"),
    )
    assert sent(dialect, told.requests[0]) == {"top_p": 0.5, "max_tokens": 4000}
    assert "parallel_tool_calls" not in told.reply.settings
    assert told.model.refused == {"temperature", "parallel_tool_calls"}


@every_wire
def test_exact_sends_both_and_a_refusal_names_the_other_profile(dialect: Dialect) -> None:
    refusal = dialect.error(400, "temperature and top_p cannot both be specified")
    with (
        FakeProvider([refusal]) as server,
        ProviderModel(uri(dialect, server), QUICK, refused=("temperature",)) as model,
    ):
        with pytest.raises(RefusedError, match="--profile paper"):
            model.complete(ASK, TOOLS, Sampling(exact=True))
        assert {"temperature": 0, "top_p": 0}.items() <= sent(dialect, server.requests[0]).items()
        assert len(server.requests) == 1


def test_a_setting_that_the_library_drops_is_not_reported(recwarn: pytest.WarningsRecorder) -> None:
    """Reasoning models take no temperature, and the client library knows them by name."""
    with (
        FakeProvider(lambda _: Responses().answer("ok")) as server,
        ProviderModel(f"openai-responses:o3@{server.base_url}", QUICK) as model,
    ):
        reply = model.complete(ASK, TOOLS, Sampling(0.3, 0.5))
        assert "temperature" not in server.requests[0]
        assert reply.settings == {"max_tokens": 4000, "parallel_tool_calls": False}
        with pytest.raises(ProviderError, match=r"does not send temperature.*--profile paper"):
            model.complete(ASK, TOOLS, Sampling(exact=True))
        assert len(server.requests) == 1


@every_wire
def test_what_cannot_be_left_out_is_raised(dialect: Dialect) -> None:
    for words in (
        "response_format is not supported by this model",
        "tools are not supported by this model",
        "Invalid schema for response_format 'step'",
    ):
        told = dialect.error(400, words)
        with pytest.raises(RefusedError, match=words.split(maxsplit=1)[0]):
            tell(dialect, [told], schema=tool_schema(Pick), tools=())


@every_wire
def test_several_calls_are_allowed_on_demand(dialect: Dialect) -> None:
    with (
        FakeProvider([dialect.answer("ok")]) as server,
        ProviderModel(uri(dialect, server), QUICK, several_calls=True) as model,
    ):
        reply = model.complete(ASK, TOOLS, Sampling())
        body = str(server.requests[0])
    assert reply.settings.get("parallel_tool_calls", True) is True
    assert "'parallel_tool_calls': False" not in body
    assert "'disable_parallel_tool_use': True" not in body


@every_wire
def test_without_tools_nothing_is_said_of_tools(dialect: Dialect) -> None:
    told = tell(dialect, [dialect.answer("ok")], tools=())
    assert not {"tools", "tool_choice", "toolConfig", "parallel_tool_calls"} & {*told.requests[0]}


def test_a_template_that_takes_one_system_message_gets_one() -> None:
    """Some chat templates refuse more, or a later one; small servers call it their fault."""

    def answer(request: Json) -> Canned:
        roles = [message["role"] for message in request["messages"]]
        if "system" in roles[1:]:
            return Chat().error(500, "Jinja Exception: System message must be at the beginning.")
        return Chat().answer("ok")

    late = SystemMessage("Now: Plate_57 in hand.")
    told = tell(Chat(), answer, (*ASK, late))
    assert told.reply.requests == 2
    assert told.model.refused == {"several_system_messages"}
    first, *_, last = told.said()
    assert (first.role, last.role, last.text) == ("system", "user", late.text)
    assert first.text == "You live in a body.\n\nPlate_57 at (0.2, -1.0, 0.8)."


def test_a_model_that_honours_no_schema_says_so() -> None:
    with (
        FakeProvider([]) as server,
        ProviderModel(f"anthropic:claude-3-haiku@{server.base_url}", QUICK) as model,
        pytest.raises(RefusedError, match="not supported"),
    ):
        model.complete(ASK, (), Sampling(), schema=tool_schema(Pick))


@pytest.mark.parametrize("cache", [True, False])
def test_anthropic_is_asked_for_a_cache_on_demand(cache: bool) -> None:
    dialect = Anthropic()
    with (
        FakeProvider([dialect.answer("ok")]) as server,
        ProviderModel(uri(dialect, server), QUICK, cache=cache) as model,
    ):
        model.complete(ASK, TOOLS, Sampling())
        assert ("cache_control" in str(server.requests[0])) is cache


@every_wire
def test_the_seed_goes_where_the_api_has_a_place_for_it(dialect: Dialect) -> None:
    with (
        FakeProvider([dialect.answer("ok")]) as server,
        ProviderModel(uri(dialect, server), QUICK, seed=7) as model,
    ):
        reply = model.complete(ASK, TOOLS, Sampling())
        arrived = dialect.settings(server.requests[0]).get("seed")
    assert arrived == reply.settings.get("seed")
    assert arrived == (7 if dialect.name in ("openai-chat", "google") else None)


def test_a_refused_seed_is_left_out() -> None:
    def answer(request: Json) -> Canned:
        refused = "seed" in request
        return Chat().error(400, "Unknown parameter: 'seed'.") if refused else Chat().answer("ok")

    with FakeProvider(answer) as server, ProviderModel(server.uri(), QUICK, seed=7) as model:
        reply = model.complete(ASK, TOOLS, Sampling())
        assert len(server.requests) == 2
    assert "seed" not in reply.settings and model.refused == {"seed"}
