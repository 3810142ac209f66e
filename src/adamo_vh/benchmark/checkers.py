"""The checker: from the states of an episode to its two scores.

Pure functions over states: an episode whose states were recorded can be scored again at any time.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import combinations

from adamo_vh.benchmark.conditions import MOVED_M, verdicts
from adamo_vh.benchmark.overlap import penetration_m
from adamo_vh.benchmark.tasks import Task
from adamo_vh.engine import ObjectState, WorldState

__all__ = ["MOVED_M", "OVERLAP_M", "ConditionResult", "Score", "score"]

OVERLAP_M = 0.005
"""Boxes that are deeper in each other than this overlap."""


@dataclass(frozen=True, slots=True)
class ConditionResult:
    """One atomic condition and whether it holds."""

    text: str
    satisfied: bool


@dataclass(frozen=True, slots=True)
class Score:
    """How well a task was done. The two figures are always reported apart."""

    completion: float
    """Satisfied atomic conditions divided by all of the task, in [0, 1]."""
    strict: float
    """1 if every condition holds and nothing was violated, else 0."""
    conditions: tuple[ConditionResult, ...]
    """In the order of the task."""
    violations: tuple[str, ...]
    """What speaks against a strict success: other things moved, overlaps, floating things."""


def score(
    initial: WorldState, final: WorldState, task: Task, between: Sequence[WorldState] = ()
) -> Score:
    """Score an episode by its states.

    Args:
        initial: The world when the episode began.
        final: The same world when it ended; a condition on what was taken out of it is not met.
        task: What was asked for.
        between: The states after each step, in order; a task that `needs_history` is judged by
            them, no other one is.

    Returns:
        Both scores and what they rest on.

    Raises:
        KeyError: The task names an object that the world never had.
    """
    results = tuple(
        ConditionResult(text, is_so)
        for text, is_so in verdicts(task.conditions, final, (initial, *between))
    )
    completion = sum(result.satisfied for result in results) / len(results)
    violations = (
        *_moved(initial, final, task.targets),
        *_overlapping(initial, final),
        *_floating(final),
    )
    strict = float(all(result.satisfied for result in results) and not violations)
    return Score(completion, strict, results, violations)


def _moved(initial: WorldState, final: WorldState, targets: frozenset[int]) -> Iterator[str]:
    """Objects that the task did not ask to move, but that are elsewhere now."""
    for after in final.objects:
        before = initial.object(after.id)
        if after.id in targets:
            continue
        if after.held and not before.held:
            yield f"{_name(after)} was left in the hand"
        elif after.support != before.support:
            yield f"{_name(after)} was moved from {before.support} to {after.support}"
        elif not _stayed(before, after):
            distance = before.box.center.distance(after.box.center)
            yield f"{_name(after)} was moved by {distance:.2f} m"


def _overlapping(initial: WorldState, final: WorldState) -> Iterator[str]:
    """Pairs that are in each other, unless the scene itself began that way."""
    for a, b in combinations((item for item in final.objects if not item.held), 2):
        depth = _depth(a, b)
        if depth <= OVERLAP_M:
            continue
        a0, b0 = initial.object(a.id), initial.object(b.id)
        if not (_stayed(a0, a) and _stayed(b0, b) and _depth(a0, b0) > OVERLAP_M):
            yield f"{_name(a)} and {_name(b)} overlap by {depth * 1000:.0f} mm"


def _floating(final: WorldState) -> Iterator[str]:
    for item in final.objects:
        if item.support is None and not item.held:
            yield f"{_name(item)} floats"


def _depth(a: ObjectState, b: ObjectState) -> float:
    """Penetration in metres; far pairs are sorted out by their bounding spheres first."""
    if a.box.center.distance(b.box.center) >= (a.box.size.norm() + b.box.size.norm()) / 2:
        return 0.0
    return penetration_m(a.box, b.box)


def _stayed(before: ObjectState, after: ObjectState) -> bool:
    return before.box.center.distance(after.box.center) <= MOVED_M


def _name(item: ObjectState) -> str:
    return f"{item.class_name}_{item.id}"
