"""The door of every server that the package opens: lets in what keeps to its rules."""

from __future__ import annotations

import asyncio
import json
import math
from collections.abc import Awaitable, Callable, MutableMapping
from typing import Any

from adamo_vh.serving.admission import WITH_BODY, Asked, Refusal, Role, Rules, admitted
from adamo_vh.serving.rate import Meter

Message = MutableMapping[str, Any]
Receive = Callable[[], Awaitable[Message]]
Send = Callable[[Message], Awaitable[None]]
App = Callable[[Any, Receive, Send], Awaitable[None]]
"""An ASGI application."""

_READ_AT_MOST = 8
"""So many times the limit is read of a body that is too large, for the client to hear of it."""
_BODY_S = 30.0
"""A body that takes longer to come is not waited for."""
_TOO_BIG = 1009
"""Close code of a WebSocket whose message is too large."""

_MORE_HEADERS = {
    401: [(b"www-authenticate", b"Bearer")],
    408: [(b"connection", b"close")],  # What is still to come of the body is no request.
    413: [(b"connection", b"close")],
}


def refusal_body(refusal: Refusal) -> bytes:
    """A refusal as JSON, in the shape of OpenAI's errors, which most clients can read."""
    error = {"message": refusal.text, "type": "invalid_request_error", "param": None, "code": None}
    return json.dumps({"error": error}).encode()


def role_of(scope: Any) -> Role:
    """As what a request was let in; a player, where no edge has looked at it."""
    role: Role = scope.get("adamo_role", Role.PLAYER)
    return role


class Edge:
    """ASGI middleware that lets in what keeps to the rules, and says as what."""

    def __init__(self, app: App, rules: Rules) -> None:
        """Guard an application.

        Args:
            app: What answers those who are let in.
            rules: What they must keep to.
        """
        self.app = app
        """What is guarded."""
        self.rules = rules
        self._meter = Meter(rules.rate)

    async def __call__(self, scope: Any, receive: Receive, send: Send) -> None:
        """Answer a request, or refuse it."""
        if scope["type"] == "lifespan":
            await self.app(scope, receive, send)
            return
        found: Role | Refusal | None = self._hasty(scope)
        found = found or admitted(Asked.of(scope), self.rules)
        if isinstance(found, Role):
            scope = {**scope, "adamo_role": found}
            if scope["type"] == "websocket":
                await self.app(scope, self._measured(scope, receive, send), send)
                return
            if scope["method"] in WITH_BODY:
                body = await _read(receive, self.rules.most_bytes(scope["path"], message=False))
                if isinstance(body, bytes):
                    receive = _again(body, receive)
                else:
                    found = self._too_large(scope["path"]) if body is None else body
        if isinstance(found, Refusal):
            await _refuse(found, scope, send)
        else:
            await self.app(scope, receive, send)

    def _hasty(self, scope: Any) -> Refusal | None:
        wait_s = self._meter.wait_s(_address(scope))
        if not wait_s:
            return None
        after_s = math.ceil(wait_s)
        return Refusal(429, f"Too many requests; ask again in {after_s} s.", after_s)

    def _too_large(self, path: str) -> Refusal:
        limit = self.rules.most_bytes(path, message=False)
        return Refusal(413, f"The request has more than {limit} bytes; {self.rules.too_large}")

    def _measured(self, scope: Any, receive: Receive, send: Send) -> Receive:
        """Messages of a WebSocket: not too large, and not faster than the rate."""
        limit, address = self.rules.most_bytes(scope["path"], message=True), _address(scope)

        async def next_message() -> Message:
            message = await receive()
            if message["type"] != "websocket.receive":
                return message
            while wait_s := self._meter.wait_s(address):
                await asyncio.sleep(wait_s)  # Nothing more is read meanwhile.
            text, data = message.get("text"), message.get("bytes")
            if len((text or "").encode() if data is None else data) <= limit:
                return message
            reason = f"A message has at most {limit} bytes."
            await send({"type": "websocket.close", "code": _TOO_BIG, "reason": reason})
            return {"type": "websocket.disconnect", "code": _TOO_BIG, "reason": reason}

        return next_message


def _address(scope: Any) -> str:
    client = scope.get("client")
    return str(client[0]) if client else ""


async def _read(receive: Receive, limit: int) -> bytes | Refusal | None:
    """The whole body; None if it is too large, a refusal if it does not come."""
    read, size, more = bytearray(), 0, True
    try:
        async with asyncio.timeout(_BODY_S):
            while more and size <= _READ_AT_MOST * limit:
                message = await receive()
                if message["type"] != "http.request":
                    break
                chunk = message.get("body", b"")
                size += len(chunk)
                if size <= limit:
                    read += chunk
                more = message.get("more_body", False)
    except TimeoutError:
        return Refusal(408, f"The body did not come within {_BODY_S:g} s; send it at once.")
    return bytes(read) if size <= limit else None


def _again(body: bytes, receive: Receive) -> Receive:
    """Gives a body that was read, and then what else comes."""
    waiting = [body]

    async def next_message() -> Message:
        if waiting:
            return {"type": "http.request", "body": waiting.pop(), "more_body": False}
        return await receive()

    return next_message


async def _refuse(refusal: Refusal, scope: Any, send: Send) -> None:
    kind = "http"
    if scope["type"] == "websocket":
        if "websocket.http.response" not in (scope.get("extensions") or {}):
            await send({"type": "websocket.close", "code": 1008, "reason": refusal.text[:100]})
            return
        kind = "websocket.http"
    body = refusal_body(refusal)
    headers = [
        (b"content-type", b"application/json"),
        (b"content-length", str(len(body)).encode()),
    ]
    headers.extend(_MORE_HEADERS.get(refusal.status, ()))
    if refusal.after_s:
        headers.append((b"retry-after", str(refusal.after_s).encode()))
    await send({"type": f"{kind}.response.start", "status": refusal.status, "headers": headers})
    await send({"type": f"{kind}.response.body", "body": body})
