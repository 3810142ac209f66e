"""The Capability-Difficulty (C-D) taxonomy: what a task asks for, in units with integer costs.

A task is decomposed into the units that its prompt spells out: actions, references and relations.
Its C-D level is the sum of their costs. Walking and looking are implicit and cost nothing.

The paper's twelve units and their costs stand as it prints them. Those for what its tasks do not
ask for follow from them:

- material 2: seen, not named, like a shape, and shared by many things like one.
- negation 2: a reference that leaves something out is a group filtered by one criterion.
- furniture 2: a place at another named thing, like near.
- level 3: that, and which board of it.
- side 3: near, and in a frame of reference.
- order 2: every step after the first depends on the one before it.
- choice 1: which of several is done must be decided, as little as which floor.
- kept 1: what must not be is one more thing to heed, wherever it is.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from enum import StrEnum
from types import MappingProxyType


class Act(StrEnum):
    """Manipulation primitives that the prompt asks for."""

    PICK = "pick"
    DROP = "drop"


class Ref(StrEnum):
    """How a target or anchor is described."""

    ID = "id"
    """A number that is unique in the scene."""
    TAG = "tag"
    """A semantic name."""
    COLOR = "attrColor"
    SHAPE = "attrShape"
    GROUP_SIMPLE = "groupSimple"
    """A group filtered by one criterion ("all objects that ...")."""
    PATTERN = "attrPattern"
    SUPER_EXTREMUM = "superExtremum"
    """A superlative over an attribute ("the smallest ...")."""
    MATERIAL = "attrMaterial"
    """What it is made of."""
    NEGATION = "negation"
    """What it is not ("the battery that is not green")."""


class Rel(StrEnum):
    """Where an object must end up."""

    FLOOR = "floor"
    PROX = "prox"
    """Near another object."""
    AREA = "area"
    """Within a designated area; includes that the area is on the floor."""
    FURNITURE = "furniture"
    """On a named piece of furniture."""
    LEVEL = "level"
    """On a named level of a piece of furniture."""
    SIDE = "side"
    """Left or right of another object."""
    ORDER = "order"
    """After something else was done; once for every step but the first."""
    CHOICE = "choice"
    """This or that."""
    KEPT = "kept"
    """What must not be at the end, or must stay as it is."""


Unit = Act | Ref | Rel

COSTS: Mapping[Unit, int] = MappingProxyType(
    {
        Act.PICK: 1,
        Act.DROP: 1,
        Ref.ID: 0,
        Ref.TAG: 1,
        Ref.COLOR: 1,
        Ref.SHAPE: 2,
        Ref.GROUP_SIMPLE: 2,
        Ref.PATTERN: 3,
        Ref.SUPER_EXTREMUM: 3,
        Rel.FLOOR: 1,
        Rel.PROX: 2,
        Rel.AREA: 4,
        Ref.MATERIAL: 2,
        Ref.NEGATION: 2,
        Rel.FURNITURE: 2,
        Rel.LEVEL: 3,
        Rel.SIDE: 3,
        Rel.ORDER: 2,
        Rel.CHOICE: 1,
        Rel.KEPT: 1,
    }
)


@dataclass(frozen=True, slots=True)
class Difficulty:
    """C-D figures of one task: the three dimensions and the level.

    The total is a field because the printed one of some tasks is not the sum of its dimensions.
    """

    act: int
    ref: int
    rel: int
    total: int
    """The C-D level."""

    @classmethod
    def of(cls, units: Iterable[Unit]) -> Difficulty:
        """Compute from units; every occurrence counts."""
        found = tuple(units)
        act, ref, rel = (
            sum(COSTS[unit] for unit in found if isinstance(unit, dimension))
            for dimension in (Act, Ref, Rel)
        )
        return cls(act, ref, rel, act + ref + rel)
