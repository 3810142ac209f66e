"""The engines of a server: one for each scene that is played in, shared by all of its sessions."""

from __future__ import annotations

import threading
from collections import Counter
from collections.abc import Callable, Mapping

from adamo_vh.engine import World
from adamo_vh.episode.config import EpisodeConfig
from adamo_vh.errors import AdamoError
from adamo_vh.session.bodies import create_engine
from adamo_vh.session.lending import Lender

Place = tuple[str, str, int]
"""Scene, figure and variation."""
Make = Callable[[str, str, int], World]
"""Makes the world of a place."""


class BusyError(AdamoError):
    """The server has no room now; later it may have."""


class Engines:
    """Makes engines when they are needed, and closes those that nobody plays in."""

    def __init__(
        self,
        most: int = 4,
        ready: Mapping[Place, Lender] | None = None,
        make: Make | None = None,
    ) -> None:
        """Start with none.

        Args:
            most: So many are open at once.
            ready: Open already, by their place; never closed here.
            make: Makes the world of a scene, a figure and a variation; the built-in one by default.
        """
        self._make = make
        self._most = most
        self._ready = dict(ready or {})
        self._made: dict[Place, Lender] = {}
        self._players: Counter[Place] = Counter()
        self._lock = threading.Lock()

    def take(self, config: EpisodeConfig) -> Lender:
        """The engine for an episode; give it back when that is over.

        Raises:
            BusyError: All are in use, in other scenes.
            SceneError: The scene is wrong.
        """
        place = place_of(config)
        with self._lock:
            lender = self._ready.get(place) or self._made.get(place)
            if lender is None or bool(getattr(lender.world, "fault", "")):
                # One that dialled in may have gone: those in it are broken, and others go on.
                self._made.pop(place, None)
                self._make_room()
                lender = self._made[place] = Lender((self._make or create_engine)(*place))
            self._players[place] += 1
            return lender

    def give_back(self, config: EpisodeConfig) -> None:
        """End a use; the engine stays open for the next one, until its room is needed."""
        with self._lock:
            self._players[place_of(config)] -= 1

    def _make_room(self) -> None:
        idle = [place for place in self._made if not self._players[place]]
        while len(self._made) >= self._most:
            if not idle:
                raise BusyError(
                    f"{self._most} scenes are played in already; play in one of them, or wait."
                )
            self._made.pop(idle.pop(0)).close()

    def close(self) -> None:
        """Close all that were made here."""
        with self._lock:
            while self._made:
                self._made.popitem()[1].close()


def place_of(config: EpisodeConfig) -> Place:
    """Where an episode is played."""
    return config.scene, config.figure, config.variation
