"""A conversation with tool calls, told again for a model that has none."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence

from adamo_vh.action import ToolSchema
from adamo_vh.inference.arguments import wire_arguments
from adamo_vh.inference.ladder.descriptions import describe_tools
from adamo_vh.inference.ladder.steps import NOTE, Form, Step, ends_by_answer, takes_note
from adamo_vh.inference.messages import (
    AIMessage,
    HumanMessage,
    Message,
    SystemMessage,
    TextPart,
    ToolCall,
    ToolMessage,
)
from adamo_vh.inference.prompts import render

UNREADABLE = "unreadable "
"""Put before `AIMessage.kept` of a reply that was no step: it goes back as the model wrote it."""


def rewritten(
    messages: Sequence[Message], tools: Sequence[ToolSchema], form: Form
) -> list[Message]:
    """The same conversation in a form, without tools.

    Calls become steps in the model's own words, results become human messages that carry their
    pictures, several calls of one turn become steps one after another. Neighbours of one role are
    merged: many chat templates insist on turns, and on one system message.

    Args:
        messages: The prompt, oldest first.
        tools: The tools on offer; they are described behind the first system message.
        form: How steps are written.
    """
    final = ends_by_answer(tools)
    note = any(takes_note(tool) for tool in tools)
    text = render(form.name, tools=describe_tools(tools), final=final, note=note)
    told, about = list(_told(messages, form, final)), SystemMessage(text)
    first = 1 if told and isinstance(told[0], SystemMessage) else 0
    return merged([*told[:first], about, *told[first:]])


def merged(messages: Iterable[Message]) -> list[Message]:
    """The messages with neighbours of one role made one."""
    joined: list[Message] = []
    for message in messages:
        last = joined[-1] if joined else None
        if isinstance(last, SystemMessage) and isinstance(message, SystemMessage):
            joined[-1] = SystemMessage(f"{last.text}\n\n{message.text}")
        elif isinstance(last, HumanMessage) and isinstance(message, HumanMessage):
            joined[-1] = HumanMessage((*last.parts, *message.parts))
        elif isinstance(last, AIMessage) and isinstance(message, AIMessage):
            joined[-1] = AIMessage(f"{last.text}\n{message.text}", kept=message.kept)
        else:
            joined.append(message)
    return joined


def _told(messages: Sequence[Message], form: Form, by_answer: bool) -> Iterator[Message]:
    results: dict[str, ToolMessage] = {}
    for place, message in enumerate(messages):
        if isinstance(message, AIMessage):
            results = _results_after(messages, place)
            yield from _turn(message, results, form, by_answer)
        elif not isinstance(message, ToolMessage):
            yield message
        elif results.get(message.call_id) is not message:
            yield _result(message, form)


def _results_after(messages: Sequence[Message], place: int) -> dict[str, ToolMessage]:
    """The results of a turn, by call; a second result for a call stays where it is."""
    found: dict[str, ToolMessage] = {}
    message = messages[place]
    ids = {call.id for call in message.calls} if isinstance(message, AIMessage) else set()
    for later in messages[place + 1 :]:
        if not isinstance(later, ToolMessage):
            break
        if later.call_id in ids:
            found.setdefault(later.call_id, later)
    return found


def _turn(
    message: AIMessage, results: dict[str, ToolMessage], form: Form, by_answer: bool
) -> Iterator[Message]:
    if not message.calls:
        if message.text.strip():
            yield _said(message, form, by_answer)
        return
    for number, call in enumerate(message.calls):
        step = _step("" if number else message.text, call)
        yield AIMessage(form.write(step), kept="" if number else message.kept)
        if (result := results.get(call.id)) is not None:
            yield _result(result, form)


def _said(message: AIMessage, form: Form, by_answer: bool) -> AIMessage:
    """Text without a call: a final answer, or what could not be read, as it was."""
    if message.kept.startswith(UNREADABLE):
        return AIMessage(message.text, kept=message.kept.removeprefix(UNREADABLE))
    if not by_answer:
        return AIMessage(message.text, kept=message.kept)
    return AIMessage(form.write(Step("", answer=message.text)), kept=message.kept)


def _step(text: str, call: ToolCall) -> Step:
    args = wire_arguments(call)
    note = args.pop(NOTE, "")
    return Step(text or (note if isinstance(note, str) else ""), call.name, args)


def _result(message: ToolMessage, form: Form) -> HumanMessage:
    text = TextPart(f"{form.result_label}: {message.text}")
    return HumanMessage((text, *message.images))
