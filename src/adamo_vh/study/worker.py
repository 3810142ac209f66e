"""A worker: one process that plays the episodes it is sent, several at once."""

from __future__ import annotations

import os
import threading
import time
import warnings
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass, field
from multiprocessing.connection import Connection
from pathlib import Path

from adamo_vh.action_server.frame_cache import FrameCache
from adamo_vh.analysis.outcome import Outcome
from adamo_vh.cognition.budget import Budget
from adamo_vh.cognition.telling import fault
from adamo_vh.errors import (
    AdamoError,
    ConfigError,
    FileError,
    FolderInUseError,
    ModelConfigError,
    RecordError,
    SceneError,
)
from adamo_vh.heap import give_back, share_pools
from adamo_vh.inference.model import Model
from adamo_vh.inference.registry import is_remote
from adamo_vh.inference.remote.gate import Gate, through
from adamo_vh.observation import Frame
from adamo_vh.record.termination import TerminationReason
from adamo_vh.record.trajectory import Event
from adamo_vh.session.minds import model_of
from adamo_vh.session.pooling import Engines
from adamo_vh.study.executor import Failed, Finished, Noted, Report
from adamo_vh.study.ledger import Purse, StudyLedger, budgeted
from adamo_vh.study.limiter import LIMITS, Limiter, Rates
from adamo_vh.study.plan import Planned
from adamo_vh.study.playing import play

BEAT_S = 2.0
"""Seconds between two signs of life."""
_SILENT_S = 1800.0
"""Seconds without any event of an episode after which it is taken to hang: more than a provider may
take for one answer, retries and waits included."""
_KEPT_S = 60.0
"""Seconds for which free memory is kept at least."""
_NO_USE = (ConfigError, ModelConfigError, RecordError, SceneError)
"""What another try would meet again."""
_IN_USE_S = 10.0
"""Seconds to wait for a folder that a process that was told to end may still hold."""


@dataclass(frozen=True, slots=True)
class Alive:
    """A sign of life."""


@dataclass(frozen=True, slots=True)
class Played:
    """An episode has ended; why it failed is still being found out. Another one may begin."""

    key: str


@dataclass(frozen=True, slots=True)
class Setup:
    """What a worker has to know before its first episode."""

    folder: Path
    """The study's."""
    frame_cache: bool = True
    """Whether views that episodes share are drawn once."""
    budget: Budget = field(default=Budget())
    """Of the whole study."""
    rates: Rates = field(default=Rates())
    """How much each provider may be asked by all workers together."""


class Pulse:
    """Hears every event of an episode, so that one that hangs is noticed."""

    def __init__(self) -> None:
        """Start now."""
        self.heard = time.monotonic()

    def notify(self, event: Event, frame: Frame | None = None) -> None:
        """Take note that it is alive."""
        self.heard = time.monotonic()


class Player:
    """Plays episodes in this process and reports what became of each."""

    def __init__(
        self,
        setup: Setup,
        *,
        purse: Purse | None = None,
        gate: Gate | None = None,
        played: Callable[[str], None] | None = None,
    ) -> None:
        """Prepare; engines are made when they are needed.

        Args:
            setup: The study.
            purse: Keeps its budget; by default a file in its folder.
            gate: Keeps the pace of its providers; by default a file in its folder.
            played: Is told the key of an episode that has ended before its failure is explained.
        """
        self._setup = setup
        self._engines = Engines()
        self._frames = FrameCache() if setup.frame_cache else None
        self._gate = gate or Limiter(setup.folder / LIMITS, setup.rates)
        self._purse = purse or StudyLedger(setup.folder, setup.budget)
        self._pulses: dict[str, Pulse] = {}
        self._gave_back = time.monotonic()
        self._told_played = played or (lambda _: None)
        self._explaining = threading.Lock()

    @property
    def hangs(self) -> bool:
        """Whether an episode has given no sign for too long."""
        now = time.monotonic()
        return any(now - pulse.heard > _SILENT_S for pulse in list(self._pulses.values()))

    def play(self, planned: Planned) -> Report:
        """Play an episode; whatever happens to it is in the report. From any thread."""
        pulse = self._pulses[planned.key] = Pulse()
        try:
            return self._played(planned, pulse)
        finally:
            del self._pulses[planned.key]
            self._give_back()

    def _give_back(self) -> None:
        """Give back what ended episodes took for pictures and prompts; seldom, as it takes 5 ms."""
        now = time.monotonic()
        if now - self._gave_back > _KEPT_S:
            self._gave_back = now
            give_back()

    def _played(self, planned: Planned, pulse: Pulse) -> Report:
        try:
            outcome = self._outcome(planned, pulse)
        except FileError as error:
            return Failed(planned.key, str(error), fatal=True)
        except AdamoError as error:
            again = isinstance(error, FolderInUseError) or not isinstance(error, _NO_USE)
            return Failed(planned.key, str(error), again=again)
        except Exception as error:
            return Failed(planned.key, fault(error), again=True)
        return Finished(planned.key, outcome)

    def _outcome(self, planned: Planned, pulse: Pulse) -> Outcome:
        deadline = time.monotonic() + _IN_USE_S
        while True:
            try:
                with ExitStack() as stack:
                    stack.enter_context(through(self._gate))
                    engine = stack.enter_context(self._engines.lent(planned.config))
                    outcome = play(
                        self._setup.folder,
                        planned,
                        explaining=self._explained(planned.key),
                        engine=engine,
                        model=self._mind(planned, stack),
                        observers=(pulse,),
                        frame_cache=self._frames,
                    )
                    if outcome.termination is TerminationReason.BROKEN:
                        self._engines.distrust(engine)
                    return outcome
            except FolderInUseError:
                if time.monotonic() > deadline:
                    raise
                time.sleep(0.2)

    @contextmanager
    def _explained(self, key: str) -> Iterator[None]:
        """Explain one failure at a time, beside episodes that wait for their models."""
        self._told_played(key)
        with self._explaining:
            yield

    def _mind(self, planned: Planned, stack: ExitStack) -> Model | None:
        """A model that spends the study's budget; None for one that costs nothing."""
        config = planned.config
        if not is_remote(config.model):
            return None
        model = model_of(
            config.model, tools=config.tool_calls, profile=config.profile, seed=config.seed
        )
        stack.callback(model.info.close)
        return budgeted(model, config.model, planned.key, self._purse)


def work(pipe: Connection, setup: Setup) -> None:
    """Play what comes through a pipe until it ends; for `multiprocessing`.

    When the other end is gone the process ends at once, because somebody else may go on with the
    study in the next moment.

    Args:
        pipe: Brings `Planned`, or None for the end; takes `Report`, `Played` and `Alive`.
        setup: The study.
    """
    # Several processes draw faster with one thread each; before anything loads OpenGL.
    os.environ.setdefault("LP_NUM_THREADS", "1")
    share_pools()
    lock = threading.Lock()

    def send(message: Report | Alive | Played) -> None:
        try:
            with lock:
                pipe.send(message)
        except OSError:
            os._exit(1)

    warnings.showwarning = lambda message, *_, **__: send(Noted(str(message)))
    player = Player(setup, played=lambda key: send(Played(key)))

    def beat() -> None:
        while not player.hangs:
            send(Alive())
            time.sleep(BEAT_S)

    def play_one(planned: Planned) -> None:
        send(player.play(planned))

    threading.Thread(target=beat, daemon=True).start()
    try:
        while (planned := pipe.recv()) is not None:
            threading.Thread(target=play_one, args=(planned,), daemon=True).start()
    except (EOFError, OSError):
        os._exit(1)
    # Nothing is in flight any more; engines and connections go with the process.
    os._exit(0)
