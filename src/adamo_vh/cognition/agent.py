"""The Cognitive Server's loop: perceive, reason, act, until the instruction is done."""

from __future__ import annotations

import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

from adamo_vh.action import Inspect, action_name
from adamo_vh.action_server import ActionResult, ActionServer, Sighting, execute_call
from adamo_vh.cognition.doubts import Doubts
from adamo_vh.cognition.guards import Guard, LoopGuard, ProtocolGuard
from adamo_vh.cognition.memory.short_term import Result, ShortTermMemory
from adamo_vh.cognition.profile import PAPER, Profile
from adamo_vh.cognition.prompts import render
from adamo_vh.cognition.turns import offered, read_turn
from adamo_vh.errors import AdamoError
from adamo_vh.inference.messages import AIMessage
from adamo_vh.inference.model import Model, Sampling
from adamo_vh.inference.tidy import tidied
from adamo_vh.observation import Frame, Observation
from adamo_vh.perception import TextForm
from adamo_vh.record.termination import Limits, Stopwatch, TerminationReason
from adamo_vh.record.trajectory import (
    Ended,
    Event,
    LeftOut,
    Observer,
    Started,
    acted,
    observed,
    shown,
    thought,
)
from adamo_vh.record.turn import Turn, Wish


@dataclass(frozen=True, slots=True)
class AgentConfig:
    """How the model is spoken to, and how far it may go; the defaults are the paper's baseline."""

    profile: Profile = PAPER
    k: int = 50
    """Steps that the short-term memory keeps."""
    text_form: TextForm = TextForm.FULL
    """Which fields the symbolic state has."""
    sampling: Sampling = field(default=Sampling())
    limits: Limits = field(default=Limits())


class Agent:
    """A mind in a body: asks a model what to do and lets the action server do it."""

    def __init__(
        self,
        model: Model,
        server: ActionServer,
        system_prompt: str,
        config: AgentConfig | None = None,
        *,
        guards: Sequence[Guard] = (),
        observers: Sequence[Observer] = (),
    ) -> None:
        """Bring a model and a body together.

        Args:
            model: Who decides.
            server: What acts.
            system_prompt: The fixed instructions.
            config: How the model is spoken to and how far it may go; the paper's baseline by
                default.
            guards: Further reasons to stop, e.g. a budget.
            observers: Are told of every event.
        """
        self._model = model
        self._server = server
        self._system_prompt = system_prompt
        config = config or AgentConfig()
        self._profile, self._limits = config.profile, config.limits
        self._sampling = replace(config.sampling, exact=config.profile.exact_sampling)
        self._memory = ShortTermMemory(system_prompt, config.k, config.profile, config.text_form)
        self._guards: tuple[Guard, ...] = (
            ProtocolGuard(config.limits.max_unreadable),
            LoopGuard(config.limits.max_repeats),
            *guards,
        )
        self._observers: tuple[Observer, ...] = (*self._guards, *observers)
        self._tools = offered(server.actions, config.profile)
        self._steps = 0
        self._state_hash = ""
        """Digest of the world after the last answer of the server."""

    def run(self, instruction: str) -> Ended:
        """Carry out one instruction; a further one goes on in the same world and memory.

        Returns:
            How it ended. A fault of a provider or of ours ends it as `BROKEN`, for the caller to
            leave unscored.
        """
        try:
            self._begin(instruction)
            while (reason := self._stop()) is None:
                turn = self.think()
                if objection := self._doubts.about_turn(turn):
                    self._object(turn, objection)
                elif turn.ends:
                    self._reply(turn, render("said"))
                    return self._end(turn.reason, turn.answer)
                else:
                    self.act(turn)
            return self._end(reason, "")
        except AdamoError as error:
            return self._end(TerminationReason.BROKEN, f"{type(error).__name__}: {error}")

    def think(self) -> Turn:
        """Ask the model."""
        messages = self._memory.messages()
        asked = time.monotonic()
        reply = tidied(self._model.complete(messages, self._tools, self._sampling), self._tools)
        # Only the reply's own time counts: waits do not, and a recorded reply took its time before.
        self._watch.leave_out(time.monotonic() - asked - reply.seconds)
        self._tell(thought(self._steps, self._memory.state_text, messages, reply))
        return read_turn(reply, self._profile)

    def act(self, turn: Turn) -> None:
        """Execute the calls of a turn up to the first surprise; every one gets its answer."""
        results: list[Result] = []
        for wish in turn.wishes:
            why_not = self._why_not(wish, results)
            results.append(self._left_out(wish, why_not) if why_not else self._carry_out(wish))
        self._look_again(results)
        self._memory.add_step(*self._remembered(turn.message, results))

    def _begin(self, instruction: str) -> None:
        self._watch = Stopwatch()
        self._first_step = self._steps
        self._doubts = Doubts(self._profile)
        saved, sighting = "", None
        try:
            sighting = self._server.observe()
            saved = sighting.saved
            self._note(sighting)
        finally:
            # Without a first view the record still says what was asked.
            self._tell(Started(instruction, self._system_prompt, self._state_hash, saved))
        self._memory.instruct(instruction, self._perceived(sighting.observation))

    def _stop(self) -> TerminationReason | None:
        """The first reason to stop before another question."""
        limit = self._limits.exceeded(self._steps - self._first_step, self._watch.seconds)
        reasons = (limit, *(guard.verdict() for guard in self._guards))
        return next((reason for reason in reasons if reason is not None), None)

    def _object(self, turn: Turn, objection: str) -> None:
        """Say why a turn is not carried out, or does not end the episode."""
        self._reply(turn, objection)
        if not (turn.wishes and turn.goes_back):
            self._memory.remark(objection)

    def _reply(self, turn: Turn, text: str) -> None:
        """Remember a turn without an action; every call gets the same answer."""
        if turn.goes_back:
            results = [self._result(wish, text) for wish in turn.wishes]
            self._memory.add_step(turn.message, *results)

    def _why_not(self, wish: Wish, results: Sequence[Result]) -> str:
        """Why a call is left out; empty if it is to be executed."""
        if wish.is_finish:
            return "Finish comes alone, when you have seen what the other calls did"
        if len(results) >= self._profile.plan:
            most = self._profile.plan
            return "one action a turn" if most == 1 else f"at most {most} actions a turn"
        if self._steps - self._first_step >= self._limits.max_steps:
            return "the step limit is reached"
        if results and not results[-1].went_as_planned:
            return "an earlier call of this turn did not go as planned"
        return ""

    def _left_out(self, wish: Wish, why_not: str) -> Result:
        self._tell(LeftOut(self._steps, wish.call.name, why_not))
        result = self._result(wish, render("not_executed", why=why_not))
        return replace(result, left_out=why_not)

    def _carry_out(self, wish: Wish) -> Result:
        if doubt := self._doubts.about_pick(wish):
            seen = self._execute(action_name(Inspect), wish.arguments)
            result = self._result(wish, f"{doubt} {seen.feedback.text}")
            return replace(result, pictures=seen.pictures)
        done = self._execute(wish.call.name, wish.arguments)
        return replace(
            self._result(wish, done.feedback.text),
            outcome=done.feedback.outcome,
            view=done.observation,
            pictures=done.pictures,
        )

    def _execute(self, name: str, arguments: Mapping[str, Any] | None) -> ActionResult:
        started = time.monotonic()
        result = execute_call(self._server, name, arguments)
        self._note(result)
        self._steps += 1
        self._tell(acted(self._steps, name, arguments, result, time.monotonic() - started))
        for frame in result.pictures:
            self._tell(shown(self._steps, frame), frame)
        if result.observation is not None:
            self._perceived(result.observation)
        return result

    def _result(self, wish: Wish, text: str) -> Result:
        return Result(wish.call.id, wish.call.name, text, self._body)

    def _look_again(self, results: list[Result]) -> None:
        """With fresh views on, see what a turn has changed since the last view."""
        if self._profile.fresh_view and self._state_hash != self._seen_state:
            executed = [i for i, result in enumerate(results) if result.outcome is not None]
            last = executed[-1] if executed else -1
            results[last] = replace(results[last], view=self._observe())

    def _remembered(self, message: AIMessage, results: list[Result]) -> tuple[Any, ...]:
        """What of a turn goes into the memory: in few words, only the calls that were executed."""
        reasons = [result.left_out for result in results if result.left_out]
        done = len(results) - len(reasons)
        # What a provider keeps with a message belongs to all of its calls.
        if not (self._profile.terse and reasons and done) or message.kept:
            return message, *results
        text = render("left_out", text=results[done - 1].text, count=len(reasons), why=reasons[0])
        told = [*results[: done - 1], replace(results[done - 1], text=text)]
        return replace(message, calls=message.calls[:done]), *told

    def _note(self, answer: ActionResult | Sighting) -> None:
        """Note how body and world stand after an answer of the server."""
        self._body, self._state_hash = answer.agent, answer.state_hash

    def _observe(self) -> Observation:
        sighting = self._server.observe()
        self._note(sighting)
        return self._perceived(sighting.observation)

    def _perceived(self, view: Observation) -> Observation:
        self._seen_state = self._state_hash
        self._tell(observed(self._steps, view), view.frame)
        return view

    def _end(self, reason: TerminationReason, answer: str) -> Ended:
        if reason.is_scored:
            self._server.say(answer)
        steps, seconds = self._steps - self._first_step, self._watch.seconds
        why = next((guard.why for guard in self._guards if guard.verdict() is reason), "")
        ended = Ended(steps, reason, answer, self._state_hash, seconds, why)
        self._tell(ended)
        return ended

    def _tell(self, event: Event, frame: Frame | None = None) -> None:
        for observer in self._observers:
            observer.notify(event, frame)
