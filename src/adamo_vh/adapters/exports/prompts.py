"""The prompts of a recorded episode, exactly as its model was given them.

The record holds what happened, not the prompts, which would hold every picture many times. The
mind is a pure function of what it was told, so it is told the same again: the record answers in
place of the body and of the model, and every prompt comes out as it was.
"""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Sequence
from dataclasses import dataclass

from adamo_vh.action import Action, Outcome, ToolSchema
from adamo_vh.action_server import ActionResult, Sighting
from adamo_vh.action_server.local import PAPER_REFRESH
from adamo_vh.adapters.exports.recorded import Episode
from adamo_vh.cognition.agent import Agent, AgentConfig
from adamo_vh.cognition.memory.short_term import ShortTermMemory
from adamo_vh.errors import InvalidActionError, RecordError
from adamo_vh.geometry import Camera
from adamo_vh.inference.messages import Message
from adamo_vh.inference.model import ModelInfo, ModelKind, Reply, Sampling
from adamo_vh.observation import Frame, Observation
from adamo_vh.record.trajectory import (
    Acted,
    Event,
    Observed,
    Restored,
    Shown,
    Started,
    Thought,
    Trajectory,
)
from adamo_vh.session.bodies import check_handed, tools_for

_FOV_Y_RAD = math.radians(60.0)
"""The camera of a view is not on record, and no mind is told of it."""


@dataclass(frozen=True, slots=True)
class Prompt:
    """What a model was asked in one turn, and what it answered."""

    thought: Thought
    messages: tuple[Message, ...]
    """The whole prompt, oldest first."""
    tools: tuple[ToolSchema, ...]
    """The tools on offer."""
    reply: Reply
    """The answer."""


def prompts(episode: Episode) -> tuple[Prompt, ...]:
    """Every prompt of an episode with its answer, in order.

    Raises:
        RecordError: They cannot be told from the record: a picture is missing, or a part that was
            handed in (a tool, a labeling, a memory) made them.
    """
    config, told = episode.manifest.config, episode.trajectory
    check_handed(episode.folder, episode.manifest, told, None, config.labeling)
    actions = tuple(tool.action_type for tool in tools_for(config))
    mind, body = _Mind(told.thoughts), _Body(episode, actions, told.events)
    started = next((event for event in told.events if isinstance(event, Started)), None)
    if started is None:
        return ()
    settings = AgentConfig(
        config.profile, config.k, config.text_form, config.sampling, config.limits
    )
    prompt = started.system_prompt
    memory = ShortTermMemory(prompt, config.k, config.profile, config.text_form)
    known = [event for event in told.events if event.type not in ("happened", "stood", "lost")]
    again = Trajectory()
    agent = Agent(mind, body, prompt, settings, memory=memory, records=(again,), known=known)
    for event in told.events:
        if isinstance(event, Restored):
            agent.restore(event.saved)
        if not isinstance(event, Started):
            continue
        agent.run(event.instruction)
        if body.fault is not None:
            raise body.fault
    _check(episode, again)
    return tuple(mind.asked)


def _check(episode: Episode, again: Trajectory) -> None:
    """Make sure that the prompts are those that the record speaks of."""
    first, second = (
        [(thought.step, thought.messages, thought.state_text) for thought in told.thoughts]
        for told in (episode.trajectory, again)
    )
    if first != second:
        raise RecordError(
            f"{episode.folder}: its prompts cannot be told from the record: a memory or tools of "
            "somebody's own, or another version of ADAMO, made them. Leave the episode out."
        )


class _NoMoreError(Exception):
    """The record ends here."""


class _Mind:
    """Answers as recorded, and keeps what it was asked."""

    def __init__(self, thoughts: Sequence[Thought]) -> None:
        self._ahead = deque(thoughts)
        self.asked: list[Prompt] = []
        self.info = ModelInfo("recorded", ModelKind.REPLAY)

    def complete(
        self, messages: Sequence[Message], tools: Sequence[ToolSchema], sampling: Sampling
    ) -> Reply:
        if not self._ahead:
            raise _NoMoreError
        thought = self._ahead.popleft()
        self.asked.append(Prompt(thought, tuple(messages), tuple(tools), thought.reply))
        return thought.reply


class _Body:
    """Shows and answers as recorded. Implements `ActionServer`."""

    def __init__(
        self, episode: Episode, actions: tuple[type, ...], events: Sequence[Event]
    ) -> None:
        self._episode = episode
        self.actions = actions
        self._ahead = deque(e for e in events if isinstance(e, Started | Observed | Acted | Shown))
        self._hash = ""
        self.fault: RecordError | None = None
        """What is wrong with the record."""

    def observe(self) -> Sighting:
        while self._ahead and not isinstance(self._ahead[0], Observed):
            passed = self._ahead.popleft()
            if isinstance(passed, Started):
                self._hash = passed.state_hash
        return Sighting(self._view(), self._hash, "")

    def execute(self, action: Action) -> ActionResult:
        return self._answer()

    def refuse(self, error: InvalidActionError) -> ActionResult:
        return self._answer()

    def say(self, text: str) -> None:
        """Nobody hears it again."""

    def load(self, saved: str) -> str:
        return self._hash

    def _answer(self) -> ActionResult:
        while self._ahead and not isinstance(self._ahead[0], Acted):
            self._ahead.popleft()
        if not self._ahead:
            raise _NoMoreError
        act = self._ahead.popleft()
        assert isinstance(act, Acted)
        pictures = []
        while self._ahead and isinstance(self._ahead[0], Shown):
            pictures.append(self._picture(self._ahead.popleft()))
        self._hash = act.state_hash
        # As the server's own rule is; any other view was asked for, and is given when it is again.
        grants = act.name in PAPER_REFRESH and act.feedback.outcome is not Outcome.REFUSED
        view = self._view() if grants else None
        return ActionResult(act.feedback, act.agent, view, self._hash, "", tuple(pictures))

    def _view(self) -> Observation:
        if not self._ahead:
            raise _NoMoreError
        seen = self._ahead.popleft()
        if not isinstance(seen, Observed):
            raise _NoMoreError  # The record stops, or was written by another rule.
        frame, agent = self._picture(seen), seen.agent
        size = (frame.width_px, frame.height_px)
        camera = Camera.towards(agent.eyes, agent.gaze, _FOV_Y_RAD, size)
        return Observation(frame, seen.objects, seen.points, agent, camera)

    def _picture(self, event: Event) -> Frame:
        assert isinstance(event, Observed | Shown)
        try:
            return self._episode.picture(event)
        except RecordError as fault:
            self.fault = fault
            raise
