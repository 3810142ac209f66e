"""A page without pictures: what a test sees and asks of a studio over real sockets."""

from __future__ import annotations

import json
from collections.abc import Callable
from contextlib import ExitStack
from types import TracebackType
from typing import Any, Self

from websockets.sync.client import ClientConnection, connect

Message = dict[str, Any]


class Visitor:
    """One connection to a room; keeps all that was told."""

    def __init__(self, url: str, room: str, after: int = 0, headers: Any = None) -> None:
        address = f"{url.replace('http', 'ws', 1)}/studio/api/rooms/{room}/live?from={after}"
        self._opened = ExitStack()
        self.wire: ClientConnection = self._opened.enter_context(
            connect(address, max_size=None, additional_headers=headers)
        )
        self.told: list[Message] = []

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        fault: BaseException | None,
        at: TracebackType | None,
    ) -> None:
        self.close()

    def close(self) -> None:
        self._opened.close()

    def ask(self, kind: str, **more: Any) -> None:
        self.wire.send(json.dumps({"type": kind, **more}))

    def next(self, limit_s: float = 60.0) -> Message:
        message: Message = json.loads(self.wire.recv(timeout=limit_s))
        self.told.append(message)
        return message

    def until(self, meant: Callable[[Message], bool], most: int = 5000) -> Message:
        for _ in range(most):
            if meant(message := self.next()):
                return message
        raise AssertionError("it was never told")

    def event(self, kind: str) -> Message:
        """The next event of a kind."""
        found = self.until(lambda m: m["type"] == "event" and m["event"]["type"] == kind)
        told: Message = found["event"]
        return told

    def doing(self, what: str) -> Message:
        """The next status that says so."""
        return self.until(lambda m: m["type"] == "status" and m["doing"] == what)

    def notice(self) -> Message:
        return self.until(lambda m: m["type"] == "notice")

    def say(self, text: str) -> Message:
        """Have an instruction carried out; how it ended."""
        self.ask("say", text=text)
        return self.event("ended")
