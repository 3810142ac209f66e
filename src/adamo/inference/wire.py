"""Translate between the neutral messages and those of pydantic-ai."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Sequence
from typing import TYPE_CHECKING

from adamo.action import ToolSchema
from adamo.inference.arguments import (
    dump_arguments,
    encodable_text,
    read_arguments,
    wire_arguments,
)
from adamo.inference.messages import (
    AIMessage,
    HumanMessage,
    Message,
    SystemMessage,
    TextPart,
    ToolCall,
    ToolMessage,
)
from adamo.inference.model import Usage
from adamo.inference.text_calls import fresh_id, recognise_call

if TYPE_CHECKING:
    from pydantic_ai import messages as wire
    from pydantic_ai.models import ModelRequestParameters
    from pydantic_ai.usage import RequestUsage

_MADE_UP = "pyd_ai_"


def to_wire(messages: Iterable[Message]) -> list[wire.ModelMessage]:
    """Translate a prompt, keeping every message in its place.

    Everything between two answers becomes one request, whose parts arrive as separate messages of
    their own role: system text as system, feedback as tool, instructions and frames as user.
    """
    from pydantic_ai.messages import ModelRequest

    translated: list[wire.ModelMessage] = []
    waiting: list[wire.ModelRequestPart] = []
    for message in messages:
        if not isinstance(message, AIMessage):
            waiting.append(_request_part(message))
            continue
        if waiting:
            translated.append(ModelRequest(parts=waiting))
            waiting = []
        translated.append(_response(message))
    if waiting:
        translated.append(ModelRequest(parts=waiting))
    return translated


def _request_part(
    message: SystemMessage | HumanMessage | ToolMessage,
) -> wire.ModelRequestPart:
    from pydantic_ai import messages as wire

    if isinstance(message, SystemMessage):
        return wire.SystemPromptPart(encodable_text(message.text))
    if isinstance(message, ToolMessage):
        return wire.ToolReturnPart(
            tool_name=message.name,
            content=encodable_text(message.text),
            tool_call_id=message.call_id,
        )
    content: list[wire.UserContent] = [
        encodable_text(part.text)
        if isinstance(part, TextPart)
        else wire.BinaryContent(part.data, media_type=part.media_type)
        for part in message.parts
    ]
    if len(content) == 1 and isinstance(content[0], str):
        return wire.UserPromptPart(content[0])
    return wire.UserPromptPart(content)


def _response(message: AIMessage) -> wire.ModelResponse:
    from pydantic_ai import messages as wire

    parts: list[wire.ModelResponsePart] = []
    if message.text:
        parts.append(wire.TextPart(encodable_text(message.text)))
    parts.extend(
        wire.ToolCallPart(encodable_text(call.name), wire_arguments(call), tool_call_id=call.id)
        for call in message.calls
    )
    return wire.ModelResponse(parts=parts)


def to_parameters(tools: Iterable[ToolSchema]) -> ModelRequestParameters:
    """Put tools on offer.

    Strict mode stays off: it would rewrite the schemas, and differently for each provider, so that
    models would not be compared on the same words.
    """
    from pydantic_ai.models import ModelRequestParameters
    from pydantic_ai.tools import ToolDefinition

    return ModelRequestParameters(
        function_tools=[
            ToolDefinition(
                name=tool.name,
                description=tool.description,
                parameters_json_schema=tool.parameters,
                strict=False,
            )
            for tool in tools
        ]
    )


def from_wire(
    response: wire.ModelResponse, messages: Sequence[Message], tools: Collection[str]
) -> AIMessage:
    """Translate an answer.

    Thinking parts are left out. A refusal counts as text. If there is no native call but a call
    leaked into the text, it is recognised.

    Args:
        response: The answer.
        messages: The prompt it answers; new call ids differ from those in it.
        tools: Names of the tools on offer.
    """
    from pydantic_ai import messages as wire

    texts = [part.content for part in response.parts if isinstance(part, wire.TextPart)]
    text = encodable_text("\n\n".join(texts)).strip()
    if not text:
        text = encodable_text(str((response.provider_details or {}).get("refusal") or ""))
    taken = {call.id for m in messages if isinstance(m, AIMessage) for call in m.calls}
    calls: list[ToolCall] = []
    for part in response.parts:
        if isinstance(part, wire.ToolCallPart):
            calls.append(_call(part, taken))
            taken.add(calls[-1].id)
    if calls:
        return AIMessage(text, tuple(calls))
    return recognise_call(text, tools, taken) or AIMessage(text)


def _call(part: wire.ToolCallPart, taken: Collection[str]) -> ToolCall:
    raw = part.args if isinstance(part.args, str) else dump_arguments(part.args or {})
    # Some servers number calls anew in each answer; an id that means two calls confuses others.
    # Some give none; the library then makes one up at random, ours follows from the call.
    call_id = part.tool_call_id
    if call_id in taken or call_id.startswith(_MADE_UP):
        call_id = fresh_id(f"{part.tool_name} {raw}", taken)
    name = encodable_text(part.tool_name)
    return ToolCall(call_id, name, read_arguments(raw), encodable_text(raw))


def from_usage(usage: RequestUsage) -> Usage:
    """Translate the token counts; those of the cache are part of the input."""
    return Usage(usage.input_tokens, usage.output_tokens, usage.cache_read_tokens)
