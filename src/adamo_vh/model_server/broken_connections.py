"""Responses that are none: connections that hang, are reset, or end in the middle."""

from __future__ import annotations

import asyncio
import contextlib
import socket
import struct
from typing import TYPE_CHECKING, Any

from fastapi import Response

from adamo_vh.model_server.injected_faults import HALF
from adamo_vh.serving.prompt_clients import PromptHttp

if TYPE_CHECKING:
    from starlette.types import Receive, Scope, Send

_MISSING_BYTES = 400


class CuttableProtocol(PromptHttp):
    """HTTP/1.1 that lets a response reach its own connection, in order to break it."""

    def connection_made(self, transport: Any) -> None:
        """Put the connection where requests find it."""
        self.app_state = {**self.app_state, "transport": transport}
        super().connection_made(transport)


class Reset(Response):
    """Resets the connection instead of answering."""

    status_code = 0

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Break the connection of the request."""
        await _reset(scope, receive)


class Hang(Response):
    """Lets the client wait, then resets the connection."""

    def __init__(self, seconds: float) -> None:
        """Take the time to wait, seconds."""
        super().__init__()
        self.status_code = 0
        self._seconds = seconds

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Wait until the time is over or the client gives up."""
        with contextlib.suppress(TimeoutError):
            await asyncio.wait_for(_gone(receive), self._seconds)
        await _reset(scope, receive)


class HalfBody(Response):
    """Announces a completion, sends half of it and closes the connection."""

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Send the first half."""
        length = str(len(HALF) + _MISSING_BYTES).encode()
        headers = [(b"content-type", b"application/json"), (b"content-length", length)]
        await send({"type": "http.response.start", "status": 200, "headers": headers})
        await send({"type": "http.response.body", "body": HALF, "more_body": True})
        scope["state"]["transport"].close()
        await _gone(receive)


async def _reset(scope: Scope, receive: Receive) -> None:
    transport = scope["state"]["transport"]
    if not transport.is_closing():
        # Lingering for no time turns the end of a connection into a reset.
        linger = struct.pack("ii", 1, 0)
        transport.get_extra_info("socket").setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, linger)
        transport.abort()
    # The protocol would answer for a request that returned without a word before the break.
    await _gone(receive)


async def _gone(receive: Receive) -> None:
    while (await receive())["type"] != "http.disconnect":
        pass
