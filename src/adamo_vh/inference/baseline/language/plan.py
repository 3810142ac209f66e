"""What an instruction means, as plain data: things, wishes about them, questions, acts."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum


class Relation(StrEnum):
    """Where a thing shall end, or is asked to be."""

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
    LEFT = "left"
    RIGHT = "right"
    FRONT = "front"
    BEHIND = "behind"
    """These four: beside another thing, as the body sees it when the instruction is given."""
    BETWEEN = "between"
    """Between two other things."""
    UNDER = "under"
    """On the floor under furniture."""
    FAR = "far"
    """At some distance from another thing."""
    EDGE = "edge"
    """Near the edge of what it stands on."""
    HOME = "home"
    """Where it was before."""
    SHIFT = "shift"
    """Some way from where it was."""


SIDES = (Relation.LEFT, Relation.RIGHT, Relation.FRONT, Relation.BEHIND)


class Size(StrEnum):
    """What a superlative compares."""

    SMALLEST = "smallest"
    LARGEST = "largest"
    TALLEST = "tallest"
    SHORTEST = "shortest"
    NEAREST = "nearest"
    FARTHEST = "farthest"


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
    rank: int = 1
    """1 for the largest, 2 for the second largest."""
    every: bool = False
    """Means all things that fit, not one."""
    count: int | None = None
    """How many, if said ("both", "two")."""
    source: tuple[Relation, tuple[str, ...]] | None = None
    """Where the thing is now: on the floor, on furniture, near or beside one of some classes."""
    measured_from: tuple[str, ...] = ()
    """Classes of what is to be nearest to, or farthest from; empty for the body."""
    other: bool = False
    """Not the one that was meant before."""
    definite: bool = False
    """Said with "the", as if there were one."""
    but: tuple[Description, ...] = ()
    """What is left out."""
    spared: int = 0
    """How many of all are left out, whichever."""

    @property
    def compares(self) -> bool:
        """Whether it can be told only after seeing the other things too."""
        return self.every or self.size is not None

    @property
    def by_looks(self) -> bool:
        """Whether pixels decide."""
        return bool(
            self.colours or self.part_colours or self.shapes or self.transparent or self.label
        ) or any(left_out.by_looks for left_out in self.but)


@dataclass(frozen=True, slots=True)
class Goal:
    """One wish: a thing, or all things of a kind, in a place."""

    target: Description
    relation: Relation = Relation.HOLD
    anchor: Description | None = None
    """The thing to be near, left of, far from."""
    furniture: str = ""
    """The furniture's name, for `Relation.SURFACE`."""
    second: Description | None = None
    """The other one, for `Relation.BETWEEN`."""
    distance_m: float | None = None
    """How far, if said."""
    direction: str = ""
    """For `Relation.SHIFT`: left, right, front (away from the viewer), back."""
    mutual: bool = False
    """Whether it belongs to a group that shall stand together."""

    def wish(self) -> str:
        """What shall happen with the target, as a participle."""
        anchor = self.anchor.text if self.anchor else "it"
        other = self.second.text if self.second else "it"
        centimetres = round((self.distance_m or 0) * 100)
        return {
            Relation.HOLD: "held",
            Relation.FLOOR: "put on the floor",
            Relation.CORNER: "put on the floor in a corner of the room",
            Relation.SURFACE: f"put on the {self.furniture}",
            Relation.NEAR: f"put near {anchor}",
            Relation.BETWEEN: f"put between {anchor} and {other}",
            Relation.UNDER: f"put on the floor under the {self.furniture}",
            Relation.FAR: f"put far from {anchor}",
            Relation.EDGE: "put near an edge of what it stands on",
            Relation.HOME: "put back",
            Relation.SHIFT: f"put {centimetres} cm to the {self.direction}",
            Relation.FRONT: f"put in front of {anchor}",
            Relation.BEHIND: f"put behind {anchor}",
            Relation.LEFT: f"put to the left of {anchor}",
            Relation.RIGHT: f"put to the right of {anchor}",
        }[self.relation]


class Ask(StrEnum):
    """Kinds of questions."""

    WHERE = "where"
    COUNT = "count"
    AT = "at"
    """What is at a place."""
    HELD = "held"
    COLOUR = "colour"
    WHICH = "which"
    SEE = "see"
    EXISTS = "exists"
    IS = "is"
    """Whether a thing has a property or is at a place."""
    SIZE = "size"
    DISTANCE = "distance"
    """How far a thing is from the body, or from another thing."""
    STAND = "stand"
    """Where the body stands."""
    HELP = "help"


@dataclass(frozen=True, slots=True)
class Question:
    """Something to find out and tell."""

    ask: Ask
    target: Description | None = None
    place: Goal | None = None
    """Where things are asked for; its own target means nothing."""
    quality: Description | None = None
    """For `Ask.IS`: what the thing is said to be like."""
    negated: bool = False


@dataclass(frozen=True, slots=True)
class Act:
    """Something the body shall do that moves no thing."""

    name: str
    """"look" or "walk"."""
    target: Description | None = None
    direction: str = ""
    """left, right, back, up, down, ahead; start, corner, middle; empty with a target."""
    distance_m: float = 1.0
    text: str = ""


@dataclass(frozen=True, slots=True)
class Plan:
    """A whole instruction, or why it is none."""

    goals: tuple[Goal, ...] = ()
    """In the order of their execution."""
    problem: str = ""
    """The part that was not understood, and why; empty if all was."""
    questions: tuple[Question, ...] = ()
    acts: tuple[Act, ...] = ()
    remarks: tuple[str, ...] = ()
    """Sentences to say whatever happens: what was left alone, how a word was read."""
    condition: Question | None = None
    """Only if it holds, the goals and acts count."""
    otherwise: Plan | None = None
    """What to do if it does not hold."""

    @property
    def empty(self) -> bool:
        """Whether there is nothing to do or to say."""
        return not (self.goals or self.problem or self.questions or self.acts or self.remarks)
