"""A conversation: one instruction after another, in the same world and with the same memory."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import ExitStack
from dataclasses import replace
from pathlib import Path

from adamo_vh.cognition.guards import Guard
from adamo_vh.episode.result import EpisodeConfig, read_manifest, write_record
from adamo_vh.inference.model import Model
from adamo_vh.inference.players.cassette import FOLDER, taped
from adamo_vh.observation import Frame
from adamo_vh.record.run_folder import MANIFEST, FolderLock, check_unused
from adamo_vh.record.trajectory import Ended, Event, Observer
from adamo_vh.record.writer import TrajectoryWriter
from adamo_vh.report.page import try_page
from adamo_vh.session.engines import create_engine
from adamo_vh.session.episode import create_agent, describe, read_unfinished, resumed_player
from adamo_vh.session.players import create_player, fitting


class ChatSession:
    """One body, one memory, and what the user says to it.

    A question of the agent is its final answer to an instruction; what the user answers is the
    next instruction. Everything is recorded in a run folder as it happens, and any run folder, of
    a conversation or of a single episode, can be gone on with.
    """

    def __init__(
        self,
        config: EpisodeConfig,
        folder: Path,
        model: Model,
        *,
        known: Sequence[Event] | None = None,
        record: bool = False,
        lock: FolderLock | None = None,
        guards: Sequence[Guard] = (),
        observers: Sequence[Observer] = (),
    ) -> None:
        """Bring body and mind together; use `begin` or `resume`.

        Args:
            config: Scene, model, profile and limits; the limits hold for each instruction.
            folder: Run folder for the record.
            model: Who thinks; closed with the session.
            record: Also keep every request and reply of the model, as a cassette.
            known: Events that are recorded already and will come again; None begins a new record.
            lock: Of the folder, where the caller holds it; let go of with the session.
            guards: Further reasons to stop.
            observers: Are told of every event that is not known yet.
        """
        self.folder = folder
        with ExitStack() as stack:
            stack.callback(model.info.close)
            held = lock or FolderLock(folder)
            stack.callback(held.close)
            if known is None:
                check_unused(folder)
            engine = create_engine(config.scene, config.figure)
            stack.callback(engine.close)
            engine.reset(config.seed)
            if known is None:
                write_record(folder, MANIFEST, describe(config, model, engine))
            self._writer = writer = TrajectoryWriter(folder, known=known, lock=held)
            stack.callback(writer.close)
            if record:
                model = taped(model, folder / FOLDER)
            before = known or ()
            later = [_FromThen(observer, len(before)) for observer in observers]
            heard: tuple[Observer, ...] = (writer, *later)
            self._agent = create_agent(config, model, engine, None, guards, heard, before)
            self._open = stack.pop_all()

    @classmethod
    def begin(
        cls,
        config: EpisodeConfig,
        folder: str | Path,
        *,
        record: bool = False,
        guards: Sequence[Guard] = (),
        observers: Sequence[Observer] = (),
    ) -> ChatSession:
        """Begin a conversation; nothing is said yet.

        Args:
            config: Scene, model, profile and limits.
            folder: A new run folder.
            record: Also keep every request and reply of the model, as a cassette.
            guards: Further reasons to stop.
            observers: Are told of every event.

        Raises:
            ConfigError: A setting is wrong.
            ModelConfigError: The model is unknown or lacks a key or an extra.
            RecordError: The folder already holds a run.
        """
        path = Path(folder)
        wish = config.profile
        player = create_player(
            config.model, tools=config.tool_calls, profile=wish, seed=config.seed
        )
        config = replace(config, profile=fitting(wish, player))
        return cls(config, path, player, record=record, guards=guards, observers=observers)

    @classmethod
    def resume(
        cls,
        folder: str | Path,
        *,
        guards: Sequence[Guard] = (),
        observers: Sequence[Observer] = (),
    ) -> ChatSession:
        """Go on with a recorded conversation or episode, in the state in which it was left.

        What was recorded is executed again with the recorded answers; an instruction that was
        interrupted is then carried out to its end.

        Raises:
            RecordError: The folder holds no run, or somebody else writes it, or it came out
                otherwise. The record is as it was.
        """
        path = Path(folder)
        read_manifest(path)
        with ExitStack() as stack:
            lock = stack.enter_context(FolderLock(path))
            config, recorded = read_manifest(path).config, read_unfinished(path)
            player = resumed_player(path, config, recorded, None)
            known = recorded.events
            session = cls(
                config, path, player, known=known, lock=lock, guards=guards, observers=observers
            )
            stack.pop_all()
        try:
            for instruction in recorded.instructions:
                session._run(instruction)
            try_page(path)
        except BaseException:
            session.close()
            raise
        return session

    def say(self, instruction: str) -> Ended:
        """Have one instruction carried out; world and memory stay for the next one."""
        ended = self._run(instruction)
        try_page(self.folder)
        return ended

    def _run(self, instruction: str) -> Ended:
        ended = self._agent.run(instruction)
        if self._writer.fault is not None:
            raise self._writer.fault
        return ended

    def close(self) -> None:
        """End the conversation; it can be resumed from its folder."""
        self._open.close()

    def __enter__(self) -> ChatSession:
        """The session itself."""
        return self

    def __exit__(self, *_: object) -> None:
        """Close it."""
        self.close()


class _FromThen:
    """Leaves out the events that an observer has no need to hear again."""

    def __init__(self, observer: Observer, known: int) -> None:
        self._observer = observer
        self._known = known

    def notify(self, event: Event, frame: Frame | None = None) -> None:
        if self._known:
            self._known -= 1
        else:
            self._observer.notify(event, frame)
