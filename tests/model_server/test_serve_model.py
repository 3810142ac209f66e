"""A local model as an OpenAI-compatible endpoint, asked over a real socket."""

from __future__ import annotations

import base64
import io
import json
import socket
import threading
from collections.abc import Iterator
from typing import Any

import httpx
import openai
import pytest
from PIL import Image

from adamo_vh.errors import ConfigError
from adamo_vh.inference.messages import (
    AIMessage,
    HumanMessage,
    ImagePart,
    SystemMessage,
    TextPart,
    ToolCall,
    ToolMessage,
)
from adamo_vh.inference.players.scripted import ScriptedModel
from adamo_vh.model_server.model_serving import ServedModel, serve_model
from adamo_vh.model_server.openai_messages import read_request

Json = dict[str, Any]

LOOK: Any = {"type": "function", "function": {"name": "Look", "parameters": {"type": "object"}}}
PICK: Any = {"type": "function", "function": {"name": "Pick", "parameters": {"type": "object"}}}
CALL = ToolCall("call_7", "Pick", {"object": "Plate_57"}, '{"object": "Plate_57"}')


def picture_uri(size: tuple[int, int] = (8, 6), form: str = "PNG") -> str:
    data = io.BytesIO()
    Image.new("RGB", size, "red").save(data, form)
    return f"data:image/{form.lower()};base64,{base64.b64encode(data.getvalue()).decode()}"


def user(content: Any) -> Any:
    return {"role": "user", "content": content}


def picture(url: str) -> Json:
    return {"type": "image_url", "image_url": {"url": url}}


@pytest.fixture(scope="module")
def served() -> Iterator[ServedModel]:
    with serve_model("baseline", max_body_bytes=100_000) as found:
        yield found


def client(served: ServedModel) -> openai.OpenAI:
    return openai.OpenAI(base_url=served.base_url, api_key="any", max_retries=0)


def post(served: ServedModel, body: Any) -> httpx.Response:
    content = body if isinstance(body, bytes) else json.dumps(body).encode()
    headers = {"content-type": "application/json"}
    url = f"{served.base_url}/chat/completions"
    return httpx.post(url, content=content, headers=headers, timeout=10)


def test_the_openai_client_gets_a_note_and_a_call(served: ServedModel) -> None:
    answer = client(served).chat.completions.create(
        model="baseline", messages=[user("Pick up the key")], tools=[LOOK, PICK], temperature=0
    )
    choice = answer.choices[0]
    assert choice.finish_reason == "tool_calls"
    assert choice.message.content and choice.message.content.startswith("Evidence: ")
    assert choice.message.tool_calls
    call = choice.message.tool_calls[0]
    assert call.type == "function" and call.function.name == "Look"
    assert set(json.loads(call.function.arguments)) == {"x", "y", "z"}
    assert answer.usage is not None
    assert answer.usage.prompt_tokens > 0 and answer.usage.completion_tokens > 0


def test_a_stream_says_the_same_as_one_piece(served: ServedModel) -> None:
    asked: Json = {"model": "m", "messages": [user("Pick up the key")], "tools": [LOOK]}
    whole = client(served).chat.completions.create(**asked).choices[0]
    chunks = list(
        client(served).chat.completions.create(
            **asked, stream=True, stream_options={"include_usage": True}
        )
    )
    *parts, last = chunks
    deltas = [part.choices[0].delta for part in parts]
    calls: list[Any] = [call for delta in deltas for call in delta.tool_calls or ()]
    made: Any = whole.message.tool_calls
    assert deltas[0].role == "assistant"
    assert "".join(delta.content or "" for delta in deltas) == whole.message.content
    assert [call.index for call in calls] == [0]
    assert calls[0].function.arguments == made[0].function.arguments
    assert parts[-1].choices[0].finish_reason == "tool_calls"
    assert last.choices == [] and last.usage is not None
    raw = post(served, {**asked, "stream": True})
    assert raw.headers["content-type"].startswith("text/event-stream")
    assert raw.text.endswith("data: [DONE]\n\n")


def test_models_and_health_are_told(served: ServedModel) -> None:
    assert [model.id for model in client(served).models.list()] == ["baseline"]
    assert client(served).models.retrieve("baseline").owned_by == "adamo"
    health = httpx.get(served.base_url.removesuffix("/v1") + "/health").json()
    assert health == {"status": "ok", "model": "baseline", "kind": "rule-based", "tools": True}


def test_a_conversation_arrives_as_it_was_meant() -> None:
    call = {
        "id": "call_7",
        "type": "function",
        "function": {"name": "Pick", "arguments": '{"object": "Plate_57"}'},
    }
    asked = read_request(
        {
            "model": "m",
            "messages": [
                {"role": "system", "content": "Rules."},
                {"role": "developer", "content": [{"type": "text", "text": "State."}]},
                user([{"type": "text", "text": "Take it."}, picture(picture_uri((8, 6)))]),
                {"role": "assistant", "content": "Memory: a.\n", "tool_calls": [call]},
                {"role": "tool", "tool_call_id": "call_7", "content": "Done."},
                user([{"type": "text", "text": "New view."}, picture(picture_uri((5, 4), "JPEG"))]),
            ],
            "tools": [LOOK, PICK],
            "temperature": 0.5,
            "top_p": 1,
            "max_completion_tokens": 12,
            "max_tokens": 99,
        }
    )
    first, frame = asked.messages[2], asked.messages[5]
    assert asked.messages[:2] == (SystemMessage("Rules."), SystemMessage("State."))
    assert isinstance(first, HumanMessage) and isinstance(frame, HumanMessage)
    assert first.parts[0] == TextPart("Take it.")
    assert isinstance(first.parts[1], ImagePart) and isinstance(frame.parts[1], ImagePart)
    assert (first.parts[1].width_px, first.parts[1].height_px) == (8, 6)
    assert (frame.parts[1].media_type, frame.parts[1].width_px) == ("image/jpeg", 5)
    assert asked.messages[3] == AIMessage("Memory: a.\n", (CALL,))
    assert asked.messages[4] == ToolMessage("call_7", "Pick", "Done.")
    assert [tool.name for tool in asked.tools] == ["Look", "Pick"]
    assert asked.tools[0].parameters == {"type": "object", "properties": {}}
    assert (asked.sampling.temperature, asked.sampling.top_p) == (0.5, 1)
    assert asked.sampling.max_tokens == 12
    assert {"top_p", "image_url"} <= asked.parameters


def test_pictures_behind_the_results_come_back_into_them() -> None:
    def call(name: str) -> Any:
        about = {"name": "Pick", "arguments": "{}"}
        return {"id": name, "type": "function", "function": about}

    shown = picture(picture_uri((5, 4)))
    told = [
        {"type": "text", "text": "Picture from Pick (b):"},
        shown,
        {"type": "text", "text": "Go on."},
        shown,
    ]
    messages = [
        user("Take both."),
        {"role": "assistant", "content": None, "tool_calls": [call("a"), call("b")]},
        {"role": "tool", "tool_call_id": "a", "content": "Done."},
        {"role": "tool", "tool_call_id": "b", "content": "Done."},
        user(told[:2]),
        user(told),
    ]
    found = read_request({"model": "m", "messages": messages}).messages
    assert [message.role for message in found] == ["human", "ai", "tool", "tool", "human"]
    first, second, rest = found[2:]
    assert isinstance(first, ToolMessage) and not first.images
    assert isinstance(second, ToolMessage) and len(second.images) == 2
    assert isinstance(rest, HumanMessage) and rest.text == "Go on." and len(rest.parts) == 2


@pytest.mark.parametrize(
    ("choice", "names"),
    [
        ("auto", ["Look", "Pick"]),
        ("required", ["Look", "Pick"]),
        ("none", []),
        ({"type": "function", "function": {"name": "Pick"}}, ["Pick"]),
    ],
)
def test_tool_choice_says_what_is_on_offer(choice: Any, names: list[str]) -> None:
    body = {"model": "m", "messages": [user("x")], "tools": [LOOK, PICK], "tool_choice": choice}
    assert [tool.name for tool in read_request(body).tools] == names


ANSWERED = {"role": "tool", "tool_call_id": "call_9", "content": "Done."}
ASKING = {
    "role": "assistant",
    "content": None,
    "tool_calls": [
        {"id": "call_7", "type": "function", "function": {"name": "Pick", "arguments": "{}"}}
    ],
}


@pytest.mark.parametrize(
    ("change", "field", "fix"),
    [
        ({"messages": None}, "messages", "must be a list"),
        ({"messages": []}, "messages", "at least one"),
        ({"model": 3}, "model", "must be a text"),
        ({"messages": [{"role": "robot", "content": "x"}]}, "messages[0].role", "use system"),
        ({"messages": [{"role": "user"}]}, "messages[0].content", "is missing"),
        ({"messages": [user([{"type": "audio"}])]}, "messages[0].content[0].type", "use text"),
        (
            {"messages": [user([picture("https://example.com/a.png")])]},
            "messages[0].content[0].image_url.url",
            "never fetched",
        ),
        (
            {"messages": [user([picture("data:image/png;base64,AAAA")])]},
            "messages[0].content[0].image_url.url",
            "no picture",
        ),
        ({"messages": [user("x"), ANSWERED]}, "messages[1].tool_call_id", "call_9"),
        ({"messages": [user("x"), ASKING]}, "messages", "call_7"),
        ({"messages": [user("x"), ASKING, user("y")]}, "messages[2]", "followed by"),
        ({"n": 2}, "n", "set it to 1"),
        ({"temperature": 3}, "temperature", "from 0 to 2"),
        ({"top_p": "much"}, "top_p", "a number"),
        ({"max_tokens": 0}, "max_tokens", "at least 1"),
        ({"tools": [{"type": "web"}]}, "tools[0].type", "use function"),
        ({"tool_choice": "maybe"}, "tool_choice", "required"),
        (
            {"tool_choice": {"type": "function", "function": {"name": "Fly"}}},
            "tool_choice.function.name",
            "Fly",
        ),
        ({"response_format": {"type": "xml"}}, "response_format.type", "json_schema"),
    ],
)
def test_a_wrong_request_is_told_its_field_and_the_fix(
    served: ServedModel, change: Json, field: str, fix: str
) -> None:
    answer = post(served, {"model": "m", "messages": [user("x")], **change})
    error = answer.json()["error"]
    assert answer.status_code == 400
    assert (error["type"], error["param"]) == ("invalid_request_error", field)
    assert fix in error["message"]


def test_what_is_no_json_too_large_or_elsewhere_is_refused(served: ServedModel) -> None:
    assert post(served, b"{").json()["error"]["param"] == "body"
    large = post(served, {"model": "m", "messages": [user("x" * 100_000)]})
    assert large.status_code == 413
    assert "100000 bytes" in large.json()["error"]["message"]
    lost = httpx.get(f"{served.base_url}/embeddings")
    assert (lost.status_code, "POST /v1/chat" in lost.json()["error"]["message"]) == (404, True)
    stranger = httpx.get(f"{served.base_url}/models", headers={"Host": "evil.example"})
    assert stranger.status_code == 403


def test_an_own_model_is_asked_one_request_at_a_time() -> None:
    replies = [AIMessage(str(number)) for number in range(8)]
    with serve_model(ScriptedModel("mine", replies)) as served:
        said: list[str] = []

        def ask() -> None:
            said.append(post(served, {"model": "m", "messages": [user("x")]}).json()["id"])

        threads = [threading.Thread(target=ask) for _ in replies]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        assert sorted(said) == sorted(f"chatcmpl-{number}" for number in range(1, 9))


def test_a_model_that_fails_is_an_error_of_the_server() -> None:
    class Failing(ScriptedModel):
        def complete(self, *_: Any) -> Any:
            raise ZeroDivisionError("by zero")

    with serve_model(Failing("failing", ())) as served:
        answer = post(served, {"model": "m", "messages": [user("x")]})
    assert answer.status_code == 500
    assert "ZeroDivisionError: by zero" in answer.json()["error"]["message"]


def test_nothing_is_served_to_other_machines_or_on_a_taken_port() -> None:
    with pytest.raises(ConfigError, match="other machines"), serve_model(host="0.0.0.0"):
        pass
    with pytest.raises(ConfigError, match="no local model"), serve_model("openai:gpt-4o"):
        pass
    with socket.create_server(("127.0.0.1", 0)) as taken:
        port = taken.getsockname()[1]
        with pytest.raises(ConfigError, match=f"Port {port}"), serve_model(port=port):
            pass


def test_it_stops_with_its_block_and_frees_the_port() -> None:
    with serve_model() as served:
        assert httpx.get(f"{served.base_url}/models").status_code == 200
    with pytest.raises(httpx.ConnectError):
        httpx.get(f"{served.base_url}/models")


def test_a_foreign_page_cannot_drive_a_model(served: ServedModel) -> None:
    body = json.dumps({"model": "m", "messages": [user("Hello")]})
    url = f"{served.base_url}/chat/completions"
    foreign = {"origin": "https://evil.example", "content-type": "text/plain"}
    answer = httpx.post(url, content=body, headers=foreign, timeout=10)
    assert answer.status_code == 403 and "evil.example" in answer.json()["error"]["message"]
    plain = httpx.post(url, content=body, headers={"content-type": "text/plain"}, timeout=10)
    assert plain.status_code == 415


def test_a_limit_of_tokens_cuts_the_answer_off(served: ServedModel) -> None:
    asked: Json = {"model": "m", "messages": [user("Pick up the key")], "tools": [LOOK]}
    whole = post(served, asked).json()["choices"][0]
    for name in ("max_tokens", "max_completion_tokens"):
        cut = post(served, {**asked, name: 5}).json()
        choice = cut["choices"][0]
        assert choice["finish_reason"] == "length"
        assert "tool_calls" not in choice["message"]
        assert whole["message"]["content"].startswith(choice["message"]["content"])
        assert 0 < cut["usage"]["completion_tokens"] <= 5
    assert post(served, {**asked, "max_tokens": 4000}).json()["choices"][0] == whole


@pytest.mark.parametrize("fields", [{"stream": 1}, {"stream": "true"}, {"stream": []}])
def test_a_flag_is_true_or_false(served: ServedModel, fields: Json) -> None:
    answer = post(served, {"model": "m", "messages": [user("Hello")], **fields})
    assert answer.status_code == 400 and answer.json()["error"]["param"] == "stream"
    options = {"stream": True, "stream_options": {"include_usage": 1}}
    assert post(served, {"model": "m", "messages": [user("Hi")], **options}).status_code == 400
