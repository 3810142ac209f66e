"""The fifteen tasks T1 to T15 as data: prompt, units, printed levels and conditions.

Prompts name no scene; every task can be done in every scene that has its objects.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum

from adamo_vh.benchmark.conditions import Condition, Holds, InArea, Near, OnFloor
from adamo_vh.benchmark.taxonomy import Act, Difficulty, Ref, Rel, Unit
from adamo_vh.errors import ConfigError


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
    """Atomic conditions, in the order of the prompt."""

    @property
    def computed(self) -> Difficulty:
        """What the units add up to by the taxonomy's own rules."""
        return Difficulty.of(self.units)

    @property
    def targets(self) -> frozenset[int]:
        """Ids of the objects that are to be moved; anchors are not."""
        return frozenset(condition.id for condition in self.conditions)

    @property
    def objects(self) -> frozenset[int]:
        """Ids of all objects that it is about, anchors too."""
        return frozenset().union(*(condition.objects for condition in self.conditions))

    @property
    def areas(self) -> frozenset[str]:
        """Kinds of the floor areas that it is about."""
        return frozenset(c.kind for c in self.conditions if isinstance(c, InArea))


def task(task_id: str) -> Task:
    """The task with an id, e.g. "T7".

    Raises:
        ConfigError: There is no such task.
    """
    for item in TASKS:
        if item.id == task_id.upper():
            return item
    known = ", ".join(item.id for item in TASKS)
    raise ConfigError(f"There is no task {task_id!r}. Tasks: {known}.")


def _moves(count: int) -> tuple[Unit, ...]:
    """Units of picking and placing a number of objects."""
    return (Act.PICK, Act.DROP) * count


TASKS: tuple[Task, ...] = (
    Task(
        "T1",
        "Pick the object tagged as 34",
        Family.SINGLE,
        (Act.PICK, Ref.ID),
        Difficulty(1, 0, 0, 1),
        (Holds(34),),
    ),
    Task(
        "T2",
        "Pick the plate",
        Family.SINGLE,
        (Act.PICK, Ref.TAG),
        Difficulty(1, 1, 0, 2),
        (Holds(57),),
    ),
    Task(
        "T3",
        "Pick the blue circular object",
        Family.SINGLE,
        (Act.PICK, Ref.COLOR, Ref.SHAPE),
        Difficulty(1, 1, 0, 2),
        (Holds(4),),
    ),
    Task(
        "T4",
        "Pick the plate and place it on the floor",
        Family.SINGLE,
        (*_moves(1), Ref.TAG, Rel.FLOOR),
        Difficulty(2, 1, 1, 4),
        (OnFloor(57),),
    ),
    Task(
        "T5",
        "Pick the object tagged as 4 and place it near the indoor plant",
        Family.SINGLE,
        (*_moves(1), Ref.ID, Ref.TAG, Rel.PROX),
        Difficulty(2, 1, 2, 5),
        (Near(4, 50),),
    ),
    Task(
        "T6",
        "Pick the smallest object then place it on the floor",
        Family.RELATIONAL,
        (*_moves(1), Ref.SUPER_EXTREMUM, Rel.FLOOR),
        Difficulty(2, 3, 1, 6),
        (OnFloor(34),),
    ),
    Task(
        "T7",
        "Pick the flashlight and place it on the floor in a corner of the room",
        Family.RELATIONAL,
        (*_moves(1), Ref.TAG, Rel.AREA),
        Difficulty(2, 1, 4, 7),
        (InArea(2),),
    ),
    Task(
        "T8",
        "Pick the glass and the plate then put them on the floor",
        Family.SEVERAL,
        (*_moves(2), *(Ref.TAG,) * 2, *(Rel.FLOOR,) * 2),
        Difficulty(4, 2, 2, 8),
        (OnFloor(37), OnFloor(57)),
    ),
    Task(
        "T9",
        "Pick object tagged as 37 then place it next to the plate, then go pick object tagged as "
        "30 and place it next to object tagged as 3",
        Family.SEVERAL,
        (*_moves(2), *(Ref.ID,) * 3, Ref.TAG, *(Rel.PROX,) * 2),
        Difficulty(4, 1, 4, 9),
        (Near(37, 57), Near(30, 3)),
    ),
    Task(
        "T10",
        "Pick the glass then place it next to the plate, moreover pick the binoculars and place "
        "it next to the screwdriver",
        Family.RELATIONAL,
        (*_moves(2), *(Ref.TAG,) * 4, *(Rel.PROX,) * 2),
        Difficulty(4, 4, 4, 11),
        (Near(37, 57), Near(21, 5)),
    ),
    Task(
        "T11",
        "Pick object tagged as 4 and place it near the indoor plant, then pick the glass and "
        "place it next to the plate",
        Family.SEVERAL,
        (*_moves(2), Ref.ID, *(Ref.TAG,) * 3, *(Rel.PROX,) * 2),
        Difficulty(4, 3, 4, 12),
        (Near(4, 50), Near(37, 57)),
    ),
    Task(
        "T12",
        "Pick the cup, peanut butter, and pills and place them on the floor",
        Family.SEVERAL,
        (*_moves(3), *(Ref.TAG,) * 3, *(Rel.FLOOR,) * 3),
        Difficulty(6, 3, 3, 12),
        (OnFloor(45), OnFloor(8), OnFloor(20)),
    ),
    Task(
        "T13",
        "Pick the cylindrical can and place it next to the indoor plant, and pick the binoculars "
        "and place it next to the screwdriver",
        Family.SEVERAL,
        # "Can" is no name of an object in the scene: its shape is what tells it apart.
        (*_moves(2), Ref.SHAPE, *(Ref.TAG,) * 3, *(Rel.PROX,) * 2),
        Difficulty(4, 4, 4, 12),
        (Near(19, 50), Near(21, 5)),
    ),
    Task(
        "T14",
        "Pick all objects with white parts and place them on the floor",
        Family.LONG,
        (*_moves(5), Ref.GROUP_SIMPLE, Ref.COLOR, *(Rel.FLOOR,) * 5),
        Difficulty(10, 3, 5, 15),
        tuple(OnFloor(i) for i in (57, 19, 20, 23, 36)),
    ),
    Task(
        "T15",
        "Pick all objects that have a printed product label and place them on the floor",
        Family.LONG,
        (*_moves(5), Ref.GROUP_SIMPLE, Ref.PATTERN, *(Rel.FLOOR,) * 5),
        Difficulty(10, 5, 5, 20),
        tuple(OnFloor(i) for i in (8, 19, 20, 23, 36)),
    ),
)
