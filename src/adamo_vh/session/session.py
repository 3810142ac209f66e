"""The session: where engine, model, memory, task and record meet."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import ExitStack
from dataclasses import replace
from pathlib import Path
from typing import Self, Unpack

from adamo_vh.cognition.agent import Agent, AgentConfig
from adamo_vh.cognition.budget import Budget, BudgetGuard
from adamo_vh.cognition.forecast import Forecast
from adamo_vh.cognition.memory.short_term import ShortTermMemory
from adamo_vh.cognition.oversight import Oversight
from adamo_vh.engine import World, WorldEvent
from adamo_vh.episode.config import EpisodeConfig
from adamo_vh.episode.result import (
    EpisodeResult,
    Manifest,
    read_manifest,
    write_record,
)
from adamo_vh.errors import ConfigError, RecordError
from adamo_vh.inference.model import Model, ModelKind
from adamo_vh.inference.players.cassette import FOLDER, Cassette, taped
from adamo_vh.record.run_folder import (
    EVENTS,
    FORMAT,
    MANIFEST,
    FolderLock,
)
from adamo_vh.record.trajectory import (
    Ended,
    Event,
    Happened,
    Lost,
    Observer,
    Restored,
    Started,
    Stood,
    Trajectory,
    read_trajectory,
)
from adamo_vh.record.witness import Witness
from adamo_vh.record.writer import TrajectoryWriter
from adamo_vh.report.page import try_page
from adamo_vh.session.bodies import (
    as_said,
    check_handed,
    check_task,
    instructions,
    open_server,
    opened,
)
from adamo_vh.session.cut_short import as_recorded
from adamo_vh.session.figures import recorded_figure
from adamo_vh.session.forecasting import check_price, forecast_episodes, refuse_early
from adamo_vh.session.minds import fitting, lasting, opened_model, resumed_model
from adamo_vh.session.parts import Parts, capped, describe
from adamo_vh.session.recording import begin_record, told_result
from adamo_vh.session.repeating import Again, BroughtAbout, later


class Session:
    """One body, one mind, and what the user says to it; recorded as it happens.

    An episode is one instruction. A conversation is several: a question of the agent is its final
    answer to an instruction, and what the user answers is the next one. Any run folder can be gone
    on with, whether it is of an episode or of a conversation.
    """

    def __init__(
        self,
        manifest: Manifest,
        world: World,
        model: Model,
        parts: Parts,
        *,
        writer: TrajectoryWriter | None = None,
        folder: Path | None = None,
        known: Sequence[Event] = (),
        page: bool = True,
    ) -> None:
        """Bring the parts together; use `begin` or `resume`.

        Args:
            manifest: How the session is set up.
            world: Just reset.
            model: Who decides.
            parts: What was handed in.
            writer: Of the record, if one is written.
            folder: Its run folder.
            known: What is on record already and will come again.
            page: Whether the page of the run folder is kept up to date.
        """
        self.manifest = manifest
        self.folder = folder
        self.engine = world
        self.model = model
        self._parts, self._writer = parts, writer
        self._paged = folder if page else None
        self._closing = ExitStack()
        self._trajectory = Trajectory(tuple(known))  # What was recorded counts, not its repetition.
        config = manifest.config
        tagger = parts.get("labeling")
        frames = parts.get("frame_cache")
        server = open_server(config, world, parts.get("tools"), tagger, frames)
        prompt = instructions(config, world, server, tagger)
        memory = parts.get("memory") or ShortTermMemory
        task, heard = config.scored_task, [e for e in known if not isinstance(e, Stood)]
        records: Sequence[Observer] = (
            *((writer,) if writer else ()),
            *later((self._trajectory,), len(known)),
        )
        if task is not None and task.needs_history:
            records = (Witness(records, world.state),)
        self._happening = Again(heard, self._bring_about)
        self._oversight = Oversight(parts.get("consent"))
        self._agent = Agent(
            model,
            as_recorded(server, heard),
            prompt,
            AgentConfig(config.profile, config.k, config.text_form, config.sampling, config.limits),
            memory=memory(prompt, config.k, config.profile, config.text_form),
            guards=(BudgetGuard(config.budget), *parts.get("guards", ())),
            records=(*records, self._happening),
            observers=later(parts.get("observers", ()), len(heard)),
            known=heard,
            oversight=self._oversight,
        )

    @classmethod
    def begin(
        cls,
        config: EpisodeConfig,
        out: str | Path | None = None,
        *,
        record: bool = False,
        cap: Budget | None = None,
        page: bool = True,
        **parts: Unpack[Parts],
    ) -> Self:
        """Begin; nothing is said yet.

        Args:
            config: Scene, model, profile, limits: everything that can be written down.
            out: A new run folder for manifest, events, frames, result and page; none without.
            record: Also keep every request and reply of the model there, as a cassette.
            cap: On all instructions together.
            page: Write the page too; it can be made from the rest at any time.
            **parts: What is handed in; see `Parts`.

        Raises:
            ConfigError: A setting is wrong; nothing was started.
            SceneError: The scene is wrong.
            ModelConfigError: The model is unknown or lacks a key or an extra.
            RecordError: `out` already holds a run, or somebody else writes it.
        """
        if record and out is None:
            raise ConfigError("A recording needs a run folder: give out as well.")
        engine, model, tools = parts.get("engine"), parts.get("model"), parts.get("tools")
        folder = None if out is None else Path(out)
        if model is None:
            # Also a probe is paid for.
            refuse_early(config, folder, cap)
        with ExitStack() as stack:
            # The world first: a wrong scene or task is told before a model is asked anything.
            world = opened(stack, config, engine)
            if engine is not None:
                config = as_said(config, world)
            check_task(config, world)
            mind = opened_model(stack, config, model)
            if model is None:
                check_price(config.model, config.budget, mind)
                check_price(config.model, cap or Budget(), mind)
            config = replace(
                config,
                model=mind.info.name if model is not None else lasting(config.model),
                profile=fitting(config.profile, mind, tools),
            )
            manifest = describe(config, mind.info, world, parts)
            writer = None
            if folder is not None:
                writer = begin_record(stack, folder, manifest, world)
                if record:
                    mind = taped(mind, folder / FOLDER)
            parts = capped(parts, cap)
            session = cls(manifest, world, mind, parts, writer=writer, folder=folder, page=page)
            session._closing.enter_context(stack.pop_all())
        return session

    @classmethod
    def resume(
        cls,
        folder: str | Path,
        *,
        budget: Budget | None = None,
        cap: Budget | None = None,
        page: bool = True,
        **parts: Unpack[Parts],
    ) -> Self:
        """Go on in a run folder, in the state in which it was left.

        What was recorded is executed again, with the recorded replies in place of the model's; an
        instruction that was interrupted, or broke as the last one, is then carried out to its end.
        Nothing is asked or written twice, and nothing is changed before all of it came again.

        Args:
            folder: A run folder.
            budget: Holds from now on, in place of the recorded one.
            cap: On all instructions together, those on record too.
            page: Write the page too.
            **parts: What is handed in, as when it began; a model, to let another one go on.

        Raises:
            RecordError: The folder holds no run, or one of an older version, or somebody else
                writes it, or it came out otherwise. The record is as it was.
        """
        path = Path(folder)
        read_manifest(path)
        with ExitStack() as stack:
            lock = stack.enter_context(FolderLock(path))
            manifest, recorded = read_manifest(path), read_unfinished(path)
            if manifest.format != FORMAT:
                raise RecordError(
                    f"{path} was written by an older version of ADAMO: it can be shown and "
                    "replayed, and not be continued. Run it again."
                )
            check_handed(path, manifest, recorded, parts.get("tools"), parts.get("labeling"))
            on_file = known = recorded.events
            ended = known[-1] if known else None
            if isinstance(ended, Ended) and not ended.reason.is_scored:
                # It broke: let it go on from there, and what it paid stay on record.
                on_file = known[:-1]
                known = [*on_file, *([Lost(ended.steps, ended.spent)] if ended.spent else ())]
            mind = resumed_model(stack, path, manifest.config, recorded, parts.get("model"))
            if budget:
                manifest = replace(manifest, config=replace(manifest.config, budget=budget))
            check_price(manifest.config.model, budget or Budget(), mind)
            check_price(manifest.config.model, cap or Budget(), mind)
            if parts.get("engine") is None and (lacks := recorded_figure(path, manifest).lacks):
                # Who goes on would see another body in the frames.
                raise RecordError(lacks)
            world = opened(stack, manifest.config, parts.get("engine"), (path, manifest))
            writer = TrajectoryWriter(path, known=on_file, lock=lock)
            stack.callback(writer.close)
            parts = capped(parts, cap)
            session = cls(
                manifest, world, mind, parts, writer=writer, folder=path, known=known, page=page
            )
            session._closing.enter_context(stack.pop_all())
        try:
            session._happening.catch_up()
            for instruction in recorded.instructions:
                session._carry_out(instruction)
            if budget:
                write_record(path, MANIFEST, manifest)
        except BaseException:
            session.close()
            raise
        return session

    @property
    def config(self) -> EpisodeConfig:
        """How the session is set up."""
        return self.manifest.config

    @property
    def trajectory(self) -> Trajectory:
        """What happened so far."""
        return self._trajectory

    def forecast(self) -> Forecast | None:
        """What an episode will take, if a provider is to be asked."""
        is_asked = self.manifest.model_kind is ModelKind.VLM
        if not is_asked or isinstance(self.model, Cassette):
            return None
        return forecast_episodes(self.config, self.engine)

    def say(self, instruction: str) -> Ended:
        """Have one instruction carried out; world and memory stay for the next one.

        Raises:
            RecordError: It came out otherwise than recorded.
            FileError: The record cannot be written any more; it can be gone on with later.
        """
        ended = self._carry_out(instruction)
        if self._paged is not None:
            try_page(self._paged)
        return ended

    def play(self) -> EpisodeResult:
        """Have the instruction carried out that the session was set up with, and score it.

        The same as `say` and `result`, but that the page is drawn once.

        Raises:
            RecordError: It came out otherwise than recorded.
            FileError: The record cannot be written any more; it can be gone on with later.
        """
        self._carry_out(self.config.instruction)
        return self.result()

    def _carry_out(self, instruction: str) -> Ended:
        ended = self._agent.run(instruction)
        if self._writer is not None and self._writer.fault is not None:
            raise self._writer.fault
        return ended

    def stop(self) -> None:
        """Let the instruction that is being carried out end as stopped; from any thread.

        What the model is being asked is still waited for, and nothing of it is done.
        """
        self._oversight.stop()

    def apply(self, event: WorldEvent, *, by_user: bool = False) -> None:
        """Let something happen in the world that its body does not do; it goes on record.

        Args:
            event: What happens.
            by_user: Whether a person who watches does it: the episode is then an assisted one.

        Raises:
            EngineError: The engine cannot do it, or not now; nothing changed.
        """
        self.engine.apply(event)
        self._agent.happened(event, self.engine.state().hash(), by_user=by_user)

    @property
    def can_undo(self) -> bool:
        """Whether there is an instruction to undo."""
        return bool(_in_effect(self._trajectory))

    def undo(self) -> None:
        """Put the world back as it was before the last instruction that is still in effect.

        The model is told with the next one. What was dragged since is put back too.

        Raises:
            ConfigError: There is none.
        """
        if not (starts := _in_effect(self._trajectory)):
            raise ConfigError("There is nothing to undo: no instruction was carried out.")
        self._agent.restore(starts[-1].saved)

    def _bring_about(self, event: BroughtAbout) -> None:
        match event:
            case Happened():
                self.apply(event.event, by_user=event.by_user)
            case Restored():
                self._agent.restore(event.saved)
            case Lost():
                self._agent.lost(event.spent)

    def result(self) -> EpisodeResult:
        """Score and count what happened since the session began; written into the run folder.

        Raises:
            RecordError: The last instruction has not ended.
        """
        again = f"adamo-vh run --resume {self.folder}"
        try:
            return told_result(self.manifest, self._trajectory, self.engine, self.folder, again)
        finally:
            if self._paged is not None:
                try_page(self._paged)

    def close(self) -> None:
        """Close what was opened; the session can be resumed from its folder."""
        self._closing.close()

    def __enter__(self) -> Self:
        """The session itself."""
        return self

    def __exit__(self, *_: object) -> None:
        """Close it."""
        self.close()


def _in_effect(trajectory: Trajectory) -> list[Started]:
    """The instructions that were carried out and not undone since."""
    starts: list[Started] = []
    for event in trajectory.events:
        if isinstance(event, Started) and event.saved:
            starts.append(event)
        elif isinstance(event, Restored) and starts:
            starts.pop()
    return starts


def read_unfinished(folder: Path) -> Trajectory:
    """What was recorded so far; nothing, if the run was stopped before its first event."""
    return read_trajectory(folder) if (folder / EVENTS).exists() else Trajectory()
