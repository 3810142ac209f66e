"""Recorded runs for tests of exports: real ones, with what their models were really asked."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import adamo_vh
from adamo_vh.action import ToolSchema
from adamo_vh.engine import World
from adamo_vh.inference.baseline import BaselineModel
from adamo_vh.inference.messages import Message
from adamo_vh.inference.model import Reply, Sampling

SMALL = "160x90"
Asked = list[tuple[tuple[Message, ...], tuple[ToolSchema, ...]]]


class Overheard:
    """The baseline, with a note of all that it was asked."""

    def __init__(self) -> None:
        self._model = BaselineModel()
        self.info = self._model.info
        self.asked: Asked = []

    def complete(
        self, messages: Sequence[Message], tools: Sequence[ToolSchema], sampling: Sampling
    ) -> Reply:
        self.asked.append((tuple(messages), tuple(tools)))
        return self._model.complete(messages, tools, sampling)


def run(out: Path, engine: World | None, profile: str = "paper", task: str = "T8") -> Asked:
    """Play a task with the baseline; what it was asked."""
    model = Overheard()
    adamo_vh.run_episode(
        task=task, profile=profile, resolution=SMALL, model=model, engine=engine, out=out
    )
    return model.asked
