"""Read what an engine sent: whatever is wrong with it becomes one sentence."""

from __future__ import annotations

from typing import Any, TypeVar

from pydantic import ValidationError

from adamo_vh.errors import EngineError
from adamo_vh.files import parse_json
from adamo_vh.readable import readable
from adamo_vh.service.engines.messages import FRAME, WIRE, Hello, codec

MAX_TEXT = 8_000_000
"""Longest text message, characters."""
MAX_BINARY = 64_000_000
"""Largest binary message, bytes."""
MAX_ATTACHMENTS = 4
_SHOWN = 300
_T = TypeVar("_T")


def shown(text: str) -> str:
    """What an engine wrote, short and safe to read."""
    return readable(text)[:_SHOWN]


def read_message(message: str | bytes) -> dict[str, Any]:
    """A text message as a JSON object.

    Raises:
        EngineError: It is binary, too long, or no JSON object that anybody should read.
    """
    if isinstance(message, bytes):
        raise EngineError(
            f"The engine sent {len(message)} bytes where a text message belongs; binary messages "
            'follow an answer that announces them with "attachments".'
        )
    if len(message) > MAX_TEXT:
        raise EngineError(f"The engine sent {len(message)} characters; send at most {MAX_TEXT}.")
    try:
        value = parse_json(message)
    except ValueError as error:
        raise EngineError(f"The engine sent what is no JSON: {shown(str(error))}.") from None
    if not isinstance(value, dict):
        raise EngineError("The engine sent JSON that is no object; see docs/engines.md.")
    return value


def read_as(kind: type[_T], value: Any, what: str) -> _T:
    """A JSON value as one kind of message.

    Args:
        kind: A dataclass of the wire.
        value: Read JSON.
        what: What it should be, for the sentence.

    Raises:
        EngineError: It is not of that kind.
    """
    try:
        read: _T = codec(kind).validate_python(value)
    except ValidationError as error:
        first = error.errors()[0]
        where = ".".join(str(part) for part in first["loc"]) or "the whole"
        told = f"{shown(where)}: {shown(first['msg'])}"
        raise EngineError(f"The engine sent a wrong {what}: {told}.") from None
    return read


def read_hello(message: str | bytes) -> Hello:
    """The first message of an engine.

    Raises:
        EngineError: It is no hello, or of an engine that does not speak as this side does.
    """
    value = read_message(message)
    if value.get("method") != "hello":
        raise EngineError('The engine must say "hello" first; see docs/engines.md.')
    params = value.get("params")
    wire = params.get("wire") if isinstance(params, dict) else None
    if wire != WIRE:
        raise EngineError(
            f"The engine speaks version {shown(str(wire))} of the wire, and here it is {WIRE}; "
            "take a version of ADAMO that speaks it, or change the engine."
        )
    hello = read_as(Hello, params, "hello")
    if hello.frame != FRAME:
        raise EngineError(
            f"The engine's frame is {shown(hello.frame)!r}, and the wire's is {FRAME!r}: translate "
            "all points on the engine's side and say so."
        )
    if not hello.engine.strip():
        raise EngineError("The engine has no name; say one in the hello.")
    return hello
