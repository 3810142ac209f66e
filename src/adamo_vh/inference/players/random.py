"""The floor of all players: calls drawn uniformly from those that can be valid."""

from __future__ import annotations

import hashlib
import random
import time
from collections.abc import Iterator, Sequence
from typing import Any

from adamo_vh.action import ToolSchema
from adamo_vh.inference.baseline.prompt.reading import Prompt, read_prompt
from adamo_vh.inference.messages import (
    AIMessage,
    HumanMessage,
    Message,
    SystemMessage,
    TextPart,
    ToolCall,
    ToolMessage,
)
from adamo_vh.inference.model import ModelInfo, ModelKind, Reply, Sampling

END_CHANCE = 0.05
"""Probability of ending the episode instead of a further call, from the second turn on: 20 calls
in the mean."""
_NOTE = "Evidence: none, I draw lots. Conclusion: any valid call. Next: {call}."
_ANSWER = "I drew lots; I do not know what is done."
_GAZE_M = 1.5
"""Greatest height of a random point to look at, metres."""


class RandomModel:
    """Draws a tool, then its arguments, each uniformly from what the messages show to be valid.

    With an empty hand: Look, Walk, and Pick of any listed tag. With something in it: Look, Walk,
    and Drop at a reference point or, as often, at a random point of the room. The same seed and
    messages always give the same reply; nothing is kept between calls.
    """

    def __init__(self, seed: int = 0) -> None:
        """Fix the lots.

        Args:
            seed: Other seeds draw other calls from the same messages.
        """
        self._seed = seed

    @property
    def info(self) -> ModelInfo:
        """No player at all: reports keep it apart."""
        name = f"random:{self._seed}" if self._seed else "random"
        return ModelInfo(name, ModelKind.RANDOM)

    def complete(
        self, messages: Sequence[Message], tools: Sequence[ToolSchema], sampling: Sampling
    ) -> Reply:
        """Answer with one call or, with the probability `END_CHANCE`, with the end.

        Args:
            messages: The whole prompt, oldest first.
            tools: The tools on offer; others than the paper's four and Finish are left alone.
            sampling: Has no effect: the seed alone decides.
        """
        begin = time.perf_counter()
        lots = random.Random(_digest(self._seed, messages))
        offered = {tool.name: tool for tool in tools}
        prompt = read_prompt(messages)
        calls = [call for call in _valid(prompt, lots) if call[0] in offered]
        if not calls or (_has_acted(messages) and lots.random() < END_CHANCE):
            message = _end(offered, prompt.instruction, lots)
        else:
            name, arguments = lots.choice(calls)
            message = _call(offered[name], arguments, lots)
        return Reply(message, seconds=time.perf_counter() - begin)


def _digest(seed: int, messages: Sequence[Message]) -> str:
    """A name for seed and messages; pictures are told apart by the texts around them."""
    digest = hashlib.sha256(str(seed).encode())
    for message in messages:
        digest.update(f"\n{message.role}:".encode())
        for text in _texts(message):
            digest.update(text.encode("utf-8", "replace"))
    return digest.hexdigest()


def _texts(message: Message) -> Iterator[str]:
    match message:
        case HumanMessage(parts=parts):
            yield from (part.text for part in parts if isinstance(part, TextPart))
        case AIMessage(text=text, calls=calls):
            yield text
            yield from (f"{call.name}{dict(call.arguments or {})}" for call in calls)
        case ToolMessage(text=text) | SystemMessage(text=text):
            yield text


def _has_acted(messages: Sequence[Message]) -> bool:
    return any(isinstance(message, AIMessage) for message in messages)


def _valid(prompt: Prompt, lots: random.Random) -> list[tuple[str, dict[str, Any]]]:
    """One call of each tool that can be valid now, its arguments drawn."""
    calls = [
        ("Look", _place(prompt, lots, lots.uniform(0.0, _GAZE_M))),
        ("Walk", _place(prompt, lots, 0.0)),
    ]
    hand = _hand(prompt)
    tags = [thing.tag for thing in prompt.things]
    if hand:
        calls.append(("Drop", {"object": hand, **_spot(prompt, lots)}))
    elif tags:
        calls.append(("Pick", {"object": lots.choice(tags)}))
    return calls


def _hand(prompt: Prompt) -> str:
    """What the hand holds; where the text does not tell it, as the feedback lets one know."""
    if prompt.body.hand is not None:
        return "" if prompt.body.hand == "empty" else prompt.body.hand
    held = ""
    for turn in prompt.turns:
        for event in turn.events:
            if event.outcome in ("done", "corrected") and event.name in ("Pick", "Drop"):
                held = event.tag if event.name == "Pick" else ""
    return held


def _place(prompt: Prompt, lots: random.Random, z: float) -> dict[str, Any]:
    room = prompt.room
    x, y = lots.uniform(room.x_min, room.x_max), lots.uniform(room.y_min, room.y_max)
    return {"x": round(x, 2), "y": round(y, 2), "z": round(z, 2)}


def _spot(prompt: Prompt, lots: random.Random) -> dict[str, Any]:
    if prompt.points and lots.random() < 0.5:
        point = lots.choice(prompt.points)
        return {"x": point.x, "y": point.y, "z": point.z}
    return _place(prompt, lots, lots.uniform(0.0, _GAZE_M))


def _call(tool: ToolSchema, arguments: dict[str, Any], lots: random.Random) -> AIMessage:
    wants_note = "note" in tool.parameters.get("properties", {})
    note = _NOTE.format(call=tool.name)
    if wants_note:
        arguments = {"note": note, "confidence": round(lots.random(), 2), **arguments}
    call = ToolCall(f"call_{lots.getrandbits(48):012x}", tool.name, arguments)
    return AIMessage("" if wants_note else note, (call,))


def _end(offered: dict[str, ToolSchema], asked: str, lots: random.Random) -> AIMessage:
    if "Finish" not in offered:
        return AIMessage(_ANSWER)
    arguments = {"asked": asked, "verified": "nothing", "unseen": "all", "answer": _ANSWER}
    return _call(offered["Finish"], arguments, lots)
