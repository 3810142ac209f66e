"""Why an answer ended: the words of every provider for it, and what they mean."""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Any

from adamo_vh.inference.model import Ending
from adamo_vh.inference.redaction import redacted
from adamo_vh.readable import encodable

_MEANINGS = (
    (
        Ending.FILTERED,
        r"filter|safety|refus|block|prohibit|recit|sensitiv|moderat|guardrail|spii|toxic|language"
        r"|policy",
    ),
    (Ending.UNPARSED_CALL, r"malformed|unexpected_tool|too_many_tool|invalid_tool|parse"),
    (
        Ending.CUT_OFF,
        r"length|max|limit|context|trunc|incomplete|pause|abort|cancel|interrupt|exceed|budget"
        r"|time_?out|in_progress|queued|unspecified|\Aother\Z",
    ),
)
"""What an ending means by the words in it; whatever has none of them is an end of its own."""

_OWN_CALL = re.compile(
    r"\bpars(?:e|ing)\b.{0,40}?\b(?:tool|function)[ _-]?call"
    r"|\b(?:tool|function)[ _-]?calls?\b.{0,60}?\b(?:not be parsed|pars(?:e|ing) (?:error|fail)"
    r"|failed to parse|is not valid JSON)"
    r"|\bfailed to parse input at pos\b"
    r"|\bmodel\b.{0,40}?\b(?:not a valid (?:tool|function)[ _-]?call"
    r"|output that could not be parsed)"
    r"|\b(?:malformed|invalid|unparsable)\b.{0,20}?\b(?:tool|function)[ _-]?call.{0,40}?"
    r"\b(?:generat|output|by the model|from model|from the model)"
    r"|\bmodel\b.{0,40}?\b(?:malformed|invalid|unparsable)\b.{0,20}?\b(?:tool|function)[ _-]?call"
    r"|\btool call validation failed\b|\battempted to call tool\b|\bfailed to call a function\b"
    r"|\btool_use_failed\b|\boutput_parse_failed\b"
    r"|\bmodel (?:has )?(?:called|(?:tried|attempted) to call) (?:a|an unknown) (?:tool|function)\b"
    r"|\b(?:produced|generated?) (?:an? )?(?:in)?valid\b.{0,40}?\btool[ _-]?(?:use|call)"
    r"|\berror in extracting (?:tool|function) call"
    r"|\b(?:Extra data|Unterminated string starting at|Expecting (?:property name[\w ]{0,40}"
    r"|'[,:]' delimiter)|Invalid \\{1,2}(?:escape|uXXXX escape)|Invalid control character at)"
    r": line \d{1,6} column \d{1,6}",
    re.IGNORECASE | re.DOTALL,
)
"""How servers complain that they cannot read the call which the model has just written.

A bare complaint about JSON, too: a request is always whole JSON, down to the arguments of calls.
"""
_ABOUT_REQUEST = re.compile(r"\bmessages?(?:\[|\.\d)|tool_call_id|\brole\b", re.IGNORECASE)
_RAW = re.compile(r"raw='(.*)', err=", re.DOTALL)
_JUDGED = 20_000
"""Letters of an error that are looked at."""
_SHOWN = 200


def meaning(reason: str) -> Ending | None:
    """What a provider's word for an end says about an answer; None if it ended by itself."""
    for ending, words in _MEANINGS:
        if re.search(words, reason[:_SHOWN], re.IGNORECASE):
            return ending
    return None


def finish_reason(body: Any) -> str:
    """Why an answer ended, in the provider's own word; empty if its body does not say.

    Args:
        body: JSON body of an answer of any of the four wires.
    """
    if not isinstance(body, dict):
        return ""
    details = body.get("incomplete_details")
    for holder, key in (
        (_first(body, "choices"), "finish_reason"),
        (_first(body, "candidates"), "finishReason"),
        (body, "stop_reason"),
        (details, "reason"),
        (body, "status"),
    ):
        value = holder.get(key) if isinstance(holder, dict) else None
        if isinstance(value, str) and value:
            return encodable(value[:_SHOWN])
    return ""


def refused_call(body: Any, text: str) -> tuple[str, str] | None:
    """The call of the model's own that an error complains of.

    Args:
        body: The error as JSON; None if it is none.
        text: The error as it came.

    Returns:
        What the model wrote, as far as the server shows it, and the complaint; None if the error
        is about something else.
    """
    error = body.get("error", body) if isinstance(body, dict) else None
    written = error.get("failed_generation") if isinstance(error, dict) else None
    message = error.get("message") if isinstance(error, dict) else error
    complaint = message if isinstance(message, str) else text
    shown = f"{complaint} {text}"[:_JUDGED]
    if not isinstance(written, str):
        if not _OWN_CALL.search(shown) or _ABOUT_REQUEST.search(complaint[:_JUDGED]):
            return None
        raw = _RAW.search(complaint[:_JUDGED])
        written = raw[1] if raw else ""
    plain = " ".join(redacted(encodable(complaint[:_JUDGED])).split())
    return encodable(written[:_JUDGED]), plain[:_SHOWN]


def _first(body: Mapping[str, Any], key: str) -> Any:
    items = body.get(key)
    return items[0] if isinstance(items, list) and items else None
