"""Outcomes for tests of what is made of many: each differs from a plain one as told."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import Any

from adamo_vh.analysis.outcome import Outcome
from adamo_vh.benchmark.tasks import task
from adamo_vh.inference.model import ModelKind, Usage
from adamo_vh.record.termination import TerminationReason

_PLAIN = Outcome(
    key="",
    scene="s1",
    variation=0,
    labeling="sem",
    model="openai:gpt-4o",
    model_kind=ModelKind.VLM,
    profile="paper",
    task="T1",
    repetition=1,
    seed=7,
    completion=1.0,
    strict=1.0,
    termination=TerminationReason.ANSWERED,
    conditions=1,
    conditions_open=0,
    claims_success=True,
    steps=3,
    calls={"Pick": 1, "Drop": 1, "Look": 1},
    model_calls=4,
    requests=4,
    protocol_failures=0,
    cut_prompts=0,
    missing_notes=0,
    refused=0,
    corrected=0,
    usage=Usage(9_000, 100),
    cost_usd=0.02,
    model_s=8.0,
    world_s=1.0,
    waited_s=0.0,
    walked_m=2.0,
    direct_m=2.0,
    shortest_m=1.0,
)


def made(task_id: str = "T1", completion: float | None = 1.0, **fields: Any) -> Outcome:
    """An outcome of a built-in task.

    Args:
        task_id: "T1" to "T15".
        completion: None for one that is unscored.
        **fields: Whatever else is to be said of it.
    """
    found = task(task_id)
    count = len(found.conditions)
    scored: dict[str, Any] = {
        "completion": completion,
        "strict": None if completion is None else float(completion == 1.0),
        "conditions": 0 if completion is None else count,
        "conditions_open": 0 if completion is None else round(count * (1 - completion)),
    }
    if completion is None:
        scored["termination"] = TerminationReason.BROKEN
    known: dict[str, Any] = {
        "task": task_id,
        "family": str(found.family),
        "printed_level": found.printed.total,
        "computed_level": found.computed.total,
    }
    outcome = replace(_PLAIN, **(known | scored | fields))
    where = (outcome.scene, outcome.task, outcome.labeling, outcome.model, outcome.profile)
    axes = "".join(f"/{name}={value}" for name, value in sorted(outcome.axes.items()))
    key = f"{'/'.join(where)}{axes}/v{outcome.variation:04d}/r{outcome.repetition:02d}"
    return replace(outcome, key=key, run=f"episodes/{key}")


def repeated(task_id: str, *completions: float | None, **fields: Any) -> Iterator[Outcome]:
    """One outcome for each repetition."""
    for number, completion in enumerate(completions, start=1):
        yield made(task_id, completion, repetition=number, **fields)
