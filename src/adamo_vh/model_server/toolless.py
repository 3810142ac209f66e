"""A model without tool calling: conversations whose calls are text, read and written.

The client describes the tools in its system prompt and tells past calls as text, see
`adamo_vh.inference.ladder`. Here that is read back, so that a model is given the same conversation
either way; its answer goes out in the form that the prompt asks for.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from enum import Enum, auto

from adamo_vh.action import ToolSchema
from adamo_vh.inference.arguments import wire_arguments
from adamo_vh.inference.ladder.json_form import JsonForm
from adamo_vh.inference.ladder.react_form import ReactForm
from adamo_vh.inference.ladder.steps import NOTE, Step
from adamo_vh.inference.ladder.steps import Form as Written
from adamo_vh.inference.messages import AIMessage, Message, ToolCall
from adamo_vh.model_server.fault_rules import WithoutTools
from adamo_vh.model_server.injected_faults import raw_of
from adamo_vh.model_server.json_fields import BadRequest
from adamo_vh.model_server.openai_messages import ChatRequest
from adamo_vh.model_server.told_steps import read_conversation
from adamo_vh.model_server.told_tools import schema_tools

_JSON, _REACT = JsonForm(), ReactForm()


class Form(Enum):
    """How an answer is written."""

    NATIVE = auto()
    """Calls as calls."""
    PROSE = auto()
    """The note alone: the model does not know what a call is."""
    STEP = auto()
    """One JSON object with a thought, an action and its arguments."""
    REACT = auto()
    """Thought, Action and Action Input, or a Final Answer."""


@dataclass(frozen=True, slots=True)
class Conversation:
    """What the model is given, and how its answer goes out."""

    messages: Sequence[Message]
    tools: Sequence[ToolSchema]
    form: Form


def conversation(asked: ChatRequest, can_call: bool, without: WithoutTools) -> Conversation:
    """What the model is given for a request.

    Args:
        asked: The request.
        can_call: Whether the model is served with tool calling.
        without: What a model without tool calling does with tools and schemas.

    Raises:
        BadRequest: The request has tools or a schema that the model refuses.
    """
    if asked.tools and can_call:
        return Conversation(asked.messages, asked.tools, Form.NATIVE)
    if asked.tools and without.tools == "refuse":
        raise BadRequest(
            "tools", "this model does not support tools; leave them out and describe them in words."
        )
    if asked.tools:
        return Conversation(asked.messages, asked.tools, Form.PROSE)
    told = read_conversation(asked.messages)
    obeys = can_call or without.schema == "obey"
    held = schema_tools(asked.schema) if asked.schema is not None and obeys else None
    if held is not None:
        return Conversation(told.messages, told.tools or held, Form.STEP)
    if asked.schema is not None and obeys:
        raise BadRequest(
            "response_format",
            "the reply of this model is a step: an object with a thought and an action; leave the "
            "format out, or ask for that.",
        )
    if not told.tools:
        return Conversation(asked.messages, (), Form.PROSE)
    as_json = told.as_json and asked.schema is None
    return Conversation(told.messages, told.tools, Form.STEP if as_json else Form.REACT)


def written(message: AIMessage, form: Form) -> AIMessage:
    """The answer of a model as a model without tool calling writes it.

    Args:
        message: The answer, with its calls.
        form: How to write it.
    """
    if form is Form.NATIVE:
        return message
    if form is Form.PROSE:
        names = ", ".join(call.name for call in message.calls)
        return AIMessage(message.text or (f"I would use {names} now." if names else ""))
    style: Written = _JSON if form is Form.STEP else _REACT
    if not message.calls:
        return AIMessage(style.write(Step("", answer=message.text)))
    steps = [_step(message.text if not at else "", c, style) for at, c in enumerate(message.calls)]
    return AIMessage("\n".join(steps))


def _step(text: str, call: ToolCall, style: Written) -> str:
    if call.arguments is None:
        # What could not be read as arguments is no more readable as text.
        whole = style.write(Step(text, call.name, {}))
        return f"{whole.removesuffix('{}')}{raw_of(call)}" if style is _REACT else whole[:-3]
    args = wire_arguments(call)
    note = args.pop(NOTE, "")
    return style.write(Step(text or str(note), call.name, args))
