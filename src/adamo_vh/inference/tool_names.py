"""Names of tools: which one a model means, and how a name goes back to a server."""

from __future__ import annotations

import re
from collections.abc import Iterable

NAMESPACE = r"(?:functions?|tools?|default_api|api|multi_tool_use)[.:/]"
"""What models put before the name of a tool, as a regular expression."""
_DRESS = re.compile(rf"\A\W{{0,9}}(?:{NAMESPACE})?|(?:<\|.*|:\d+|\W{{1,9}})\Z", re.I | re.S)
_ALLOWED = re.compile(r"[^A-Za-z0-9_-]")
_LONGEST = 64
_NAMELESS = "unnamed"


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


def _folded(name: str) -> str:
    return name.casefold().replace("_", "").replace("-", "")
