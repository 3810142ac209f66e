"""Prompts and answers in the words of the OpenAI chat format.

Every content is a list of parts, also where it is text alone: the format allows it, and readers of
tables (Arrow, `datasets`) want one type in one column.
"""

from __future__ import annotations

import json
from collections.abc import Iterator, Sequence
from typing import Any

from adamo_vh.action import ToolSchema
from adamo_vh.adapters.exports.pictures import Pictures
from adamo_vh.inference.messages import (
    AIMessage,
    HumanMessage,
    ImagePart,
    Message,
    Part,
    SystemMessage,
    ToolMessage,
)

_BEHIND = "Pictures of the results above."


def chat_tools(tools: Sequence[ToolSchema]) -> list[dict[str, Any]]:
    """The tools on offer, as function definitions."""
    return [
        {
            "type": "function",
            "function": {
                "name": tool.name,
                "description": tool.description,
                "parameters": dict(tool.parameters),
            },
        }
        for tool in tools
    ]


def chat_messages(messages: Sequence[Message], pictures: Pictures) -> list[dict[str, Any]]:
    """A prompt.

    Args:
        messages: Oldest first.
        pictures: Where pictures go.
    """
    written: list[dict[str, Any]] = []
    behind: list[ImagePart] = []
    for message in messages:
        if behind and not isinstance(message, ToolMessage):
            written.append(_behind(behind, pictures))
            behind = []
        written.append(chat_message(message, pictures))
        if isinstance(message, ToolMessage):
            # In this format a result is text alone; its pictures come right behind the results.
            behind.extend(message.images)
    return [*written, _behind(behind, pictures)] if behind else written


def chat_message(message: Message, pictures: Pictures) -> dict[str, Any]:
    """One message; the pictures of a tool's result are left out.

    Args:
        message: Of any role.
        pictures: Where pictures go.
    """
    match message:
        case SystemMessage():
            return {"role": "system", "content": [_text(message.text)]}
        case HumanMessage():
            return {"role": "user", "content": list(_parts(message.parts, pictures))}
        case ToolMessage():
            content = [_text(message.text)]
            return {"role": "tool", "tool_call_id": message.call_id, "content": content}
        case AIMessage():
            return _answer(message)


def _answer(message: AIMessage) -> dict[str, Any]:
    written: dict[str, Any] = {"role": "assistant"}
    if message.text or not message.calls:
        written["content"] = [_text(message.text)]
    if message.calls:
        written["tool_calls"] = [
            {
                "id": call.id,
                "type": "function",
                "function": {
                    "name": call.name,
                    "arguments": call.raw
                    if call.arguments is None
                    else json.dumps(dict(call.arguments), ensure_ascii=False),
                },
            }
            for call in message.calls
        ]
    return written


def _behind(images: Sequence[ImagePart], pictures: Pictures) -> dict[str, Any]:
    parts = [_text(_BEHIND), *(_image(image, pictures) for image in images)]
    return {"role": "user", "content": parts}


def _parts(parts: Sequence[Part], pictures: Pictures) -> Iterator[dict[str, Any]]:
    for part in parts:
        yield _image(part, pictures) if isinstance(part, ImagePart) else _text(part.text)


def _text(text: str) -> dict[str, Any]:
    return {"type": "text", "text": text}


def _image(image: ImagePart, pictures: Pictures) -> dict[str, Any]:
    return {"type": "image_url", "image_url": {"url": pictures.url(image)}}
