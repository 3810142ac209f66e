"""Answers to the questions of `adamo-vh models check`.

They ask what the wire carries, not how to play: whether a picture arrives, a call, a schema. So the
endpoint answers them itself, the same for every model it serves, and no script moves on.
"""

from __future__ import annotations

import io
from collections.abc import Sequence
from functools import cache

from adamo_vh.action import ToolSchema
from adamo_vh.inference.messages import (
    AIMessage,
    HumanMessage,
    ImagePart,
    Message,
    ToolCall,
    ToolMessage,
    pictures_of,
)
from adamo_vh.inference.prompts import render
from adamo_vh.inference.remote.probe import COLOURS, LAMP


def answer_to_probe(messages: Sequence[Message], tools: Sequence[ToolSchema]) -> AIMessage | None:
    """The answer to a question of the probe; None if the request is another one.

    Args:
        messages: The conversation.
        tools: The tools on offer.
    """
    human = [message for message in messages if isinstance(message, HumanMessage)]
    question = human[0].text.strip() if human else ""
    if question not in _questions():
        return None
    pictures = [part for message in messages for part in pictures_of(message)]
    offered = any(tool.name == LAMP.name for tool in tools)
    if offered and not any(isinstance(message, ToolMessage) for message in messages):
        return AIMessage("", (ToolCall("call_probe", LAMP.name, {"lamp": "desk"}),))
    return AIMessage(_halves(pictures[-1]) if pictures else "ready")


@cache
def _questions() -> frozenset[str]:
    return frozenset(render(f"probe_{name}") for name in ("colours", "tool", "schema", "word"))


def _halves(picture: ImagePart) -> str:
    """The colours in the middle of the two halves of a picture."""
    from PIL import Image

    with Image.open(io.BytesIO(picture.data)) as opened:
        seen = opened.convert("RGB")
    middle = picture.height_px // 2
    return " ".join(
        _named(seen.getpixel((picture.width_px * part // 4, middle))) for part in (1, 3)
    )


def _named(colour: object) -> str:
    values = colour if isinstance(colour, tuple) else (0, 0, 0)

    def distance(name: str) -> int:
        return sum(abs(one - int(other)) for one, other in zip(COLOURS[name], values, strict=True))

    return min(COLOURS, key=distance)
