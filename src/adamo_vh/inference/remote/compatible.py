"""OpenAI-compatible servers that keep to the letter less than OpenAI does."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    import httpx2
    from pydantic_ai.models.openai import OpenAIChatModel


def compatible_client(
    model: str, base_url: str, key: str, http: httpx2.AsyncClient
) -> OpenAIChatModel:
    """Make a chat-completions client for a server of one's own.

    Args:
        model: The model's name at the server.
        base_url: Address of the API, with its ``/v1`` if it has one.
        key: The key; any text if the server needs none.
        http: What sends the requests.
    """
    from openai.types.chat import ChatCompletion
    from pydantic_ai.exceptions import ModelAPIError
    from pydantic_ai.models.openai import OpenAIChatModel
    from pydantic_ai.profiles.openai import OpenAIModelProfile
    from pydantic_ai.providers.openai_compatible import OpenAICompatibleProvider

    class CompatibleChatModel(OpenAIChatModel):
        """Fills in what small servers leave out, before the answer is checked."""

        def _validate_completion(self, response: ChatCompletion) -> Any:
            data = response.model_dump(warnings=False)
            if not data.get("choices"):
                # Some servers and gateways report an error under status 200.
                what = data.get("error") or "no choices"
                raise ModelAPIError(model, f"the answer is no completion: {what}")
            return super()._validate_completion(ChatCompletion.model_construct(**_filled(data)))

    # Compatible servers know max_tokens; only some know OpenAI's newer max_completion_tokens.
    profile = OpenAIModelProfile(
        openai_chat_supports_max_completion_tokens=False, supports_json_schema_output=True
    )
    provider = OpenAICompatibleProvider(
        "openai-compatible", base_url=base_url, api_key=key, profile=profile, http_client=http
    )
    return CompatibleChatModel(model, provider=provider)


def _filled(data: dict[str, Any]) -> dict[str, Any]:
    """A completion with every field that its schema demands and its reader has no use for."""
    defaults = {"id": "", "model": "", "created": 0}
    head = {key: data.get(key) or value for key, value in defaults.items()}
    choices = [
        {
            **choice,
            "index": choice.get("index") or 0,
            "finish_reason": choice.get("finish_reason") or "stop",
            "message": _filled_message(choice.get("message")),
        }
        for choice in data["choices"]
    ]
    return {**data, **head, "object": "chat.completion", "choices": choices}


def _filled_message(message: Any) -> Any:
    if not isinstance(message, dict):
        return message
    calls, legacy = message.get("tool_calls"), message.get("function_call")
    if not calls and isinstance(legacy, dict):
        # The way of calls before there were tools.
        calls = [{"function": legacy}]
    return {
        **message,
        "role": "assistant",
        "tool_calls": calls and [_filled_call(call) for call in calls],
    }


def _filled_call(call: dict[str, Any]) -> dict[str, Any]:
    function = call.get("function")
    if not isinstance(function, dict):
        return call
    arguments = function.get("arguments")
    if not isinstance(arguments, str):
        arguments = "" if arguments is None else json.dumps(arguments)
    return {
        **call,
        "id": call.get("id") or "",
        "type": "function",
        "function": {**function, "arguments": arguments},
    }
