"""The baseline behind the one interface of all models."""

from __future__ import annotations

import hashlib
import time
from collections.abc import Sequence

from adamo.action import ToolSchema
from adamo.inference.baseline.grammar import understand
from adamo.inference.baseline.policy import Step, decide
from adamo.inference.baseline.reading import read_prompt
from adamo.inference.messages import AIMessage, Message, ToolCall
from adamo.inference.model import ModelKind, Reply, Sampling


class BaselineModel:
    """A rule-based player that sees only what any model sees: the messages.

    It keeps nothing between calls. The same messages always give the same reply, so it can be
    shared between episodes and served to many at once.
    """

    @property
    def name(self) -> str:
        """As in its URI."""
        return "baseline"

    @property
    def kind(self) -> ModelKind:
        """No learned weights: reports keep it apart from VLMs."""
        return ModelKind.RULE_BASED

    def complete(
        self, messages: Sequence[Message], tools: Sequence[ToolSchema], sampling: Sampling
    ) -> Reply:
        """Answer with a note and one call, or with the final answer.

        Args:
            messages: The whole prompt, oldest first.
            tools: The tools on offer; a step that needs another one ends the episode.
            sampling: Has no effect: the rules are deterministic.
        """
        begin = time.perf_counter()
        prompt = read_prompt(messages)
        step = decide(prompt, understand(prompt.instruction))
        offered = {tool.name for tool in tools}
        if step.name and step.name not in offered:
            step = Step(f"I cannot go on: I have no tool named {step.name}.")
        message = AIMessage(step.note, _calls(step))
        return Reply(message, seconds=time.perf_counter() - begin)


def _calls(step: Step) -> tuple[ToolCall, ...]:
    if not step.name:
        return ()
    # The id comes from the words alone, so that the same prompt gives the same reply.
    digest = hashlib.sha256(f"{step.name}{step.arguments}{step.note}".encode()).hexdigest()
    return (ToolCall(f"call_{digest[:12]}", step.name, dict(step.arguments)),)
