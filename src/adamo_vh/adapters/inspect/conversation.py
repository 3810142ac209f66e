"""Messages, tools and answers, in the words of Inspect AI and back."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from adamo_vh.action import ToolSchema
from adamo_vh.files import data_url
from adamo_vh.inference.arguments import dump_arguments, read_arguments
from adamo_vh.inference.messages import (
    AIMessage,
    HumanMessage,
    ImagePart,
    Message,
    Part,
    SystemMessage,
    TextPart,
    ToolCall,
    ToolMessage,
)
from adamo_vh.inference.model import Ending, Reply, Usage
from adamo_vh.inference.remote.endings import meaning
from adamo_vh.inference.remote.replies import read_text, taken_ids
from adamo_vh.inference.tool_names import fresh_id
from adamo_vh.readable import encodable

if TYPE_CHECKING:
    from inspect_ai.model import ChatMessage, Content, ModelOutput, ModelUsage
    from inspect_ai.tool import ToolInfo

_KEPT = "inspect:"


def chat(messages: Sequence[Message]) -> list[ChatMessage]:
    """A conversation as Inspect has it.

    Args:
        messages: Oldest first.
    """
    from inspect_ai.model import ChatMessageSystem, ChatMessageTool, ChatMessageUser

    written: list[ChatMessage] = []
    for message in messages:
        match message:
            case SystemMessage():
                written.append(ChatMessageSystem(content=message.text))
            case HumanMessage():
                written.append(ChatMessageUser(content=_contents(message.parts)))
            case ToolMessage():
                written.append(
                    ChatMessageTool(
                        content=_contents((TextPart(message.text), *message.images)),
                        tool_call_id=message.call_id,
                        function=message.name,
                    )
                )
            case AIMessage():
                written.append(_answer(message))
    return written


def _answer(message: AIMessage) -> Any:
    from inspect_ai.model import ChatMessageAssistant
    from inspect_ai.tool import ToolCall as InspectCall

    calls = [
        InspectCall(
            id=call.id,
            function=call.name,
            arguments=dict(call.arguments or {}),
            parse_error=call.raw if call.arguments is None else None,
        )
        for call in message.calls
    ]
    if message.kept.startswith(_KEPT):
        # Its thinking goes back with it, signed as the provider wants it.
        whole = ChatMessageAssistant.model_validate_json(message.kept.removeprefix(_KEPT))
        whole.tool_calls = calls or None
        return whole
    return ChatMessageAssistant(content=message.text, tool_calls=calls or None)


def _contents(parts: Sequence[Part]) -> str | list[Content]:
    if len(parts) == 1 and isinstance(parts[0], TextPart):
        return parts[0].text
    return parts_of(parts)


def parts_of(parts: Sequence[Part]) -> list[Content]:
    """Texts and pictures as Inspect has them.

    Args:
        parts: In order.
    """
    from inspect_ai.model import ContentImage, ContentText

    return [
        ContentImage(image=data_url(part.media_type, part.data))
        if isinstance(part, ImagePart)
        else ContentText(text=part.text)
        for part in parts
    ]


def offered_tools(tools: Sequence[ToolSchema]) -> list[ToolInfo]:
    """The tools on offer as Inspect tells a model of them."""
    from inspect_ai.tool import ToolInfo, ToolParams

    return [
        ToolInfo(
            name=tool.name,
            description=tool.description,
            parameters=ToolParams.model_validate(
                {
                    key: tool.parameters[key]
                    for key in ("properties", "required")
                    if key in tool.parameters
                }
            ),
        )
        for tool in tools
    ]


def reply_of(
    output: ModelOutput, messages: Sequence[Message], tools: Sequence[ToolSchema], seconds: float
) -> Reply:
    """An answer, judged as the answers of every other provider are.

    Args:
        output: As Inspect gives it.
        messages: The prompt it answers.
        tools: The tools on offer.
        seconds: What it took.
    """
    told = output.message
    reason = str(output.stop_reason)
    calls: list[ToolCall] = []
    taken = taken_ids(messages)
    for call in told.tool_calls or ():
        calls.append(_call(call, taken))
        taken.add(calls[-1].id)
    thinks = not isinstance(told.content, str)
    kept = f"{_KEPT}{told.model_dump_json(exclude_none=True)}" if thinks else ""
    message = AIMessage(encodable(told.text), tuple(calls), kept)
    ending, problem = _stopped(reason)
    if ending is None and not calls and message.text.strip():
        reading = read_text(message, messages, tools, reason)
        message, ending, problem = reading.message, reading.ending, reading.problem
    return Reply(
        message,
        _usage_of(output.usage),
        seconds=seconds,
        cost_usd=output.usage.total_cost if output.usage else None,
        unreadable=problem,
        ending=ending or (Ending.CALL if calls else Ending.EMPTY),
        finish_reason=reason,
    )


def _call(call: Any, taken: set[str]) -> ToolCall:
    raw = dump_arguments(call.arguments)
    call_id = encodable(call.id)
    if call_id in taken:
        call_id = fresh_id(f"{call.function} {raw}", taken)
    arguments = None if call.parse_error else read_arguments(raw)
    return ToolCall(call_id, encodable(call.function), arguments, encodable(raw))


def _stopped(reason: str) -> tuple[Ending | None, str]:
    """How an answer was stopped, and what to say of it; None if it ended by itself."""
    if reason == "unknown" or (ending := meaning(reason)) is None:
        return None, ""
    if ending is Ending.FILTERED:
        return ending, "was refused or stopped by a filter of the provider."
    return ending, f"was cut off ({reason}). Be shorter."


def _usage_of(spent: ModelUsage | None) -> Usage:
    if spent is None:
        return Usage()
    cached = spent.input_tokens_cache_read or 0
    whole = spent.input_tokens + cached + (spent.input_tokens_cache_write or 0)
    return Usage(whole, spent.output_tokens, cached, spent.reasoning_tokens or 0)


def spent_on(usage: Usage, cost_usd: float | None) -> ModelUsage:
    """Tokens and money in Inspect's words: there, cached tokens are none of the input's.

    Args:
        usage: As the record has it.
        cost_usd: None if no price is known.
    """
    from inspect_ai.model import ModelUsage

    return ModelUsage(
        input_tokens=usage.input_tokens - usage.cached_tokens,
        output_tokens=usage.output_tokens,
        total_tokens=usage.total_tokens,
        input_tokens_cache_read=usage.cached_tokens,
        reasoning_tokens=usage.reasoning_tokens,
        total_cost=cost_usd,
    )
