"""What a provider wants back with an answer of its own: signatures, encrypted reasoning, item ids.

Anthropic refuses a tool's result whose call comes without the signed thinking before it, Gemini
thinks worse without its signatures, and OpenAI without its reasoning items. All of it is opaque
here: it is stored as the client library's own JSON and woven into the message on its way back.
"""

from __future__ import annotations

import json
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from adamo_vh.inference.arguments import wire_arguments
from adamo_vh.inference.messages import AIMessage
from adamo_vh.inference.tool_names import wire_id, wire_name
from adamo_vh.readable import encodable

if TYPE_CHECKING:
    from pydantic_ai import messages as wire

_WORTH_KEEPING = ("signature", "provider_details", "id")


def dump_kept(response: wire.ModelResponse, source: str, *, takes_thinking: bool) -> str:
    """JSON text of what must go back with an answer; empty if nothing must.

    Args:
        response: The answer.
        source: Who gave it; nobody else gets it back.
        takes_thinking: Whether the wire has a place for thinking. Otherwise the client library
            would write it into the text of the answer.
    """
    from pydantic_ai import messages as wire

    parts = [
        part
        for part in response.parts
        if not _is_tagged_thinking(part)
        and (takes_thinking or not isinstance(part, wire.ThinkingPart))
    ]
    if not any(isinstance(p, wire.ThinkingPart) or _carries_something(p) for p in parts):
        return ""
    slim = replace(response, parts=parts)
    ((dumped),) = wire.ModelMessagesTypeAdapter.dump_python([slim], mode="json")
    fields = ("parts", "kind", "model_name", "provider_name", "provider_url", "canonical_system")
    body = {name: dumped[name] for name in fields if dumped.get(name) is not None}
    body["parts"] = [_without_empty(part) for part in body["parts"]]
    return encodable(json.dumps({"from": source, "response": body}, ensure_ascii=False))


def _is_tagged_thinking(part: wire.ModelResponsePart) -> bool:
    """Thinking that was written into the text, between tags: models do not expect it back."""
    from pydantic_ai import messages as wire

    if not isinstance(part, wire.ThinkingPart) or part.signature:
        return False
    return part.id in (None, "content")


def _carries_something(part: wire.ModelResponsePart) -> bool:
    return any(getattr(part, name, None) for name in _WORTH_KEEPING)


def _without_empty(part: dict[str, Any]) -> dict[str, Any]:
    return {name: value for name, value in part.items() if value is not None}


def to_response(message: AIMessage, source: str) -> wire.ModelResponse:
    """A message as the answer it once was, with what `dump_kept` kept of it.

    The message has the last word on the text, the calls and their ids.

    Args:
        message: The answer, in neutral words.
        source: Who is about to get it.
    """
    from pydantic_ai import messages as wire

    kept = _load(message.kept, source)
    if kept is None:
        return wire.ModelResponse(parts=list(_plain_parts(message, source)))
    plain = _plain_parts(message, source)
    calls = [part for part in plain if isinstance(part, wire.ToolCallPart)]
    notes = [part for part in plain if isinstance(part, wire.TextPart)]
    texts = [part.content for part in kept.parts if isinstance(part, wire.TextPart)]
    untouched = "\n\n".join(texts).strip() == message.text
    parts: list[wire.ModelResponsePart] = []
    for part in kept.parts:
        if isinstance(part, wire.ToolCallPart):
            parts += [_as_kept(call, part) for call in calls[:1]]
            del calls[:1]
        elif isinstance(part, wire.TextPart):
            # Anthropic refuses a block of blanks, though it writes some itself.
            parts += ([part] if part.content.strip() else []) if untouched else notes
            notes.clear()
        else:
            parts.append(part)
    return replace(kept, parts=[*parts, *([] if untouched else notes), *calls])


def _as_kept(call: wire.ToolCallPart, kept: wire.ToolCallPart) -> wire.ToolCallPart:
    """A call with the ids and signatures that it came with."""
    return replace(
        call,
        id=kept.id,
        provider_name=kept.provider_name,
        provider_details=kept.provider_details,
    )


def _load(kept: str, source: str) -> wire.ModelResponse | None:
    from pydantic import ValidationError
    from pydantic_ai import messages as wire

    if not kept:
        return None
    try:
        stored = json.loads(kept)
        if stored["from"] != source:
            return None
        (response,) = wire.ModelMessagesTypeAdapter.validate_python([stored["response"]])
    except (ValueError, LookupError, TypeError, ValidationError):
        # A record of another version: the conversation goes on without its thinking.
        return None
    return response if isinstance(response, wire.ModelResponse) else None


def _plain_parts(message: AIMessage, source: str) -> list[wire.ModelResponsePart]:
    from pydantic_ai import messages as wire

    return [
        *([wire.TextPart(encodable(message.text))] if message.text.strip() else ()),
        *(
            wire.ToolCallPart(
                wire_name(call.name), wire_arguments(call), tool_call_id=wire_id(call.id, source)
            )
            for call in message.calls
        ),
    ]
