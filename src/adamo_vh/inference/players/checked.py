"""An own model at the door: its mistakes become sentences that name it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from adamo_vh.action import ToolSchema
from adamo_vh.errors import AdamoError, ModelConfigError, ModelError
from adamo_vh.inference.messages import AIMessage, Message, ToolCall
from adamo_vh.inference.model import Model, ModelInfo, ModelKind, Reply, Sampling, Usage
from adamo_vh.inference.players.wrapper import Ask, Wrapped

_EXAMPLE = 'info = ModelInfo("my-model", ModelKind.VLM)'


def checked(model: Model) -> Model:
    """A model whose answers are looked at before anybody relies on them.

    Args:
        model: Somebody's own, which may be anything.

    Raises:
        ModelConfigError: It is no model: names what is missing.
    """
    who = type(model).__name__
    if not callable(getattr(model, "complete", None)):
        raise ModelConfigError(
            f"{who} is no model: it lacks complete(messages, tools, sampling), which gives a Reply."
        )
    info = getattr(model, "info", None)
    if not isinstance(info, ModelInfo):
        raise ModelConfigError(f"{who} is no model: it lacks info; give it {_EXAMPLE}.")
    if not isinstance(info.name, str) or not isinstance(info.kind, ModelKind):
        raise ModelConfigError(f"{who}: its info needs a name and a kind; give it {_EXAMPLE}.")

    def answer(
        ask: Ask, messages: Sequence[Message], tools: Sequence[ToolSchema], sampling: Sampling
    ) -> Reply:
        try:
            reply = ask(messages, tools, sampling)
        except AdamoError:
            raise
        except Exception as error:
            what = f"{type(error).__name__}: {error}"
            raise ModelError(f"The model {who} failed in complete(): {what}.") from error
        if problem := _problem(reply):
            raise ModelError(f"The model {who} {problem}")
        return reply

    return Wrapped(model, answer)


def _problem(reply: Any) -> str:
    """What is wrong with a reply, as the rest of a sentence; empty if nothing is."""
    if not isinstance(reply, Reply):
        return f"gave {_kind(reply)} instead of a Reply, e.g. Reply(AIMessage(text, calls))."
    message = reply.message
    if not isinstance(message, AIMessage) or not isinstance(message.text, str):
        return f"gave a Reply whose message is {_kind(message)}; make it an AIMessage with a text."
    if not isinstance(message.calls, tuple) or not all(map(_is_call, message.calls)):
        return (
            "gave calls that are none; make them a tuple of ToolCall(id, name, arguments), with "
            "texts and a mapping."
        )
    if not isinstance(reply.usage, Usage):
        return f"gave {_kind(reply.usage)} as usage; make it a Usage, or leave it out."
    for name in ("seconds", "waited_s", "requests"):
        value = getattr(reply, name)
        if isinstance(value, bool) or not isinstance(value, int | float) or not value >= 0:
            return f"gave {value!r} as {name}; make it a number of 0 or more, or leave it out."
    return ""


def _is_call(call: Any) -> bool:
    return (
        isinstance(call, ToolCall)
        and isinstance(call.id, str)
        and isinstance(call.name, str)
        and (call.arguments is None or isinstance(call.arguments, Mapping))
        and isinstance(call.raw, str)
    )


def _kind(value: Any) -> str:
    return "None" if value is None else f"a {type(value).__name__}"
