"""Neutral messages between the agent and any model, in the paper's four roles."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Literal


@dataclass(frozen=True, slots=True)
class TextPart:
    """A piece of text."""

    text: str


@dataclass(frozen=True, slots=True)
class ImagePart:
    """An encoded picture."""

    data: bytes
    media_type: str
    width_px: int
    height_px: int


Part = TextPart | ImagePart


@dataclass(frozen=True, slots=True)
class SystemMessage:
    """Instructions, or the symbolic state."""

    text: str
    role: Literal["system"] = "system"


@dataclass(frozen=True, slots=True)
class HumanMessage:
    """The user's instruction, or a frame."""

    parts: tuple[Part, ...]
    role: Literal["human"] = "human"

    @property
    def text(self) -> str:
        """All text parts, joined by newlines."""
        return "\n".join(part.text for part in self.parts if isinstance(part, TextPart))


@dataclass(frozen=True, slots=True)
class ToolCall:
    """A tool call as the model wrote it."""

    id: str
    name: str
    arguments: Mapping[str, Any] | None
    """The arguments, or None if they could not be read as a JSON object."""
    raw: str = ""
    """The arguments as the model wrote them."""
    written_name: str = ""
    """The name as the model wrote it, where it was read as that of the tool it means."""


@dataclass(frozen=True, slots=True)
class AIMessage:
    """What a model answered: a note and its calls."""

    text: str
    calls: tuple[ToolCall, ...] = ()
    kept: str = ""
    """What the provider wants back with this message (signatures of its thinking), opaque to all
    others; empty if nothing."""
    role: Literal["ai"] = "ai"


@dataclass(frozen=True, slots=True)
class ToolMessage:
    """The feedback on one tool call."""

    call_id: str
    name: str
    text: str
    images: tuple[ImagePart, ...] = ()
    """Pictures that belong to the feedback. A wire whose tool results carry text alone sends them
    right behind the results, as a human message."""
    role: Literal["tool"] = "tool"


Message = SystemMessage | HumanMessage | AIMessage | ToolMessage


def pictures_of(message: Message) -> tuple[ImagePart, ...]:
    """The pictures of a message, in order."""
    if isinstance(message, HumanMessage):
        return tuple(part for part in message.parts if isinstance(part, ImagePart))
    return message.images if isinstance(message, ToolMessage) else ()
