"""One engine for many episodes at once: each has it for the moment of an action or a view.

A model takes seconds to answer, an engine a fraction of one to act. So while one episode's model
thinks, the engine carries out what another one decided: it goes back to that one's state, which
takes about a millisecond, and no episode can tell that it is not alone.

    with Lender(create_engine("s1")) as lender, ThreadPoolExecutor(16) as pool:
        results = pool.map(lambda task: run_episode(task=task, engine=lender.lend()), TASKS)
"""

from __future__ import annotations

import threading
import time
from collections.abc import Iterator, Mapping, Sequence
from contextlib import AbstractContextManager, contextmanager
from typing import Self

from adamo_vh.abilities import Abilities, abilities
from adamo_vh.engine import (
    Body,
    BodyInfo,
    BodyReport,
    SceneInfo,
    World,
    WorldEvent,
    WorldState,
)
from adamo_vh.errors import EngineError
from adamo_vh.geometry import Array, Vec3
from adamo_vh.observation import BodyState, Percept


class Lender:
    """Lends one engine to many episodes, from any threads; one at a time is in it."""

    def __init__(self, world: World) -> None:
        """Take an engine over: from now on it is used through what is lent alone.

        Args:
            world: As it is now, so are the worlds that are lent. Is closed by `close`.
        """
        self.world = world
        """The engine; whose state it has at a moment is nobody's business."""
        self._start = world.snapshot()
        self._lock = threading.RLock()
        self._holder: LentWorld | None = None
        """Whose state the engine has."""
        self._inside: LentWorld | None = None
        """Who is in the engine at this moment."""

    def lend(self) -> LentWorld:
        """A world for one episode or conversation; give it back with its `close`, or forget it."""
        return LentWorld(self, self._start)

    @contextmanager
    def turn(self, lent: LentWorld) -> Iterator[float]:
        """Let one of those it is lent to into the engine, alone, in the state in which it left it.

        Args:
            lent: Waits for the others; may come in again within its own turn.

        Yields:
            Seconds that this took.

        Raises:
            EngineError: It was given back; or a call of another one, which this is made within, has
                not ended; or the engine failed.
        """
        asked = time.monotonic()
        with self._lock:
            if self._inside is lent:
                yield 0.0
                return
            if self._inside is not None:
                raise EngineError(
                    "The engine is in the middle of another episode's action: what watches it can "
                    "use that episode's world alone."
                )
            self._hand_over(lent)
            self._inside = lent
            try:
                yield time.monotonic() - asked
            finally:
                self._inside = None

    def _hand_over(self, lent: LentWorld) -> None:
        if lent is self._holder:
            return
        if lent.fault:
            raise EngineError(lent.fault)
        if not abilities(self.world).snapshot:
            self._hand_over_anew(lent)
            return
        if (last := self._holder) is not None:
            try:
                last.kept = self.world.snapshot()
            except Exception as fault:
                # It is that episode which broke, and the next one goes on.
                what = f"{type(fault).__name__}: {fault}"
                last.fault = f"The engine could not keep this episode's world: {what}"
            self._holder = None
        self.world.restore(lent.kept)
        self._holder = lent

    def _hand_over_anew(self, lent: LentWorld) -> None:
        """Lend an engine that keeps no states: to one at a time, and from its start."""
        if self._holder is not None:
            raise EngineError(
                "This engine keeps no states, so it carries one episode at a time, and it is in "
                "another one now. Try again when that has ended."
            )
        self.world.reset(0)
        self._holder = lent

    def take_back(self, lent: LentWorld) -> None:
        """End a loan; its world cannot be used afterwards."""
        with self._lock:
            lent.fault = "This world was given back; lend another one."
            if self._holder is lent:
                self._holder = None

    def close(self) -> None:
        """Close the engine; nothing that was lent can be used afterwards."""
        with self._lock:
            self.world.close()

    def __enter__(self) -> Self:
        """Itself."""
        return self

    def __exit__(self, *_: object) -> None:
        """Close it."""
        self.close()


class LentWorld:
    """A world of one's own in an engine that others use too. Implements `adamo_vh.engine.World`."""

    def __init__(self, lender: Lender, start: bytes) -> None:
        """Get a world; use `Lender.lend`.

        Args:
            lender: Whose engine it is in.
            start: The state in which it begins.
        """
        self.lender = lender
        self.kept = start
        """Its state, while others are in the engine."""
        self.fault = ""
        """Why it cannot be used any more; empty if it can."""
        self._bodies = {name: LentBody(self, name) for name in lender.world.bodies}

    def turn(self) -> AbstractContextManager[float]:
        """Have the engine for several calls in a row; gives the seconds that this was waited for.

        Raises:
            EngineError: See `Lender.turn`.
        """
        return self.lender.turn(self)

    @property
    def scene(self) -> SceneInfo:
        """The engine's, which is the same for all."""
        return self.lender.world.scene

    @property
    def object_names(self) -> Mapping[int, str]:
        """The engine's, which are the same for all."""
        return self.lender.world.object_names

    @property
    def bodies(self) -> Mapping[str, Body]:
        """Its bodies by name, in the engine's order."""
        return self._bodies

    @property
    def abilities(self) -> Abilities:
        """The engine's."""
        return abilities(self.lender.world)

    def reset(self, seed: int) -> None:
        """Put this world back to its start."""
        with self.turn():
            self.lender.world.reset(seed)

    def state(self) -> WorldState:
        """The whole truth about this world."""
        with self.turn():
            return self.lender.world.state()

    def snapshot(self) -> bytes:
        """Everything that decides what happens next in this world."""
        with self.turn():
            return self.lender.world.snapshot()

    def restore(self, snapshot: bytes) -> None:
        """Take this world back to a snapshot."""
        with self.turn():
            self.lender.world.restore(snapshot)

    def apply(self, event: WorldEvent) -> None:
        """Let something happen in this world alone."""
        with self.turn():
            self.lender.world.apply(event)

    def close(self) -> None:
        """Give it back; the engine stays open for the others."""
        self.lender.take_back(self)


class LentBody:
    """A body in a lent world. Implements `adamo_vh.engine.Body`."""

    def __init__(self, lent: LentWorld, name: str) -> None:
        """Be a body of a world.

        Args:
            lent: The world.
            name: Of the body in the engine.
        """
        self._turn = lent.turn
        self._body = lent.lender.world.bodies[name]

    @property
    def info(self) -> BodyInfo:
        """What is always true of it."""
        return self._body.info

    def state(self) -> BodyState:
        """Where it stands and looks now, and what it feels in its hand."""
        with self._turn():
            return self._body.state()

    def see(self, width_px: int, height_px: int) -> Percept:
        """See the room through its eyes."""
        with self._turn():
            return self._body.see(width_px, height_px)

    def closeup(
        self, point: Vec3, vertical_fov_rad: float, width_px: int, height_px: int
    ) -> Percept:
        """See a part of the room larger."""
        with self._turn():
            return self._body.closeup(point, vertical_fov_rad, width_px, height_px)

    def rays(self, origin: Vec3, directions: Array) -> Sequence[Vec3 | None]:
        """First hits of rays from a point."""
        with self._turn():
            return self._body.rays(origin, directions)

    def look(self, point: Vec3) -> BodyReport:
        """Turn body and gaze to a point."""
        with self._turn():
            return self._body.look(point)

    def walk(self, point: Vec3) -> BodyReport:
        """Walk to the reachable place that is nearest to a point."""
        with self._turn():
            return self._body.walk(point)

    def pick(self, object_id: int) -> BodyReport:
        """Take an object into the hand, walking closer if needed."""
        with self._turn():
            return self._body.pick(object_id)

    def drop(self, point: Vec3) -> BodyReport:
        """Put the held object down at a point, walking closer if needed."""
        with self._turn():
            return self._body.drop(point)

    def say(self, text: str) -> None:
        """Deliver the agent's final answer."""
        with self._turn():
            self._body.say(text)
