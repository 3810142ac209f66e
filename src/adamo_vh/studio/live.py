"""One connection to a room: what happens goes out, what the person asks comes in."""

from __future__ import annotations

import asyncio
import json

from fastapi import WebSocket
from starlette.websockets import WebSocketDisconnect, WebSocketState

from adamo_vh.errors import AdamoError, ConfigError
from adamo_vh.studio import messages
from adamo_vh.studio.messages import MAX_MESSAGE_BYTES, Message, read_wish
from adamo_vh.studio.room import Room

_MOST = 32
"""So many look into one room at once."""
_SLOW_S = 10.0
"""Who takes longer for a message is let go, and can come again from where he was."""
_FULL, _TOO_SLOW, _OVER = 4429, 4408, 1000


class Connection:
    """A person at a page."""

    def __init__(self, wire: WebSocket, room: Room, after: int) -> None:
        """Begin.

        Args:
            wire: Accepted already.
            room: Where he looks.
            after: The first serial that he lacks; 0 for the greeting and all.
        """
        self._wire = wire
        self._room = room
        self._next = after
        self._news = asyncio.Event()
        self._sending = asyncio.Lock()

    async def go_on(self) -> None:
        """Tell and hear until one of both leaves."""
        log = self._room.log
        if log.watchers >= _MOST:
            await self._wire.close(_FULL, "Too many look into this room.")
            return
        loop = asyncio.get_running_loop()
        key = log.watch(lambda: loop.call_soon_threadsafe(self._news.set))
        tasks = [asyncio.create_task(work) for work in (self._tell(), self._hear())]
        try:
            await asyncio.wait(tasks, return_when=asyncio.FIRST_COMPLETED)
        finally:
            log.leave(key)
            for task in tasks:
                task.cancel()
            await asyncio.gather(*tasks, return_exceptions=True)
            if self._wire.application_state is not WebSocketState.DISCONNECTED:
                await self._leave(_OVER, "The room is closed.")

    async def _tell(self) -> None:
        """Send what happens, from where he is."""
        log = self._room.log
        try:
            if self._next <= 0:
                await self._send(json.dumps(self._room.hello))
            while True:
                self._news.clear()
                is_last = log.closed
                batch = log.since(self._next)
                for kept in batch:
                    await self._send(kept.text)
                    self._next = kept.number + 1
                if not batch:
                    if is_last:
                        return
                    await self._news.wait()
        except TimeoutError:
            await self._leave(_TOO_SLOW, f"Too slow; come again from {self._next}.")
        except (WebSocketDisconnect, RuntimeError):
            return

    async def _hear(self) -> None:
        """Do what he asks."""
        while True:
            message = await self._wire.receive()
            if message["type"] == "websocket.disconnect":
                return
            try:
                text = message.get("text")
                if text is None or len(text) > MAX_MESSAGE_BYTES:
                    raise ConfigError(
                        f"A message is JSON text of at most {MAX_MESSAGE_BYTES} bytes."
                    )
                await asyncio.to_thread(self._room.ask, read_wish(text))
            except AdamoError as error:
                await self._answer(messages.notice(str(error), "error"))

    async def _answer(self, message: Message) -> None:
        """Tell him alone: it is no part of the track, so it has no serial."""
        try:
            await self._send(json.dumps({"n": 0, "t": 0.0, **message}))
        except (TimeoutError, WebSocketDisconnect, RuntimeError):
            return

    async def _send(self, text: str) -> None:
        async with self._sending, asyncio.timeout(_SLOW_S):
            await self._wire.send_text(text)

    async def _leave(self, code: int, why: str) -> None:
        try:
            async with asyncio.timeout(1.0):
                await self._wire.close(code, why)
        except (TimeoutError, WebSocketDisconnect, RuntimeError):
            return
