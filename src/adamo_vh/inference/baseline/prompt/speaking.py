"""How the agent wants to be spoken to: which arguments, which tools, how many calls a turn."""

from __future__ import annotations

import hashlib
import re
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from adamo_vh.action import ToolSchema
from adamo_vh.inference.baseline.mind.memory import Decision, Finish, Move
from adamo_vh.inference.messages import AIMessage, Message, SystemMessage, ToolCall

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


_FOLLOWS = "As planned."


def say(step: Decision, manner: Manner, instruction: str) -> AIMessage:
    """Write a turn.

    Args:
        step: What to do.
        manner: Which arguments the tools want, and which tools there are.
        instruction: For the check at the end.
    """
    if step.finish is not None:
        return _end(step.finish, manner, instruction)
    missing = next((move.name for move in step.moves if move.name not in manner.tools), None)
    if missing is not None:
        sorry = f"I cannot go on: I have no tool named {missing}."
        return _end(Finish(sorry, "nothing", "what is left to do", 0.9), manner, instruction)
    calls = []
    for index, move in enumerate(step.moves):
        note = step.note if index == 0 else _FOLLOWS
        calls.append(_call(index, move, note, manner))
    in_text = not any(move.name in manner.notes for move in step.moves)
    return AIMessage(step.note if in_text else "", tuple(calls))


def _call(index: int, move: Move, note: str, manner: Manner) -> ToolCall:
    arguments: dict[str, Any] = {}
    if move.name in manner.notes:
        arguments = {"note": note, "confidence": move.confidence}
    arguments |= dict(move.arguments)
    return ToolCall(_id(index, move.name, arguments, note), move.name, arguments)


def _end(finish: Finish, manner: Manner, instruction: str) -> AIMessage:
    if not manner.finishes:
        return AIMessage(finish.answer)
    arguments: dict[str, Any] = {}
    if "Finish" in manner.notes:
        arguments = {"note": "Nothing is left to do.", "confidence": finish.confidence}
    arguments |= {
        "asked": instruction,
        "verified": finish.verified,
        "unseen": finish.unseen,
        "answer": finish.answer,
    }
    return AIMessage("", (ToolCall(_id(0, "Finish", arguments, ""), "Finish", arguments),))


def _id(index: int, name: str, arguments: dict[str, Any], note: str) -> str:
    """From the words alone, so that the same prompt gives the same reply."""
    digest = hashlib.sha256(f"{index}{name}{arguments}{note}".encode()).hexdigest()
    return f"call_{digest[:12]}"
