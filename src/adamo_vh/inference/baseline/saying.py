"""A turn as a message: where note and confidence go, and how an episode ends."""

from __future__ import annotations

import hashlib
from typing import Any

from adamo_vh.inference.baseline.manner import Manner
from adamo_vh.inference.baseline.steps import Finish, Move, Step
from adamo_vh.inference.messages import AIMessage, ToolCall

_FOLLOWS = "As planned."


def say(step: Step, manner: Manner, instruction: str) -> AIMessage:
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
