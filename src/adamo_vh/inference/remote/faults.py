"""Read what went wrong at a provider: is it worth another try, and what is there to say?"""

from __future__ import annotations

import re
from collections.abc import Collection, Mapping
from typing import Any
from urllib.parse import urljoin

from adamo_vh.inference.redaction import redacted
from adamo_vh.inference.remote.exchange import Exchange
from adamo_vh.inference.remote.retry import Failure
from adamo_vh.readable import encodable

_RETRYABLE_STATUS = frozenset({408, 409, 425, 429})
_LONGEST_TEXT = 500
_JUDGED = 20_000
"""Letters of an error that are looked at: whoever has more to say says it in the first of them."""
_STATUS = re.compile(r"[45]\d\d", re.ASCII)
_RETRY_DELAY = re.compile(r"\"retryDelay\": ?\"(\d{1,9}(?:\.\d{1,9})?)s\"")

_FIXES = {
    401: "Check the API key in the environment.",
    403: "Check the API key in the environment and what it may use.",
    404: "Check the model's name and the server's address.",
}

_PERMANENT = re.compile(
    r"mmproj"
    r"|image input is not supported|not support\w* (?:image|vision|multimodal)"
    r"|is not a multimodal model|at most 0 image"
    r"|failed to parse tool call arguments|invalid tool call arguments"
    r"|jinja|chat[ _]template|conversation roles must alternate",
    re.IGNORECASE,
)
"""Faults of the request that servers report as their own: no waiting mends them."""

_NO_PICTURES = re.compile(
    r"mmproj|image input is not supported|not support\w* (?:image|vision|multimodal)"
    r"|is not a multimodal model|at most 0 image",
    re.IGNORECASE,
)
_FEW_PICTURES = re.compile(
    r"(?:at most|up to|more than|max(?:imum)?(?: of)?) (\d{1,3}) image"
    r"|\bimages?\b.{0,40}?\b(?:limit of|max(?:imum)?(?: of| allowed)?:?) (\d{1,3})\b"
    r"|(?:only (?:one|1|a)(?: single)?|multiple|too many|single)[ -]images?\b",
    re.IGNORECASE,
)

_TOO_LONG = re.compile(
    r"context[ _]?(?:length|window|size)|maximum context|exceed_context|num_ctx"
    r"|\b(?:prompt|inputs?|sequence)\b(?:(?!image|picture).){0,200}?"
    r"\b(?:too (?:long|large)|longer than|exceed)"
    r"|longer than the (?:context|maximum model)|model(?:'s)? token limit|range of input length"
    r"|maximum prompt length|reduce the length of|too many (?:input|prompt) tokens"
    r"|max_new_tokens\W{0,2} must be",
    re.IGNORECASE | re.DOTALL,
)

_NO_CREDIT = ("insufficient_quota", "billing_hard_limit_reached", "insufficient_credits")

_ERROR_STATUS = {
    "authentication_error": 401,
    "billing_error": 402,
    "permission_error": 403,
    "not_found_error": 404,
    "request_too_large": 413,
    "rate_limit_error": 429,
    "rate_limit_exceeded": 429,
    "insufficient_quota": 429,
    "api_error": 500,
    "overloaded_error": 529,
}
"""HTTP status of an error that only names its type."""


def read_exchange(exchange: Exchange) -> Failure | None:
    """Read an answer's bytes.

    Returns:
        What is wrong with it; None if it is no plain error.
    """
    if exchange.fault:
        return Failure(exchange.fault, False, status=exchange.status)
    if exchange.status is None:
        return None
    if 300 <= exchange.status < 400:
        return _redirected(exchange)
    if exchange.status >= 400:
        return _failed(exchange.status, exchange.body or exchange.text, exchange)
    if "event-stream" in exchange.headers.get("content-type", ""):
        return None
    return _read_body(exchange)


def _read_body(exchange: Exchange) -> Failure | None:
    """What is wrong with the body of an answer under status 200."""
    body = exchange.body
    if not isinstance(body, dict):
        return Failure("The answer is no JSON object.", True)
    if blocked := _blocked(body):
        return Failure(f"The provider blocked the prompt: {_short(blocked)}", False)
    if error := _hidden_error(body):
        return _failed(_status_of(error), {"error": error}, exchange, hidden=True)
    # Google's library takes any object for an answer, and finds it empty.
    if "contents" in exchange.sent and not body.get("candidates"):
        return Failure("The answer holds no candidates.", True)
    return None


def _redirected(exchange: Exchange) -> Failure:
    """Redirects are not followed: the key would go where nobody sent it."""
    target = urljoin(exchange.location, exchange.headers.get("location", ""))
    for path in _PATHS:
        target = target.removesuffix(path)
    text = f"The server redirects to {_short(target).rstrip('.')}; use that address."
    return Failure(text, False, status=exchange.status)


_PATHS = ("/chat/completions", "/responses", "/v1/messages")
"""What the client libraries put behind an address."""


def _hidden_error(body: Mapping[str, Any]) -> Any:
    """An error that came under status 200, wherever it is; None if there is none."""
    if body.get("error"):
        return body["error"]
    choices = body.get("choices")
    first = choices[0] if isinstance(choices, list) and choices else None
    if not isinstance(first, dict):
        return None
    if first.get("error"):
        return first["error"]
    return {"message": "the answer broke off"} if first.get("finish_reason") == "error" else None


def _blocked(body: Mapping[str, Any]) -> str:
    feedback = body.get("promptFeedback")
    return str(feedback.get("blockReason") or "") if isinstance(feedback, dict) else ""


def _status_of(error: Any) -> int:
    """The HTTP status that an error stands for; 500 if it does not say."""
    if not isinstance(error, dict):
        return 500
    for value in (error.get("code"), error.get("status")):
        if found := _STATUS.fullmatch(str(value)):
            return int(found[0])
    for name in (str(error.get("type")), str(error.get("code"))):
        if name in _ERROR_STATUS:
            return _ERROR_STATUS[name]
        if name.startswith("invalid_"):
            return 400
    return 500


def _failed(status: int, body: Any, exchange: Exchange, *, hidden: bool = False) -> Failure:
    words = _server_text(body)
    everything = f"{words} {exchange.text}"[:_JUDGED]
    told = f"HTTP {exchange.status} with an error" if hidden else f"HTTP {status}"
    text = f"The server answered {told}: {_short(words)}"
    said = _short(words)
    if status != 429 and _TOO_LONG.search(everything):
        text = f"The prompt is longer than the model's context. {text} Keep fewer steps in it."
        return Failure(text, False, status=status, words=said)
    most = _most_pictures(everything)
    if fix := _FIXES.get(status) if most is None else picture_fix(most):
        text = f"{text} {fix}"
    final = _PERMANENT.search(everything) or _is_out_of_credit(body, everything)
    retryable = (status in _RETRYABLE_STATUS or status >= 500) and not final
    waits = _retry_after_s(exchange.headers, exchange.text)
    return Failure(text, retryable, waits, status=status, words=said, most_pictures=most)


def is_too_long(words: str) -> bool:
    """Whether a server complains of a prompt that is longer than its context."""
    return _TOO_LONG.search(words[:_JUDGED]) is not None


def picture_fix(most: int) -> str:
    """What to do about a server that takes so many pictures a prompt at most."""
    if most == 0:
        return "Leave the pictures out: --switch pictures=none."
    closeups = " and, if the profile has close-ups, --switch closeups=off --switch min_confidence=0"
    return f"Keep fewer pictures in the prompt: --switch pictures={most}{closeups * (most == 1)}."


def _most_pictures(complaint: str) -> int | None:
    """How many pictures a server takes that complains of too many; None if it does not."""
    if _NO_PICTURES.search(complaint):
        return 0
    if (found := _FEW_PICTURES.search(complaint)) is None:
        return None
    return int(found[1] or found[2] or 1)


def _is_out_of_credit(body: Any, everything: str) -> bool:
    """Used-up credit comes as 429 too, but no waiting brings it back."""
    error = body.get("error") if isinstance(body, dict) else None
    named = {str(error.get(key)) for key in ("code", "type")} if isinstance(error, dict) else set()
    return bool(named & {*_NO_CREDIT}) or "PerDay" in everything


def _retry_after_s(headers: Mapping[str, str], text: str) -> float | None:
    """Seconds that the server asked to wait, from a header or from Google's error details."""
    from pydantic_ai.exceptions import ModelHTTPError

    asked = ModelHTTPError(429, "", headers=dict(headers)).retry_after
    if asked is not None:
        return asked
    found = _RETRY_DELAY.search(text[:_JUDGED])
    return float(found.group(1)) if found else None


def read_error(error: Exception) -> Failure:
    """Classify what a request raised that left no answer, or none that can be read.

    Args:
        error: Any exception of the client library, or of its reading of the answer.
    """
    from pydantic_ai.exceptions import (
        ModelAPIError,
        ModelConnectionError,
        ModelHTTPError,
        ModelRequestTimeout,
        UserError,
    )

    if isinstance(error, ModelHTTPError):
        headers = {name.lower(): value for name, value in (error.headers or {}).items()}
        exchange = Exchange(status=error.status_code, headers=headers, text=str(error.body))
        return _failed(error.status_code, error.body, exchange)
    if isinstance(error, ModelConnectionError | ModelRequestTimeout):
        if getattr(error, "phase", None) == "connect":
            return Failure("No connection to the server. Is it running at that address?", True)
        return Failure(f"The connection failed: {_short(str(error))}", True)
    if isinstance(error, TimeoutError):
        return Failure("No whole answer came in time.", True)
    if isinstance(error, UserError):
        return Failure(f"The request cannot be made: {_short(str(error))}", False)
    if isinstance(error, ModelAPIError):
        return Failure(f"The request failed: {_short(str(error))}", True, error.retry_after)
    text = f"{type(error).__name__}: {error}"
    return Failure(f"The answer cannot be read: {_short(text)}", True)


SEVERAL_SYSTEM = "several_system_messages"
"""Not a parameter, but refused like one: by the chat templates of some models."""

USER_AFTER_TOOL = "user_after_tool"
"""Nor this: some servers want an answer between the results of calls and what a user says."""

_SPELLINGS = {
    "top_p": r"top_?p",
    "temperature": r"temperature",
    "parallel_tool_calls": r"parallel_tool_calls|disable_parallel_tool_use",
    "seed": r"seed",
    "max_tokens": r"max_tokens|max_completion_tokens|max_?output_?tokens",
    SEVERAL_SYSTEM: r"system (?:message|role)",
    USER_AFTER_TOOL: r"after (?:the )?(?:role )?['\"]?tool|roles must alternate|expected last role"
    r"|['\"]?user['\"]? (?:messages? )?(?:cannot|can't|must not|may not) follow (?:a )?['\"]?tool"
    r"|['\"]?tool['\"]? (?:messages? )?must be followed by|message[_ ]order|role sequence"
    r"|same number of function calls and responses|(?:unexpected|wrong) role",
}
"""How servers spell what may go, in the order in which it goes."""

_WRONG_ORDER = re.compile(r"invalid_request_message_order|\"code\": ?\"?3230\b")
"""The code for it of the one API that has one."""

_COMPLAINT = frozenset({400, 422})


def refused_setting(exchange: Exchange, present: Collection[str]) -> str | None:
    """The setting that a server refuses by name.

    Args:
        exchange: The answer.
        present: Settings in the request that may be left out.

    Returns:
        Its name; None if the server complains of something else.
    """
    if exchange.status == 500:
        # Some servers report as a fault of theirs what a chat template refuses.
        present = {SEVERAL_SYSTEM, USER_AFTER_TOOL} & {*present}
    elif exchange.status not in _COMPLAINT or _TOO_LONG.search(exchange.text[:_JUDGED]):
        return None
    text = _complaint(exchange.body)[:_JUDGED]
    if USER_AFTER_TOOL in present and _WRONG_ORDER.search(exchange.text[:_JUDGED]):
        return USER_AFTER_TOOL
    for name, spelling in _SPELLINGS.items():
        if name in present and re.search(rf"(?<![A-Za-z]){spelling}(?![A-Za-z])", text, re.I):
            return name
    return None


def _complaint(body: Any) -> str:
    """What a refusal is about: never the echo of the request that some carry."""
    if not isinstance(body, dict):
        return ""
    error, detail = body.get("error"), body.get("detail")
    if isinstance(error, dict) and error.get("param"):
        return str(error["param"])
    if isinstance(detail, list):
        found = [item for item in detail if isinstance(item, dict)]
        return " ".join(f"{item.get('loc')} {item.get('msg')}" for item in found)
    return _server_text(body)


def _server_text(body: object) -> str:
    """The human part of an error body, wherever the server put it."""
    for _ in range(3):
        if not isinstance(body, dict):
            break
        body = next((body[key] for key in ("error", "message", "detail") if body.get(key)), "")
    return str(body) if body else "(no message)"


def _short(text: str) -> str:
    """One line without keys; redacted before it is cut, so that no half of a key survives."""
    whole = " ".join(encodable(text[: 2 * _JUDGED]).split())
    # A key that the first cut went through is not shown, however few blanks were taken out.
    text = redacted(whole if len(text) <= 2 * _JUDGED else whole[: _JUDGED // 2])
    text = text if len(text) <= _LONGEST_TEXT else f"{text[:_LONGEST_TEXT]}..."
    return text if text.endswith((".", "!", "?")) else f"{text}."
