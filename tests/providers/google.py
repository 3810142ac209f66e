"""Google generateContent."""

from __future__ import annotations

import base64
from collections.abc import Iterator, Sequence

from tests.fake_provider import Canned, Json
from tests.providers.dialect import CACHED, INPUT, OUTPUT, REASONING, Call, Said


class Google:
    """Google generateContent."""

    name = "google"
    model = "gemini-3-pro-preview"
    path = f"/v1beta/models/{model}:generateContent"
    pictures_in_results = True

    def answer(
        self,
        text: str = "",
        calls: Sequence[Call] = (),
        thinking: str = "",
        finish: str = "STOP",
    ) -> Canned:
        parts: list[Json] = [{"text": text}] if text else []
        for id, name, args in calls:
            parts.append({"functionCall": {"id": id, "name": name, "args": args}})
        if thinking:
            parts[-1]["thoughtSignature"] = base64.b64encode(thinking.encode()).decode()
        usage = {
            "promptTokenCount": INPUT,
            "cachedContentTokenCount": CACHED,
            "candidatesTokenCount": OUTPUT - REASONING,
            "thoughtsTokenCount": REASONING,
            "totalTokenCount": INPUT + OUTPUT,
        }
        content = {"role": "model", "parts": parts}
        candidate = {"content": content, "finishReason": finish, "index": 0}
        return Canned(
            {"candidates": [candidate], "usageMetadata": usage, "modelVersion": self.model}
        )

    def ended(self, reason: str, text: str = "", calls: Sequence[Call] = ()) -> Canned:
        return self.answer(text, calls, finish=reason)

    def refusal(self) -> Canned:
        return self.answer(finish="SAFETY")

    def error(self, status: int, message: str, param: str | None = None) -> Canned:
        return Canned({"error": {"code": status, "message": message, "status": "X"}}, status)

    def hidden_error(self, status: int, message: str) -> Canned:
        return Canned(self.error(status, message).body)

    def read(self, request: Json) -> Iterator[Said]:
        for part in request.get("systemInstruction", {}).get("parts", ()):
            yield Said("system", "text", part["text"])
        roles = {"model": "assistant", "user": "user"}
        for content in request["contents"]:
            role = roles[content["role"]]
            for part in content["parts"]:
                if "thoughtSignature" in part:
                    signature = _unsigned(part["thoughtSignature"])
                    yield Said(role, "thinking", signature)
                yield from self._part(role, part)

    def _part(self, role: str, part: Json) -> Iterator[Said]:
        if call := part.get("functionCall"):
            yield Said(role, "call", call["name"], call["id"], value=call.get("args") or {})
        elif result := part.get("functionResponse"):
            (text,) = result["response"].values()
            yield Said("tool", "result", text, result["id"])
            for inner in result.get("parts", ()):
                # Google's library spells this one as its protocol buffers do; the API takes both.
                data = _unsigned_bytes(inner["inline_data"]["data"])
                yield Said("tool", "image", id=result["id"], data=data)
        elif picture := part.get("inlineData"):
            yield Said(role, "image", data=_unsigned_bytes(picture["data"]))
        else:
            yield Said(role, "text", part["text"])

    def tools(self, request: Json) -> Json:
        found = [f for tool in request["tools"] for f in tool["functionDeclarations"]]
        return {f["name"]: f["parameters_json_schema"] for f in found}

    def settings(self, request: Json) -> Json:
        found: Json = request["generationConfig"]
        return found

    def schema(self, request: Json) -> Json | None:
        found: Json | None = self.settings(request).get("responseJsonSchema")
        return found


def _unsigned_bytes(data: str) -> bytes:
    """Google's library writes base64 in the alphabet for addresses."""
    return base64.urlsafe_b64decode(data + "=" * (-len(data) % 4))


def _unsigned(data: str) -> str:
    return _unsigned_bytes(data).decode("utf-8", "replace")
