"""The live rooms of a studio: opened, found again, and closed when nobody is in them."""

from __future__ import annotations

import re
import secrets
import threading
import time
from contextlib import suppress
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path
from typing import Annotated, ClassVar
from urllib.parse import quote

from pydantic import ConfigDict, Field

from adamo_vh.episode.config import EpisodeConfig
from adamo_vh.errors import ConfigError
from adamo_vh.readable import readable
from adamo_vh.record.run_folder import reserve
from adamo_vh.record.termination import Limits
from adamo_vh.service.hosting import NoSessionError
from adamo_vh.session.pooling import BusyError
from adamo_vh.studio.messages import Places
from adamo_vh.studio.offer import Offer
from adamo_vh.studio.room import Room

_SWEEP_S = 5.0
_DAY_S = 86_400.0
_FREE_TALK = "What is said in the studio."
"""The instruction of a room without a task: what is really said is in the events."""
_Short = Annotated[str, Field(max_length=200)]


@dataclass(frozen=True, slots=True)
class Asked:
    """What a new room is to be."""

    __pydantic_config__: ClassVar[ConfigDict] = ConfigDict(extra="forbid")

    scene: _Short = "s1"
    model: _Short = "baseline"
    profile: _Short = "paper"
    labeling: _Short = "sem"
    figure: _Short = "mara"
    task: _Short | None = None
    variation: Annotated[int, Field(ge=0, le=999_999)] = 0
    approve: bool = False


@dataclass(frozen=True, slots=True)
class RoomTerms:
    """How many rooms there are, and how long."""

    most: int = 4
    """So many are open at once; each has an engine of its own, about 0.4 GB."""
    idle_s: float = 900.0
    """A room in which nobody is and nothing happens is closed after this."""
    resolution: str = "1920x1080"


class Rooms:
    """The rooms of one server; may be used from any threads."""

    def __init__(self, out: Path, offer: Offer, terms: RoomTerms | None = None) -> None:
        """Begin without rooms.

        Args:
            out: Each room has its run folder in it.
            offer: What may be chosen.
            terms: How many, and how long.
        """
        self._out = out
        self._offer = offer
        self._terms = terms or RoomTerms()
        self._rooms: dict[str, Room] = {}
        self._opening = 0
        self._lock = threading.Lock()
        self._ending = threading.Event()
        self._sweeper = threading.Thread(target=self._sweep, name="adamo-rooms", daemon=True)
        self._sweeper.start()

    def open(self, asked: Asked) -> Room:
        """Open a room.

        Raises:
            ConfigError: A setting is wrong, or not on offer.
            BusyError: There are too many rooms.
        """
        config = self._config(asked)
        with self._lock:
            self._forget_closed()
            if self._ending.is_set():
                raise BusyError("The studio is ending.")
            if len(self._rooms) + self._opening >= self._terms.most:
                raise BusyError(f"{self._terms.most} rooms are open already; close one, or wait.")
            self._opening += 1
        try:
            room = self._opened(config, asked)
            with self._lock:
                self._rooms[room.name] = room
        finally:
            with self._lock:
                self._opening -= 1
        return room

    def _opened(self, config: EpisodeConfig, asked: Asked) -> Room:
        words = re.sub(r"[^a-z0-9]+", "-", (asked.task or "studio").lower()).strip("-")
        stamp = datetime.now(UTC).strftime("%Y%m%d-%H%M%S")
        folder = reserve(self._out, f"{stamp}-{words}")
        places = Places(
            f"/studio/api/scenes/{quote(asked.scene, safe='')}.glb?variation={asked.variation}",
            f"/studio/api/figures/{quote(asked.figure, safe='')}.glb",
        )
        name = secrets.token_urlsafe(9)
        room = Room(name, config, folder, places, approve=asked.approve)
        try:
            room.open()
        except BaseException:
            with suppress(OSError):
                folder.rmdir()  # Nothing was recorded in it.
            raise
        return room

    def _config(self, asked: Asked) -> EpisodeConfig:
        """The settings of a room: nothing that a page names is read as a path."""
        self._offer.check(asked.model, asked.scene, asked.figure, asked.task)
        return EpisodeConfig.of(
            None if asked.task else _FREE_TALK,
            task=asked.task,
            scene=self._offer.scene(asked.scene),
            figure=self._offer.figure(asked.figure),
            labeling=asked.labeling,
            profile=asked.profile,
            model=asked.model,
            variation=asked.variation,
            resolution=self._terms.resolution,
            # A person takes his time, and what is shown is not hurried.
            limits=Limits(max_seconds=_DAY_S),
        )

    def find(self, name: str) -> Room:
        """A room by its name, also one that was closed a moment ago.

        Raises:
            NoSessionError: There is none.
        """
        with self._lock:
            room = self._rooms.get(name)
        if room is None:
            shown = readable(name)[:40]
            raise NoSessionError(f"There is no room {shown!r}, or it was closed; open another one.")
        return room

    def close(self, name: str) -> None:
        """Close a room; its record stays.

        Raises:
            NoSessionError: There is none.
        """
        room = self.find(name)
        room.close()
        with self._lock:
            self._rooms.pop(name, None)

    def close_all(self) -> None:
        """Close every room: every record is whole."""
        self._ending.set()
        with self._lock:
            rooms = list(self._rooms.values())
        for room in rooms:
            room.close()
        self._sweeper.join()

    def _forget_closed(self) -> None:
        for name in [name for name, room in self._rooms.items() if room.closed]:
            if not self._rooms[name].log.watchers:
                del self._rooms[name]

    def _sweep(self) -> None:
        while not self._ending.wait(min(_SWEEP_S, self._terms.idle_s / 4)):
            now = time.monotonic()
            with self._lock:
                idle = [
                    room
                    for room in self._rooms.values()
                    if not (room.busy or room.log.watchers)
                    and now - room.touched > self._terms.idle_s
                ]
            for room in idle:
                with suppress(NoSessionError, ConfigError):
                    self.close(room.name)
