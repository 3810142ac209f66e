"""Names of tools and ids of calls: which tool a model means, and what goes back to a server."""

from __future__ import annotations

import hashlib
import re
from collections.abc import Collection, Iterable

from adamo_vh.readable import encodable

NAMESPACE = r"(?:functions?|tools?|default_api|api|multi_tool_use)[.:/]"
"""What models put before the name of a tool, as a regular expression."""
_DRESS = re.compile(rf"\A\W{{0,9}}(?:{NAMESPACE})?|(?:<\|.*|:\d+|\W{{1,9}})\Z", re.I | re.S)
_ALLOWED = re.compile(r"[^A-Za-z0-9_-]")
_LONGEST = 64
_NAMELESS = "unnamed"
_STRICT_ID = re.compile(r"[A-Za-z0-9_-]{1,64}")
_ID = re.compile(r"[A-Za-z0-9_.:-]{1,64}")


def meant_tool(written: str, names: Iterable[str]) -> str | None:
    """The tool on offer that a model means, if it can only be one.

    Case, ``_`` and ``-`` do not matter, nor does what chat templates leave around a name
    (``functions.Pick``, ``Pick:0``, ``Pick<|channel|>commentary``).

    Args:
        written: The name as the model wrote it.
        names: The tools on offer.
    """
    offered = list(names)
    if written in offered:
        return written
    wanted = _folded(_DRESS.sub("", written[:200]))
    alike = [name for name in offered if wanted and _folded(name) == wanted]
    return alike[0] if len(alike) == 1 else None


def wire_name(name: str) -> str:
    """The name in the letters that every server takes: what is odd in it becomes ``_``."""
    plain = _ALLOWED.sub("_", name).strip("_-")[:_LONGEST]
    return plain if plain[:1].isalpha() else f"{_NAMELESS}_{plain}".rstrip("_")[:_LONGEST]


def wire_id(call_id: str, source: str) -> str:
    """The id of a call as a server takes it; another one stands for one that it would refuse.

    Args:
        call_id: The id, mostly the server's own.
        source: Who gets it, e.g. "anthropic:NAME": its API allows the fewest letters.
    """
    allowed = _STRICT_ID if source.startswith("anthropic") else _ID
    return call_id if allowed.fullmatch(call_id) else fresh_id(call_id, ())


def fresh_id(seed: str, taken: Collection[str]) -> str:
    """A call id that follows from a text: nine letters and digits, which every server accepts."""
    number = 0
    while True:
        digest = hashlib.sha256(f"{number} {encodable(seed)}".encode()).hexdigest()[:9]
        if digest not in taken:
            return digest
        number += 1


def _folded(name: str) -> str:
    return name.casefold().replace("_", "").replace("-", "")
