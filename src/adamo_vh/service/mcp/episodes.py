"""The episodes of a server: begun, found again by their ids, closed when nobody comes any more."""

from __future__ import annotations

import re
import secrets
import threading
from collections.abc import Callable, Mapping, Sequence
from contextlib import ExitStack, suppress
from pathlib import Path
from typing import Any

from adamo_vh.episode.config import EpisodeConfig
from adamo_vh.episode.result import read_manifest
from adamo_vh.errors import ConfigError
from adamo_vh.inference.model import ModelKind
from adamo_vh.record.run_folder import FIGURE, FRAMES, MANIFEST, RESULT, SCENE, reserve
from adamo_vh.record.trajectory import Observer, frame_type
from adamo_vh.service.mcp.offer import Offer
from adamo_vh.service.seats import Seats
from adamo_vh.session.lending import LentWorld
from adamo_vh.session.outside import OutsideEpisode
from adamo_vh.session.pooling import Engines, server_engines
from adamo_vh.session.session import read_unfinished

_ID = re.compile(r"[A-Za-z0-9][A-Za-z0-9._-]{0,99}")
_FRAME = re.compile(r"[0-9a-f]{24}\.(jpg|png)")
_CHECK_S = 5.0

Watch = Callable[[str], None]
"""Is told what happens, in lines for whoever runs the server."""


class Episodes:
    """All episodes of a server; safe to use from any threads."""

    def __init__(
        self,
        offer: Offer,
        watch: Watch = lambda line: None,
        engines: Engines | None = None,
        observers: Sequence[Observer] = (),
        seats: Seats | None = None,
    ) -> None:
        """Play nothing yet.

        Args:
            offer: What is played.
            watch: Is told what happens; never the players.
            engines: Where it is played; made when they are needed, and closed here, by default.
            observers: Are told of every event of the episodes that begin here.
            seats: Of a server with other faces; as many as are offered, by default.
        """
        self.offer = offer
        self._watch = watch
        self._engines = engines or server_engines()
        self._has_own_engines = engines is None
        self._observers = observers
        self._lock = threading.RLock()
        self._live: dict[str, OutsideEpisode] = {}
        self._seats = seats or Seats(offer.most)
        self._seats.count(lambda: sum(not live.ended for live in tuple(self._live.values())))
        self._closing = threading.Event()
        self._sweeper = threading.Thread(target=self._sweep, name="adamo-mcp-idle", daemon=True)
        self._sweeper.start()

    @property
    def fixed(self) -> str:
        """Id of the one episode that was set up beforehand; empty if clients begin their own."""
        return self.offer.fixed.name if self.offer.fixed is not None else ""

    def begin(self, client: str, wishes: Mapping[str, Any]) -> tuple[str, OutsideEpisode]:
        """Begin an episode that a client asks for.

        Returns:
            Its id, and the episode.

        Raises:
            ConfigError: A wish cannot be met.
            BusyError: The server plays as many as it can.
        """
        config = self.offer.config(wishes)
        with self._lock, self._seats.one_more():
            what = re.sub(r"[^a-z0-9]+", "-", (config.task or "free").lower()).strip("-")
            folder = reserve(self.offer.root, f"{what}-{secrets.token_hex(4)}")
            return folder.name, self._begun(folder, config, client)

    def find(self, name: str, client: str) -> OutsideEpisode | None:
        """An episode by its id; one that was interrupted is gone on with.

        Args:
            name: Its id, from anybody.
            client: Who asks, if it says so.

        Returns:
            The episode; None if it has ended.

        Raises:
            ConfigError: There is none.
            AdamoError: It cannot be gone on with.
        """
        with self._lock:
            live = self._live.get(name)
        if live is not None and not live.ended:
            return live
        if live is not None:
            live.close()  # Until its record is whole: whether it can be gone on with is in there.
        with self._lock:
            if (live := self._live.get(name)) is not None:
                return live
            folder = self._folder(name)
            if folder is None:
                raise ConfigError(f"There is no episode {name!r:.60}.{self._hint()}")
            if not (folder / MANIFEST).exists():
                return self._begun(folder, self.offer.config(), client)
            ended = read_unfinished(folder).ended
            if ended is not None and ended.reason.is_scored and (folder / RESULT).exists():
                return None
            with self._seats.one_more():
                self._watch(f"{name}: gone on with, from {folder}")
                return self._resumed(folder)

    def frame(self, name: str, frame: str) -> tuple[bytes, str]:
        """A picture that a player was shown, as it was drawn, and its media type.

        Raises:
            ConfigError: There is none.
        """
        folder = self._folder(name)
        path = None if folder is None else folder / FRAMES / frame
        if path is None or not _FRAME.fullmatch(frame) or not path.is_file():
            raise ConfigError("There is no such frame.")
        if not read_manifest(path.parent.parent).config.profile.has_pictures:
            raise ConfigError("This episode is played without pictures.")
        return path.read_bytes(), frame_type(frame)

    def close(self) -> None:
        """Cut off what has not ended; it can be gone on with from its run folder."""
        self._closing.set()
        with self._lock:
            left = list(self._live.values())
        for episode in left:
            episode.close()
        if self._has_own_engines:
            self._engines.close()

    def __enter__(self) -> Episodes:
        """Itself."""
        return self

    def __exit__(self, *_: object) -> None:
        """Close."""
        self.close()

    def _hint(self) -> str:
        return f" Yours is {self.fixed}." if self.fixed else " new_episode begins one."

    def _folder(self, name: str) -> Path | None:
        """The run folder of an episode of this server, be it from before its last start."""
        if self.offer.fixed is not None:
            return self.offer.fixed if name == self.fixed else None
        if not _ID.fullmatch(name):
            return None
        folder = self.offer.root / name
        if folder.is_symlink() or not (folder / MANIFEST).is_file():
            return None
        return folder if read_manifest(folder).model_kind is ModelKind.OUTSIDE else None

    def _begun(self, folder: Path, config: EpisodeConfig, client: str) -> OutsideEpisode:
        with ExitStack() as stack:
            # A folder that holds nothing is no episode.
            stack.callback(_remove_empty, folder)
            lent = self._lent(stack, config)
            self._live[folder.name] = episode = OutsideEpisode.begin(
                config,
                folder,
                client=client,
                engine=lent,
                isolation=self.offer.isolation,
                observers=self._observers,
                done=self._done(folder, config, lent),
            )
            stack.pop_all()
        self._watch(f"{folder.name}: {config.task or 'free'} in {config.scene}, run in {folder}")
        return episode

    def _resumed(self, folder: Path) -> OutsideEpisode:
        # With its own scene or figure in the folder, it is that one whatever is there by its name.
        config = read_manifest(folder).config
        own = (folder / SCENE).is_file() or (folder / FIGURE).is_file()
        with ExitStack() as stack:
            lent = None if own else self._lent(stack, config)
            done = self._done(folder, config, lent)
            self._live[folder.name] = OutsideEpisode.resume(folder, engine=lent, done=done)
            stack.pop_all()
        return self._live[folder.name]

    def _lent(self, stack: ExitStack, config: EpisodeConfig) -> LentWorld:
        """A world for an episode, given back if it does not begin."""
        lender = self._engines.take(config)
        stack.callback(self._engines.give_back, lender)
        return lender.lend()

    def _done(
        self, folder: Path, config: EpisodeConfig, lent: LentWorld | None
    ) -> Callable[[OutsideEpisode], None]:
        """Ends what an episode has here, and tells what came of it."""

        def done(episode: OutsideEpisode) -> None:
            if lent is not None:
                lent.close()
                self._engines.give_back(lent.lender)
            with self._lock:
                del self._live[folder.name]
            try:
                result = episode.result()
            except Exception as error:
                self._watch(f"{folder.name}: broke off: {error}")
                return
            score = "unscored"
            if result.completion is not None:
                score = f"completion {result.completion:.2f}"
            self._watch(f"{folder.name}: ended ({result.termination}), {score}, see {folder}")

        return done

    def _sweep(self) -> None:
        """Close what nobody has come back to."""
        while not self._closing.wait(min(_CHECK_S, self.offer.idle_s / 2)):
            with self._lock:
                idle = [e for e in self._live.values() if e.idle_s > self.offer.idle_s]
            for episode in idle:
                episode.close("Nobody came back to it.")


def _remove_empty(folder: Path) -> None:
    with suppress(OSError):  # It holds something, or never was.
        folder.rmdir()
