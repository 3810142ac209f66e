"""The baseline behind the one interface of all models."""

from __future__ import annotations

import time
from collections.abc import Sequence
from dataclasses import replace

from adamo_vh.action import ToolSchema
from adamo_vh.inference.baseline.language.requests import understand
from adamo_vh.inference.baseline.mind.policy import decide
from adamo_vh.inference.baseline.prompt.reading import read_prompt
from adamo_vh.inference.baseline.prompt.speaking import manner_of, say
from adamo_vh.inference.baseline.sight.printed import MISSING, PrintReader, installed
from adamo_vh.inference.messages import Message
from adamo_vh.inference.model import ModelInfo, ModelKind, Reply, Sampling


class BaselineModel:
    """A rule-based player that sees only what any model sees: the messages.

    It keeps nothing between calls. The same messages always give the same reply, so it can be
    shared between episodes and served to many at once.
    """

    def __init__(self, ocr: bool | None = False) -> None:
        """Choose the senses.

        Args:
            ocr: Read printed words too, for which the extra `ocr` must be installed; slower. None
                to do so where it is installed.
        """
        wanted = ocr or (ocr is None and installed())
        self._name = "baseline:ocr" if wanted else "baseline"
        self._reader = PrintReader() if wanted and installed() else None
        self._remark = MISSING if wanted and not installed() else ""

    @property
    def info(self) -> ModelInfo:
        """No learned weights: reports keep it apart from VLMs."""
        return ModelInfo(self._name, ModelKind.RULE_BASED)

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
        prompt, manner = read_prompt(messages), manner_of(messages, tools)
        plan = understand(prompt.instruction, prompt.spoken_of, prompt.former)
        step = decide(prompt, plan, manner, self._reader)
        if self._remark and not prompt.turns:
            step = replace(step, note=f"{self._remark} {step.note}")
        message = say(step, manner, prompt.instruction)
        return Reply(message, seconds=time.perf_counter() - begin)
