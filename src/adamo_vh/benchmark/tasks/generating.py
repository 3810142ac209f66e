"""New tasks from templates: drawn over the whole range of C-D levels, so that none was seen before.

A task is one to four clauses, each of which says what is to become of one object or one group. The
draws depend on seed, split and scene alone. Whether a task can be done is not decided here.
"""

from __future__ import annotations

import hashlib
import random
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace

from adamo_vh.benchmark.conditions import (
    Beside,
    Condition,
    Holds,
    InArea,
    Near,
    On,
    OnFloor,
    Or,
    Ordered,
    Stays,
    atoms,
    holds,
)
from adamo_vh.benchmark.tasks.phrases import Group, Named, groups_of, names_of
from adamo_vh.benchmark.tasks.task import Family, Task
from adamo_vh.benchmark.taxonomy import Act, Difficulty, Ref, Rel, Unit
from adamo_vh.engine import WorldState, WorldSurface

LEVELS = range(1, 21)
"""C-D levels that are drawn, each as often as any other."""
SPLITS = ("dev", "test")
_MOST_CLAUSES = 4
_TRIES = 4000
"""Draws for one level before it is taken to have no further task."""


@dataclass(frozen=True, slots=True)
class _Clause:
    text: str
    units: tuple[Unit, ...]
    conditions: tuple[Condition, ...]
    objects: frozenset[int]
    """All that it is about, anchors too: no two clauses share one."""
    is_last: bool = False
    """Whether it keeps the hand full, so that nothing can be done after it."""
    is_limit: bool = False
    """Whether it forbids something, and so is nothing to do."""


def split_of(conditions: Sequence[Condition]) -> str:
    """The split that a task belongs to, by what it asks for, in whatever words and order.

    So no task of one split is in the other, whatever seeds they were made with.
    """
    told = "\n".join(_told(conditions))
    return SPLITS[hashlib.sha256(told.encode()).digest()[0] % 2]


class Drawer:
    """Draws tasks for one scene; never the same twice, and never a built-in one."""

    def __init__(
        self, world: WorldState, seed: int, split: str, known: Sequence[Task] = ()
    ) -> None:
        """Prepare.

        Args:
            world: The scene as it begins.
            seed: Of the draws.
            split: "dev" or "test".
            known: Tasks that are not to be drawn.
        """
        self._world = world
        self._split = split
        self._random = random.Random(f"{seed}/{split}/{world.scene.name}")
        self._names, self._groups = names_of(world), groups_of(world)
        self._surfaces = [surface for piece in world.furniture for surface in piece.surfaces]
        self._drawn = {_told(task.conditions) for task in known}

    def draw(self, level: int, name: str) -> Task | None:
        """A new task of a C-D level; None if none was found.

        Args:
            level: One of `LEVELS`.
            name: Its id.
        """
        for _ in range(_TRIES):
            clauses = self._clauses(level)
            if clauses is None:
                continue
            task = self._task(clauses, name, is_ordered=self._random.random() < 0.3)
            told = _told(task.conditions)
            if task.computed.total != level or told in self._drawn:
                continue
            if split_of(task.conditions) != self._split or self._is_begun(task):
                continue
            self._drawn.add(told)
            return task
        return None

    def _is_begun(self, task: Task) -> bool:
        """Whether a part of a task holds before anything is done."""
        begun = (atom for atom in atoms(task.conditions) if not isinstance(atom, Stays))
        return any(holds(atom, self._world, ()) for atom in begun)

    def _clauses(self, level: int) -> list[_Clause] | None:
        """Clauses that share no object, and may add up to a level."""
        clauses: list[_Clause] = []
        for _ in range(self._random.randint(1, _MOST_CLAUSES)):
            clause = self._clause()
            if clause is None or any(clause.objects & other.objects for other in clauses):
                return None
            clauses.append(clause)
            if Difficulty.of(unit for one in clauses for unit in one.units).total > level:
                return None
        if sum(c.is_last for c in clauses) > 1 or all(c.is_limit for c in clauses):
            return None
        return sorted(clauses, key=lambda clause: (clause.is_limit, clause.is_last))

    def _clause(self) -> _Clause | None:
        makers: list[Callable[[], _Clause | None]] = [
            self._held, self._on_floor, self._near, self._in_area, self._on, self._beside,
            self._group, self._choice, self._kept,
        ]  # fmt: skip
        return self._random.choice(makers)()

    def _task(self, clauses: Sequence[_Clause], name: str, *, is_ordered: bool) -> Task:
        conditions = tuple(one for clause in clauses for one in clause.conditions)
        units = tuple(unit for clause in clauses for unit in clause.units)
        plain = not any(clause.is_limit for clause in clauses) and len(conditions) == len(clauses)
        is_ordered = is_ordered and len(clauses) > 1 and plain
        texts = [clause.text for clause in clauses]
        if is_ordered:
            prompt = f"First {', then '.join(texts)}"
            units += (Rel.ORDER,) * (len(clauses) - 1)
            conditions = (Ordered(conditions),)
        else:
            prompt = ", and ".join(texts)
        task = Task(
            name,
            prompt[0].upper() + prompt[1:],
            Family.SINGLE,
            units,
            Difficulty.of(units),
            conditions,
            (self._world.scene.name,),
        )
        return replace(task, family=_family(task))

    def _named(self) -> Named:
        return self._random.choice(self._names)

    def _held(self) -> _Clause:
        item = self._named()
        return _Clause(
            f"pick {item.text}",
            (Act.PICK, *item.units),
            (Holds(item.id),),
            frozenset({item.id}),
            is_last=True,
        )

    def _put(
        self, item: Named, where: str, units: tuple[Unit, ...], condition: Condition
    ) -> _Clause:
        return _Clause(
            f"pick {item.text} and place {item.them} {where}",
            (Act.PICK, Act.DROP, *item.units, *units),
            (condition,),
            condition.objects,
        )

    def _on_floor(self) -> _Clause:
        item = self._named()
        return self._put(item, "on the floor", (Rel.FLOOR,), OnFloor(item.id))

    def _near(self) -> _Clause | None:
        item, anchor = self._named(), self._named()
        if item.id == anchor.id:
            return None
        units = (*anchor.units, Rel.PROX)
        return self._put(item, f"next to {anchor.text}", units, Near(item.id, anchor.id))

    def _beside(self) -> _Clause | None:
        item, anchor = self._named(), self._named()
        if item.id == anchor.id:
            return None
        if self._random.random() < 0.5:
            condition, side = Beside(item.id, anchor.id, "left"), "left"
        else:
            condition, side = Beside(item.id, anchor.id, "right"), "right"
        where = f"to the {side} of {anchor.text}, as seen from where you are now"
        return self._put(item, where, (*anchor.units, Rel.SIDE), condition)

    def _in_area(self) -> _Clause | None:
        kinds = sorted({area.kind for area in self._world.scene.areas})
        if not kinds:
            return None
        item, kind = self._named(), self._random.choice(kinds)
        where = f"on the floor in a {kind} of the room"
        return self._put(item, where, (Rel.AREA,), InArea(item.id, kind))

    def _on(self) -> _Clause | None:
        places = list(_places(self._surfaces))
        if not places:
            return None
        item, (surface, where, unit) = self._named(), self._random.choice(places)
        return self._put(item, where, (unit,), On(item.id, surface))

    def _group(self) -> _Clause | None:
        if not self._groups:
            return None
        group: Group = self._random.choice(self._groups)
        count = len(group.ids)
        return _Clause(
            f"pick {group.text} and place them on the floor",
            (*(Act.PICK, Act.DROP) * count, *group.units, *(Rel.FLOOR,) * count),
            tuple(OnFloor(item) for item in group.ids),
            frozenset(group.ids),
        )

    def _kept(self) -> _Clause:
        item = self._named()
        return _Clause(
            f"leave {item.text} where {'they are' if item.them == 'them' else 'it is'}",
            (*item.units, Rel.KEPT),
            (Stays(item.id),),
            frozenset({item.id}),
            is_limit=True,
        )

    def _choice(self) -> _Clause | None:
        one, other = self._named(), self._named()
        if one.id == other.id or Ref.ID in (*one.units, *other.units):
            return None
        return _Clause(
            f"pick either {one.text} or {other.text} and place what you picked on the floor",
            (Act.PICK, Act.DROP, *one.units, *other.units, Rel.FLOOR, Rel.CHOICE),
            (Or((OnFloor(one.id), OnFloor(other.id))),),
            frozenset({one.id, other.id}),
        )


def _places(surfaces: Sequence[WorldSurface]) -> Iterator[tuple[str, str, Unit]]:
    """Furniture, and levels of it, that a name alone tells apart: name, words, unit."""
    pieces: dict[str, list[str]] = {}
    for surface in surfaces:
        piece, _, level = surface.support.partition("/")
        pieces.setdefault(piece, []).append(level)
    for piece, levels in pieces.items():
        if any(letter.isdigit() for letter in piece):
            continue
        yield piece, f"on the {piece}", Rel.FURNITURE
        for level in levels:
            if level:
                words = f"on the {level} level of the {piece}"
                yield f"{piece}/{level}", words, Rel.LEVEL


def _family(task: Task) -> Family:
    if len(task.targets) > 2 or task.computed.total >= LEVELS[-1] - 5:
        return Family.LONG
    if len(task.targets) > 1:
        return Family.SEVERAL
    return Family.RELATIONAL if len(task.objects) > 1 else Family.SINGLE


def _told(conditions: Sequence[Condition]) -> tuple[str, ...]:
    return tuple(sorted(map(str, conditions)))


def levels_in_turn(seed: int, split: str) -> Iterator[int]:
    """C-D levels without end: each once before any comes again, in an order that is drawn."""
    drawn = random.Random(f"{seed}/{split}/levels")
    while True:
        yield from drawn.sample(LEVELS, len(LEVELS))
