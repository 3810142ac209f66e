"""What an instruction means, as plain data: descriptions of things, and goals over them."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum


class Relation(StrEnum):
    """Where a thing shall end."""

    HOLD = "hold"
    """In the hand."""
    FLOOR = "floor"
    """On the floor."""
    NEAR = "near"
    """Next to another thing, on the same surface."""
    CORNER = "corner"
    """On the floor in a corner of the room."""
    SURFACE = "surface"
    """On a piece of furniture."""


class Size(StrEnum):
    """What a superlative compares."""

    SMALLEST = "smallest"
    LARGEST = "largest"
    TALLEST = "tallest"
    SHORTEST = "shortest"


@dataclass(frozen=True, slots=True)
class Description:
    """What a noun phrase says about the thing or things it means.

    An empty field says nothing. All that is said must hold together.
    """

    text: str
    """The words, for notes and answers."""
    ids: tuple[str, ...] = ()
    """Tags or bare ids, lower case: "57" or "plate_57"."""
    classes: tuple[str, ...] = ()
    """Possible classes, the most usual meaning first."""
    colours: tuple[str, ...] = ()
    part_colours: tuple[str, ...] = ()
    """Colours that some part of it has."""
    shapes: tuple[str, ...] = ()
    transparent: bool = False
    label: bool = False
    """Carries printed text."""
    size: Size | None = None
    every: bool = False
    """Means all things that fit, not one."""
    count: int | None = None
    """How many, if said ("both", "two")."""
    source: tuple[Relation, tuple[str, ...]] | None = None
    """Where the thing is now: on the floor, or near one of some classes."""

    @property
    def compares(self) -> bool:
        """Whether it can be told only after seeing the other things too."""
        return self.every or self.size is not None

    @property
    def by_looks(self) -> bool:
        """Whether pixels decide."""
        return bool(
            self.colours or self.part_colours or self.shapes or self.transparent or self.label
        )


@dataclass(frozen=True, slots=True)
class Goal:
    """One wish: a thing, or all things of a kind, in a place."""

    target: Description
    relation: Relation = Relation.HOLD
    anchor: Description | None = None
    """The thing to be near, for `Relation.NEAR`."""
    furniture: str = ""
    """The furniture's name, for `Relation.SURFACE`."""

    def wish(self) -> str:
        """What shall happen with the target, as a participle."""
        match self.relation:
            case Relation.HOLD:
                return "held"
            case Relation.FLOOR:
                return "put on the floor"
            case Relation.CORNER:
                return "put on the floor in a corner of the room"
            case Relation.SURFACE:
                return f"put on the {self.furniture}"
            case Relation.NEAR:
                return f"put near {self.anchor.text if self.anchor else 'it'}"


@dataclass(frozen=True, slots=True)
class Plan:
    """A whole instruction: its goals in the order of their execution, or why there are none."""

    goals: tuple[Goal, ...] = ()
    problem: str = ""
    """The part that was not understood, and why; empty if all was."""
