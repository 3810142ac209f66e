"""Translate between the neutral messages and those of pydantic-ai."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

from adamo_vh.action import ToolSchema
from adamo_vh.inference.messages import (
    AIMessage,
    HumanMessage,
    Message,
    Part,
    SystemMessage,
    TextPart,
    ToolMessage,
)
from adamo_vh.inference.model import Usage
from adamo_vh.inference.prompts import render
from adamo_vh.inference.remote.clients import Connection
from adamo_vh.inference.remote.kept import to_response
from adamo_vh.inference.tool_names import wire_id, wire_name
from adamo_vh.readable import encodable

if TYPE_CHECKING:
    from pydantic_ai import messages as wire
    from pydantic_ai.models import ModelRequestParameters
    from pydantic_ai.usage import RequestUsage

_Input = SystemMessage | HumanMessage | ToolMessage

_NO_RESULT = "Not executed."
_NOTHING = "(nothing)"
"""Stands for an empty text, which servers refuse."""
CAPTION = "Picture from"
"""Says whose picture follows, where it cannot be in the result itself."""


def to_wire(
    messages: Iterable[Message],
    connection: Connection,
    source: str,
    *,
    one_system: bool = False,
    bridged: bool = False,
) -> list[wire.ModelMessage]:
    """Translate a prompt.

    Everything between two answers becomes one request, whose parts arrive as separate messages of
    their own role: system text as system, feedback as tool, instructions and frames as user. Each
    call of the answer before gets exactly one result, and the results come first, as every
    provider wants it; all else keeps its place.

    Args:
        messages: The prompt, oldest first.
        connection: Where it goes.
        source: Who gets it; see `kept`.
        one_system: Whether all system text at the start must be one message, and none may follow.
        bridged: Whether an answer must stand between results and what follows them, and that must
            be one message.
    """
    from pydantic_ai.messages import ModelRequest

    if one_system:
        messages = _with_one_system(messages)
        connection = replace(connection, late_system=False)

    translated: list[wire.ModelMessage] = []
    for asked, following in _turns(messages):
        if asked is not None:
            translated.append(to_response(asked, source))
        parts = _turn(asked, following, connection)
        translated += _bridged(parts) if bridged else [ModelRequest(parts=parts)] if parts else []
    return translated


def _bridged(parts: Sequence[wire.ModelRequestPart]) -> list[wire.ModelMessage]:
    """A request whose results are followed by an answer, and that by one message of the user."""
    from pydantic_ai import messages as wire

    results = [part for part in parts if isinstance(part, wire.ToolReturnPart)]
    system = [part for part in parts if isinstance(part, wire.SystemPromptPart)]
    content: list[wire.UserContent] = []
    for part in parts:
        if isinstance(part, wire.UserPromptPart):
            content += [part.content] if isinstance(part.content, str) else part.content
    said = [*system, *([wire.UserPromptPart(content)] if content else ())]
    if not (results and said):
        return [wire.ModelRequest(parts=[*results, *said])] if results or said else []
    bridge = wire.ModelResponse(parts=[wire.TextPart(render("bridge"))])
    return [wire.ModelRequest(parts=results), bridge, wire.ModelRequest(parts=said)]


def _with_one_system(messages: Iterable[Message]) -> list[Message]:
    rest = [*messages]
    texts: list[str] = []
    while rest and isinstance(first := rest[0], SystemMessage):
        texts.append(first.text)
        del rest[0]
    return [SystemMessage("\n\n".join(texts)), *rest] if texts else rest


def _turns(messages: Iterable[Message]) -> Iterator[tuple[AIMessage | None, list[_Input]]]:
    """Each answer with all that follows it up to the next; first what comes before any answer."""
    asked: AIMessage | None = None
    following: list[_Input] = []
    for message in messages:
        if isinstance(message, AIMessage):
            yield asked, following
            asked, following = message, []
        else:
            following.append(message)
    yield asked, following


def _turn(
    asked: AIMessage | None, messages: Sequence[_Input], connection: Connection
) -> list[wire.ModelRequestPart]:
    """The parts of one request: the results of the calls, their pictures, and the rest."""
    results = {m.call_id: m for m in reversed(messages) if isinstance(m, ToolMessage)}
    calls = asked.calls if asked else ()
    parts: list[wire.ModelRequestPart] = []
    shown: list[Part] = []
    for call in calls:
        result = results.pop(call.id, None) or ToolMessage(call.id, call.name, _NO_RESULT)
        parts.append(_result(result, connection))
        if result.images and not connection.pictures_in_results:
            about = f"{CAPTION} {wire_name(result.name)} ({wire_id(call.id, connection.wire)}):"
            shown += [TextPart(about), *result.images]
    if shown:
        parts.append(_human(HumanMessage(tuple(shown))))
    answered = {call.id for call in calls}
    at_start = asked is None
    for message in messages:
        if isinstance(message, SystemMessage):
            parts.append(_system(message, as_system=at_start or connection.late_system))
            continue
        at_start = False
        if isinstance(message, HumanMessage):
            parts.append(_human(message))
        elif message.call_id not in answered:
            # Its call was left out of the prompt; servers refuse a result without one.
            note = TextPart(f"Result of {message.name}: {message.text}")
            parts.append(_human(HumanMessage((note, *message.images))))
    return parts


def _system(message: SystemMessage, *, as_system: bool) -> wire.ModelRequestPart:
    """System text; where a wire would move it to the front, it stays in place as the user's."""
    from pydantic_ai import messages as wire

    text = encodable(message.text)
    return wire.SystemPromptPart(text) if as_system else wire.UserPromptPart(text)


def _result(message: ToolMessage, connection: Connection) -> wire.ToolReturnPart:
    from pydantic_ai import messages as wire

    text = encodable(message.text).strip() or _NOTHING
    pictures = [
        wire.BinaryContent(image.data, media_type=image.media_type)
        for image in message.images
        if connection.pictures_in_results
    ]
    return wire.ToolReturnPart(
        tool_name=wire_name(message.name),
        content=[text, *pictures] if pictures else text,
        tool_call_id=wire_id(message.call_id, connection.wire),
    )


def _human(message: HumanMessage) -> wire.UserPromptPart:
    from pydantic_ai import messages as wire

    content: list[wire.UserContent] = [
        encodable(part.text)
        if isinstance(part, TextPart)
        else wire.BinaryContent(part.data, media_type=part.media_type)
        for part in message.parts
        if not isinstance(part, TextPart) or part.text.strip()
    ] or [_NOTHING]
    if len(content) == 1 and isinstance(content[0], str):
        return wire.UserPromptPart(content[0])
    return wire.UserPromptPart(content)


def to_parameters(
    tools: Iterable[ToolSchema], schema: ToolSchema | None = None
) -> ModelRequestParameters:
    """Put tools on offer, or ask for JSON of a schema.

    Strict mode stays off for tools: it would rewrite the schemas, and differently for each
    provider, so that models would not be compared on the same words.

    Args:
        tools: Tools on offer.
        schema: What the text of the answer must be, if it must.
    """
    from pydantic_ai.models import ModelRequestParameters
    from pydantic_ai.output import OutputObjectDefinition
    from pydantic_ai.tools import ToolDefinition

    output: OutputObjectDefinition | None = None
    if schema is not None:
        output = OutputObjectDefinition(
            json_schema=schema.parameters, name=schema.name, description=schema.description
        )
    return ModelRequestParameters(
        output_mode="native" if output else "text",
        output_object=output,
        function_tools=[
            ToolDefinition(
                name=tool.name,
                description=tool.description,
                parameters_json_schema=tool.parameters,
                strict=False,
            )
            for tool in tools
        ],
    )


_REASONING = ("reasoning_tokens", "thoughts_tokens", "thinking_tokens")
"""Under which names the client library counts hidden reasoning."""


def from_usage(usage: RequestUsage) -> Usage:
    """Translate the token counts: those of the cache are part of the input on every wire."""
    reasoning = max((usage.details.get(name, 0) for name in _REASONING), default=0)
    return Usage(usage.input_tokens, usage.output_tokens, usage.cache_read_tokens, reasoning)
