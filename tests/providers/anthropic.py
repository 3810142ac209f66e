"""Anthropic Messages."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from tests.fake_provider import Canned, Json
from tests.providers.dialect import CACHED, INPUT, OUTPUT, REASONING, Call, Said, unbase64


class Anthropic:
    """Anthropic Messages."""

    name = "anthropic"
    model = "claude-sonnet-4-6"
    path = "/v1/messages"
    pictures_in_results = True

    def answer(
        self,
        text: str = "",
        calls: Sequence[Call] = (),
        thinking: str = "",
        stop_reason: str = "end_turn",
    ) -> Canned:
        content: list[Json] = []
        if thinking:
            content.append({"type": "thinking", "thinking": "I think.", "signature": thinking})
        if text:
            content.append({"type": "text", "text": text})
        content += [
            {"type": "tool_use", "id": id, "name": name, "input": args} for id, name, args in calls
        ]
        usage = {
            "input_tokens": INPUT - CACHED - 50,
            "cache_read_input_tokens": CACHED,
            "cache_creation_input_tokens": 50,
            "output_tokens": OUTPUT,
            "output_tokens_details": {"thinking_tokens": REASONING},
        }
        return Canned(
            {
                "id": "msg_1",
                "type": "message",
                "role": "assistant",
                "model": self.model,
                "content": content,
                "stop_reason": stop_reason,
                "stop_sequence": None,
                "usage": usage,
            }
        )

    def ended(self, reason: str, text: str = "", calls: Sequence[Call] = ()) -> Canned:
        return self.answer(text, calls, stop_reason=reason)

    def refusal(self) -> Canned:
        return self.answer(stop_reason="refusal")

    def error(self, status: int, message: str, param: str | None = None) -> Canned:
        kinds = {400: "invalid_request_error", 401: "authentication_error", 429: "rate_limit_error"}
        error = {"type": kinds.get(status, "api_error"), "message": message}
        return Canned({"type": "error", "error": error}, status)

    def hidden_error(self, status: int, message: str) -> Canned:
        return Canned(self.error(status, message).body)

    def read(self, request: Json) -> Iterator[Said]:
        if request.get("system"):
            yield Said("system", "text", request["system"])
        for message in request["messages"]:
            role, content = message["role"], message["content"]
            pieces = [{"type": "text", "text": content}] if isinstance(content, str) else content
            for piece in pieces:
                if piece["type"] == "tool_result":
                    inner = piece["content"]
                    inner = [{"type": "text", "text": inner}] if isinstance(inner, str) else inner
                    for part in inner:
                        yield self._piece("tool", part, piece["tool_use_id"])
                elif piece["type"] == "tool_use":
                    yield Said(role, "call", piece["name"], piece["id"], value=piece["input"])
                elif piece["type"] == "thinking":
                    yield Said(role, "thinking", piece["signature"])
                else:
                    yield self._piece(role, piece)

    def _piece(self, role: str, piece: Json, id: str = "") -> Said:
        if piece["type"] == "image":
            return Said(role, "image", id=id, data=unbase64(piece["source"]["data"]))
        return Said(role, "result" if id else "text", piece["text"], id)

    def tools(self, request: Json) -> Json:
        return {tool["name"]: tool["input_schema"] for tool in request["tools"]}

    def settings(self, request: Json) -> Json:
        return request

    def schema(self, request: Json) -> Json | None:
        found = request.get("output_config") or request.get("output_format")
        return found and (found.get("format") or found)["schema"]
