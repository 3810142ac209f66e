"""An episode whose mind is somebody outside: an ordinary session, driven call by call.

The session runs in a thread of its own and takes its replies from an `OutsideModel`; so profile,
notes, doubts, limits, record and score are what they are for any model. What is here is the other
side of it: what the mind is told, and how it acts.
"""

from __future__ import annotations

import math
import threading
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Self

from adamo_vh.action import ToolSchema
from adamo_vh.cognition.memory.protocol import Memory
from adamo_vh.cognition.memory.short_term import ShortTermMemory
from adamo_vh.cognition.profile import Profile
from adamo_vh.engine import World
from adamo_vh.episode.config import EpisodeConfig
from adamo_vh.episode.result import EpisodeResult, read_manifest
from adamo_vh.errors import ModelError
from adamo_vh.inference.messages import (
    AIMessage,
    ImagePart,
    Message,
    SystemMessage,
    pictures_of,
)
from adamo_vh.inference.model import Isolation
from adamo_vh.inference.players.outside import UNKNOWN, Asked, OutsideModel, outside_name
from adamo_vh.observation import Frame
from adamo_vh.perception import TextForm
from adamo_vh.record.trajectory import Ended, Event, Observer
from adamo_vh.session.runs import resume_episode
from adamo_vh.session.session import Session, read_unfinished

ENDED = "The episode has ended."
"""All that a mind is told of the end; what came of it is for the judge."""


@dataclass(frozen=True, slots=True)
class View:
    """What the mind outside is told."""

    text: str
    """What came back: feedback, and remarks such as why it cannot finish yet."""
    state: str = ""
    """The whole symbolic state now; empty if the profile tells none."""
    pictures: tuple[ImagePart, ...] = ()
    ended: bool = False


_END = View(ENDED, ended=True)


class OutsideEpisode:
    """One episode for a mind outside; safe to use from any threads, which take turns."""

    def __init__(
        self,
        config: EpisodeConfig,
        model: OutsideModel,
        recall: _Recall,
        play: Callable[[], EpisodeResult],
        done: Callable[[OutsideEpisode], None] | None = None,
    ) -> None:
        """Start the thread; use `begin` or `resume`.

        Args:
            config: How the episode is set up.
            model: Who waits for the mind outside.
            recall: What the session remembers.
            play: Carries the episode out, from its first question to its result.
            done: Is called when all is over, in the thread of the episode.
        """
        self.config = config
        self._inside, self._left = 0, time.monotonic()
        """How many callers are here now, and when the last one left."""
        self._model = model
        self._recall = recall
        self._turn, self._count = threading.Lock(), threading.Lock()
        self._result: EpisodeResult | None = None
        self._fault: Exception | None = None
        self._done = done
        self._thread = threading.Thread(target=self._carry_out, args=(play,), name="adamo-outside")
        self._thread.start()

    @classmethod
    def begin(
        cls,
        config: EpisodeConfig,
        out: Path | None = None,
        *,
        client: str = "",
        engine: World | None = None,
        isolation: Isolation = UNKNOWN,
        observers: Sequence[Observer] = (),
        done: Callable[[OutsideEpisode], None] | None = None,
    ) -> Self:
        """Begin an episode.

        Args:
            config: As for `Session.begin`; the model in it plays no part, and every turn has one
                call, because each gets its answer before the next one is known.
            out: A new run folder; none without.
            client: What the mind calls itself.
            engine: In place of the scene's; is reset, and not closed.
            isolation: How far the mind is kept from all but its body; see `ModelInfo`.
            observers: Are told of every event.
            done: Is called when all is over, in the thread of the episode.

        Raises:
            ConfigError: A setting is wrong; nothing was started.
            RecordError: `out` already holds a run, or somebody else writes it.
        """
        config = replace(config, profile=replace(config.profile, plan=1))
        model, recall = (
            OutsideModel(outside_name(client), _within_s(config), 0, isolation),
            _Recall(),
        )
        session = Session.begin(
            config,
            out,
            engine=engine,
            model=model,
            memory=recall.make,
            observers=(*observers, _TellsEnd(model)),
        )

        def play() -> EpisodeResult:
            with session:
                return session.play()

        return cls(session.config, model, recall, play, done)

    @classmethod
    def resume(
        cls,
        folder: Path,
        *,
        engine: World | None = None,
        done: Callable[[OutsideEpisode], None] | None = None,
    ) -> Self:
        """Go on with an episode that was interrupted; any mind may.

        What was recorded is executed again first. If it does not come out as it was, the first use
        raises a `RecordError`.

        Args:
            folder: Its run folder.
            engine: As when it began.
            done: Is called when all is over, in the thread of the episode.

        Raises:
            RecordError: The folder holds no run.
        """
        manifest, said = read_manifest(folder), read_unfinished(folder).thoughts
        took_s = sum(thought.reply.seconds for thought in said)
        left_s = max(0.0, _within_s(manifest.config) - took_s)
        model, recall = OutsideModel(manifest.model_name, left_s, len(said)), _Recall()

        def play() -> EpisodeResult:
            return resume_episode(
                folder,
                engine=engine,
                model=model,
                memory=recall.make,
                observers=(_TellsEnd(model),),
            )

        return cls(manifest.config, model, recall, play, done)

    @property
    def ended(self) -> bool:
        """Whether it has ended; then every call says so and changes nothing."""
        return self._model.is_over

    @property
    def idle_s(self) -> float:
        """Seconds for which nobody has been here."""
        return 0.0 if self._inside else time.monotonic() - self._left

    @property
    def instruction(self) -> str:
        """What the user asked for."""
        return self.config.instruction

    def system_prompt(self) -> str:
        """The fixed instructions, as any model gets them; empty once the episode has ended."""
        asked = self._asked()
        return "" if asked is None else _system(asked)

    def tools(self) -> tuple[ToolSchema, ...]:
        """The tools, as any model gets them; none once the episode has ended."""
        asked = self._asked()
        return () if asked is None else asked.tools

    def view(self) -> View:
        """What the mind was told last, and the newest picture it may see; costs nothing.

        One that goes on in another's place is told all that is still remembered.
        """
        with self._turn:
            asked = self._asked()
            return _END if asked is None else self._told(asked, _pictures(asked.prompt)[-1:])

    def story(self) -> str:
        """What happened so far, as far as it is remembered; empty at the beginning and the end."""
        asked = self._asked()
        if asked is None or not any(isinstance(message, AIMessage) for message in asked.prompt):
            return ""
        said = [m for m in asked.prompt if not isinstance(m, SystemMessage)]
        return "\n\n".join(_words(message) for message in said[1:])

    def call(
        self, name: str, arguments: Mapping[str, Any] | None, note: str = "", client: str = ""
    ) -> View:
        """Act, and wait for what comes of it.

        Args:
            name: Of the tool; one that does not exist is refused like any model's.
            arguments: With note and confidence, if the profile asks for them in each call.
            note: What the mind says with it, where the profile has the note before the call.
            client: Who it is.
        """
        return self._reply(lambda: self._model.call(name, arguments, note, client))

    def answer(self, text: str, client: str = "") -> View:
        """Give the final answer, and wait for what is said to it.

        Args:
            text: The answer.
            client: Who gives it.
        """
        return self._reply(lambda: self._model.answer(text, client))

    def _reply(self, post: Callable[[], None]) -> View:
        with self._turn:
            asked = self._asked()
            if asked is None:
                return _END
            try:
                post()
            except ModelError:
                return _END  # It ended at this very moment.
            after = self._asked(asked.number)
            return _END if after is None else self._told(after, _pictures(after.new))

    def hang_up(self, why: str) -> None:
        """End it for a mind that says nothing any more; it is scored as it stands."""
        self._model.hang_up(why)

    def close(
        self, why: str = "The server was closed before the mind outside had finished."
    ) -> None:
        """Cut it off if it has not ended, unscored; it can be gone on with from its run folder."""
        self._model.cut_off(why)
        self._thread.join()

    def result(self) -> EpisodeResult:
        """Wait for the end; for the judge alone.

        Raises:
            AdamoError: It broke before there was a result.
        """
        if threading.current_thread() is not self._thread:
            self._thread.join()
        if self._fault is not None:
            raise self._fault
        assert self._result is not None
        return self._result

    def _carry_out(self, play: Callable[[], EpisodeResult]) -> None:
        try:
            self._result = play()
        except Exception as error:
            self._fault = error
        finally:
            self._model.end()
            if self._done is not None:
                self._done(self)

    def _asked(self, after: int = 0) -> Asked | None:
        """The question that stands; None if the episode has ended.

        Raises:
            AdamoError: It broke off without an end.
        """
        with self._count:
            self._inside += 1
        try:
            asked = self._model.asked(after)
        finally:
            with self._count:
                self._inside, self._left = self._inside - 1, time.monotonic()
        if asked is None and self._fault is not None:
            raise self._fault
        return asked

    def _told(self, asked: Asked, pictures: tuple[ImagePart, ...]) -> View:
        state = "" if self._recall.memory is None else self._recall.memory.state_text
        words = [text for text in map(_words, asked.new) if text != state]
        return View("\n\n".join(words), state, pictures)


class _Recall:
    """Keeps hold of the memory that a session makes for itself."""

    memory: Memory | None = None

    def make(self, prompt: str, k: int, profile: Profile, form: TextForm) -> Memory:
        """Make the usual one."""
        self.memory = ShortTermMemory(prompt, k, profile, form)
        return self.memory


class _TellsEnd:
    """Lets a mind outside know that the episode has ended, before it is scored and shown."""

    def __init__(self, model: OutsideModel) -> None:
        self._model = model

    def notify(self, event: Event, frame: Frame | None = None) -> None:
        """Hear of the end."""
        if isinstance(event, Ended):
            self._model.end()


def _within_s(config: EpisodeConfig) -> float:
    """Seconds that a mind has for all its replies: never more than what ends the episode."""
    budget = config.budget.seconds
    return min(config.limits.max_seconds, math.inf if budget is None else budget)


def _system(asked: Asked) -> str:
    first = asked.prompt[0]
    return first.text if isinstance(first, SystemMessage) else ""


def _pictures(messages: Sequence[Message]) -> tuple[ImagePart, ...]:
    return tuple(picture for message in messages for picture in pictures_of(message))


def _words(message: Message) -> str:
    """A message for a mind outside; what it said itself is marked, for another in its place."""
    if not isinstance(message, AIMessage):
        return message.text
    calls = [f"{call.name} {call.raw}" for call in message.calls]
    said = [message.text] if message.text.strip() else []
    return f"(Before: {' - '.join([*said, *calls])})"
