"""A body that is driven from outside: somebody else decides, and it is recorded like any episode.

The player's side is an `ActionServer`, with the same tools, views, feedback, limits and guards as a
model's. The judge's side (`state`, `completion`, `result`) is apart: no player is given any of it.
"""

from __future__ import annotations

import time
from collections.abc import Iterator, Mapping
from contextlib import ExitStack, contextmanager, suppress
from dataclasses import asdict, replace
from pathlib import Path
from typing import Any, Self, Unpack

from adamo_vh.action import Action, Code, Feedback, Outcome, ToolSchema, action_name
from adamo_vh.action_server import ActionResult, Sighting, execute_call
from adamo_vh.cognition.profile import StateText
from adamo_vh.cognition.prompts import render
from adamo_vh.cognition.telling import fault
from adamo_vh.cognition.turns import offered
from adamo_vh.engine import World, WorldState
from adamo_vh.episode.config import EpisodeConfig
from adamo_vh.episode.result import EpisodeResult, Manifest, judged
from adamo_vh.errors import ConfigError, EpisodeOverError, InvalidActionError
from adamo_vh.inference.model import ModelInfo, ModelKind, Reply
from adamo_vh.inference.players.outside import UNKNOWN
from adamo_vh.observation import Observation
from adamo_vh.perception.writer import SymbolicState, Wording
from adamo_vh.record.termination import Stop, TerminationReason
from adamo_vh.record.trajectory import Started
from adamo_vh.record.turn import Wish
from adamo_vh.record.writer import TrajectoryWriter
from adamo_vh.report.page import try_page
from adamo_vh.session.bodies import as_said, check_task, instructions, open_server, opened
from adamo_vh.session.driven_record import DrivenRecord
from adamo_vh.session.lending import Lender
from adamo_vh.session.parts import Parts, describe
from adamo_vh.session.recording import begin_record, told_result


class DrivenBody:
    """One episode in which somebody outside decides. Implements `ActionServer`.

    For one caller at a time. Time counts from the beginning on, whoever is waited for.
    """

    def __init__(
        self,
        manifest: Manifest,
        world: World,
        parts: Parts,
        *,
        writer: TrajectoryWriter | None = None,
        folder: Path | None = None,
        page: bool = True,
    ) -> None:
        """Bring the parts together and take the first view; use `begin`.

        Args:
            manifest: How the episode is set up.
            world: Just reset.
            parts: What was handed in.
            writer: Of the record, if one is written.
            folder: Its run folder.
            page: Whether the page of the run folder is drawn at the end.
        """
        config = manifest.config
        self.manifest, self.folder = manifest, folder
        self._world, self._page = world, page
        self._closing = ExitStack()
        tagger = parts.get("labeling")
        self._server = open_server(
            config, world, parts.get("tools"), tagger, parts.get("frame_cache")
        )
        self.system_prompt = instructions(config, world, self._server, tagger)
        """What a player is told of the room, the tools and the rules."""
        self.tools: tuple[ToolSchema, ...] = tuple(offered(self._server.actions, config.profile))
        """The tools of the profile, as a model sees them."""
        records = (writer,) if writer else ()
        self._record = DrivenRecord(config, self.tools, world, records, parts)
        self._wording = Wording(config.text_form, config.profile.terse, config.profile.has_pictures)
        self._saved: dict[str, str] = {}
        """Saved states by their handles; the last one alone, where there is a task."""
        self._handles = 0
        self._note = self._said = self._state_hash = ""
        self._sighting: Sighting | None = None
        """The last view, while nothing was done since."""
        self._start()

    @classmethod
    def begin(
        cls,
        config: EpisodeConfig,
        out: str | Path | None = None,
        *,
        player: str = "outside",
        lender: Lender | None = None,
        page: bool = True,
        **parts: Unpack[Parts],
    ) -> Self:
        """Begin an episode and take the first view.

        Args:
            config: Scene, task or instruction, profile, limits; its model is not asked.
            out: A new run folder; none without.
            player: Who decides, as the record calls him.
            lender: Of an engine that others use too; of the scene that the settings name.
            page: Draw the page at the end too.
            **parts: What is handed in; see `Parts`. Model and memory are the player's own.

        Raises:
            ConfigError: A setting is wrong; nothing was started.
            SceneError: The scene is wrong.
            RecordError: `out` already holds a run.
            FileError: It cannot be written.
            EngineError: The first view cannot be had.
        """
        if parts.get("model") or parts.get("memory"):
            raise ConfigError("Who drives a body from outside brings his own model and memory.")
        engine = parts.get("engine")
        with ExitStack() as stack:
            if lender is not None:
                engine = lender.lend()
                stack.callback(engine.close)
            world = opened(stack, config, engine)
            if engine is not None:
                config = as_said(config, world)
            check_task(config, world)
            config = replace(config, model=player)
            who = ModelInfo(player, ModelKind.OUTSIDE, isolation=UNKNOWN)
            manifest = describe(config, who, world, {**parts, "engine": engine})
            folder, writer = None if out is None else Path(out), None
            if folder is not None:
                writer = begin_record(stack, folder, manifest, world)
            body = cls(manifest, world, parts, writer=writer, folder=folder, page=page)
            body._closing.enter_context(stack.pop_all())
        return body

    @property
    def config(self) -> EpisodeConfig:
        """How the episode is set up."""
        return self.manifest.config

    @property
    def instruction(self) -> str:
        """What is to be done."""
        return self.config.instruction

    @property
    def ended(self) -> bool:
        """Whether the episode is over: all that a player is told of it."""
        return self._record.is_over

    @property
    def actions(self) -> tuple[type, ...]:
        """The action types on offer."""
        return self._server.actions

    @property
    def steps(self) -> int:
        """Calls that were executed or refused so far."""
        return self._record.steps

    def observe(self) -> Sighting:
        """The view from where the body stands now; the same one, if nothing was done since.

        Raises:
            EpisodeOverError: The episode has ended.
            EngineError: The world failed; the episode is broken and counts for nothing.
        """
        self._go_on()
        if self._sighting is None:
            with self._breaking():
                self._saw(self._server.observe())
        assert self._sighting is not None
        return self._sighting

    def state_text(self, observation: Observation | None = None) -> str:
        """The symbolic state in words: a view, and the body now; empty if the profile has none.

        Args:
            observation: The view; the last one by default.
        """
        if self.config.profile.state is StateText.NONE:
            return ""
        return SymbolicState(observation or self._view, self._wording).text(self._agent)

    def think(self, thought: str | Reply) -> None:
        """Hand over what was thought before the next call.

        Args:
            thought: A note, which goes on record with the next call; or a whole reply of a model
                with its calls and its usage, which are to be made one after the other.

        Raises:
            EpisodeOverError: The episode has ended.
        """
        self._go_on()
        if isinstance(thought, str):
            self._note = thought
        else:
            self._record.thought(thought, self.state_text())

    def call(self, name: str, arguments: Mapping[str, Any] | None) -> ActionResult:
        """Carry a tool call out; one that is no valid action is refused and changes nothing.

        Args:
            name: One of `tools`; where `Finish` is among them, it ends the episode.
            arguments: Its arguments; None if they could not be read.

        Raises:
            EpisodeOverError: The episode has ended.
            EngineError: The world failed; the episode is broken and counts for nothing.
        """
        self._go_on()
        wish = self._record.wish(name, arguments, self._note, self.state_text())
        self._note = ""
        if wish.is_finish:
            self.finish(wish.answer)
            said = Feedback(Outcome.DONE, Code.OK, render("said"))
            return ActionResult(said, self._agent, None, self._state_hash, self._handle)
        return self._act(wish)

    def execute(self, action: Action) -> ActionResult:
        """Carry out one action; see `call`."""
        return self.call(action_name(type(action)), asdict(action))

    def refuse(self, error: InvalidActionError) -> ActionResult:
        """Answer a call that is no valid action; it counts as a step, and changes nothing."""
        name, arguments = error.call or ("", None)
        return self.call(name, arguments)

    def say(self, text: str) -> None:
        """Say something through the body; the episode goes on."""
        self._go_on()
        with self._breaking():
            self._server.say(text)
        self._said = text

    def finish(
        self, answer: str = "", reason: TerminationReason | None = None, why: str = ""
    ) -> None:
        """End the episode.

        Args:
            answer: What is said to the user.
            reason: Why, if the player's own limits ended it; because he answered, by default.
            why: In words, where there is more to say.

        Raises:
            EpisodeOverError: It has ended already.
            ConfigError: The reason would leave it unscored, which is not the player's to say.
        """
        self._go_on()
        if reason is not None and not reason.is_scored:
            raise ConfigError(f"A player cannot end his episode as {str(reason)!r}; leave it.")
        said = TerminationReason.ANSWERED if answer.strip() else TerminationReason.EMPTY_REPLY
        self._end(Stop(reason or said, why, answer))

    def load(self, saved: str) -> str:
        """Go back to where an earlier answer stood.

        Args:
            saved: The handle that the answer gave. Where there is a task, the last one alone.

        Returns:
            Digest of the world then.

        Raises:
            ConfigError: There is no such handle, or it is one that a scored episode cannot go to.
            EpisodeOverError: The episode has ended.
        """
        self._go_on()
        if saved == self._handle:
            return self._state_hash
        if self.config.scored_task is not None:
            raise ConfigError(
                "A scored episode goes on from where it stands: only its last saved state can be "
                "loaded. Play without a task to go back."
            )
        if (kept := self._saved.get(saved)) is None:
            raise ConfigError(f"There is no saved state {saved[:40]!r} in this session.")
        with self._breaking():
            self._server.load(kept)
        # The record begins anew from there, so that it can be executed again.
        self._start()
        return self._state_hash

    def expire(self) -> bool:
        """End the episode if a limit is reached; whether it is over."""
        if not self.ended and (stop := self._record.stop()) is not None:
            self._end(stop)
        return self.ended

    # The judge's side.

    def state(self) -> WorldState:
        """The whole truth. Privileged."""
        return self._world.state()

    def completion(self) -> float | None:
        """Fraction of the conditions that hold now; None without a task. Privileged."""
        found = judged(self.manifest, self._record.trajectory, self._world.state())
        return None if found is None else found.completion

    def result(self) -> EpisodeResult:
        """What came of it, also written into the run folder. Privileged.

        Raises:
            RecordError: It has not ended.
        """
        again = f"adamo-vh score {self.folder}"
        return told_result(self.manifest, self._record.trajectory, self._world, self.folder, again)

    def close(self) -> None:
        """Leave the body; an episode that has not ended stays on record as unfinished."""
        if self.expire() and self.folder is not None:
            self.result()
        self._closing.close()
        if self.folder is not None and self._page:
            try_page(self.folder)

    def __enter__(self) -> Self:
        """The body itself."""
        return self

    def __exit__(self, *_: object) -> None:
        """Close it."""
        self.close()

    def _start(self) -> None:
        """Begin from where the world stands, with a view."""
        with self._breaking():
            seen, saved = None, ""
            try:
                seen = self._server.observe()
                self._state_hash, saved = seen.state_hash, seen.saved
            finally:
                # Without a first view the record still says what was asked.
                started = Started(self.instruction, self.system_prompt, self._state_hash, saved)
                self._record.started(started)
            self._saw(seen)

    def _saw(self, seen: Sighting) -> None:
        self._record.waited(seen.waited_s)
        self._agent, self._state_hash = seen.agent, seen.state_hash
        self._look(seen.observation, self._keep(seen.saved))

    def _look(self, view: Observation, handle: str) -> None:
        """Take note of a view, which stays the last one until something is done."""
        self._view, self._sighting = view, Sighting(view, self._state_hash, handle)
        self._record.perceived(view)

    def _keep(self, saved: str) -> str:
        """A handle for a saved state."""
        if self.config.scored_task is not None:
            self._saved.clear()
        self._handles += 1
        self._handle = f"saved-{self._handles}"
        self._saved[self._handle] = saved
        return self._handle

    def _act(self, wish: Wish) -> ActionResult:
        with self._breaking():
            started = time.monotonic()
            done = execute_call(self._server, wish.call.name, wish.arguments)
            world_s = time.monotonic() - started - done.waited_s
            self._agent, self._state_hash, self._sighting = done.agent, done.state_hash, None
            self._record.acted(wish, done, world_s)
            handle = self._keep(done.saved)
            if done.observation is not None:
                self._look(done.observation, handle)
        self.expire()
        return replace(done, saved=handle)

    def _go_on(self) -> None:
        """Make sure that the episode is not over, and that no limit is reached."""
        if self.expire():
            raise EpisodeOverError("The episode has ended; nothing was done. Begin another one.")

    @contextmanager
    def _breaking(self) -> Iterator[None]:
        """Let the episode end as broken if the world or the record fails meanwhile."""
        try:
            yield
        except Exception as error:
            with suppress(Exception):
                self._over(Stop(TerminationReason.BROKEN, answer=fault(error)))
            raise

    def _end(self, stop: Stop) -> None:
        with self._breaking():
            if stop.answer != self._said:
                self._server.say(stop.answer)
        self._over(stop)

    def _over(self, stop: Stop) -> None:
        self._record.ended(stop, self._state_hash)
        self.result()
