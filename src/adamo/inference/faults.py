"""Read what went wrong at a provider: is it worth another try, and what is there to say?"""

from __future__ import annotations

from typing import Any

from adamo.inference.redaction import redacted
from adamo.inference.retry import Failure

_RETRYABLE_STATUS = frozenset({408, 409, 425, 429})
_LONGEST_TEXT = 500

_FIXES = {
    401: "Check the API key in the environment.",
    403: "Check the API key in the environment and what it may use.",
    404: "Check the model's name and the server's address.",
}


def read_failure(error: Exception) -> Failure:
    """Classify what a request raised.

    Args:
        error: Any exception of the client library, or of its reading of the answer.
    """
    from pydantic_ai.exceptions import (
        ModelAPIError,
        ModelConnectionError,
        ModelHTTPError,
        ModelQuotaExceededError,
        ModelRequestRejectedError,
        ModelRequestTimeout,
        UserError,
    )

    if isinstance(error, ModelHTTPError):
        return _http_failure(error, quota=isinstance(error, ModelQuotaExceededError))
    if isinstance(error, ModelConnectionError | ModelRequestTimeout):
        if getattr(error, "phase", None) == "connect":
            return Failure("No connection to the server. Is it running at that address?", True)
        return Failure(f"The connection failed: {_short(str(error))}", True)
    if isinstance(error, ModelRequestRejectedError | ModelQuotaExceededError | UserError):
        return Failure(f"The request was refused: {_short(str(error))}", False)
    if isinstance(error, ModelAPIError):
        return Failure(f"The request failed: {_short(str(error))}", True, error.retry_after)
    text = f"{type(error).__name__}: {error}"
    return Failure(f"The answer cannot be read: {_short(text)}", True)


def _http_failure(error: Any, *, quota: bool) -> Failure:
    status: int = error.status_code
    # Used-up credit comes as 429 too, but no waiting brings it back.
    retryable = (status in _RETRYABLE_STATUS or status >= 500) and not quota
    text = f"The server answered HTTP {status}: {_short(_server_text(error.body))}"
    if fix := _FIXES.get(status):
        text = f"{text} {fix}"
    return Failure(text, retryable, error.retry_after)


def _server_text(body: object) -> str:
    """The human part of an error body, wherever the server put it."""
    for _ in range(3):
        if not isinstance(body, dict):
            break
        body = next((body[key] for key in ("error", "message", "detail") if body.get(key)), "")
    return str(body) if body else "(no message)"


def _short(text: str) -> str:
    """One line without keys; redacted before it is cut, so that no half of a key survives."""
    text = " ".join(redacted(text).split())
    text = text if len(text) <= _LONGEST_TEXT else f"{text[:_LONGEST_TEXT]}..."
    return text if text.endswith((".", "!", "?")) else f"{text}."
