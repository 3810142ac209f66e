"""What goes over the wire to a provider, what comes back, and that the key goes nowhere else."""

from __future__ import annotations

import asyncio
import base64
import json
import logging
import traceback
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor

import pytest
from tests.fake_provider import Answers, Canned, FakeProvider, Json, call, completion, fault

from adamo_vh.action import Drop, Look, Pick, Walk, tool_schema
from adamo_vh.errors import ProviderError
from adamo_vh.inference.messages import (
    AIMessage,
    HumanMessage,
    ImagePart,
    Message,
    SystemMessage,
    TextPart,
    ToolCall,
    ToolMessage,
)
from adamo_vh.inference.model import ModelKind, Reply, Sampling, Usage
from adamo_vh.inference.remote.endpoint import NO_REMOTE
from adamo_vh.inference.remote.provider import ProviderModel
from adamo_vh.inference.remote.retry import RetryPolicy

KEY = "hush-5f0c2b7e91d4"
TOOLS = [tool_schema(action) for action in (Look, Walk, Pick, Drop)]
FRAME = ImagePart(b"\xff\xd8\xff\xe0 first frame", "image/jpeg", 1920, 1080)
LATER = ImagePart(b"\xff\xd8\xff\xe0 second frame", "image/jpeg", 1920, 1080)
ASK: tuple[Message, ...] = (
    SystemMessage("You live in a body."),
    SystemMessage("Plate_57 at (0.2, -1.0, 0.8)."),
    HumanMessage((TextPart("Pick the plate"), FRAME)),
)
STEP: tuple[Message, ...] = (
    AIMessage("I turn to it.", (ToolCall("call_a", "Look", {"x": 0.2, "y": -1, "z": 0.8}),)),
    ToolMessage("call_a", "Look", "You look at (0.20, -1.00, 0.80)."),
    HumanMessage((LATER,)),
)
QUICK = RetryPolicy(max_tries=3, max_wait_s=5.0, base_s=0.001, timeout_s=5.0)


@pytest.fixture(autouse=True)
def offline(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(NO_REMOTE, "1")
    monkeypatch.setenv("OPENAI_API_KEY", KEY)


def ask(
    answers: Answers,
    messages: Sequence[Message] = ASK,
    sampling: Sampling | None = None,
) -> tuple[Reply, list[Json]]:
    with FakeProvider(answers) as server:
        model = ProviderModel(server.uri(), QUICK)
        try:
            return model.complete(messages, TOOLS, sampling or Sampling()), server.requests
        finally:
            model.close()


def url(image: ImagePart) -> Json:
    data = base64.b64encode(image.data).decode()
    return {"type": "image_url", "image_url": {"url": f"data:image/jpeg;base64,{data}"}}


def test_a_whole_conversation_arrives_in_its_roles_and_order() -> None:
    _, (request,) = ask([completion("ok")], ASK + STEP)
    *before, assistant, tool, frame = request["messages"]
    assert before == [
        {"role": "system", "content": "You live in a body."},
        {"role": "system", "content": "Plate_57 at (0.2, -1.0, 0.8)."},
        {"role": "user", "content": [{"type": "text", "text": "Pick the plate"}, url(FRAME)]},
    ]
    (sent,) = assistant.pop("tool_calls")
    assert assistant == {"role": "assistant", "content": "I turn to it."}
    assert (sent["id"], sent["type"], sent["function"]["name"]) == ("call_a", "function", "Look")
    assert json.loads(sent["function"]["arguments"]) == {"x": 0.2, "y": -1, "z": 0.8}
    assert tool == {
        "role": "tool",
        "tool_call_id": "call_a",
        "content": "You look at (0.20, -1.00, 0.80).",
    }
    assert frame == {"role": "user", "content": [url(LATER)]}


def test_tools_arrive_exactly_as_their_schemas() -> None:
    _, (request,) = ask([completion("ok")])
    assert request["tools"] == [
        {
            "type": "function",
            "function": {
                "name": tool.name,
                "description": tool.description,
                "parameters": tool.parameters,
            },
        }
        for tool in TOOLS
    ]
    assert request["tool_choice"] == "auto"
    assert request["parallel_tool_calls"] is False


@pytest.mark.parametrize(
    ("sampling", "sent"),
    [
        (Sampling(), {"temperature": 0, "max_tokens": 4000}),
        (Sampling(0.3, 0.5, 99), {"temperature": 0.3, "top_p": 0.5, "max_tokens": 99}),
        (Sampling(0.0, 0.9), {"temperature": 0, "top_p": 0.9, "max_tokens": 4000}),
    ],
)
def test_sampling_arrives_and_greedy_decoding_goes_without_top_p(
    sampling: Sampling, sent: Json
) -> None:
    _, (request,) = ask([completion("ok")], sampling=sampling)
    names = ("temperature", "top_p", "max_tokens", "max_completion_tokens")
    assert {name: request[name] for name in names if name in request} == sent
    assert request["model"] == "tiny-vlm"
    assert request["stream"] is False


def test_openai_itself_is_asked_through_the_same_bytes(monkeypatch: pytest.MonkeyPatch) -> None:
    """`openai:NAME` differs in the name of the token limit alone."""
    monkeypatch.delenv(NO_REMOTE)
    with FakeProvider(lambda _: completion("ok")) as server:
        monkeypatch.setenv("OPENAI_BASE_URL", server.base_url)
        for uri in ("openai:gpt-4o", server.uri("gpt-4o")):
            model = ProviderModel(uri, QUICK)
            model.complete(ASK + STEP, TOOLS, Sampling())
            model.close()
        own, compatible = server.requests
        assert server.paths == ["/v1/chat/completions"] * 2
    assert own.pop("max_completion_tokens") == compatible.pop("max_tokens") == 4000
    assert own == compatible


def test_a_note_and_a_call_come_back_with_usage_and_time() -> None:
    reply, _ = ask([completion("I take it.", [call("Pick", {"object": "Plate_57"})], cached=1024)])
    assert reply.message == AIMessage(
        "I take it.",
        (ToolCall("call_a", "Pick", {"object": "Plate_57"}, '{"object": "Plate_57"}'),),
    )
    assert reply.usage == Usage(1200, 34, 1024)
    assert 0 < reply.seconds < 5
    assert reply.waited_s < 0.1


@pytest.mark.parametrize("raw", ["{x: 1", "[1]", '"Plate_57"', '{"x": NaN}', "null"])
def test_bad_arguments_come_back_as_none_and_go_out_as_valid_json(raw: str) -> None:
    reply, _ = ask([completion("n", [call("Look", raw)])])
    (bad,) = reply.message.calls
    assert (bad.arguments, bad.raw) == (None, raw)
    feedback = ToolMessage(bad.id, "Look", "The arguments are not a JSON object.")
    _, (request,) = ask([completion("ok")], (*ASK, reply.message, feedback))
    sent = request["messages"][-2]["tool_calls"][0]["function"]["arguments"]
    assert json.loads(sent, parse_constant=pytest.fail) == {"unreadable_arguments": raw}


def test_two_calls_are_both_kept_with_ids_of_their_own() -> None:
    two = [call("Pick", {"object": "a"}, "same"), call("Drop", {"object": "a"}, "same")]
    reply, _ = ask([completion("n", two)])
    assert [c.name for c in reply.message.calls] == ["Pick", "Drop"]
    assert len({c.id for c in reply.message.calls}) == 2


def test_ids_that_a_server_reuses_become_unique_in_the_conversation() -> None:
    reply, _ = ask([completion("n", [call("Pick", {"object": "a"}, "call_a")])], ASK + STEP)
    assert reply.message.calls[0].id != "call_a"


def test_an_unknown_tool_passes_through() -> None:
    reply, _ = ask([completion("n", [call("Fly", {"to": "moon"})])])
    assert reply.message.calls[0].name == "Fly"


@pytest.mark.parametrize("text", ["", None, "   \n"])
def test_an_empty_answer_is_an_empty_message(text: str | None) -> None:
    reply, _ = ask([completion(text)])
    assert reply.message == AIMessage("")


def test_thinking_is_left_out() -> None:
    reply, _ = ask([completion("<think>hm</think>I go.", reasoning_content="because")])
    assert reply.message.text == "I go."


def test_a_leaked_call_is_recognised_unless_there_is_a_native_one() -> None:
    leaked = 'I see it.\n```json\n{"name": "Pick", "arguments": {"object": "Plate_57"}}\n```'
    reply, _ = ask([completion(leaked)])
    assert reply.message.text == "I see it."
    assert reply.message.calls[0].arguments == {"object": "Plate_57"}
    reply, _ = ask([completion(leaked, [call("Look", {"x": 0, "y": 0, "z": 0})])])
    assert [c.name for c in reply.message.calls] == ["Look"]
    assert reply.message.text == leaked


@pytest.mark.parametrize(
    "message",
    [
        {"content": "Hi"},
        {"content": [{"type": "text", "text": "Hi"}]},
        {
            "content": "Hi",
            "tool_calls": [{"function": {"name": "Pick", "arguments": {"object": "a"}}}],
        },
        {
            "content": "Hi",
            "tool_calls": [
                {"id": None, "function": {"name": "Pick", "arguments": '{"object":"a"}'}}
            ],
        },
    ],
)
def test_the_terse_answers_of_small_servers_are_read(message: Json) -> None:
    body: Json = {"choices": [{"message": message}]}
    first, _ = ask([Canned(body)])
    again, _ = ask([Canned(body)])
    assert first.message == again.message
    assert first.message.text == "Hi"
    assert [c.arguments for c in first.message.calls] == (
        [{"object": "a"}] if "tool_calls" in message else []
    )


def test_lone_surrogates_neither_break_the_wire_nor_the_record() -> None:
    odd = (*ASK, HumanMessage((TextPart("tag \ud800"),)))
    reply, _ = ask([completion("n \ud800", [call("Pick", '{"object": "\\ud800"}')])], odd)
    assert (reply.message.text, reply.message.calls[0].arguments) == ("n ?", {"object": "?"})


def test_it_works_inside_a_running_loop_and_from_many_threads() -> None:
    with FakeProvider(lambda _: completion("ok")) as server:
        model = ProviderModel(server.uri(), QUICK)

        async def notebook_cell() -> Reply:
            return model.complete(ASK, TOOLS, Sampling())

        assert asyncio.run(notebook_cell()).message.text == "ok"
        with ThreadPoolExecutor(4) as pool:
            futures = [pool.submit(model.complete, ASK, TOOLS, Sampling()) for _ in range(8)]
        assert [future.result().message.text for future in futures] == ["ok"] * 8
        model.close()
        assert model.complete(ASK, TOOLS, Sampling()).message.text == "ok"
        model.close()


def test_the_key_goes_to_the_server_and_nowhere_else(
    caplog: pytest.LogCaptureFixture, capfd: pytest.CaptureFixture[str]
) -> None:
    caplog.set_level(logging.DEBUG)
    answers = [fault(500, f"echo {KEY}"), fault(401, f"Incorrect API key provided: {KEY}.")]
    with FakeProvider(answers) as server:
        model = ProviderModel(server.uri(), QUICK)
        with pytest.raises(ProviderError) as caught:
            model.complete(ASK, TOOLS, Sampling())
        model.close()
        assert [h["authorization"] for h in server.headers] == [f"Bearer {KEY}"] * 2
    trace = "".join(traceback.format_exception(caught.value))
    captured = capfd.readouterr()
    assert any(record.name.startswith("openai") for record in caplog.records)
    shown = [repr(model), str(model), str(model.info), trace]
    shown += [caplog.text, captured.out, captured.err]
    assert not any(KEY in text for text in shown)
    assert caught.value.__cause__ is None
    assert caught.value.__context__ is None
    assert "Check the API key" in str(caught.value)


def test_a_masked_key_in_a_server_message_is_blacked_out() -> None:
    with pytest.raises(ProviderError) as caught:
        ask([fault(401, "Incorrect API key provided: sk-proj-ab*****yz12.")])
    assert "sk-proj" not in str(caught.value)


def test_it_is_a_vlm_and_shows_only_its_name() -> None:
    model = ProviderModel("openai:tiny@http://127.0.0.1:9/v1")
    assert model.info.kind is ModelKind.VLM
    assert repr(model) == "ProviderModel('openai:tiny@http://127.0.0.1:9/v1')"
