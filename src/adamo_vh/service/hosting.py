"""All sessions of a server: begun, found again, closed when nobody plays, ended cleanly with it."""

from __future__ import annotations

import re
import secrets
import threading
import time
from collections import OrderedDict
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass, field
from datetime import UTC, datetime
from functools import partial
from pathlib import Path
from typing import Any

from adamo_vh.action_server.wire import Create
from adamo_vh.benchmark.tasks import builtin_tasks
from adamo_vh.episode.config import EpisodeConfig
from adamo_vh.errors import AdamoError, ConfigError
from adamo_vh.readable import readable
from adamo_vh.record.run_folder import reserve
from adamo_vh.record.termination import Limits
from adamo_vh.service.hosted import Hosted
from adamo_vh.service.seats import Seats
from adamo_vh.service.watching import Watch
from adamo_vh.session.builtin import scene_names
from adamo_vh.session.driven import DrivenBody
from adamo_vh.session.lending import Lender
from adamo_vh.session.pooling import BusyError, Engines, server_engines

_SWEEP_S = 5.0
_REMEMBERED = 1_000
_UNGUESSABLE = 32
"""Letters of an id that nobody guesses, who would get into the session of another with it."""


class NoSessionError(AdamoError):
    """There is no session of this name, or it was closed."""


@dataclass(frozen=True, slots=True)
class Terms:
    """What a server offers, and how far it goes."""

    scene: str = "s1"
    """Where a session plays that names none."""
    labeling: str = "sem"
    figure: str = "mara"
    profile: str = "paper"
    resolution: str = "1920x1080"
    most_sessions: int = 16
    """So many are played at once."""
    idle_s: float = 900.0
    """A session that nobody asks anything is closed after this."""
    limits: Limits = field(default=Limits())


class Host:
    """The sessions of one server; may be used from any threads."""

    def __init__(self, out: Path, terms: Terms, engines: Engines | None = None) -> None:
        """Start without sessions.

        Args:
            out: Each session has its run folder in it.
            terms: What is offered.
            engines: Where they are played; made when they are needed, by default.
        """
        self.terms = terms
        self.out = out
        self.engines = engines or server_engines()
        """Where the sessions are played, those of every face."""
        self.seats = Seats(terms.most_sessions)
        """How many are played, those of every face."""
        self.seats.count(self._played)
        self._sessions: dict[str, Hosted] = {}
        self._lenders: dict[str, Lender] = {}
        """Where each session is played."""
        self._folders: OrderedDict[str, Path] = OrderedDict()
        """Run folders of the sessions that were closed, for a judge."""
        self._begun_for: OrderedDict[str, str] = OrderedDict()
        """Sessions by the request that began them: it may come again, if its answer was lost."""
        self._lock = threading.Lock()
        self._closing = threading.Event()
        self._sweeper = threading.Thread(target=self._sweep, name="adamo-idle", daemon=True)
        self._sweeper.start()

    def create(self, asked: Create) -> Hosted:
        """Begin a session.

        Raises:
            ConfigError: A setting is wrong, or not on offer.
            BusyError: The server has no room for another one.
        """
        config = self._config(asked)
        with self._lock:
            if known := self._sessions.get(self._begun_for.get(asked.request, "")):
                return known
        if self._closing.is_set():
            raise BusyError("The server is ending.")
        with self.seats.one_more():
            hosted = self._begun(config, readable(asked.player).strip() or "outside")
            with self._lock:
                self._sessions[hosted.id] = hosted
                if len(asked.request) >= _UNGUESSABLE:
                    self._begun_for[asked.request] = hosted.id
                while len(self._begun_for) > _REMEMBERED:
                    self._begun_for.popitem(last=False)
        return hosted

    def prepare(self, asked: Create) -> None:
        """Open the engine of a session before anybody begins one.

        Raises:
            ConfigError: A setting is wrong.
            SceneError: The scene is wrong.
        """
        config = self._config(asked)
        self.engines.give_back(self.engines.take(config))

    def _begun(self, config: EpisodeConfig, player: str) -> Hosted:
        name = secrets.token_urlsafe(12)
        watch = Watch(lambda frame: f"/v1/sessions/{name}/frames/{frame}")
        lender = self.engines.take(config)
        try:
            stamp = datetime.now(UTC).strftime("%Y%m%d-%H%M%S")
            words = re.sub(r"[^a-z0-9]+", "-", (config.task or "free").lower())
            folder = reserve(self.out, f"{stamp}-{words}")
            body = DrivenBody.begin(
                config, folder, player=player, lender=lender, observers=(watch,)
            )
        except BaseException:
            self.engines.give_back(lender)
            raise
        self._lenders[name] = lender
        return Hosted(name, body, watch)

    def _config(self, asked: Create) -> EpisodeConfig:
        """The settings of a session: nothing that a client names is read as a path."""
        terms = self.terms
        scene = asked.scene or terms.scene
        if scene != terms.scene and scene.lower() not in scene_names():
            offer = ", ".join(dict.fromkeys((terms.scene, *scene_names())))
            raise ConfigError(f"There is no scene {readable(scene)[:40]!r} here. Scenes: {offer}.")
        if asked.task is not None:
            known = [task.id for task in builtin_tasks()]
            if asked.task.upper() not in known:
                raise ConfigError(
                    f"There is no task {readable(asked.task)[:40]!r}. Tasks: {', '.join(known)}."
                )
        return EpisodeConfig.of(
            None if asked.instruction is None else readable(asked.instruction, lines=True),
            task=asked.task,
            scene=scene,
            figure=terms.figure,
            labeling=asked.labeling or terms.labeling,
            profile=asked.profile or terms.profile,
            switches=asked.switches,
            seed=asked.seed,
            variation=asked.variation,
            resolution=asked.resolution or terms.resolution,
            limits=terms.limits,
        )

    def find(self, name: str) -> Hosted:
        """A session by its id.

        Raises:
            NoSessionError: There is none, or it was closed.
        """
        with self._lock:
            hosted = self._sessions.get(name)
        if hosted is None:
            raise NoSessionError("There is no such session, or it was closed; begin another one.")
        return hosted

    def folder_of(self, name: str) -> Path:
        """The run folder of a session, also of one that was closed. Privileged.

        Raises:
            NoSessionError: There never was one, or it is long ago.
        """
        with self._lock:
            folder = self._folders.get(name)
        return folder or self.find(name).folder

    def sessions(self) -> tuple[Hosted, ...]:
        """All sessions that are open, ended ones included. Privileged."""
        with self._lock:
            return tuple(self._sessions.values())

    def close(self, name: str) -> None:
        """Close a session; its record stays.

        Raises:
            NoSessionError: There is none.
        """
        hosted = self.find(name)
        with self._lock:
            if self._sessions.pop(name, None) is None:
                return
            self._folders[name] = hosted.folder
            while len(self._folders) > _REMEMBERED:
                self._folders.popitem(last=False)
        try:
            hosted.close()
        finally:
            self.engines.give_back(self._lenders.pop(name))

    def close_all(self) -> None:
        """Close every session, and the engines: every record is whole, and can be shown."""
        self._closing.set()
        self._sweeper.join()
        for hosted in self.sessions():
            self.close(hosted.id)
        self.engines.close()

    def _played(self) -> int:
        return sum(not hosted.body.ended for hosted in tuple(self._sessions.values()))

    def _sweep(self) -> None:
        """End what ran out of time, and close what nobody uses."""
        while not self._closing.wait(min(_SWEEP_S, self.terms.idle_s / 4)):
            self._sweep_once()

    def _sweep_once(self) -> None:
        for hosted in self.sessions():
            _quietly(hosted.expire)
        for name in self._stale():
            _quietly(partial(self.close, name))

    def _stale(self) -> list[str]:
        """Sessions that nobody asks anything, and the oldest of too many that have ended."""
        sessions, now = self.sessions(), time.monotonic()
        idle = [one.id for one in sessions if now - one.touched > self.terms.idle_s]
        ended = [one.id for one in sessions if one.body.ended and one.id not in idle]
        return idle + ended[: max(0, len(ended) - self.terms.most_sessions)]


def _quietly(do: Callable[[], Any]) -> None:
    """Do something to one session; a fault of it is none of the others'."""
    with suppress(Exception):
        do()
