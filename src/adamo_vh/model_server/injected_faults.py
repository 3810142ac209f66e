"""Spoil the answers of a served model on purpose, as real servers and models do."""

from __future__ import annotations

import json
from dataclasses import replace

from adamo_vh.inference.arguments import dump_arguments
from adamo_vh.inference.messages import AIMessage, ToolCall
from adamo_vh.model_server.fault_rules import Rule, Style, What

UNKNOWN_TOOL = "Teleport"
"""A tool that no body has."""

WRONG_ARGUMENTS = {"target": "somewhere"}
"""Arguments that no tool takes."""

GARBAGE = b"<html><body>Bad gateway</body></html>"
"""A body that is no JSON."""

HALF = b'{"id": "chatcmpl-0", "object": "chat.completion", "choices": [{"index": 0, "mess'
"""The first half of a completion."""

_MESSAGES = {
    400: "The request was refused.",
    401: "Incorrect API key provided.",
    404: "The model does not exist.",
    429: "Rate limit reached.",
    503: "The server is overloaded.",
}


def error_message(rule: Rule) -> str:
    """The text of the error that a rule brings about."""
    if rule.message is not None:
        return rule.message
    if rule.what is What.REFUSED_PARAMETER:
        return (
            f"Unsupported parameter: '{rule.parameter}' is not supported with this model. "
            "Leave it out."
        )
    return _MESSAGES.get(rule.status or 500, "The server had an error.")


def spoiled(message: AIMessage, rule: Rule) -> AIMessage:
    """What becomes of an answer under a rule.

    Args:
        message: The answer of the model. One without a call has none to spoil and stays as it is,
            unless the rule empties it.
        rule: The fault.
    """
    if rule.what is What.EMPTY_REPLY:
        return AIMessage("")
    if not message.calls:
        return message
    call = message.calls[0]
    match rule.what:
        case What.UNKNOWN_TOOL:
            return replace(message, calls=(replace(call, name=UNKNOWN_TOOL),))
        case What.WRONG_ARGUMENTS:
            raw = dump_arguments(WRONG_ARGUMENTS)
            return replace(message, calls=(replace(call, arguments=WRONG_ARGUMENTS, raw=raw),))
        case What.BROKEN_ARGUMENTS:
            return replace(message, calls=(replace(call, arguments=None, raw=raw_of(call)[:-1]),))
        case What.TWO_CALLS:
            return replace(message, calls=(call, replace(call, id=f"{call.id}_2")))
        case What.LEAKED_CALL:
            written = _written(call, rule.style or Style.FENCE)
            return AIMessage(f"{message.text}\n{written}".strip())
    return message


def is_as_it_is(message: AIMessage, rule: Rule) -> bool:
    """Whether what a rule makes of an answer goes out in no form at all, not even as text steps."""
    leaks = rule.what is What.LEAKED_CALL and bool(message.calls)
    return leaks or rule.what is What.EMPTY_REPLY


def raw_of(call: ToolCall) -> str:
    """The arguments of a call as JSON text, as the model wrote them if it did."""
    return call.raw or dump_arguments(call.arguments or {})


def _written(call: ToolCall, style: Style) -> str:
    body = json.dumps({"name": call.name, "arguments": call.arguments or {}}, ensure_ascii=False)
    if style is Style.FENCE:
        return f"```json\n{body}\n```"
    return f"<tool_call>\n{body}\n</tool_call>" if style is Style.TAGS else body
