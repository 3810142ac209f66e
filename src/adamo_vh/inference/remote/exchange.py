"""What really went over the wire: a client that notes each request's bytes and the answer's.

The client libraries drop settings that they know a model to refuse, repeat requests on their own
account, and read errors each in their own way. What is recorded and what is judged is therefore
taken from the bytes, not from what the library was asked for.
"""

from __future__ import annotations

import time
from collections.abc import Mapping
from contextvars import ContextVar
from dataclasses import dataclass, field
from typing import Any

from adamo_vh.inference.remote.mended import read_json


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
    location: str = ""
    """Address of the last request."""
    fault: str = ""
    """Why its answer was not taken, in words for people; empty if it was."""

    @property
    def body(self) -> Any:
        """The body of the last answer as JSON; None if it is none."""
        return read_json(self.text)


_current: ContextVar[Exchange | None] = ContextVar("adamo_exchange", default=None)


class SettingWithheldError(RuntimeError):
    """A required setting is not in the request; raised before anything is sent."""


def note_request(exchange: Exchange, content: bytes, address: str) -> None:
    """Note a request that is about to go out.

    Args:
        exchange: Takes it.
        content: Its body.
        address: Where it goes.

    Raises:
        SettingWithheldError: A setting that was insisted on is not in it.
    """
    body = read_json(content)
    exchange.sent = body if isinstance(body, dict) else {}
    sent = sent_settings(exchange.sent)
    exchange.withheld = tuple(name for name in exchange.required if name not in sent)
    if exchange.withheld:
        raise SettingWithheldError
    exchange.requests += 1
    exchange.status, exchange.headers, exchange.text = None, {}, ""
    exchange.location, exchange.fault = address, ""
    exchange.started_s = time.monotonic()


def note_answer(exchange: Exchange, status: int, headers: Mapping[str, str], body: bytes) -> None:
    """Note the answer to the last request.

    Args:
        exchange: Takes it.
        status: Its HTTP status.
        headers: Names in lower case.
        body: All of it, or as much as was read.
    """
    exchange.seconds = time.monotonic() - exchange.started_s
    exchange.status, exchange.headers = status, headers
    exchange.text = body.decode("utf-8-sig", "replace")


def current_exchange() -> Exchange | None:
    """Where the current task notes what it sends and gets."""
    return _current.get()


def watch(exchange: Exchange) -> None:
    """Note what the current task, and the tasks it starts, send and get from here on."""
    _current.set(exchange)


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
