"""The line to an engine that dialled in: one request at a time, and its answer, or a sentence."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Protocol, TypeVar

from adamo_vh.errors import EngineError
from adamo_vh.service.engines.messages import METHODS, Hello, Nothing, codec
from adamo_vh.service.engines.reading import (
    MAX_ATTACHMENTS,
    MAX_BINARY,
    read_as,
    read_message,
    shown,
)

ANSWER_S = 60.0
"""An engine that is silent for longer has failed: a software renderer needs seconds."""
_T = TypeVar("_T")


class Pipe(Protocol):
    """Whole messages in both directions."""

    def send(self, text: str) -> None:
        """Send a text message.

        Raises:
            EngineError: The other side has gone.
        """
        ...

    def receive(self, timeout_s: float) -> str | bytes:
        """The next message.

        Raises:
            EngineError: None came in time, or the other side has gone.
        """
        ...

    def close(self) -> None:
        """Hang up."""
        ...


@dataclass(frozen=True, slots=True)
class Answer:
    """What an engine answered."""

    result: Any
    """Of the kind that the method gives."""
    attachments: tuple[bytes, ...]


class EngineLine:
    """Asks an engine; calls from several threads wait for each other.

    Once anything went wrong on it the line is dead: nobody knows what the engine has done, so
    every later call says the same sentence.
    """

    def __init__(self, pipe: Pipe, hello: Hello, answer_s: float = ANSWER_S) -> None:
        """Take over a pipe after the hello.

        Args:
            pipe: To the engine.
            hello: What it said of itself.
            answer_s: How long an answer may take, seconds.
        """
        self.hello = hello
        self.name = shown(hello.engine)
        """The engine's name, safe to read."""
        self.fault = ""
        """Why nothing can be asked any more; empty if it can."""
        self.released: Callable[[], None] = lambda: None
        """Called when the world on it is closed, so that the engine can carry another one."""
        self._pipe = pipe
        self._answer_s = answer_s
        self._lock = threading.Lock()
        self._asked = 0

    def ask(self, method: str, **params: Any) -> Answer:
        """Ask the engine for something, and wait for the answer.

        Args:
            method: One of `messages.METHODS`.
            **params: The fields of its parameters.

        Raises:
            EngineError: The engine refused it, answered otherwise than agreed, was silent or has
                gone.
        """
        wish, kind = METHODS[method]
        with self._lock:
            if self.fault:
                raise EngineError(self.fault)
            try:
                value, attachments = self._exchange(
                    method, codec(wish).dump_python(wish(**params), mode="json")
                )
                error = value.get("error")
                result = Nothing() if kind is Nothing else None
                if error is None and result is None:
                    result = read_as(kind, value.get("result"), f"answer to {method}")
            except EngineError as fault:
                self.hang_up(f"{self.name} failed in {method}: {fault}")
                raise EngineError(self.fault) from None
        if error is not None:
            raise EngineError(f"{self.name} refused {method}: {_why(error)}")
        return Answer(result, attachments)

    def failed(self, method: str, why: str) -> EngineError:
        """Hang up, since an answer cannot be right; the error to raise."""
        self.hang_up(f"{self.name} failed in {method}: {why}")
        return EngineError(self.fault)

    def hang_up(self, why: str) -> None:
        """End the line for good."""
        self.fault = self.fault or why
        self._pipe.close()

    def _exchange(self, method: str, params: Any) -> tuple[dict[str, Any], tuple[bytes, ...]]:
        self._asked += 1
        asked = {"jsonrpc": "2.0", "id": self._asked, "method": method, "params": params}
        self._pipe.send(_text(asked))
        until = time.monotonic() + self._answer_s
        value = read_message(self._pipe.receive(self._answer_s))
        if value.get("id") != self._asked:
            raise EngineError(
                f"it answered request {shown(str(value.get('id')))}, and {self._asked} was asked."
            )
        if ("result" in value) == ("error" in value):
            raise EngineError('an answer has either a "result" or an "error".')
        count = value.get("attachments", 0)
        if not isinstance(count, int) or not 0 <= count <= MAX_ATTACHMENTS:
            raise EngineError(f"it announced {shown(str(count))} attachments.")
        left = (max(0.0, until - time.monotonic()) for _ in range(count))
        return value, tuple(self._attachment(seconds) for seconds in left)

    def _attachment(self, timeout_s: float) -> bytes:
        message = self._pipe.receive(timeout_s)
        if isinstance(message, str):
            raise EngineError("it sent text where it had announced a binary message.")
        if len(message) > MAX_BINARY:
            raise EngineError(f"it sent {len(message)} bytes; send at most {MAX_BINARY}.")
        return message


def _text(value: Any) -> str:
    import json

    return json.dumps(value, allow_nan=False)


def _why(error: Any) -> str:
    message = error.get("message") if isinstance(error, dict) else None
    return shown(message) if isinstance(message, str) and message else "it does not say why."
