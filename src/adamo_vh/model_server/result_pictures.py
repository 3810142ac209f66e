"""Pictures of tool results, which chat completions carry behind the results, put back into them."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import replace

from adamo_vh.inference.messages import (
    AIMessage,
    HumanMessage,
    ImagePart,
    Message,
    Part,
    TextPart,
    ToolMessage,
)
from adamo_vh.inference.remote.wire import CAPTION

_CAPTION = re.compile(rf"{CAPTION} \S+ \((.+)\):")


def with_result_pictures(messages: Sequence[Message]) -> tuple[Message, ...]:
    """Give each result the pictures that a message behind the results says are its own.

    Args:
        messages: A conversation as `adamo_vh.inference.remote.wire` writes it for chat completions.
    """
    found: list[Message] = []
    for message in messages:
        if not isinstance(message, HumanMessage):
            found.append(message)
        elif (left := _take_back(message.parts, found)) or not message.parts:
            found.append(HumanMessage(left))
    return tuple(found)


def _take_back(parts: Sequence[Part], found: list[Message]) -> tuple[Part, ...]:
    """Put pictures behind captions into the results before them; returns what is left."""
    results = _latest_results(found)
    left: list[Part] = []
    place: int | None = None
    for part in parts:
        if isinstance(part, TextPart):
            caption = _CAPTION.fullmatch(part.text)
            place = results.get(caption[1]) if caption else None
        result = None if place is None else found[place]
        if not isinstance(result, ToolMessage):
            left.append(part)
        elif place is not None and isinstance(part, ImagePart):
            found[place] = replace(result, images=(*result.images, part))
    return tuple(left)


def _latest_results(messages: Sequence[Message]) -> dict[str, int]:
    """Where the results of the last turn are, by call."""
    turns = [at for at, message in enumerate(messages) if isinstance(message, AIMessage)]
    start = turns[-1] if turns else len(messages)
    return {
        message.call_id: start + at
        for at, message in enumerate(messages[start:])
        if isinstance(message, ToolMessage)
    }
