"""The door at which engines dial in: an ASGI application for `/engine`, and who waits for them."""

from __future__ import annotations

import asyncio
import contextlib
import queue
import threading
import time
from collections import deque
from collections.abc import Callable
from pathlib import Path
from typing import Any

from adamo_vh.errors import EngineError
from adamo_vh.service.engines.line import ANSWER_S, EngineLine
from adamo_vh.service.engines.page import offer
from adamo_vh.service.engines.reading import read_hello, shown
from adamo_vh.serving.edge import Message, Receive, Send

PATH = "/engine"
MOST_ENGINES = 16
"""So many may be there at once."""
_HELLO_S = 10.0
_UNREAD = 16
"""An engine that sends more than anybody reads is sent away."""
_REASON = 110
"""Longest reason that fits into the end of a WebSocket, in characters."""


class EngineDoor:
    """Takes engines in, and hands them out to those who need a world."""

    def __init__(
        self,
        answer_s: float = ANSWER_S,
        arrived: Callable[[str], None] | None = None,
        page: Path | None = None,
    ) -> None:
        """Open the door.

        Args:
            answer_s: How long an engine may take for an answer, seconds.
            arrived: Is told the name of each engine that came in.
            page: Folder with a page that is an engine; None if none is offered.
        """
        self._answer_s = answer_s
        self.page = page
        """Folder of the page that is offered."""
        self._arrived = arrived or (lambda name: None)
        self._idle: deque[EngineLine] = deque()
        self._inside = 0
        self._changed = threading.Condition()

    async def __call__(self, scope: Any, receive: Receive, send: Send) -> None:
        """Carry one engine's WebSocket until either side ends it."""
        if scope["type"] != "websocket":
            await offer(scope, send, self.page)
            return
        await receive()
        if self._inside >= MOST_ENGINES:
            await send({"type": "websocket.close", "code": 1013, "reason": "Too many engines."})
            return
        self._inside += 1
        pipe = _AsgiPipe(asyncio.get_running_loop(), send)
        line: EngineLine | None = None
        try:
            await send({"type": "websocket.accept"})
            try:
                first = await asyncio.wait_for(receive(), _HELLO_S)
                line = EngineLine(pipe, read_hello(_content(first)), self._answer_s)
            except TimeoutError:
                await pipe.end(f"No hello came within {_HELLO_S:g} s.")
                return
            except EngineError as error:
                await pipe.end(str(error))
                return
            self._put(line)
            self._arrived(line.name)
            await pipe.carry(receive)
        finally:
            self._inside -= 1
            pipe.gone = pipe.gone or "the engine has gone."
            pipe.close()
            if line is not None:
                self._forget(line)

    def _put(self, line: EngineLine) -> None:
        with self._changed:
            line.released = lambda: self._put(line)
            if not line.fault and line not in self._idle:
                self._idle.append(line)
                self._changed.notify()

    def _forget(self, line: EngineLine) -> None:
        line.hang_up(f"{line.name} has gone: the connection was cut.")
        with self._changed, contextlib.suppress(ValueError):
            self._idle.remove(line)

    def take(self, timeout_s: float = 0.0) -> EngineLine:
        """An engine that nobody uses; wait for one if there is none.

        Args:
            timeout_s: How long to wait, seconds.

        Raises:
            EngineError: None came.
        """
        until = time.monotonic() + timeout_s
        with self._changed:
            while not self._idle:
                left = until - time.monotonic()
                if left <= 0:
                    raise EngineError(
                        f"No engine is free: none dialled in at {PATH}, or each carries an "
                        "episode. Start one (docs/engines.md), or wait."
                    )
                self._changed.wait(min(left, 1.0))
            return self._idle.popleft()


def _content(message: Message) -> str | bytes:
    """What a WebSocket message carries.

    Raises:
        EngineError: It is the end.
    """
    if message["type"] != "websocket.receive":
        raise EngineError("the connection was cut.")
    text = message.get("text")
    return text if text is not None else message.get("bytes") or b""


class _AsgiPipe:
    """Whole messages between threads that wait and the server's loop. Implements `Pipe`."""

    def __init__(self, loop: asyncio.AbstractEventLoop, send: Send) -> None:
        self.gone = ""
        """Why nothing comes any more; empty while it can."""
        self._loop = loop
        self._send = send
        self._messages: queue.Queue[str | bytes | None] = queue.Queue()
        self._ended = asyncio.Event()

    async def carry(self, receive: Receive) -> None:
        """Take in what the engine sends, until either side ends it."""
        ended = asyncio.ensure_future(self._ended.wait())
        while not self._ended.is_set():
            coming = asyncio.ensure_future(receive())
            await asyncio.wait({coming, ended}, return_when=asyncio.FIRST_COMPLETED)
            if not coming.done():
                coming.cancel()
                break
            message = coming.result()
            if message["type"] == "websocket.disconnect":
                self.gone = "the engine has gone: the connection was cut."
                return
            if self._messages.qsize() >= _UNREAD:
                await self.end("it sent more than it was asked for.")
                return
            self._messages.put(_content(message))
        ended.cancel()
        await self.end(self.gone or "The world on this line was closed.")

    async def end(self, why: str) -> None:
        """Tell the engine why, and hang up."""
        self.gone = self.gone or why
        reason = shown(why).encode()[:_REASON].decode(errors="ignore")
        with contextlib.suppress(Exception):
            await self._send({"type": "websocket.close", "code": 1008, "reason": reason})

    def send(self, text: str) -> None:
        if self.gone:
            raise EngineError(self.gone)
        message = {"type": "websocket.send", "text": text}
        sent = asyncio.run_coroutine_threadsafe(_sent(self._send, message), self._loop)
        try:
            sent.result(ANSWER_S)
        except Exception:
            raise EngineError(self.gone or "the connection was cut.") from None

    def receive(self, timeout_s: float) -> str | bytes:
        try:
            message = self._messages.get(timeout=timeout_s)
        except queue.Empty:
            raise EngineError(f"it was silent for {timeout_s:.0f} s.") from None
        if message is None:
            raise EngineError(self.gone or "the connection was cut.")
        return message

    def close(self) -> None:
        self._messages.put(None)
        with contextlib.suppress(RuntimeError):  # The loop may have ended before.
            self._loop.call_soon_threadsafe(self._ended.set)


async def _sent(send: Send, message: Message) -> None:
    await send(message)
