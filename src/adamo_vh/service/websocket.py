"""The body over a WebSocket, ``/v1/session``: the same messages, and pictures as bytes.

The first message creates a session or attaches to one. Each answer is a text message; the pictures
that it names follow as binary messages, in order, each once.
"""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING, Any

from fastapi import FastAPI, WebSocket
from starlette.websockets import WebSocketDisconnect

from adamo_vh.action_server.wire import Attach, Create, Request, Sent, pictures_of, read, to_json
from adamo_vh.errors import ConfigError
from adamo_vh.service.hosted import Hosted
from adamo_vh.service.hosting import Host
from adamo_vh.service.problems import told

if TYPE_CHECKING:
    from contextlib import AbstractAsyncContextManager

PATH = "/v1/session"


def add(app: FastAPI, host: Host) -> AbstractAsyncContextManager[None] | None:
    """Add the face to an application."""

    @app.websocket(PATH)
    async def session(wire: WebSocket) -> None:
        await wire.accept()
        try:
            await _Conversation(host, wire).go_on()
        except WebSocketDisconnect:
            return  # The session stays: who comes back goes on.

    return None


class _Conversation:
    """One connection; at most one session on it."""

    def __init__(self, host: Host, wire: WebSocket) -> None:
        self._host = host
        self._wire = wire
        self._hosted: Hosted | None = None

    async def go_on(self) -> None:
        """Answer until the client leaves."""
        while True:
            message = await self._wire.receive()
            if message["type"] == "websocket.disconnect":
                return
            text = message.get("text")
            try:
                if text is None:
                    raise ConfigError("A message is JSON text; bytes are for pictures alone.")
                sent = await asyncio.to_thread(self._answer, text)
            except Exception as error:
                sent = Sent(told(error)[1])
            await self._send(sent)

    def _answer(self, text: str) -> Sent:
        asked: Any = read(Request, text)
        if isinstance(asked, Create):
            self._hosted = self._host.create(asked)
            return self._hosted.welcome()
        if isinstance(asked, Attach):
            self._hosted = self._host.find(asked.session)
            return self._hosted.welcome()
        if self._hosted is None:
            raise ConfigError("Create a session first, or attach to one.")
        # It may have been closed meanwhile, by whoever else knows it.
        return self._host.find(self._hosted.id).perform(asked)

    async def _send(self, sent: Sent) -> None:
        await self._wire.send_text(to_json(sent.answer))
        for picture in pictures_of(sent.answer):
            await self._wire.send_bytes(sent.frames[picture.name].data)
