"""One session of a server: what is asked of its body, one question after the other."""

from __future__ import annotations

import math
import threading
import time
from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any

from pydantic import ValidationError

from adamo_vh.action_server.wire import (
    Act,
    Answer,
    Described,
    DescribeState,
    Done,
    Finish,
    Load,
    Noted,
    Observe,
    Picture,
    Say,
    Seen,
    Sent,
    Step,
    Think,
    View,
    Welcome,
    fault_in,
)
from adamo_vh.episode.result import EpisodeResult
from adamo_vh.errors import ConfigError
from adamo_vh.inference.model import Reply, reply_codec
from adamo_vh.observation import Frame, Observation
from adamo_vh.readable import encodable
from adamo_vh.record.run_folder import FRAMES
from adamo_vh.record.termination import TerminationReason
from adamo_vh.record.trajectory import frame_name, frame_type
from adamo_vh.service.watching import Watch
from adamo_vh.session.driven import DrivenBody

_MOST = 1e12


class Hosted:
    """A session that a player asks from outside; may be used from any threads, one at a time."""

    def __init__(self, name: str, body: DrivenBody, watch: Watch) -> None:
        """Host a body.

        Args:
            name: Of the session; whoever knows it may play.
            body: Begun already, with a run folder.
            watch: Is told what happens in it.
        """
        assert body.folder is not None
        self.id = name
        self.body = body
        self.watch = watch
        self.folder: Path = body.folder
        self.touched = time.monotonic()
        """When somebody last asked something."""
        self._lock = threading.Lock()
        self._last: tuple[Step | None, Sent] = (None, Sent(Noted()))
        """The last request that has an id, and its answer: it may be asked for again."""

    def welcome(self) -> Sent:
        """What a player is told who begins, or comes back."""
        with self._lock:
            self.touched = time.monotonic()
            body = self.body
            config, over = body.config, body.expire()
            frames: dict[str, Frame] = {}
            seen = None if over else self._seen(frames)
            return Sent(
                Welcome(
                    self.id,
                    body.instruction,
                    body.system_prompt,
                    body.tools,
                    {
                        "task": config.task,
                        "scene": config.scene,
                        "labeling": config.labeling.value,
                        "profile": asdict(config.profile),
                        "text_form": config.text_form.value,
                        "limits": asdict(config.limits),
                        "k": config.k,
                    },
                    over,
                    seen,
                ),
                frames,
            )

    def perform(self, step: Step) -> Sent:
        """Do what is asked, and answer; what was done already is answered again.

        Raises:
            ConfigError: What is asked makes no sense; nothing was done.
            EpisodeOverError: The episode has ended.
            EngineError: The world failed; the episode is broken.
        """
        with self._lock:
            self.touched = time.monotonic()
            if step.request and step == self._last[0]:
                return self._last[1]
            frames: dict[str, Frame] = {}
            sent = Sent(self._answer(step, frames), frames)
            if step.request:
                self._last = (step, sent)
            return sent

    def _answer(self, step: Step, frames: dict[str, Frame]) -> Answer:
        body = self.body
        match step:
            case Observe():
                return self._seen(frames)
            case Act():
                return self._done(step, frames)
            case DescribeState():
                return Described(body.state_text())
            case Think():
                body.think(encodable(step.note) if step.reply is None else _reply(step.reply))
            case Say():
                body.say(encodable(step.text))
            case Finish():
                reason = TerminationReason(step.reason) if step.reason else None
                body.finish(encodable(step.answer), reason, encodable(step.why))
            case Load():
                return Noted(body.ended, body.load(step.saved))
        return Noted(body.ended)

    def _seen(self, frames: dict[str, Frame]) -> Seen:
        seen = self.body.observe()
        view = self._view(seen.observation, frames)
        return Seen(view, seen.state_hash, seen.saved, seen.waited_s)

    def _done(self, step: Act, frames: dict[str, Frame]) -> Done:
        if step.note:
            self.body.think(encodable(step.note))
        done = self.body.call(step.name, step.arguments)
        return Done(
            done.feedback,
            done.agent,
            done.state_hash,
            done.saved,
            None if done.observation is None else self._view(done.observation, frames),
            self._pictures(done.pictures, frames),
            done.waited_s,
            self.body.ended,
        )

    def _view(self, seen: Observation, frames: dict[str, Frame]) -> View:
        (picture,) = self._pictures((seen.frame,), frames)
        return View(picture, seen.objects, seen.points, seen.agent, seen.camera)

    def _pictures(self, shown: Sequence[Frame], frames: dict[str, Frame]) -> tuple[Picture, ...]:
        """How an answer names its pictures, which go along with it."""
        named = [(frame_name(frame), frame) for frame in shown]
        frames.update(named)
        return tuple(
            Picture(
                name,
                frame.media_type,
                frame.width_px,
                frame.height_px,
                f"/v1/sessions/{self.id}/frames/{name}",
            )
            for name, frame in named
        )

    def frame(self, name: str) -> bytes | None:
        """A picture that was shown in this session, by its name; None if there is none."""
        self.touched = time.monotonic()
        if not frame_type(name):
            return None
        try:
            return (self.folder / FRAMES / name).read_bytes()
        except OSError:
            return None

    def state(self) -> Any:
        """The whole truth. Privileged."""
        with self._lock:
            return self.body.state()

    def completion(self) -> float | None:
        """How much of the task is done now. Privileged."""
        with self._lock:
            return self.body.completion()

    def result(self) -> EpisodeResult:
        """What came of it. Privileged.

        Raises:
            RecordError: It has not ended.
        """
        with self._lock:
            return self.body.result()

    def expire(self) -> None:
        """End the episode if its time is over."""
        with self._lock:
            self.body.expire()

    def close(self) -> None:
        """Leave the body; the record stays."""
        with self._lock:
            self.body.close()
        self.watch.close()


def _reply(told: dict[str, Any]) -> Reply:
    try:
        reply = reply_codec().validate_python(told)
    except (ValidationError, RecursionError) as error:
        what = fault_in(error) if isinstance(error, ValidationError) else "It is too deep."
        raise ConfigError(f"The reply cannot be read: {what}") from None
    usage = reply.usage
    counts = (usage.input_tokens, usage.output_tokens, usage.cached_tokens, usage.reasoning_tokens)
    told_of = (*counts, reply.requests, reply.seconds, reply.waited_s, reply.cost_usd or 0.0)
    if not all(math.isfinite(number) and 0 <= number < _MOST for number in told_of):
        raise ConfigError("The reply cannot be read: what it took must be numbers from 0.")
    return reply
