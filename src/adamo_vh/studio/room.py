"""One live room: a body, a mind, and a person who looks on, talks, and takes part.

One thread owns the session. What the person asks comes from other threads: what takes effect at
once is done there (stop, speed, a word of consent), and all else waits for the room's own thread.
"""

from __future__ import annotations

import queue
import shutil
import threading
import time
from collections import deque
from contextlib import suppress
from pathlib import Path

from adamo_vh.engine import ObjectMoved, acting_body
from adamo_vh.episode.config import EpisodeConfig
from adamo_vh.errors import AdamoError, ConfigError, EngineError, RecordError
from adamo_vh.geometry import Vec3
from adamo_vh.inference.players.outside import HUMAN
from adamo_vh.observation import Frame
from adamo_vh.record.run_folder import EVENTS
from adamo_vh.record.termination import TerminationReason
from adamo_vh.record.trajectory import Event, Started
from adamo_vh.record.turn import Turn
from adamo_vh.report.page import try_page
from adamo_vh.session.builtin import scene_title
from adamo_vh.session.parts import Parts
from adamo_vh.session.posing import Posing
from adamo_vh.session.session import Session
from adamo_vh.studio import messages
from adamo_vh.studio.consent import Consent
from adamo_vh.studio.log import Log
from adamo_vh.studio.messages import (
    Act,
    Approval,
    Approve,
    Finish,
    Message,
    Move,
    Part,
    Ping,
    Places,
    Say,
    Speed,
    Stop,
    Undo,
    Veto,
    Wish,
)
from adamo_vh.studio.pace import Pace
from adamo_vh.studio.person import Person
from adamo_vh.studio.telling import Telling

_CLOSE_S = 20.0
_CONTROLS = ("say", "stop", "undo", "move", "approval", "approve", "veto", "speed", "ping")
_NOT_NOW = "Nothing is being done that could be stopped."


class Room:
    """A room; may be used from any threads."""

    def __init__(
        self, name: str, config: EpisodeConfig, folder: Path, places: Places, *, approve: bool
    ) -> None:
        """Prepare; `open` begins.

        Args:
            name: Of the room; part of its addresses.
            config: How its session is set up.
            folder: A new run folder.
            places: Where the page finds the meshes.
            approve: Whether the person is asked before each step.
        """
        self.name = name
        self.config = config
        self.folder = folder
        self.log = Log()
        """All that was told."""
        self.hello: Message = {}
        """The greeting; there once the room is open."""
        self.touched = time.monotonic()
        """When somebody last asked something."""
        self._places = places
        self._cut = threading.Event()
        self._pace = Pace(self._cut, lambda: self.log.watchers > 0)
        self._consent = Consent(self._cut, self._between_steps, self._ask, is_on=approve)
        self._person = Person() if config.model == HUMAN else None
        self._wishes: queue.SimpleQueue[Wish | None] = queue.SimpleQueue()
        self._moves: deque[Move] = deque()
        self._lock = threading.Lock()
        self._busy = False
        """Whether an instruction is carried out, or about to be."""
        self._closing = False
        self._ready = threading.Event()
        self._fault: Exception | None = None
        self._session: Session | None = None
        self._telling = Telling(self.log.append, self._href, None)
        self._thread = threading.Thread(target=self._live, name=f"adamo-room-{name}", daemon=True)

    @property
    def busy(self) -> bool:
        """Whether an instruction is carried out."""
        return self._busy

    @property
    def closed(self) -> bool:
        """Whether nothing more will happen in it."""
        return self.log.closed

    def open(self) -> None:
        """Begin, and wait until there is something to see.

        Raises:
            AdamoError: The session cannot begin: a setting is wrong, a key is missing.
        """
        self._thread.start()
        self._ready.wait()
        if self._fault is not None:
            raise self._fault

    def close(self) -> None:
        """End it; what was being done is stopped, and the record is whole."""
        self._closing = True
        if self._person is not None:
            self._person.leave()
        self._stop()
        self._wishes.put(None)
        if self._thread.ident is not None:
            self._thread.join(_CLOSE_S)

    # --- what the person asks, in any thread ----------------------------------------------------

    def ask(self, wish: Wish) -> None:
        """Do what the person asks, or let the room's thread do it as soon as it can.

        Raises:
            ConfigError: It makes no sense now; nothing was done.
        """
        self.touched = time.monotonic()
        if self.closed:
            raise ConfigError("The room is closed; its record is kept. Open another one.")
        match wish:
            case Ping():
                pass
            case Stop():
                if not self._stop():
                    raise ConfigError(_NOT_NOW)
            case Speed(factor=factor):
                self._pace.speed = self._telling.speed = factor
                self._telling.status()
            case Approve() | Veto() | Approval():
                self._consent.hear(wish)
            case Act() | Finish():
                self._play(wish)
            case Move():
                self._moves.append(wish)
                self._wishes.put(wish)
            case Say() | Undo():
                # What is being done gives way to what is said now.
                self._stop()
                self._wishes.put(wish)

    def _stop(self) -> bool:
        """Stop what is being done; whether anything was."""
        with self._lock:
            if not self._busy:
                return False
            self._cut.set()
        if self._session is not None:
            self._session.stop()
        self._consent.give_up()
        if self._person is not None and not self._closing:
            self._person.give_up()
        return True

    def _play(self, wish: Act | Finish) -> None:
        if self._person is None:
            raise ConfigError("Somebody else is the mind here; open a room with the model human.")
        self._person.play(wish)

    # --- the room's own thread ------------------------------------------------------------------

    def _live(self) -> None:
        try:
            with self._begun() as session:
                posing = Posing(session.engine, self._moment)
                self._session = session
                self._telling = telling = Telling(
                    self.log.append,
                    self._href,
                    posing,
                    "thinking" if self._person is None else "waiting_for_you",
                    rests=False,
                )
                self.hello = self._greeting(session)
                telling.pose()
                telling.status()
                self._ready.set()
                try:
                    self._go_on(session)
                finally:
                    posing.close()
        except Exception as fault:
            self._fault = fault
            if self._ready.is_set():
                self._telling.tell(messages.notice(f"The room had to close: {fault}", "error"))
        finally:
            self._busy = False
            self._telling.doing = "closed"
            self._telling.status()
            self.log.close()
            self._ready.set()
            if _holds_events(self.folder):
                try_page(self.folder)
            else:
                # Nobody said or moved anything: there is nothing to look at later.
                shutil.rmtree(self.folder, ignore_errors=True)

    def _begun(self) -> Session:
        model = None if self._person is None else self._person.model
        parts = Parts(observers=(self,), consent=self._consent.about, model=model)
        return Session.begin(self.config, self.folder, page=False, **parts)

    def _greeting(self, session: Session) -> Message:
        controls = _CONTROLS if self._person is None else (*_CONTROLS, "act", "finish")
        return messages.hello(
            Part(self.name, is_live=True, controls=controls),
            session.manifest,
            acting_body(session.engine).info,
            scene_title(self.config.scene),
            self._places,
        )

    def _go_on(self, session: Session) -> None:
        self._look_ahead(session)
        while (wish := self._wishes.get()) is not None and not self._closing:
            match wish:
                case Say(text=text):
                    self._say(session, text)
                case Undo():
                    self._undo(session)
            self._between_steps()
            self._look_ahead(session)

    def _look_ahead(self, session: Session) -> None:
        """Draw what she sees before it is needed: the engine keeps it, and she begins sooner."""
        if self._wishes.empty() and not self._closing:
            # Whatever is wrong with it is told when it is needed.
            with suppress(AdamoError):
                acting_body(session.engine).see(*self.config.resolution)

    def _say(self, session: Session, text: str) -> None:
        with self._lock:
            self._cut.clear()
            self._busy = True
        self._telling.doing = "seeing"
        self._telling.status()
        try:
            ended = session.say(text)
            session.result()
        finally:
            self._busy = False
        self._pace.rest()
        if ended.reason is TerminationReason.BROKEN:
            self._telling.tell(messages.notice(ended.answer or "It broke.", "error"))
        self._rest(session)

    def _rest(self, session: Session) -> None:
        """Tell that nothing is being done."""
        self._telling.doing = "idle"
        self._telling.can_undo = session.can_undo
        self._telling.status()

    def _undo(self, session: Session) -> None:
        try:
            session.undo()
        except ConfigError as error:
            self._telling.tell(messages.notice(str(error), "error"))
            return
        _try_result(session)
        self._rest(session)

    def _between_steps(self) -> None:
        """Do what may be done between two steps: put things elsewhere."""
        while self._moves and self._session is not None:
            move = self._moves.popleft()
            try:
                event = ObjectMoved(move.object_id, Vec3(*move.point))
                self._session.apply(event, by_user=True)
            except EngineError as error:
                # The page shows it at its new place already.
                self._telling.tell(messages.notice(str(error), "error"))
                continue
            if not self._busy:
                _try_result(self._session)

    # --- called within the session --------------------------------------------------------------

    def notify(self, event: Event, frame: Frame | None = None) -> None:
        """Tell of an event. An observer of the session."""
        if isinstance(event, Started) and self._cut.is_set() and self._session is not None:
            # It was stopped before it had begun.
            self._session.stop()
        self._telling.notify(event, frame)

    def _moment(self) -> bool:
        self._telling.pose()
        self._pace.wait(self._telling.seconds)
        return not self._cut.is_set()

    def _ask(self, turn: Turn | None) -> None:
        """Tell what she is about to do, or that she goes on."""
        telling = self._telling
        if turn is None:
            telling.doing = "acting"
        else:
            calls = [{"name": w.call.name, "arguments": w.arguments} for w in turn.wishes]
            telling.tell(messages.asked(calls, turn.note))
            telling.doing = "asking"
        telling.status()

    def _href(self, frame: str) -> str:
        return f"/studio/api/rooms/{self.name}/frames/{frame}"


def _holds_events(folder: Path) -> bool:
    """Whether anything is on record."""
    events = folder / EVENTS
    return events.is_file() and events.stat().st_size > 0


def _try_result(session: Session) -> None:
    """Score anew after something was changed by hand; there may be nothing to score yet."""
    with suppress(RecordError):
        session.result()
