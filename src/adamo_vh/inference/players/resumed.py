"""A model that first repeats what it said before an interruption and then goes on."""

from __future__ import annotations

from collections import deque
from collections.abc import Sequence

from adamo_vh.action import ToolSchema
from adamo_vh.inference.messages import Message
from adamo_vh.inference.model import Model, Reply, Sampling
from adamo_vh.inference.players.wrapper import Ask, Wrapped


def resumed(said: Sequence[Reply], model: Model) -> Model:
    """Recorded answers first, then those of a model.

    Args:
        said: What was answered before, in order.
        model: Who answers afterwards.
    """
    waiting = deque(said)

    def answer(
        ask: Ask, messages: Sequence[Message], tools: Sequence[ToolSchema], sampling: Sampling
    ) -> Reply:
        return waiting.popleft() if waiting else ask(messages, tools, sampling)

    return Wrapped(model, answer)
