"""What a process keeps between episodes: engines, which take long to make."""

from __future__ import annotations

import threading
from collections import OrderedDict
from collections.abc import Iterator
from contextlib import contextmanager

from adamo_vh.engine import World
from adamo_vh.episode.config import EpisodeConfig
from adamo_vh.session.bodies import create_engine

_KEPT = 2
"""Engines that nobody uses: each takes about half a gigabyte."""

_Place = tuple[str, str, int]
"""Scene, figure and variation: what an engine is made for."""


class Engines:
    """Makes engines, keeps those that were used last, and lends each to one episode at a time."""

    def __init__(self) -> None:
        """Start with none."""
        self._lock = threading.Lock()
        self._idle: OrderedDict[int, tuple[_Place, World]] = OrderedDict()
        self._spoilt: set[int] = set()

    @contextmanager
    def lent(self, config: EpisodeConfig) -> Iterator[World]:
        """An engine for an episode.

        Args:
            config: Names scene, figure and variation.
        """
        place = (config.scene, config.figure, config.variation)
        engine = self._taken(place) or create_engine(config.scene, config.figure)
        try:
            yield engine
        except BaseException:
            self.distrust(engine)
            raise
        finally:
            self._give_back(place, engine)

    def distrust(self, engine: World) -> None:
        """Use an engine no more after its episode, which may have broken through its fault."""
        self._spoilt.add(id(engine))

    def _taken(self, place: _Place) -> World | None:
        with self._lock:
            for number, (made_for, engine) in self._idle.items():
                if made_for == place:
                    del self._idle[number]
                    return engine
        return None

    def _give_back(self, place: _Place, engine: World) -> None:
        spare: World | None = engine
        with self._lock:
            if id(engine) in self._spoilt:
                self._spoilt.discard(id(engine))
            else:
                self._idle[id(engine)] = (place, engine)
                spare = self._idle.popitem(last=False)[1][1] if len(self._idle) > _KEPT else None
        if spare is not None:
            spare.close()
