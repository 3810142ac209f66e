"""Past calls that a conversation tells as text, read back into calls and their results."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from adamo_vh.action import ToolSchema
from adamo_vh.inference.arguments import dump_arguments
from adamo_vh.inference.ladder.json_form import JsonForm
from adamo_vh.inference.ladder.react_form import ReactForm
from adamo_vh.inference.ladder.steps import Step
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
from adamo_vh.model_server.told_tools import split_description, told_tools

_FORMS = (JsonForm(), ReactForm())


@dataclass(frozen=True, slots=True)
class Told:
    """A conversation in which calls are calls again."""

    messages: tuple[Message, ...]
    tools: tuple[ToolSchema, ...]
    """The tools that the prompt describes; none if it is no such conversation."""
    as_json: bool
    """Whether the prompt asks for JSON steps, not for lines of text."""


def read_conversation(messages: Sequence[Message]) -> Told:
    """Read a conversation as a model with tool calling would have been given it.

    Args:
        messages: The conversation, in which neighbours of one role may have been merged.
    """
    reader = _Reader()
    for message in messages:
        reader.take(message)
    return Told(tuple(reader.messages), reader.tools, reader.as_json)


class _Reader:
    """Goes through a conversation and remembers which call still waits for its result."""

    def __init__(self) -> None:
        self.messages: list[Message] = []
        self.tools: tuple[ToolSchema, ...] = ()
        self.as_json = False
        self._open: ToolCall | None = None

    def take(self, message: Message) -> None:
        """Read the next message."""
        match message:
            case SystemMessage(text):
                self._system(text)
            case AIMessage(text):
                self._said(text)
            case HumanMessage(parts):
                self._heard(message, parts[0] if parts else None)
            case _:
                self.messages.append(message)

    def _system(self, text: str) -> None:
        before, description, behind = split_description(text)
        if description:
            self.tools = told_tools(description)
            self.as_json = '"thought"' in description
        self.messages += [SystemMessage(part) for part in (before, behind) if part]

    def _said(self, text: str) -> None:
        forms = _FORMS if self.as_json else _FORMS[::-1]
        outcomes = [form.read(text, self.tools) for form in forms]
        step = next((found for found in outcomes if isinstance(found, Step)), None)
        if step is None:
            # It could not be read and had no effect; the model is asked for the same again.
            return
        if step.action is None:
            self.messages.append(AIMessage(step.answer))
            return
        args = dict(step.args)
        self._open = ToolCall(f"step_{len(self.messages)}", step.action, args, dump_arguments(args))
        self.messages.append(AIMessage(step.thought, (self._open,)))

    def _heard(self, message: HumanMessage, first: object) -> None:
        label = f"{_FORMS[0 if self.as_json else 1].result_label}: "
        call, self._open = self._open, None
        if call is None or not isinstance(first, TextPart) or not first.text.startswith(label):
            self.messages.append(message)
            return
        end = 1
        while end < len(message.parts) and isinstance(message.parts[end], ImagePart):
            end += 1
        images = tuple(p for p in message.parts[1:end] if isinstance(p, ImagePart))
        text = first.text.removeprefix(label)
        self.messages.append(ToolMessage(call.id, call.name, text, images))
        if message.parts[end:]:
            self.messages.append(HumanMessage(message.parts[end:]))
