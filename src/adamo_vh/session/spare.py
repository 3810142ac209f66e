"""Built-in engines that an episode has done with, kept for the next one in the same room.

To make an engine and draw its first picture takes longer than a whole episode of a fast player. So
the two that were used last stay, about 0.4 GB each, and serve again once they were found to stand
and look as they did when they were new. Nobody else has one meanwhile: episodes at the same time
get an engine each (to share one, see `adamo_vh.session.lending`).
"""

from __future__ import annotations

import atexit
import os
import threading
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from typing import TYPE_CHECKING

from adamo_vh.action_server.frame_check import frame_fault
from adamo_vh.session.figures import figure_digest
from adamo_vh.session.variations import built_in_scene

if TYPE_CHECKING:
    from adamo_vh.runtime.builtin import BuiltinEngine
    from adamo_vh.runtime.scenes.scene import Scene

_MOST = 2
_LOOK_PX = (64, 36)


@dataclass(frozen=True, slots=True)
class _Place:
    """What an engine is made for; a file that was changed since is another place."""

    scene: Scene
    named: str
    figure: str
    looks: str
    """Digest of an own figure."""


@dataclass(frozen=True, slots=True, eq=False)
class _Spare:
    """An engine that nobody uses."""

    place: _Place
    engine: BuiltinEngine
    start: str
    """Digest of the world when it was new."""
    process: int
    """Who made it: after a fork it draws no more."""

    def is_as_new(self) -> bool:
        """Whether it still stands and looks as it did when it was made."""
        if self.process != os.getpid():
            return False
        try:
            self.engine.reset(0)
            state = self.engine.state()
            seen = self.engine.capture(*_LOOK_PX)
            return state.hash() == self.start and not frame_fault(seen, state, self.engine.body)
        except Exception:
            return False

    def close(self) -> None:
        """Free its memory."""
        if self.process == os.getpid():
            with suppress(Exception):
                self.engine.close()


_lock = threading.Lock()
_spares: list[_Spare] = []
"""The one that was used last at the end."""


@contextmanager
def engine_for(scene: str, figure: str, variation: int = 0) -> Iterator[BuiltinEngine]:
    """The built-in engine with a scene while the block runs: one that is at hand, or a new one.

    Args:
        scene: Built-in scene or path of a scene file.
        figure: Who the virtual human is.
        variation: Of the scene's layout.

    Raises:
        SceneError: The scene is unknown or wrong, or has no such variation.
        ConfigError: No figure has this name.
    """
    place = _Place(built_in_scene(scene, variation), scene, figure, figure_digest(figure))
    used = _taken(place) or _made(place)
    try:
        yield used.engine
    finally:
        _put_back(used)


def close_spares() -> None:
    """Close the engines that nobody uses, and free their memory."""
    with _lock:
        closing = _spares[:]
        _spares.clear()
    for spare in closing:
        spare.close()


def _taken(place: _Place) -> _Spare | None:
    """A spare engine of a place, if there is one that is as new."""
    while True:
        with _lock:
            found = next((spare for spare in _spares if spare.place == place), None)
            if found is None:
                return None
            _spares.remove(found)
        if found.is_as_new():
            return found
        found.close()


def _made(place: _Place) -> _Spare:
    from adamo_vh.runtime.builtin import BuiltinEngine

    engine = BuiltinEngine(place.scene, place.figure, origin=place.named)
    return _Spare(place, engine, engine.state().hash(), os.getpid())


def _put_back(used: _Spare) -> None:
    used.engine.stage.watch(None)
    with _lock:
        _spares.append(used)
        closing = _spares[:-_MOST]
        del _spares[:-_MOST]
    for spare in closing:
        spare.close()


atexit.register(close_spares)
