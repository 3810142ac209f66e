"""What the model carries from step to step: written into its own note, read back from it.

The model keeps nothing between calls. Its last note holds all it must remember, so that it goes on
even when everything older has left the prompt.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass, field
from enum import StrEnum

from adamo.geometry import Vec3

_TITLE = "Memory:"
_JOB = re.compile(r"goal (\d+): (\S+) (\w+)(?: \(tries (\d+)\))?")
_FIT = re.compile(r"(goal|place) (\d+) = ((?:\S+ [\d.]+(?:, )?)+)")
_THING = re.compile(
    r"(\S+) at \((-?[\d.]+), (-?[\d.]+), (-?[\d.]+)\), ([\d.]+) cm3, "
    r"([\d.]+) m wide, ([\d.]+) m high, seen from ([\d.]+) m( \(moved\))?"
)
_KEPT_FITS = 6
_LEAST_FIT = 0.08


class Status(StrEnum):
    """How far a job is."""

    TODO = "todo"
    DONE = "done"
    FAILED = "failed"


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
    seen_m: float = 0.0
    """From how near it was looked at, metres."""
    moved: bool = False
    """Put there by the own hand after the last frame."""

    @property
    def radius_m(self) -> float:
        """Radius of a circle that holds its footprint, roughly."""
        return self.width_m / 2

    @property
    def bottom_z(self) -> float:
        """Height of what it stands on, estimated, metres."""
        return max(0.0, self.position.z - self.height_m / 2)


Slot = tuple[str, int]
"""("goal" or "place", index of the goal): one description of the plan."""


@dataclass(slots=True)
class Memory:
    """All that is carried."""

    views: int = 0
    """How many steps of the search were made."""
    visits: int = 0
    """How many steps were made to see far things from nearby."""
    aside: int = 0
    """How often something was put aside to empty the hand."""
    hand: str = ""
    """Tag in the hand, as far as known; empty for none."""
    jobs: list[Job] = field(default_factory=list)
    fits: dict[Slot, dict[str, float]] = field(default_factory=dict)
    """How well things fit each description of the plan, 0 to 1."""
    things: dict[str, Thing] = field(default_factory=dict)

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


def write(memory: Memory, told: Iterable[str], groups: Iterable[int]) -> str:
    """The memory as the last line of a note.

    Args:
        memory: What to remember.
        told: Tags that the next prompt will list as well; unless moved, these are left out.
        groups: Goals for which all fits count, not the best alone.
    """
    listed, compared = set(told), set(groups)
    parts = [f"looked {memory.views} times", f"hand {memory.hand or 'empty'}"]
    if memory.visits:
        parts.append(f"went closer {memory.visits} times")
    if memory.aside:
        parts.append(f"put aside {memory.aside} times")
    for job in memory.jobs:
        tries = f" (tries {job.tries})" if job.tries else ""
        parts.append(f"goal {job.goal + 1}: {job.tag} {job.status}{tries}")
    for (kind, goal), fits in sorted(memory.fits.items()):
        best = sorted(fits.items(), key=lambda item: (-item[1], item[0]))
        many = [f"{tag} {fit:.2f}" for tag, fit in best if fit >= _LEAST_FIT]
        if many:
            kept = many if goal in compared else many[:_KEPT_FITS]
            parts.append(f"{kind} {goal + 1} = " + ", ".join(kept))
    for tag, thing in memory.things.items():
        if tag not in listed or thing.moved:
            p = thing.position
            parts.append(
                f"{tag} at ({p.x:.3f}, {p.y:.3f}, {p.z:.3f}), {thing.volume_cm3:.1f} cm3, "
                f"{thing.width_m:.3f} m wide, {thing.height_m:.3f} m high, "
                f"seen from {thing.seen_m:.1f} m" + (" (moved)" if thing.moved else "")
            )
    return f"{_TITLE} " + "; ".join(parts) + "."


def read(note: str) -> Memory:
    """Read the memory back from a note; a note without one gives an empty memory."""
    memory = Memory()
    if _TITLE not in note:
        return memory
    for part in note.rsplit(_TITLE, 1)[1].strip().rstrip(".").split("; "):
        _read_part(part.strip(), memory)
    return memory


def _read_part(part: str, memory: Memory) -> None:
    if found := re.fullmatch(r"looked (\d+) times", part):
        memory.views = int(found.group(1))
    elif found := re.fullmatch(r"went closer (\d+) times", part):
        memory.visits = int(found.group(1))
    elif found := re.fullmatch(r"put aside (\d+) times", part):
        memory.aside = int(found.group(1))
    elif found := re.fullmatch(r"hand (\S+)", part):
        memory.hand = "" if found.group(1) == "empty" else found.group(1)
    elif (found := _JOB.fullmatch(part)) and found.group(3) in set(Status):
        goal, tag, status, tries = found.groups()
        memory.set_job(Job(int(goal) - 1, tag, Status(status), int(tries or 0)))
    elif found := _FIT.fullmatch(part):
        kind, goal, fits = found.groups()
        pairs = (pair.split(" ") for pair in fits.split(", "))
        memory.fits[(kind, int(goal) - 1)] = {tag: float(fit) for tag, fit in pairs}
    elif found := _THING.fullmatch(part):
        tag, x, y, z, volume, width, height, seen, moved = found.groups()
        memory.things[tag] = Thing(
            tag,
            Vec3(float(x), float(y), float(z)),
            float(volume),
            float(width),
            float(height),
            float(seen),
            bool(moved),
        )
