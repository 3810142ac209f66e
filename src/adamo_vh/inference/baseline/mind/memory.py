"""What the model knows in one step, and forgets after it: rebuilt each time from the messages."""

from __future__ import annotations

import copy
from dataclasses import dataclass, field
from enum import StrEnum

from adamo_vh.geometry import Vec3


class Status(StrEnum):
    """How far a job is."""

    TODO = "todo"
    DONE = "done"
    FAILED = "failed"


class Search(StrEnum):
    """What a call does for the search; empty for all others."""

    NONE = ""
    ROUND = "v"
    """A step of the fixed way round the room."""
    APPROACH = "w"
    """A walk to something that was seen from afar."""
    NEARER = "l"
    """A look at it from there."""
    ASIDE = "a"
    """Puts a thing away to have the hand free, or back."""
    ACT = "b"
    """An act of the body that was asked for."""


@dataclass(frozen=True, slots=True)
class Job:
    """One thing to bring to one place."""

    goal: int
    """Index of the goal in the plan."""
    tag: str
    status: Status = Status.TODO
    tries: int = 0
    """Drops and refused picks so far."""


@dataclass(frozen=True, slots=True)
class Thing:
    """An object as remembered: last known place and estimated size."""

    tag: str
    position: Vec3
    """Centre of its box, world metres."""
    volume_cm3: float
    width_m: float
    """Largest horizontal extent, estimated."""
    height_m: float

    @property
    def bottom_z(self) -> float:
        """Height of what it stands on, estimated, metres."""
        return max(0.0, self.position.z - self.height_m / 2)


@dataclass(frozen=True, slots=True)
class Stand:
    """Where the body stands and whereto it faces."""

    position: Vec3
    heading_rad: float


Slot = tuple[str, int]
"""("goal", "place", "second", "question" or "act", index): one description of the plan."""


@dataclass(slots=True)
class Memory:
    """All that is known."""

    views: int = 0
    """How many steps of the way round the room were made."""
    visits: int = 0
    """How many steps were made to see far things from nearby."""
    aside: int = 0
    """How often something was put aside to empty the hand."""
    acts: int = 0
    """How many of the acts that were asked for are done."""
    decided: bool | None = None
    """Whether the condition of the instruction holds, once that is known."""
    began: Stand | None = None
    """Where the body stood when the instruction was given."""
    home: Stand | None = None
    """Where it stood at the very first."""
    hand: str = ""
    """Tag in the hand, as far as known; empty for none."""
    jobs: list[Job] = field(default_factory=list)
    fits: dict[Slot, dict[str, float]] = field(default_factory=dict)
    """How well things fit each description of the plan, 0 to 1."""
    in_doubt: frozenset[str] = frozenset()
    """Things of which it must be seen from nearby whether they belong to a group."""
    things: dict[str, Thing] = field(default_factory=dict)
    seen_m: dict[str, float] = field(default_factory=dict)
    """From how near the pixels of things were looked at, metres."""
    before_m: dict[str, float] = field(default_factory=dict)
    """The same before the newest view, for what it lists."""
    kinds: dict[str, str] = field(default_factory=dict)
    """What things behind opaque tags seem to be, by their looks."""
    inspected: set[str] = field(default_factory=set)
    """Things that were seen close up."""
    looks: dict[str, str] = field(default_factory=dict)
    """The main colours of things, in words."""
    rests: dict[str, str] = field(default_factory=dict)
    """What things rest on, in the words of the feedback, e.g. "on the sideboard"."""
    supports: list[tuple[Vec3, str]] = field(default_factory=list)
    """Places at which feedback named what is there."""
    aims: list[Vec3] = field(default_factory=list)
    """Points that things were to be put at."""
    came_from: dict[str, Vec3] = field(default_factory=dict)
    """Where things were before they were first taken."""
    refusals: dict[str, str] = field(default_factory=dict)
    """Why things could not be taken or put, in the words of the feedback."""
    edges: dict[str, float] = field(default_factory=dict)
    """Of things that were put beyond an edge: how far from there they came to rest, metres."""
    walked: str = ""
    """Feedback of the latest walk."""

    def job(self, goal: int, tag: str) -> Job | None:
        """The job of a thing in a goal."""
        return next((j for j in self.jobs if j.goal == goal and j.tag == tag), None)

    def set_job(self, job: Job) -> None:
        """Add a job or replace it."""
        for at, old in enumerate(self.jobs):
            if (old.goal, old.tag) == (job.goal, job.tag):
                self.jobs[at] = job
                return
        self.jobs.append(job)

    def copy(self) -> Memory:
        """One that changes by itself; what it holds is either copied or immutable."""
        twin = copy.copy(self)
        twin.jobs = list(self.jobs)
        twin.fits = {slot: dict(fits) for slot, fits in self.fits.items()}
        twin.things, twin.seen_m = dict(self.things), dict(self.seen_m)
        twin.kinds, twin.inspected = dict(self.kinds), set(self.inspected)
        twin.looks, twin.rests = dict(self.looks), dict(self.rests)
        twin.came_from, twin.refusals = dict(self.came_from), dict(self.refusals)
        twin.aims = list(self.aims)
        twin.supports, twin.edges = list(self.supports), dict(self.edges)
        return twin


Arguments = tuple[tuple[str, str | float], ...]


@dataclass(frozen=True, slots=True)
class Move:
    """One call with its reasons."""

    conclusion: str
    name: str
    arguments: Arguments = ()
    search: Search = Search.NONE
    confidence: float = 0.9
    origin: Vec3 | None = None
    """Where a thing that is picked is now."""

    @property
    def tag(self) -> str:
        """The object that it is about."""
        return str(dict(self.arguments).get("object", ""))

    @property
    def point(self) -> Vec3 | None:
        """The point that it is about."""
        values = dict(self.arguments)
        if "x" not in values:
            return None
        return Vec3(float(values["x"]), float(values["y"]), float(values["z"]))

    def describe(self) -> str:
        """The call in a few words."""
        words = [self.name, self.tag] if self.tag else [self.name]
        if self.origin is not None:
            words.append(f"from {self.origin}")
        if self.point is not None:
            words.append(f"{'at' if self.name == 'Drop' else 'to'} {self.point}")
        return " ".join(words)


@dataclass(frozen=True, slots=True)
class Finish:
    """The end of an episode."""

    answer: str
    verified: str = ""
    unseen: str = ""
    confidence: float = 0.9


@dataclass(frozen=True, slots=True)
class Decision:
    """One turn: calls, or the end."""

    note: str = ""
    moves: tuple[Move, ...] = ()
    finish: Finish | None = None


def to_point(point: Vec3) -> Arguments:
    """A point as arguments."""
    p = point.rounded(3)
    return (("x", p.x), ("y", p.y), ("z", p.z))
