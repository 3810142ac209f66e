"""What a wire is to the tests: answers in its words, and requests read back into common ones."""

from __future__ import annotations

import base64
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any, Protocol

from tests.fake_provider import Canned, FakeProvider, Json

Call = tuple[str, str, Json | str]
"""Id, tool, arguments; a string of arguments is sent as it is, where the wire can."""

INPUT, CACHED, OUTPUT, REASONING = 1200, 1000, 34, 20
"""Tokens of every answer, in the neutral count."""


@dataclass(frozen=True)
class Said:
    """One piece of a message that the server received."""

    role: str
    kind: str
    """"text", "image", "call", "result" or "thinking"."""
    text: str = ""
    id: str = ""
    data: bytes = b""
    value: Any = None


class Dialect(Protocol):
    """One wire."""

    name: str
    model: str
    path: str
    pictures_in_results: bool

    def answer(self, text: str = "", calls: Sequence[Call] = (), thinking: str = "") -> Canned: ...

    def ended(self, reason: str, text: str = "", calls: Sequence[Call] = ()) -> Canned:
        """An answer that ended for a reason of the wire's own."""
        ...

    def refusal(self) -> Canned: ...

    def error(self, status: int, message: str, param: str | None = None) -> Canned: ...

    def hidden_error(self, status: int, message: str) -> Canned: ...

    def read(self, request: Json) -> Iterator[Said]: ...

    def tools(self, request: Json) -> Json: ...

    def settings(self, request: Json) -> Json: ...

    def schema(self, request: Json) -> Json | None: ...


def uri(dialect: Dialect, server: FakeProvider) -> str:
    """Model URI of a server that speaks a dialect."""
    prefix = {"openai-chat": "openai"}.get(dialect.name, dialect.name)
    return f"{prefix}:{dialect.model}@{server.base_url}"


def unbase64(data: str) -> bytes:
    """The bytes of base64, as they are or in a data address."""
    return base64.b64decode(data.rpartition(",")[2])
