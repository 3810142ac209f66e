"""Proof that tasks are sound: the oracle solves each, doing nothing solves none."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from adamo_vh.action_server import LocalActionServer
from adamo_vh.benchmark.checkers import Score, score
from adamo_vh.benchmark.conditions import Condition
from adamo_vh.benchmark.oracle import Oracle
from adamo_vh.benchmark.tasks import Task, builtin_tasks
from adamo_vh.engine import World
from adamo_vh.perception import Labeling, PerceptionConfig, Tagger

MAX_STEPS = 60
_RESOLUTION = (960, 540)
"""Enough for the oracle, whose only use of a view is which objects it lists."""


@dataclass(frozen=True, slots=True)
class Verification:
    """What one task, scene and labeling give."""

    scene: str
    labeling: Labeling
    task: str
    oracle: float
    """Completion of the oracle's plan."""
    oracle_strict: float
    idle: float
    """Completion of doing nothing."""
    walked_m: float = 0.0
    """Metres that the oracle walks."""
    problems: tuple[str, ...] = ()
    """What is met before anything is done, and what the oracle leaves open or spoils."""

    @property
    def is_sound(self) -> bool:
        """Whether the task can be done and is not done already."""
        return self.oracle == 1.0 and self.oracle_strict == 1.0 and self.idle == 0.0


def verify_tasks(
    engine: World, labeling: Labeling, tasks: Sequence[Task] | None = None
) -> Iterator[Verification]:
    """Play oracle and idle for tasks, the built-in ones by default, one after another."""
    for task in builtin_tasks() if tasks is None else tasks:
        engine.reset(0)
        start = engine.state()
        idle = score(start, start, task)
        played, walked_m = play_oracle(engine, labeling, task, task.goals)
        met = [c.text for c in idle.conditions if c.satisfied]
        left = [c.text for c in played.conditions if not c.satisfied]
        yield Verification(
            engine.scene.name,
            labeling,
            task.id,
            played.completion,
            played.strict,
            idle.completion,
            walked_m,
            (
                *(f"is so at the start: {text}" for text in met),
                *(f"the oracle cannot do it: {text}" for text in left),
                *(f"the oracle spoils something: {text}" for text in played.violations),
            ),
        )


def play_oracle(
    engine: World, labeling: Tagger, task: Task, goals: Sequence[Condition]
) -> tuple[Score, float]:
    """Let the oracle play towards goals through the same four tools, and score the task.

    Args:
        engine: Is reset first.
        labeling: How objects are called.
        task: What is scored.
        goals: What the oracle tries to bring about; a part of the task's conditions gives a part
            of its score.

    Returns:
        The score, and how many metres the oracle walked.
    """
    engine.reset(0)
    start = engine.state()
    server = LocalActionServer(
        engine,
        perception=PerceptionConfig(labeling=labeling, grid=0),
        resolution=_RESOLUTION,
    )
    oracle = Oracle(goals, server.tag, server.body.info)
    server.observe()
    states, walked_m = [start], 0.0
    for _ in range(MAX_STEPS):
        action = oracle.next_action(states[-1], server.seen)
        if action is None:
            break
        walked_m += server.execute(action).feedback.walked_m
        states.append(engine.state())
    return score(start, states[-1], task, states[1:]), walked_m
