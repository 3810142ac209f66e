"""Make a reply safe to keep, whoever gave it: a server, a script, or a model of one's own."""

from __future__ import annotations

import reprlib
from collections.abc import Iterable
from dataclasses import replace

from adamo_vh.action import ToolSchema
from adamo_vh.inference.arguments import clean_arguments
from adamo_vh.inference.messages import ToolCall
from adamo_vh.inference.model import Reply
from adamo_vh.inference.tool_names import meant_tool
from adamo_vh.readable import encodable


def tidied(reply: Reply, tools: Iterable[ToolSchema]) -> Reply:
    """A reply that can be recorded and sent, with each call under the name of the tool it means.

    Text that UTF-8 cannot hold is replaced. Arguments that are no JSON, or are nested beyond
    reason, count as unreadable.

    Args:
        reply: As the model gave it.
        tools: The tools on offer.
    """
    names = [tool.name for tool in tools]
    message = replace(
        reply.message,
        text=encodable(reply.message.text),
        calls=tuple(_tidied(call, names) for call in reply.message.calls),
    )
    return replace(
        reply,
        message=message,
        unreadable=encodable(reply.unreadable),
        finish_reason=encodable(reply.finish_reason),
    )


def _tidied(call: ToolCall, names: Iterable[str]) -> ToolCall:
    written = encodable(call.name)
    name = meant_tool(written, names) or written
    arguments = None if call.arguments is None else clean_arguments(call.arguments)
    raw = encodable(call.raw)
    if arguments is None and not raw:
        raw = _shown(call.arguments)
    return replace(
        call,
        id=encodable(call.id),
        name=name,
        arguments=arguments,
        raw=raw,
        written_name=call.written_name or (written if written != name else ""),
    )


def _shown(arguments: object) -> str:
    """What is no JSON, in few letters."""
    try:
        return encodable(reprlib.repr(arguments))
    except (ValueError, RecursionError):  # A whole number can be too long to be written.
        return "(no JSON)"
