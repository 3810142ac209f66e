"""What is put on record of a body that is driven from outside, and when its episode is over."""

from __future__ import annotations

import time
from collections import deque
from collections.abc import Mapping, Sequence
from typing import Any

from adamo_vh.action import ToolSchema
from adamo_vh.action_server import ActionResult
from adamo_vh.cognition.budget import BudgetGuard
from adamo_vh.cognition.doubts import Doubts
from adamo_vh.cognition.stops import Errand, Stops
from adamo_vh.cognition.telling import Telling
from adamo_vh.cognition.turns import read_turn
from adamo_vh.engine import World
from adamo_vh.episode.config import EpisodeConfig
from adamo_vh.inference.messages import AIMessage, ToolCall
from adamo_vh.inference.model import Reply
from adamo_vh.inference.tidy import tidied
from adamo_vh.observation import Observation
from adamo_vh.record.termination import Stop
from adamo_vh.record.trajectory import (
    Acted,
    Ended,
    Observer,
    Started,
    Thought,
    Trajectory,
    observed,
    shown,
)
from adamo_vh.record.turn import Wish
from adamo_vh.record.witness import Witness
from adamo_vh.session.parts import Parts


class DrivenRecord:
    """Keeps the record of one episode, its steps, its time, and the thoughts behind its calls."""

    def __init__(
        self,
        config: EpisodeConfig,
        tools: Sequence[ToolSchema],
        world: World,
        records: Sequence[Observer],
        parts: Parts,
    ) -> None:
        """Start empty.

        Args:
            config: Limits, budget, profile and task.
            tools: The tools on offer.
            world: Just reset; asked for its state only if the task looks at what came first.
            records: Must be told of every event.
            parts: Guards and observers, if they were handed in.
        """
        self.trajectory = Trajectory()
        """What happened so far."""
        self.steps = 0
        """Calls that were executed or refused."""
        self._profile, self._tools = config.profile, tools
        kept: Sequence[Observer] = (self.trajectory, *records)
        if config.scored_task is not None and config.scored_task.needs_history:
            kept = (Witness(kept, world.state),)
        self._stops = Stops(config.limits, (BudgetGuard(config.budget), *parts.get("guards", ())))
        self._telling = Telling((self._stops, *kept), parts.get("observers", ()))
        self._errand = Errand(0, Doubts(config.profile))
        self._answered = time.monotonic()
        self._wishes: deque[Wish] = deque()
        """Calls of the last thought that were not made yet."""

    @property
    def is_over(self) -> bool:
        """Whether the episode has ended."""
        return self.trajectory.ended is not None

    def stop(self) -> Stop | None:
        """Why to end the episode now; None to go on."""
        return self._stops.stop(self._errand, self.steps)

    def waited(self, seconds: float) -> None:
        """Leave out time that was spent waiting for an engine that others use too."""
        self._errand.watch.leave_out(seconds)

    def started(self, started: Started) -> None:
        """Note where the episode begins, or goes on from after it went back."""
        self._wishes.clear()
        self._telling.tell(started)

    def perceived(self, view: Observation) -> None:
        """Note a view."""
        self._telling.tell(observed(self.steps, view), view.frame)
        self._answered = time.monotonic()

    def thought(self, reply: Reply, state_text: str) -> None:
        """Note what was thought; its calls are to come.

        Args:
            reply: As the player tells it.
            state_text: The symbolic state at that moment.
        """
        turn = read_turn(tidied(reply, self._tools), self._profile)
        passed_s = time.monotonic() - self._answered
        # As for any model, lost tries and waits for a rate limit do not count.
        self._errand.watch.leave_out(max(0.0, min(reply.waited_s, passed_s)))
        self._wishes = deque(turn.wishes)
        self._telling.tell(Thought(self.steps, state_text, 0, turn))

    def wish(
        self, name: str, arguments: Mapping[str, Any] | None, note: str, state_text: str
    ) -> Wish:
        """Read a call; it stands for the next one of the last thought, or is a thought itself.

        Args:
            name: Of the tool, as the player wrote it.
            arguments: None if they could not be read.
            note: What was thought before it, if no whole reply was told.
            state_text: The symbolic state at that moment.
        """
        call = ToolCall(f"call-{self.steps + 1}", name, arguments)
        if not self._wishes:
            passed_s = time.monotonic() - self._answered
            self.thought(Reply(AIMessage(note, (call,)), seconds=passed_s), state_text)
            return self._wishes.popleft()
        thought = self._wishes.popleft()
        (call,) = tidied(Reply(AIMessage("", (call,))), self._tools).message.calls
        own = ToolCall(thought.call.id, call.name, call.arguments, call.raw)
        profile = self._profile
        return Wish.of(own, noted=profile.note_argument, can_finish=profile.finish_check)

    def acted(self, wish: Wish, done: ActionResult, world_s: float) -> None:
        """Note a step, and what it showed beside the view."""
        self.waited(done.waited_s)
        self.steps += 1
        self._telling.tell(
            Acted(
                self.steps,
                wish.call.id,
                wish.call.name,
                wish.arguments,
                done.feedback,
                done.agent,
                done.state_hash,
                done.saved,
                world_s,
            )
        )
        for frame in done.pictures:
            self._telling.tell(shown(self.steps, frame), frame)
        self._answered = time.monotonic()

    def ended(self, stop: Stop, state_hash: str) -> None:
        """Note the end."""
        seconds = self._errand.watch.seconds
        self._telling.tell(
            Ended(self.steps, stop.reason, stop.answer, state_hash, seconds, stop.why)
        )
