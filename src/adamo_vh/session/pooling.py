"""Engines that a process has open: each takes long to make and is shared by many episodes."""

from __future__ import annotations

import os
import threading
from collections import OrderedDict
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field
from functools import cache

from adamo_vh.engine import World
from adamo_vh.episode.config import EpisodeConfig
from adamo_vh.errors import AdamoError
from adamo_vh.session.bodies import create_engine
from adamo_vh.session.lending import Lender, LentWorld

Place = tuple[str, str, int]
"""Scene, figure and variation: what an engine is made for."""
Make = Callable[[str, str, int], World]
"""Makes the world of a place."""


class BusyError(AdamoError):
    """There is no room now; later there may be."""


@dataclass(slots=True, eq=False)
class _Shared:
    """An engine and how many episodes play in it."""

    place: Place
    lender: Lender | None = None
    is_ours: bool = True
    """Whether it was made here, and is to be closed here."""
    users: int = 0
    making: threading.Lock = field(default_factory=threading.Lock)
    """Is held while it is made: once, whoever comes meanwhile."""

    @property
    def is_spent(self) -> bool:
        """Whether it is of no more use: one that dialled in may have gone."""
        return self.lender is not None and bool(getattr(self.lender.world, "fault", ""))

    def close(self) -> None:
        if self.is_ours and self.lender is not None:
            self.lender.close()


class Engines:
    """Makes engines, keeps those that were used last, and lends each to many episodes at once."""

    def __init__(
        self,
        kept: int = 2,
        most: int | None = None,
        ready: Mapping[Place, Lender] | None = None,
        make: Make | None = None,
    ) -> None:
        """Start with none.

        Args:
            kept: So many stay open though nobody uses them; each takes about half a gigabyte.
            most: So many of those made here are open at once; any number by default.
            ready: Open already, by their place; never closed here.
            make: Makes the world of a scene, a figure and a variation; see `create_engine`.
        """
        self._kept, self._most = kept, most
        self._make = make
        self._lock = threading.Lock()
        self._shared = OrderedDict(
            (place, _Shared(place, lender, is_ours=False))
            for place, lender in (ready or {}).items()
        )
        """By what they are made for, the one that was used last at the end."""
        self._distrusted: list[_Shared] = []
        """In use, and nobody new gets into them."""

    def take(self, config: EpisodeConfig) -> Lender:
        """The engine for an episode; give it back when that is over.

        Args:
            config: Names scene, figure and variation.

        Raises:
            BusyError: As many as there may be are in use, in other places.
            SceneError: The scene is wrong.
        """
        shared = self._entered((config.scene, config.figure, config.variation))
        try:
            with shared.making:
                if shared.lender is None:
                    shared.lender = Lender((self._make or create_engine)(*shared.place))
                return shared.lender
        except BaseException:
            with self._lock:
                self._put_aside(shared)
            self._left(shared)
            raise

    def give_back(self, lender: Lender) -> None:
        """End a use; the engine may stay open for the next one."""
        for shared in self._of(lender):
            self._left(shared)

    @contextmanager
    def lent(self, config: EpisodeConfig) -> Iterator[LentWorld]:
        """A world for an episode, in an engine that it shares.

        If the episode raises, nobody new gets into that engine.

        Args:
            config: Names scene, figure and variation.
        """
        lender = self.take(config)
        world = lender.lend()
        try:
            yield world
        except BaseException:
            self.distrust(world)
            raise
        finally:
            world.close()
            self.give_back(lender)

    def distrust(self, world: LentWorld) -> None:
        """Let no new episode into the engine of a world, which may be at fault that one broke."""
        suspects = self._of(world.lender)
        with self._lock:
            for shared in suspects:
                self._put_aside(shared)

    def close(self) -> None:
        """Close all that were made here."""
        with self._lock:
            closing = [*self._shared.values(), *self._distrusted]
            self._shared.clear()
            self._distrusted.clear()
        for shared in closing:
            shared.close()

    def _of(self, lender: Lender) -> list[_Shared]:
        with self._lock:
            known = [*self._shared.values(), *self._distrusted]
        return [shared for shared in known if shared.lender is lender]

    def _put_aside(self, shared: _Shared) -> None:
        if self._shared.get(shared.place) is shared:
            del self._shared[shared.place]
            self._distrusted.append(shared)

    def _entered(self, place: Place) -> _Shared:
        with self._lock:
            known = self._shared.get(place)
            if known is not None and known.is_spent:
                self._put_aside(known)
                known = None
            closing = [] if known is not None else self._room_for_one()
            shared = known or self._shared.setdefault(place, _Shared(place))
            self._shared.move_to_end(place)
            shared.users += 1
        for one in closing:
            one.close()
        return shared

    def _room_for_one(self) -> list[_Shared]:
        """What is to be closed so that one more may be made."""
        if self._most is None:
            return []
        ours = [shared for shared in self._shared.values() if shared.is_ours]
        if (surplus := len(ours) + 1 - self._most) <= 0:
            return []
        idle = [shared for shared in ours if not shared.users]
        if len(idle) < surplus:
            raise BusyError(
                f"{self._most} scenes are played in already; play in one of them, or wait."
            )
        return [self._shared.pop(shared.place) for shared in idle[:surplus]]

    def _left(self, shared: _Shared) -> None:
        with self._lock:
            shared.users -= 1
            closing = [one for one in self._distrusted if not one.users]
            self._distrusted = [one for one in self._distrusted if one.users]
            idle = [one for one in self._shared.values() if one.is_ours and not one.users]
            for one in idle[: max(0, len(idle) - self._kept)]:
                closing.append(self._shared.pop(one.place))
        for one in closing:
            one.close()


def server_engines() -> Engines:
    """The engines of a server: four scenes at once, open until their room is needed."""
    return Engines(kept=4, most=4)


def process_engines() -> Engines:
    """The engines of this process; a process that was forked from it has its own."""
    return _engines_of(os.getpid())


@cache
def _engines_of(process: int) -> Engines:
    return Engines()
