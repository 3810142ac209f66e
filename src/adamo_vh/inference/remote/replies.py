"""Read an answer of the client library: what it says, what it calls, and what it is."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from adamo_vh.action import ToolSchema
from adamo_vh.inference.arguments import dump_arguments, read_arguments
from adamo_vh.inference.messages import AIMessage, Message, ToolCall
from adamo_vh.inference.model import Ending
from adamo_vh.inference.reasoning_text import split_reasoning
from adamo_vh.inference.remote.endings import finish_reason, meaning
from adamo_vh.inference.remote.kept import dump_kept
from adamo_vh.inference.text_calls import UnparsedCall, read_calls
from adamo_vh.inference.tool_names import fresh_id
from adamo_vh.readable import encodable

if TYPE_CHECKING:
    from pydantic_ai import messages as wire

_MADE_UP = "pyd_ai_"
_AS_CALLS = "Make calls as tool calls, not as text."


@dataclass(frozen=True, slots=True)
class Reading:
    """An answer in neutral words."""

    message: AIMessage
    ending: Ending
    finish_reason: str = ""
    """Why it ended, in the provider's own word."""
    problem: str = ""
    """What is wrong with it; see `Reply.unreadable`."""
    leaked: bool = False
    """Whether its calls were written into the text."""


def read_response(
    response: wire.ModelResponse,
    body: Any,
    messages: Sequence[Message],
    tools: Sequence[ToolSchema],
    source: str,
    *,
    takes_thinking: bool,
) -> Reading:
    """Read an answer.

    Reasoning is no part of the text, wherever it stands. An answer that did not end by itself is
    neither a call nor a final answer, whatever it holds: a limit may have cut through a number.

    Args:
        response: The answer, as the client library read it.
        body: The same as JSON; None if it could not be watched.
        messages: The prompt it answers; new call ids differ from those in it.
        tools: The tools on offer.
        source: Who gave the answer; see `kept`.
        takes_thinking: Whether thinking can go back; see `kept`.
    """
    from pydantic_ai import messages as wire

    texts = [part.content for part in response.parts if isinstance(part, wire.TextPart)]
    text, drafts = split_reasoning(encodable("\n\n".join(texts)))
    thoughts = [part.content for part in response.parts if isinstance(part, wire.ThinkingPart)]
    taken = taken_ids(messages)
    calls: list[ToolCall] = []
    for part in response.parts:
        if isinstance(part, wire.ToolCallPart):
            calls.append(_call(part, taken))
            taken.add(calls[-1].id)
    kept = dump_kept(response, source, takes_thinking=takes_thinking)
    message = AIMessage(text, tuple(calls), kept)
    reason = finish_reason(body) if isinstance(body, dict) else _reason_of(response)
    if stopped := _stopped(response, reason):
        return Reading(message, stopped[0], reason, stopped[1])
    if calls:
        return Reading(message, Ending.CALL, reason)
    if not text:
        draft = "\n".join([drafts, *map(encodable, thoughts)])
        if tools and read_calls(draft, tools, taken) is not None:
            problem = f"holds a call inside its reasoning, where it is a draft. {_AS_CALLS}"
            return Reading(message, Ending.UNPARSED_CALL, reason, problem)
        return Reading(message, Ending.EMPTY, reason)
    return read_text(message, messages, tools, reason)


def read_text(
    message: AIMessage, messages: Sequence[Message], tools: Sequence[ToolSchema], reason: str
) -> Reading:
    """Read an answer that is text alone: it may hold calls."""
    found = read_calls(message.text, tools, taken_ids(messages)) if tools else None
    if isinstance(found, AIMessage):
        read = AIMessage(found.text, found.calls, message.kept)
        return Reading(read, Ending.CALL, reason, leaked=True)
    if isinstance(found, UnparsedCall):
        return Reading(message, Ending.UNPARSED_CALL, reason, f"{found.problem} {_AS_CALLS}")
    return Reading(message, Ending.ANSWER, reason)


def read_refused_call(
    written: str, complaint: str, messages: Sequence[Message], tools: Sequence[ToolSchema]
) -> Reading:
    """Read what a model wrote from the error of a server that could not read its call.

    Args:
        written: What it wrote, as far as the server shows it.
        complaint: The server's own words.
        messages: The prompt it answers.
        tools: The tools on offer.
    """
    text, _ = split_reasoning(written)
    reading = read_text(AIMessage(text), messages, tools, "")
    if reading.ending is Ending.CALL:
        return reading
    problem = f"holds a call that the server could not read: {complaint.rstrip('.')}."
    return Reading(AIMessage(text), Ending.UNPARSED_CALL, "", problem)


def taken_ids(messages: Sequence[Message]) -> set[str]:
    """Call ids of a conversation."""
    return {call.id for m in messages if isinstance(m, AIMessage) for call in m.calls}


def _reason_of(response: wire.ModelResponse) -> str:
    details = response.provider_details or {}
    found = details.get("finish_reason") or response.finish_reason or ""
    return encodable(str(getattr(found, "value", found)))


def _stopped(response: wire.ModelResponse, reason: str) -> tuple[Ending, str] | None:
    """How an answer was stopped, and what to say of it; None if it ended by itself."""
    refusal = (response.provider_details or {}).get("refusal")
    ending = Ending.FILTERED if refusal else meaning(reason)
    if ending is None:
        return None
    if ending is Ending.FILTERED:
        why = encodable(str(refusal or reason))[:200].rstrip(".")
        return ending, f"was refused or stopped by a filter of the provider ({why})."
    if ending is Ending.UNPARSED_CALL:
        return ending, f"holds a call that the server could not read ({reason}). {_AS_CALLS}"
    tokens = response.usage.output_tokens
    after = f" after {tokens} tokens" if tokens else ""
    return ending, f"was cut off{after} ({reason}). Be shorter."


def _call(part: wire.ToolCallPart, taken: Collection[str]) -> ToolCall:
    raw = part.args if isinstance(part.args, str) else dump_arguments(part.args or {})
    # Some servers number calls anew in each answer; an id that means two calls confuses others.
    # Some give none; the library then makes one up at random, ours follows from the call.
    call_id = encodable(part.tool_call_id)
    if call_id in taken or call_id.startswith(_MADE_UP):
        call_id = fresh_id(f"{part.tool_name} {raw}", taken)
    name = encodable(part.tool_name)
    return ToolCall(call_id, name, read_arguments(raw), encodable(raw))
