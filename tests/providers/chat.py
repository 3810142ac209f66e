"""OpenAI chat completions, as every compatible server speaks them."""

from __future__ import annotations

import json
from collections.abc import Iterator, Sequence
from typing import Any

from tests.fake_provider import Canned, Json
from tests.providers.dialect import CACHED, INPUT, OUTPUT, REASONING, Call, Said, unbase64


def raw_arguments(arguments: Json | str) -> str:
    """Arguments as a model writes them."""
    return arguments if isinstance(arguments, str) else json.dumps(arguments)


def openai_error(status: int, message: str, param: str | None = None) -> Canned:
    """An error of both OpenAI wires."""
    error = {"message": message, "type": "invalid_request_error", "param": param, "code": None}
    return Canned({"error": error}, status)


def _call(id: str, name: str, arguments: Json | str) -> Json:
    function = {"name": name, "arguments": raw_arguments(arguments)}
    return {"id": id, "type": "function", "function": function}


class Chat:
    """OpenAI chat completions."""

    name = "openai-chat"
    model = "tiny-vlm"
    path = "/v1/chat/completions"
    pictures_in_results = False

    def answer(
        self, text: str = "", calls: Sequence[Call] = (), thinking: str = "", **message: Any
    ) -> Canned:
        content: Json = {"role": "assistant", "content": text or None, **message}
        if thinking:
            content["reasoning_content"] = thinking
        if calls:
            content["tool_calls"] = [_call(*call) for call in calls]
        usage = {
            "prompt_tokens": INPUT,
            "completion_tokens": OUTPUT,
            "total_tokens": INPUT + OUTPUT,
            "prompt_tokens_details": {"cached_tokens": CACHED},
            "completion_tokens_details": {"reasoning_tokens": REASONING},
        }
        choice = {"index": 0, "finish_reason": "stop", "message": content}
        return Canned(
            {
                "id": "chatcmpl-1",
                "object": "chat.completion",
                "created": 1,
                "model": self.model,
                "choices": [choice],
                "usage": usage,
            }
        )

    def ended(self, reason: str, text: str = "", calls: Sequence[Call] = ()) -> Canned:
        body = self.answer(text, calls).body
        assert isinstance(body, dict)
        body["choices"][0]["finish_reason"] = reason
        return Canned(body)

    def refusal(self) -> Canned:
        return self.answer(refusal="I will not.")

    def error(self, status: int, message: str, param: str | None = None) -> Canned:
        return openai_error(status, message, param)

    def hidden_error(self, status: int, message: str) -> Canned:
        error = {"code": status, "message": message}
        return Canned({"choices": [{"error": error, "finish_reason": "error", "message": {}}]})

    def read(self, request: Json) -> Iterator[Said]:
        for message in request["messages"]:
            role, content = message["role"], message["content"]
            if message.get("reasoning_content"):
                yield Said(role, "thinking", message["reasoning_content"])
            pieces: list[Json] = content or []
            if isinstance(content, str):
                pieces = [{"type": "text", "text": content}]
            for piece in pieces:
                if role == "tool":
                    assert piece["type"] == "text"
                    yield Said(role, "result", piece["text"], message["tool_call_id"])
                elif piece["type"] == "text":
                    yield Said(role, "text", piece["text"])
                else:
                    yield Said(role, "image", data=unbase64(piece["image_url"]["url"]))
            for call in message.get("tool_calls", ()):
                function = call["function"]
                arguments = json.loads(function["arguments"])
                yield Said(role, "call", function["name"], call["id"], value=arguments)

    def tools(self, request: Json) -> Json:
        functions = [tool["function"] for tool in request["tools"]]
        return {function["name"]: function["parameters"] for function in functions}

    def settings(self, request: Json) -> Json:
        return request

    def schema(self, request: Json) -> Json | None:
        found = request.get("response_format")
        return found and found["json_schema"]["schema"]
