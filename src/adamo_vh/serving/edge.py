"""The door of every server that the package opens: who may come in, and with how much.

A server on a loopback address is not safe from the web: a page in the user's own browser can send
requests to it, and a name of the page's own can be pointed at it. So a request must name this
machine as its host, come from no other page, say what it carries, and keep to a size.
"""

from __future__ import annotations

import hmac
import json
from collections.abc import Awaitable, Callable, MutableMapping
from dataclasses import dataclass
from typing import Any
from urllib.parse import urlsplit

from adamo_vh.serving.loopback import is_loopback

Message = MutableMapping[str, Any]
Receive = Callable[[], Awaitable[Message]]
Send = Callable[[Message], Awaitable[None]]
App = Callable[[Any, Receive, Send], Awaitable[None]]
"""An ASGI application."""

_WITH_BODY = ("POST", "PUT", "PATCH")
_READ_AT_MOST = 8
"""So many times the limit is read of a body that is too large, for the client to hear of it."""


@dataclass(frozen=True, slots=True)
class Refusal:
    """Why a request is not let in."""

    status: int
    text: str


@dataclass(frozen=True, slots=True)
class Rules:
    """What a request must keep to."""

    max_body_bytes: int
    content_types: tuple[str, ...] = ("application/json",)
    """What a request with a body may carry."""
    token: str = ""
    """What each request must bring as its bearer token; empty for none."""
    too_large: str = "send less at once."
    """What helps against a body that is too large."""


def refusal_body(refusal: Refusal) -> bytes:
    """A refusal as JSON, in the shape of OpenAI's errors, which most clients can read."""
    error = {"message": refusal.text, "type": "invalid_request_error", "param": None, "code": None}
    return json.dumps({"error": error}).encode()


class Edge:
    """ASGI middleware that lets in what keeps to the rules."""

    def __init__(self, app: App, rules: Rules) -> None:
        """Guard an application.

        Args:
            app: What answers those who are let in.
            rules: What they must keep to.
        """
        self._app = app
        self._rules = rules

    async def __call__(self, scope: Any, receive: Receive, send: Send) -> None:
        """Answer a request, or refuse it."""
        if scope["type"] == "lifespan":
            await self._app(scope, receive, send)
            return
        pairs = [(n.decode("latin-1").lower(), v.decode("latin-1")) for n, v in scope["headers"]]
        headers = dict(pairs)
        refusal = self._judged(scope.get("method", ""), headers)
        if refusal is None and scope["type"] == "http" and scope["method"] in _WITH_BODY:
            body = await _read(receive, self._rules.max_body_bytes)
            if body is None:
                limit = self._rules.max_body_bytes
                text = f"The request has more than {limit} bytes; {self._rules.too_large}"
                refusal = Refusal(413, text)
            else:
                receive = _again(body, receive)
        if refusal is None:
            await self._app(scope, receive, send)
        elif scope["type"] == "http":
            await _refuse(refusal, send)
        else:
            await send({"type": "websocket.close", "code": 1008, "reason": refusal.text[:100]})

    def _judged(self, method: str, headers: dict[str, str]) -> Refusal | None:
        host = headers.get("host", "")
        if not is_loopback(_host_name(host)):
            return Refusal(403, f"{host!r} is not served here; use 127.0.0.1 or localhost.")
        origin, site = headers.get("origin"), headers.get("sec-fetch-site", "none")
        if origin is not None and origin not in (f"http://{host}", f"https://{host}"):
            return Refusal(403, f"Pages of {origin[:200]} may not ask here; ask without a browser.")
        if site not in ("none", "same-origin"):
            return Refusal(403, "Pages of other sites may not ask here; ask without a browser.")
        if self._rules.token:
            brought = headers.get("authorization", "").removeprefix("Bearer ").encode()
            if not hmac.compare_digest(brought, self._rules.token.encode()):
                return Refusal(401, "The token is missing or wrong; send it as bearer token.")
        if method in _WITH_BODY:
            kind = headers.get("content-type", "").partition(";")[0].strip().lower()
            if kind not in self._rules.content_types:
                offer = " or ".join(self._rules.content_types)
                return Refusal(415, f"The content type is {kind or 'missing'!r}; send {offer}.")
        return None


def _host_name(host: str) -> str:
    try:
        return urlsplit(f"//{host}").hostname or ""
    except ValueError:
        return ""


async def _read(receive: Receive, limit: int) -> bytes | None:
    """The whole body; None if it is too large."""
    read, size, more = bytearray(), 0, True
    while more and size <= _READ_AT_MOST * limit:
        message = await receive()
        if message["type"] != "http.request":
            break
        chunk = message.get("body", b"")
        size += len(chunk)
        if size <= limit:
            read += chunk
        more = message.get("more_body", False)
    return bytes(read) if size <= limit else None


def _again(body: bytes, receive: Receive) -> Receive:
    """Gives a body that was read, and then what else comes."""
    waiting = [body]

    async def next_message() -> Message:
        if waiting:
            return {"type": "http.request", "body": waiting.pop(), "more_body": False}
        return await receive()

    return next_message


async def _refuse(refusal: Refusal, send: Send) -> None:
    body = refusal_body(refusal)
    headers = [
        (b"content-type", b"application/json"),
        (b"content-length", str(len(body)).encode()),
    ]
    await send({"type": "http.response.start", "status": refusal.status, "headers": headers})
    await send({"type": "http.response.body", "body": body})
