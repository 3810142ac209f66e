"""One recorded model call as plain data, and how two of them are compared.

Pictures are kept by hash and size, not as bytes: they make most of a prompt, and another machine
may draw them a little differently.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cache
from typing import Annotated, Any, Literal, assert_never

from pydantic import Field, TypeAdapter

from adamo_vh.action import ToolSchema
from adamo_vh.inference.messages import (
    AIMessage,
    HumanMessage,
    ImagePart,
    Message,
    SystemMessage,
    TextPart,
    ToolCall,
    ToolMessage,
)
from adamo_vh.inference.model import Reply, Sampling
from adamo_vh.inference.redaction import clean_message, cleaned, redacted
from adamo_vh.readable import encodable

Clean = Callable[[str], str]


def without_keys(text: str) -> str:
    """The text without keys, and without what UTF-8 cannot spell."""
    return redacted(encodable(text))


@dataclass(frozen=True, slots=True)
class Picture:
    """What is kept of a picture."""

    sha256: str
    media_type: str
    width_px: int
    height_px: int
    type: Literal["picture"] = "picture"


@dataclass(frozen=True, slots=True)
class Text:
    """A piece of text."""

    text: str
    type: Literal["text"] = "text"


@dataclass(frozen=True, slots=True)
class Human:
    """A `HumanMessage` without the bytes of its pictures."""

    parts: tuple[Annotated[Text | Picture, Field(discriminator="type")], ...]
    role: Literal["human"] = "human"


@dataclass(frozen=True, slots=True)
class ToolResult:
    """A `ToolMessage` without the bytes of its pictures."""

    call_id: str
    name: str
    text: str
    images: tuple[Picture, ...] = ()
    role: Literal["tool"] = "tool"


Plain = SystemMessage | Human | AIMessage | ToolResult


@dataclass(frozen=True, slots=True)
class Request:
    """What a model was asked."""

    messages: tuple[Annotated[Plain, Field(discriminator="role")], ...]
    tools: tuple[ToolSchema, ...]
    sampling: Sampling


@dataclass(frozen=True, slots=True)
class Call:
    """A request and its reply."""

    number: int
    request: Request
    reply: Reply


@cache
def codec() -> TypeAdapter[Call]:
    """Reads and writes calls as JSON."""
    return TypeAdapter(Call)


def request_of(
    messages: Sequence[Message],
    tools: Sequence[ToolSchema],
    sampling: Sampling,
    clean: Clean = without_keys,
) -> Request:
    """A request as plain data.

    Args:
        messages: The prompt.
        tools: The tools on offer.
        sampling: Decoding settings.
        clean: Is applied to every text; takes keys out unless told otherwise.
    """
    offered = tuple(
        ToolSchema(clean(t.name), clean(t.description), cleaned(t.parameters, clean)) for t in tools
    )
    return Request(tuple(_plain(m, clean) for m in messages), offered, sampling)


def clean_reply(reply: Reply, clean: Clean = without_keys) -> Reply:
    """A reply without keys."""
    return replace(
        reply,
        message=clean_message(reply.message, clean),
        settings=cleaned(dict(reply.settings), clean),
        unreadable=clean(reply.unreadable),
        finish_reason=clean(reply.finish_reason),
        warning=clean(reply.warning),
    )


def sections(request: Request) -> list[tuple[str, str]]:
    """A request as titled texts that two requests can be compared by.

    Of pictures only the size is in it; what a provider wants back with an answer is not.
    """
    told = [
        (f"message {number} ({message.role})", _shown(message))
        for number, message in enumerate(request.messages, start=1)
    ]
    tools = [
        (f"tool {tool.name}", _json({"description": tool.description, "args": tool.parameters}))
        for tool in request.tools
    ]
    sampling = TypeAdapter(Sampling).dump_python(request.sampling)
    return [*told, *tools, ("sampling", _json(sampling))]


def _plain(message: Message, clean: Clean) -> Plain:
    match message:
        case SystemMessage():
            return SystemMessage(clean(message.text))
        case AIMessage():
            return clean_message(message, clean)
        case HumanMessage():
            return Human(
                tuple(
                    Text(clean(part.text)) if isinstance(part, TextPart) else _picture(part)
                    for part in message.parts
                )
            )
        case ToolMessage():
            images = tuple(map(_picture, message.images))
            return ToolResult(message.call_id, message.name, clean(message.text), images)
        case _:
            assert_never(message)


def _picture(part: ImagePart) -> Picture:
    digest = hashlib.sha256(part.data).hexdigest()
    return Picture(digest, part.media_type, part.width_px, part.height_px)


def _shown(message: Plain) -> str:
    match message:
        case SystemMessage():
            return message.text
        case Human():
            parts = (p.text if isinstance(p, Text) else _size(p) for p in message.parts)
            return "\n".join(parts)
        case AIMessage():
            return "\n".join([message.text, *map(_call, message.calls)])
        case ToolResult():
            head = f"[result of {message.name}, call {message.call_id}]"
            return "\n".join([head, message.text, *map(_size, message.images)])
        case _:
            assert_never(message)


def _size(picture: Picture) -> str:
    return f"[picture {picture.width_px} x {picture.height_px} px]"


def _call(call: ToolCall) -> str:
    arguments = call.raw if call.arguments is None else _json(dict(call.arguments), indent=None)
    return f"[call {call.id}] {call.name} {arguments}"


def _json(value: Any, indent: int | None = 1) -> str:
    return json.dumps(value, indent=indent, sort_keys=True, ensure_ascii=False)
