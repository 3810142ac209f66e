"""Views that were drawn before: where episodes repeat, so do their views, the first one always."""

from __future__ import annotations

import hashlib
import threading
from collections import OrderedDict
from collections.abc import Callable

from adamo_vh.engine import World
from adamo_vh.errors import ConfigError
from adamo_vh.observation import Observation
from adamo_vh.perception import Labeling, PerceptionConfig

_MIB = 2**20
_BESIDES = 20_000
"""Bytes that a view takes about without its frame."""


class FrameCache:
    """Keeps the views that were used last. Any number of threads and servers may share one.

    A view is that of a world in one state through one pair of eyes with one setting, so what is
    found is what would be drawn: an episode is the same with and without.
    """

    def __init__(self, megabytes: float = 256.0) -> None:
        """Set how much is kept.

        Args:
            megabytes: Memory at most; a view at 1920x1080 takes about half of one.

        Raises:
            ConfigError: It is no amount.
        """
        if not megabytes >= 0:
            raise ConfigError(f"frame cache of {megabytes!r} MB: use a number from 0.")
        self.found = 0
        """Views that needed no drawing."""
        self.drawn = 0
        """Views that did."""
        self._most = megabytes * _MIB
        self._size = 0
        self._views: OrderedDict[bytes, Observation] = OrderedDict()
        self._lock = threading.Lock()

    @property
    def kept(self) -> int:
        """How many views are kept now."""
        return len(self._views)

    @property
    def size(self) -> int:
        """Bytes that they take, about."""
        return self._size

    def view(self, key: bytes, draw: Callable[[], Observation]) -> Observation:
        """The view under a key; drawn if it is not kept.

        Args:
            key: As `view_key` gives it; an empty one belongs to no view that may be kept.
            draw: Makes the view.
        """
        with self._lock:
            kept = self._views.get(key)
            if kept is not None:
                self._views.move_to_end(key)
                self.found += 1
                return kept
        view = draw()
        with self._lock:
            self.drawn += 1
            if key and key not in self._views:
                self._views[key] = view
                self._size += _size(view)
            while self._size > self._most:
                _, oldest = self._views.popitem(last=False)
                self._size -= _size(oldest)
        return view


def view_key(world: World, resolution: tuple[int, int], perception: PerceptionConfig) -> bytes:
    """What tells the view of the acting body's eyes from any other one.

    The hash of a state does not: it leaves out lights and furniture, and the figure, which is seen
    where the body is in view. The snapshot and the digest of the scene hold them all.

    Args:
        world: Between two actions.
        resolution: Width and height in pixels.
        perception: How the view is made.

    Returns:
        Nothing, if it cannot be told: the engine says no digest, or an own labeling makes the tags.
    """
    if not world.scene.digest or not isinstance(perception.labeling, Labeling):
        return b""
    told = hashlib.sha256(f"{world.scene.digest} {resolution} {perception}\n".encode())
    told.update(world.snapshot())
    return told.digest()


def _size(view: Observation) -> int:
    return len(view.frame.data) + _BESIDES
