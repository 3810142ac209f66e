"""Studies for tests of their report: a few hundred outcomes, made without playing."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from random import Random
from typing import Any

from tests.outcomes import made, repeated

from adamo_vh.analysis.outcome import Outcome
from adamo_vh.inference.model import ModelKind
from adamo_vh.report.study.material import Material, Source

TASKS = ("T1", "T3", "T8", "T10", "T14")
CODES = ("wrong_object", "false_claim", "goal_forgotten", "unreadable")
CLASSES = ("perceptual", "execution", "reasoning", "protocol")


def episodes(
    model: str = "openai:gpt-4o",
    *,
    skill: float = 0.6,
    repetitions: int = 3,
    tasks: tuple[str, ...] = TASKS,
    **fields: Any,
) -> Iterator[Outcome]:
    """The episodes of a model in both scenes and under both labelings."""
    lots = Random(f"{model}{skill}{fields}")
    for scene in ("s1", "s2"):
        for labeling in ("sem", "opaq"):
            for task in tasks:
                for repetition in range(1, repetitions + 1):
                    done = float(lots.random() < skill - (labeling == "opaq") * 0.2)
                    one = made(task, done, model=model, scene=scene, labeling=labeling,
                               repetition=repetition, **fields)  # fmt: skip
                    kind = lots.randrange(4)
                    why: dict[str, Any] = {
                        "diagnosis": CLASSES[kind],
                        "diagnosis_code": CODES[kind],
                    }
                    yield replace(one, **(why if done < 1 else {}))


def source(name: str = "mine", *groups: Iterator[Outcome], **fields: Any) -> Source:
    """A study of some episodes; those of one model by default."""
    found = tuple(one for group in groups or (episodes(),) for one in group)
    return Source(name, found, fields.pop("planned", len(found)), **fields)


def material(*sources: Source) -> Material:
    """What a report of some studies is made of."""
    return Material.of("A study", sources or (source(),))


def baseline() -> Iterator[Outcome]:
    """The episodes of a player without chance, each played once."""
    return episodes("baseline", skill=0.9, repetitions=1, model_kind=ModelKind.RULE_BASED)


def side_by_side() -> Material:
    """The same model in two studies, the second with two values of k."""
    few = ("T1", "T8", "T14")
    varied = (episodes(tasks=few, repetitions=2, axes={"k": k}, skill=0.8) for k in ("4", "50"))
    return material(source("old", episodes(tasks=few, repetitions=2)), source("new", *varied))


def tiny() -> Material:
    """Four episodes of two tasks, of which one failed."""
    done = (*repeated("T1", 1.0, 1.0), *repeated("T8", 1.0, 0.5, diagnosis="reasoning"))
    return material(source("tiny", iter(done)))
