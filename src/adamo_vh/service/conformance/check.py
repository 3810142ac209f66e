"""What a check is, and what it may use of the engine that it looks at."""

from __future__ import annotations

import math
import tomllib
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from importlib import resources

import numpy as np

from adamo_vh.action import Code, Outcome
from adamo_vh.engine import Body, BodyReport, World, WorldState, acting_body
from adamo_vh.geometry import Vec3
from adamo_vh.observation import Percept
from adamo_vh.perception.visibility import VisibleObject, visible_objects

SIZE_PX = (480, 270)
NEAR_M = 0.05
"""What is called done ended this close to the wish."""
TOUCH_M = 0.02
"""How far from what carries it a thing may be that rests on it."""


class NotTriedError(Exception):
    """A check could not be made, since something else it needs does not work; says what."""


class Probe:
    """An engine that is looked at: what several checks need to know of it."""

    def __init__(self, world: World) -> None:
        """Look at an engine.

        Args:
            world: Is reset before each check.
        """
        self.world = world
        self._pickable: int | None = None
        self._place: Vec3 | None = None

    @property
    def body(self) -> Body:
        """The body that acts."""
        return acting_body(self.world)

    def state(self) -> WorldState:
        """The world now."""
        return self.world.state()

    def see(self, size_px: tuple[int, int] = SIZE_PX) -> Percept:
        """What the body sees now."""
        return self.body.see(*size_px)

    def visible(self, percept: Percept) -> tuple[VisibleObject, ...]:
        """What is large enough in a view for the agent to be told of it."""
        return visible_objects(percept, 20)

    def pickable(self) -> int:
        """An object that the body sees from the start and can take; the world is as reset then.

        Raises:
            NotTriedError: There is none.
        """
        if self._pickable is None:
            seen = sorted(self.visible(self.see()), key=lambda item: -item.pixels)
            for item in seen[:12]:
                done = self.body.pick(item.id).outcome is Outcome.DONE
                holds = self.body.state().held == item.id
                self.world.reset(0)
                if done and holds:
                    self._pickable = item.id
                    break
            else:
                raise NotTriedError("no object in the first view could be picked")
        return self._pickable

    def place(self) -> Vec3:
        """A place on the floor, a step away, where the body can stand; the world is as reset then.

        Raises:
            NotTriedError: There is none.
        """
        if self._place is None:
            here = self.state().body.position
            for step_m in (0.8, 0.5, 1.2):
                for turn in range(12):
                    angle = turn * math.tau / 12
                    way = Vec3(math.cos(angle), math.sin(angle), 0.0) * step_m
                    report = self.body.walk(here + way)
                    arrived = self.body.state().position.horizontal_distance(here + way) <= NEAR_M
                    self.world.reset(0)
                    if report.outcome is Outcome.DONE and arrived:
                        self._place = here + way
                        return self._place
            raise NotTriedError("no step from the start could be walked")
        return self._place

    def take(self) -> int:
        """Have an object in the hand; its id.

        Raises:
            NotTriedError: None can be taken.
        """
        number = self.pickable()
        report = self.body.pick(number)
        if self.body.state().held != number:
            raise NotTriedError(f"picking object {number} went otherwise than before ({report})")
        return number

    def drop_aside(self) -> tuple[int, Vec3, BodyReport]:
        """Take an object and put it on the floor where the body can stand: id, wish and report."""
        wish = self.place()
        number = self.take()
        return number, wish, self.body.drop(wish)


CheckFunction = Callable[[Probe], Iterator[str]]


@dataclass(frozen=True, slots=True)
class Check:
    """One thing that an engine must keep to."""

    name: str
    expected: str
    """What holds in a good engine, as a sentence."""
    mend: str
    """What to do where it does not hold."""
    run: CheckFunction = field(repr=False)
    """Says in sentences what was found instead; nothing if all is well."""
    needs: str = ""
    """The ability that it is about, see `Abilities`; empty for what every engine must."""

    @property
    def group(self) -> str:
        """What it is about: the first word of its name."""
        return self.name.partition("-")[0]


def told(functions: Mapping[str, CheckFunction]) -> tuple[Check, ...]:
    """The checks with the words that belong to them: those of checks.toml.

    Args:
        functions: What is looked at, by the name of the check.
    """
    text = resources.files(__package__).joinpath("checks.toml").read_text(encoding="utf-8")
    words = tomllib.loads(text)
    return tuple(Check(name, run=run, **words[name]) for name, run in functions.items())


def refused_with(report: BodyReport, code: Code) -> Iterator[str]:
    """Whether something was refused for a reason."""
    if report.outcome is not Outcome.REFUSED or report.code != code:
        yield f"{report.outcome}/{report.code} instead of refused/{code}"


def unchanged(before: WorldState, after: WorldState) -> Iterator[str]:
    """Whether the world is as it was."""
    if before.hash() != after.hash():
        moved = [
            f"object {b.id}" for a, b in zip(before.objects, after.objects, strict=False) if a != b
        ]
        moved += ["the body"] if before.body != after.body else []
        yield f"the world changed: {', '.join(moved[:4]) or 'other objects are in the room'}"


def pixels_of(percept: Percept, number: int) -> np.ndarray:
    """(N, 2) centres of the pixels (u, v) that show an object, in any layer."""
    shows = np.logical_or.reduce([layer == number for layer in percept.id_layers])
    rows, columns = np.nonzero(shows)
    return np.stack([columns, rows], axis=1) + 0.5
