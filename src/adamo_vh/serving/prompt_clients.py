"""Connections that keep nobody waiting: a client that sends or reads too slowly is dropped.

uvicorn waits without end for the rest of a request's head, and for a client that does not read what
it is sent. Either keeps memory and a connection.
"""

from __future__ import annotations

from asyncio import Protocol, TimerHandle
from typing import Any

import h11
from uvicorn.protocols.http.h11_impl import H11Protocol
from uvicorn.protocols.websockets.websockets_sansio_impl import WebSocketsSansIOProtocol

HEAD_S = 15.0
"""So long the head of a request may take."""
UNREAD_S = 20.0
"""So long a client may leave unread what it is sent."""


class _DropsWhoDoesNotRead(Protocol):
    """What both kinds of connection do with a client that leaves unread what it is sent."""

    loop: Any
    transport: Any
    _unread: TimerHandle | None = None

    def pause_writing(self) -> None:
        """Wait for the client to read, but not for ever."""
        super().pause_writing()
        self._unread = self.loop.call_later(UNREAD_S, self.transport.abort)

    def resume_writing(self) -> None:
        """Go on: it has read."""
        super().resume_writing()
        _cancel(self._unread)

    def connection_lost(self, exc: Exception | None) -> None:
        """Wait for nothing any more."""
        _cancel(self._unread)
        super().connection_lost(exc)


class PromptHttp(_DropsWhoDoesNotRead, H11Protocol):
    """HTTP/1.1 that drops a client which is too slow."""

    _head: TimerHandle | None = None

    def connection_made(self, transport: Any) -> None:
        """Wait for the head of a request."""
        super().connection_made(transport)
        self._head = self.loop.call_later(HEAD_S, transport.abort)

    def data_received(self, data: bytes) -> None:
        """Take what came; until the head of a request is whole, time is running."""
        super().data_received(data)
        in_head = self.conn.their_state is h11.IDLE and self.transport.get_protocol() is self
        if self._head is not None and not in_head:
            self._head.cancel()
            self._head = None
        elif self._head is None and in_head and self.conn.trailing_data[0]:
            self._head = self.loop.call_later(HEAD_S, self.transport.abort)

    def connection_lost(self, exc: Exception | None) -> None:
        """Wait for nothing any more."""
        _cancel(self._head)
        super().connection_lost(exc)


class PromptWebSocket(_DropsWhoDoesNotRead, WebSocketsSansIOProtocol):
    """A WebSocket that drops a client which does not read."""


def _cancel(timer: TimerHandle | None) -> None:
    if timer is not None:
        timer.cancel()
