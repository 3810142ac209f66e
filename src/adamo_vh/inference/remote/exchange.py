"""What really went over the wire: a client that notes each request's bytes and the answer's.

The client libraries drop settings that they know a model to refuse, repeat requests on their own
account, and read errors each in their own way. What is recorded and what is judged is therefore
taken from the bytes, not from what the library was asked for.
"""

from __future__ import annotations

import json
import time
from collections.abc import Mapping
from contextvars import ContextVar
from dataclasses import dataclass, field
from functools import cache
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    import ssl

    import httpx2

_CONNECT_S = 10.0
"""A server that takes longer to accept a connection is not there."""


@dataclass(slots=True)
class Exchange:
    """The bytes of one try; filled in while it runs."""

    required: tuple[str, ...] = ()
    """Settings without which nothing may be sent."""
    requests: int = 0
    """Requests that went out."""
    sent: Mapping[str, Any] = field(default_factory=dict)
    """Body of the last request."""
    withheld: tuple[str, ...] = ()
    """Required settings that the client library left out; then nothing went out."""
    status: int | None = None
    """HTTP status of the last answer; None if there was none."""
    headers: Mapping[str, str] = field(default_factory=dict)
    """Headers of the last answer, names in lower case."""
    text: str = ""
    """Body of the last answer."""
    seconds: float = 0.0
    """From the last request to the end of its answer; 0 if there was none."""
    started_s: float = 0.0
    """When the last request went out, on the monotonic clock."""

    @property
    def body(self) -> Any:
        """The body of the last answer as JSON; None if it is none."""
        try:
            return json.loads(self.text)
        except (ValueError, RecursionError):
            return None


_current: ContextVar[Exchange | None] = ContextVar("adamo_exchange", default=None)


class SettingWithheldError(RuntimeError):
    """A required setting is not in the request; raised before anything is sent."""


def watch(exchange: Exchange) -> None:
    """Note what the current task, and the tasks it starts, send and get from here on."""
    _current.set(exchange)


def watching_client(timeout_s: float) -> httpx2.AsyncClient:
    """Make an HTTP client that notes what it sends and gets.

    Args:
        timeout_s: Seconds at most for one request.
    """
    import httpx2

    return httpx2.AsyncClient(
        verify=_trusted(),
        timeout=httpx2.Timeout(timeout_s, connect=min(timeout_s, _CONNECT_S), pool=None),
        limits=httpx2.Limits(max_connections=None, max_keepalive_connections=20),
        event_hooks={"request": [_note_request], "response": [_note_response]},
    )


@cache
def _trusted() -> ssl.SSLContext:
    """Whom to trust, for all clients: reading the certificates takes longer than a local call."""
    import httpx2

    return httpx2.create_ssl_context()


async def _note_request(request: httpx2.Request) -> None:
    exchange = _current.get()
    if exchange is None:
        return
    # A scalar time-out, as the libraries send it, would allow as long for the connection alone.
    timeout = request.extensions.get("timeout")
    if isinstance(timeout, dict):
        timeout["connect"] = min(timeout.get("connect") or _CONNECT_S, _CONNECT_S)
    exchange.sent = _object(request.content)
    sent = sent_settings(exchange.sent)
    exchange.withheld = tuple(name for name in exchange.required if name not in sent)
    if exchange.withheld:
        raise SettingWithheldError
    exchange.requests += 1
    exchange.status, exchange.headers, exchange.text = None, {}, ""
    exchange.started_s = time.monotonic()


async def _note_response(response: httpx2.Response) -> None:
    exchange = _current.get()
    if exchange is None:
        return
    await response.aread()
    exchange.seconds = time.monotonic() - exchange.started_s
    exchange.status, exchange.text = response.status_code, response.text
    exchange.headers = {name.lower(): value for name, value in response.headers.items()}


def _object(content: bytes) -> Mapping[str, Any]:
    try:
        value = json.loads(content)
    except ValueError:
        return {}
    return value if isinstance(value, dict) else {}


_TOKEN_LIMITS = ("max_tokens", "max_completion_tokens", "max_output_tokens", "maxOutputTokens")


def sent_settings(body: Mapping[str, Any]) -> dict[str, Any]:
    """The decoding settings in a request's body, under the same names for every wire.

    Args:
        body: JSON body of a chat-completions, Responses, Messages or generateContent request.
    """
    google = body.get("generationConfig")
    found: Mapping[str, Any] = google if isinstance(google, dict) else body
    settings: dict[str, Any] = {}
    for name, spellings in (
        ("temperature", ("temperature",)),
        ("top_p", ("top_p", "topP")),
        ("max_tokens", _TOKEN_LIMITS),
        ("parallel_tool_calls", ("parallel_tool_calls",)),
        ("seed", ("seed",)),
        ("reasoning", ("reasoning", "reasoning_effort", "thinking", "thinkingConfig")),
    ):
        for spelling in spellings:
            if found.get(spelling) is not None:
                settings[name] = found[spelling]
    choice = body.get("tool_choice")
    if isinstance(choice, dict) and "disable_parallel_tool_use" in choice:
        settings["parallel_tool_calls"] = not choice["disable_parallel_tool_use"]
    return settings
