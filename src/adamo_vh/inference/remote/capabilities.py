"""What a model and its server can do, as a probe found out, and where that is kept."""

from __future__ import annotations

import contextlib
import hashlib
from dataclasses import dataclass, field
from enum import StrEnum
from functools import cache
from importlib.metadata import version
from pathlib import Path
from typing import TYPE_CHECKING

from adamo_vh.errors import FileError
from adamo_vh.files import cache_folder, read_text, write_whole
from adamo_vh.inference.model import Rung, Usage

if TYPE_CHECKING:
    from pydantic import TypeAdapter


_PROBE = 3
"""Counts the ways of probing; what an earlier one found is asked anew."""


class Support(StrEnum):
    """Whether something works."""

    YES = "yes"
    NO = "no"
    """Accepted, but the answer shows that it was not taken in or not obeyed."""
    REFUSED = "refused"
    """The server answers with an error."""
    UNTESTED = "untested"
    """It was not asked: something that it takes does not work."""
    UNKNOWN = "unknown"
    """It was asked, and no answer came; it will be asked again."""


class ToolSupport(StrEnum):
    """What becomes of a tool call."""

    NATIVE = "native"
    LEAKED = "leaked"
    """Written into the text."""
    NONE = "none"
    REFUSED = "refused"
    """The server answers with an error."""
    UNKNOWN = "unknown"
    """It was asked, and no answer came; it will be asked again."""


@dataclass(frozen=True, slots=True)
class Capabilities:
    """What a model that was reached can do."""

    uri: str
    rung: Rung | None
    """How it is best asked; None if that hangs on a question that was not answered."""
    tools: ToolSupport
    schema: Support
    """Whether answers obey a JSON schema."""
    pictures: Support
    """Whether it sees a picture in a message."""
    result_pictures: Support
    """Whether it sees a picture that comes with the result of a tool."""
    refused: tuple[str, ...] = ()
    """Parameters that the server refuses; requests go without them."""
    requests: int = 0
    """Requests that the probe took; one that failed counts once, however often it was tried."""
    usage: Usage = field(default_factory=Usage)
    """Tokens that the probe took."""
    seconds: float = 0.0
    """Time that the probe took."""
    when: str = ""
    """Date and time of the probe, ISO 8601, UTC."""
    unanswered: tuple[str, ...] = ()
    """Why questions were not answered, a sentence each."""
    several_pictures: Support = Support.UNTESTED
    """Whether one prompt may hold more than one picture."""

    @property
    def is_complete(self) -> bool:
        """Whether every question was answered."""
        seen = (self.schema, self.pictures, self.result_pictures, self.several_pictures)
        return self.tools is not ToolSupport.UNKNOWN and Support.UNKNOWN not in seen


def load_capabilities(uri: str) -> Capabilities | None:
    """What an earlier probe found out, if this version of the package made one.

    Args:
        uri: Model URI.
    """
    try:
        found = _codec().validate_json(read_text(_file(uri)))
    except (FileError, ValueError):
        return None
    return found if found.uri == uri else None


def save_capabilities(capabilities: Capabilities) -> None:
    """Keep what a probe found out; a cache that cannot be written is no error."""
    with contextlib.suppress(FileError):
        write_whole(_file(capabilities.uri), _codec().dump_json(capabilities, indent=1))


def _file(uri: str) -> Path:
    key = hashlib.sha256(f"{version('adamo-vh')} {_PROBE} {uri}".encode()).hexdigest()[:16]
    return cache_folder() / "models" / f"{key}.json"


@cache
def _codec() -> TypeAdapter[Capabilities]:
    from pydantic import TypeAdapter

    return TypeAdapter(Capabilities)
