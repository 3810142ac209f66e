"""OpenAI Responses."""

from __future__ import annotations

import json
from collections.abc import Iterator, Sequence
from typing import Any

from tests.fake_provider import Canned, Json
from tests.providers.chat import openai_error, raw_arguments
from tests.providers.dialect import CACHED, INPUT, OUTPUT, REASONING, Call, Said, unbase64


class Responses:
    """OpenAI Responses."""

    name = "openai-responses"
    model = "gpt-5.1"
    path = "/v1/responses"
    pictures_in_results = True

    def answer(
        self, text: str = "", calls: Sequence[Call] = (), thinking: str = "", refusal: str = ""
    ) -> Canned:
        output: list[Json] = []
        if thinking:
            output.append(
                {
                    "type": "reasoning",
                    "id": "rs_1",
                    "summary": [],
                    "encrypted_content": thinking,
                }
            )
        content: list[Json] = []
        if text:
            content.append({"type": "output_text", "text": text, "annotations": []})
        if refusal:
            content.append({"type": "refusal", "refusal": refusal})
        if content:
            output.append(
                {
                    "type": "message",
                    "id": "msg_1",
                    "role": "assistant",
                    "status": "completed",
                    "content": content,
                }
            )
        output += [
            {
                "type": "function_call",
                "id": f"fc_{id}",
                "call_id": id,
                "name": name,
                "arguments": raw_arguments(args),
                "status": "completed",
            }
            for id, name, args in calls
        ]
        usage = {
            "input_tokens": INPUT,
            "output_tokens": OUTPUT,
            "total_tokens": INPUT + OUTPUT,
            "input_tokens_details": {"cached_tokens": CACHED, "cache_write_tokens": 0},
            "output_tokens_details": {"reasoning_tokens": REASONING},
        }
        return Canned({**self._frame(), "output": output, "usage": usage})

    def _frame(self) -> Json:
        return {
            "id": "resp_1",
            "object": "response",
            "created_at": 1,
            "model": self.model,
            "status": "completed",
            "error": None,
            "parallel_tool_calls": False,
            "tool_choice": "auto",
            "tools": [],
            "output": [],
        }

    def ended(self, reason: str, text: str = "", calls: Sequence[Call] = ()) -> Canned:
        body = self.answer(text, calls).body
        assert isinstance(body, dict)
        return Canned({**body, "status": "incomplete", "incomplete_details": {"reason": reason}})

    def refusal(self) -> Canned:
        return self.answer(refusal="I will not.")

    def error(self, status: int, message: str, param: str | None = None) -> Canned:
        return openai_error(status, message, param)

    def hidden_error(self, status: int, message: str) -> Canned:
        error = {"code": status, "message": message}
        return Canned({**self._frame(), "status": "failed", "error": error})

    def read(self, request: Json) -> Iterator[Said]:
        for item in request["input"]:
            kind = item.get("type", "message")
            if kind == "reasoning":
                yield Said("assistant", "thinking", item["encrypted_content"], item.get("id", ""))
            elif kind == "function_call":
                arguments = json.loads(item["arguments"])
                yield Said("assistant", "call", item["name"], item["call_id"], value=arguments)
            elif kind == "function_call_output":
                for piece in self._pieces(item["output"]):
                    yield self._piece("tool", piece, item["call_id"])
            else:
                for piece in self._pieces(item["content"]):
                    yield self._piece(item["role"], piece)

    def _pieces(self, content: Any) -> list[Json]:
        return [{"type": "input_text", "text": content}] if isinstance(content, str) else content

    def _piece(self, role: str, piece: Json, id: str = "") -> Said:
        if piece["type"] == "input_image":
            return Said(role, "image", id=id, data=unbase64(piece["image_url"]))
        return Said(role, "result" if id else "text", piece["text"], id)

    def tools(self, request: Json) -> Json:
        return {tool["name"]: tool["parameters"] for tool in request["tools"]}

    def settings(self, request: Json) -> Json:
        return request

    def schema(self, request: Json) -> Json | None:
        found = request.get("text")
        return found and found["format"]["schema"]
