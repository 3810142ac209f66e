"""How the agent wants to be spoken to: which arguments, which tools, how many calls a turn."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass

from adamo_vh.action import ToolSchema
from adamo_vh.inference.messages import Message, SystemMessage

_SEVERAL = re.compile(r"several calls[^\n]*?up to (\d+)|several calls", re.IGNORECASE)
_USUAL_PLAN = 4


@dataclass(frozen=True, slots=True)
class Manner:
    """What the tools' schemas and the fixed instructions allow and ask for."""

    tools: frozenset[str] = frozenset({"Look", "Walk", "Pick", "Drop"})
    notes: frozenset[str] = frozenset()
    """Tools that take the note and the confidence as arguments."""
    plan: int = 1
    """Calls in one turn at most."""

    @property
    def finishes(self) -> bool:
        """Whether an episode is ended by a tool."""
        return "Finish" in self.tools

    @property
    def inspects(self) -> bool:
        """Whether single objects can be seen close up."""
        return "Inspect" in self.tools


def manner_of(messages: Sequence[Message], tools: Sequence[ToolSchema]) -> Manner:
    """Find out how to answer.

    Args:
        messages: The prompt; its system messages say whether several calls are welcome.
        tools: The tools on offer; their schemas say which arguments they want.
    """
    system = "\n".join(m.text for m in messages if isinstance(m, SystemMessage))
    several = _SEVERAL.search(system)
    most = int(several.group(1) or _USUAL_PLAN) if several else 1
    return Manner(
        tools=frozenset(tool.name for tool in tools),
        notes=frozenset(tool.name for tool in tools if "note" in tool.parameters["properties"]),
        plan=most,
    )
