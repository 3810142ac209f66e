"""Many episodes in one engine: while one waits for its model, the others act.

A model takes seconds to answer, an engine a fraction of one to act, so one engine carries dozens of
waiting episodes. Each is the same as if it were alone: same states, same frames, and the time for
which it waits for the engine is not counted as the agent's.
"""

from __future__ import annotations

import time
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor

import adamo_vh
from adamo_vh.action import ToolSchema
from adamo_vh.inference.messages import Message
from adamo_vh.inference.model import ModelInfo, ModelKind, Reply, Sampling
from adamo_vh.inference.registry import create_model

THINKS_S = 1.0


class Slow:
    """The baseline, as slow as a remote model."""

    info = ModelInfo("slow-baseline", ModelKind.RULE_BASED)

    def __init__(self) -> None:
        """Be one player: each episode has its own."""
        self._baseline = create_model("baseline")

    def complete(
        self, messages: Sequence[Message], tools: Sequence[ToolSchema], sampling: Sampling
    ) -> Reply:
        """Answer a prompt after a while."""
        time.sleep(THINKS_S)
        return self._baseline.complete(messages, tools, sampling)


def main() -> None:
    """Play four tasks at once."""
    tasks = ("T1", "T2", "T4", "T8")
    with (
        adamo_vh.Lender(adamo_vh.create_engine("s1")) as lender,
        ThreadPoolExecutor(len(tasks)) as pool,
    ):

        def play(task: str) -> adamo_vh.EpisodeResult:
            return adamo_vh.run_episode(
                task=task, engine=lender.lend(), model=Slow(), resolution=(640, 360)
            )

        for result in pool.map(play, tasks):
            print(result.task, result.completion, f"after {result.model_calls} calls")


if __name__ == "__main__":
    main()
