"""What a process keeps between episodes: engines, which take long to make, each shared by many."""

from __future__ import annotations

import os
import threading
from collections import OrderedDict
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from functools import cache

from adamo_vh.episode.config import EpisodeConfig
from adamo_vh.session.bodies import create_engine
from adamo_vh.session.lending import Lender, LentWorld

_KEPT = 2
"""Engines that nobody uses: each takes about half a gigabyte."""

_Place = tuple[str, str, int]
"""Scene, figure and variation: what an engine is made for."""


@dataclass(slots=True, eq=False)
class _Shared:
    """An engine and how many episodes play in it."""

    place: _Place
    making: threading.Lock = field(default_factory=threading.Lock)
    """Is held while it is made: once, whoever comes meanwhile."""
    lender: Lender | None = None
    users: int = 0

    def world(self) -> LentWorld:
        """A world in it."""
        with self.making:
            if self.lender is None:
                self.lender = Lender(create_engine(*self.place))
        return self.lender.lend()


class Engines:
    """Makes engines, keeps those that were used last, and lends each to many episodes at once."""

    def __init__(self) -> None:
        """Start with none."""
        self._lock = threading.Lock()
        self._shared: OrderedDict[_Place, _Shared] = OrderedDict()
        """By what they are made for, the one that was used last at the end."""

    @contextmanager
    def lent(self, config: EpisodeConfig) -> Iterator[LentWorld]:
        """A world for an episode, in an engine that it shares.

        Args:
            config: Names scene, figure and variation.
        """
        shared = self._entered((config.scene, config.figure, config.variation))
        world = None
        try:
            world = shared.world()
            yield world
        except BaseException:
            self._distrust(shared)
            raise
        finally:
            if world is not None:
                world.close()
            self._left(shared)

    def distrust(self, world: LentWorld) -> None:
        """Let no new episode into the engine of a world, which may be at fault that one broke."""
        with self._lock:
            suspects = [one for one in self._shared.values() if one.lender is world.lender]
        for shared in suspects:
            self._distrust(shared)

    def _distrust(self, shared: _Shared) -> None:
        with self._lock:
            if self._shared.get(shared.place) is shared:
                del self._shared[shared.place]

    def _entered(self, place: _Place) -> _Shared:
        with self._lock:
            shared = self._shared.setdefault(place, _Shared(place))
            self._shared.move_to_end(place)
            shared.users += 1
            return shared

    def _left(self, shared: _Shared) -> None:
        with self._lock:
            shared.users -= 1
            spare = [] if shared.users or shared in self._shared.values() else [shared]
            idle = [one for one in self._shared.values() if not one.users]
            for one in idle[: max(0, len(idle) - _KEPT)]:
                del self._shared[one.place]
                spare.append(one)
        for one in spare:
            if one.lender is not None:
                one.lender.close()


def process_engines() -> Engines:
    """The engines of this process; a process that was forked from it has its own."""
    return _engines_of(os.getpid())


@cache
def _engines_of(process: int) -> Engines:
    return Engines()
