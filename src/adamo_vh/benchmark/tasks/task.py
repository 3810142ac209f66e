"""What a task is: a prompt, how hard it is, and when it is done."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum

from adamo_vh.benchmark.conditions import Condition, InArea, On, atoms, needs_history
from adamo_vh.benchmark.taxonomy import Difficulty, Unit


class Family(StrEnum):
    """The paper's task families."""

    SINGLE = "single object"
    RELATIONAL = "comparative and relational"
    SEVERAL = "several objects"
    LONG = "attribute-heavy and long"


@dataclass(frozen=True, slots=True)
class Task:
    """One instruction, how hard it is, and when it is done."""

    id: str
    prompt: str
    """What the agent is told, as in the paper."""
    family: Family
    units: tuple[Unit, ...]
    """What the prompt asks for, in units of the C-D taxonomy."""
    printed: Difficulty
    """As the paper prints it; T3, T10, T11, T13 and T14 differ from `computed` there."""
    conditions: tuple[Condition, ...]
    """What must hold at the end, in the order of the prompt."""
    scenes: tuple[str, ...] = ()
    """Names of the scenes that it fits; empty for every scene that has its objects."""
    oracle: tuple[Condition, ...] = ()
    """What the oracle brings about, in this order, in place of the conditions."""

    @property
    def goals(self) -> tuple[Condition, ...]:
        """What the oracle brings about."""
        return self.oracle or self.conditions

    @property
    def computed(self) -> Difficulty:
        """What the units add up to by the taxonomy's own rules."""
        return Difficulty.of(self.units)

    @property
    def targets(self) -> frozenset[int]:
        """Ids of the objects that are to be moved; anchors are not."""
        return frozenset().union(*(condition.moves for condition in self.conditions))

    @property
    def objects(self) -> frozenset[int]:
        """Ids of all objects that it is about, anchors too."""
        return frozenset().union(*(condition.objects for condition in self.conditions))

    @property
    def areas(self) -> frozenset[str]:
        """Kinds of the floor areas that it is about."""
        return frozenset(c.kind for c in atoms(self.conditions) if isinstance(c, InArea))

    @property
    def surfaces(self) -> frozenset[str]:
        """Names of the furniture, and of levels of it, that it is about."""
        return frozenset(c.surface for c in atoms(self.conditions) if isinstance(c, On))

    @property
    def needs_history(self) -> bool:
        """Whether it is judged by the states between the first and the last as well."""
        return any(map(needs_history, self.conditions))
