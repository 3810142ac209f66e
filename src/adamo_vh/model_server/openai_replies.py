"""Write answers and errors as OpenAI's chat-completions API does."""

from __future__ import annotations

import json
import time
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

from adamo_vh.action import ToolSchema
from adamo_vh.inference.messages import AIMessage, Message, ToolCall
from adamo_vh.inference.model import Usage
from adamo_vh.model_server.injected_faults import raw_of

Json = dict[str, Any]


@dataclass(frozen=True, slots=True)
class Answer:
    """An answer on its way out."""

    number: int
    """The request's number."""
    model: str
    """The model's name as the client wrote it."""
    message: AIMessage
    usage: Usage
    is_cut: bool = False
    """Whether it was cut off at the limit of tokens."""


def error_body(message: str, kind: str, param: str | None = None, code: str | None = None) -> Json:
    """An error.

    Args:
        message: For people.
        kind: E.g. "invalid_request_error".
        param: The field of the request that is to blame.
        code: E.g. "rate_limit_exceeded".
    """
    return {"error": {"message": message, "type": kind, "param": param, "code": code}}


def completion_body(answer: Answer) -> Json:
    """A completion in one piece."""
    message: Json = {"role": "assistant", "content": answer.message.text or None}
    if answer.message.calls:
        message["tool_calls"] = [_call(call) for call in answer.message.calls]
    choice = {"index": 0, "message": message, "logprobs": None, "finish_reason": _reason(answer)}
    head = _head(answer, "chat.completion")
    return {**head, "choices": [choice], "usage": _usage(answer.usage)}


def completion_events(answer: Answer, with_usage: bool) -> Iterator[str]:
    """A completion as server-sent events: role, text, one for each call, reason, end.

    Args:
        answer: The answer.
        with_usage: Whether an event with the token counts comes before the end.
    """
    head = _head(answer, "chat.completion.chunk")
    deltas: list[Json] = [{"role": "assistant", "content": ""}]
    if answer.message.text:
        deltas.append({"content": answer.message.text})
    deltas += [
        {"tool_calls": [{"index": at, **_call(call)}]}
        for at, call in enumerate(answer.message.calls)
    ]
    for delta in deltas:
        yield _event({**head, "choices": [_choice(delta, None)]})
    yield _event({**head, "choices": [_choice({}, _reason(answer))]})
    if with_usage:
        yield _event({**head, "choices": [], "usage": _usage(answer.usage)})
    yield "data: [DONE]\n\n"


def fitted(message: AIMessage, most_tokens: int | None) -> tuple[AIMessage, bool]:
    """An answer cut off at a limit of tokens, and whether it was.

    Args:
        message: The whole answer.
        most_tokens: The limit; None for none.
    """
    from adamo_vh.inference.cost.tokens import estimate_reply

    if most_tokens is None or estimate_reply(message) <= most_tokens:
        return message, False
    text = message.text
    low, high = 0, len(text)
    while low < high:
        middle = (low + high + 1) // 2
        fits = estimate_reply(AIMessage(text[:middle])) <= most_tokens
        low, high = (middle, high) if fits else (low, middle - 1)
    # Calls come behind the text: one that is cut through is none.
    return AIMessage(text[:low]), True


def estimated_usage(
    uri: str, messages: Sequence[Message], tools: Sequence[ToolSchema], reply: AIMessage
) -> Usage:
    """Tokens of a request and its reply, as estimated for a provider's rules.

    Args:
        uri: Name of the model that is served.
        messages: The prompt.
        tools: The tools on offer.
        reply: The answer.
    """
    from adamo_vh.inference.cost.tokens import estimate_reply, estimate_request, rule_for

    rule = rule_for(uri)
    return Usage(estimate_request(messages, tools, rule), estimate_reply(reply))


def _head(answer: Answer, kind: str) -> Json:
    return {
        "id": f"chatcmpl-{answer.number}",
        "object": kind,
        "created": int(time.time()),
        "model": answer.model,
    }


def _choice(delta: Json, reason: str | None) -> Json:
    return {"index": 0, "delta": delta, "logprobs": None, "finish_reason": reason}


def _event(body: Json) -> str:
    return f"data: {json.dumps(body)}\n\n"


def _reason(answer: Answer) -> str:
    if answer.is_cut:
        return "length"
    return "tool_calls" if answer.message.calls else "stop"


def _call(call: ToolCall) -> Json:
    function = {"name": call.name, "arguments": raw_of(call)}
    return {"id": call.id, "type": "function", "function": function}


def _usage(usage: Usage) -> Json:
    return {
        "prompt_tokens": usage.input_tokens,
        "completion_tokens": usage.output_tokens,
        "total_tokens": usage.total_tokens,
        "prompt_tokens_details": {"cached_tokens": usage.cached_tokens},
        "completion_tokens_details": {"reasoning_tokens": usage.reasoning_tokens},
    }
