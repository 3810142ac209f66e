"""The Cognitive Server's loop: perceive, reason, act, until the instruction is done."""

from __future__ import annotations

import time
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import Any

from adamo_vh.action import Inspect, action_name
from adamo_vh.action_server import ActionResult, ActionServer, Sighting, execute_call
from adamo_vh.cognition.doubts import Doubts
from adamo_vh.cognition.guards import Guard
from adamo_vh.cognition.memory.protocol import Memory, Result
from adamo_vh.cognition.memory.short_term import ShortTermMemory
from adamo_vh.cognition.oversight import Oversight
from adamo_vh.cognition.profile import PAPER, Profile
from adamo_vh.cognition.prompts import render
from adamo_vh.cognition.stops import Errand, Stops
from adamo_vh.cognition.telling import Telling, fault
from adamo_vh.cognition.turns import offered, read_turn
from adamo_vh.engine import WorldEvent
from adamo_vh.errors import BudgetError, ModelError
from adamo_vh.inference.messages import AIMessage
from adamo_vh.inference.model import Model, Sampling, Spent
from adamo_vh.inference.tidy import tidied
from adamo_vh.observation import AgentState, Frame, Observation
from adamo_vh.perception import TextForm
from adamo_vh.record.termination import Limits, Stop, TerminationReason
from adamo_vh.record.trajectory import (
    Acted,
    Ended,
    Event,
    Happened,
    LeftOut,
    Lost,
    Observer,
    Restored,
    Started,
    Thought,
    Vetoed,
    observed,
    shown,
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
        memory: Memory | None = None,
        guards: Sequence[Guard] = (),
        records: Sequence[Observer] = (),
        observers: Sequence[Observer] = (),
        known: Sequence[Event] = (),
        oversight: Oversight | None = None,
    ) -> None:
        """Bring a model and a body together.

        Args:
            model: Who decides.
            server: What acts.
            system_prompt: The fixed instructions.
            config: How the model is spoken to and how far it may go; the paper's baseline by
                default.
            memory: What makes a prompt of what happened; the short-term memory by default.
            guards: Further reasons to stop, e.g. a budget.
            records: Must be told of every event: a fault of theirs ends the episode.
            observers: Are told of every event; a fault of theirs ends nothing.
            known: What is on record already and will come again, to the same ends.
            oversight: The word of a person who watches; nobody does by default.
        """
        config = config or AgentConfig()
        self._model = model
        self._server = server
        self._system_prompt = system_prompt
        self._profile, self._limits = config.profile, config.limits
        self._sampling = replace(config.sampling, exact=config.profile.exact_sampling)
        self._memory: Memory = memory or ShortTermMemory(
            system_prompt, config.k, config.profile, config.text_form
        )
        self._stops = Stops(config.limits, guards, known, oversight)
        self._telling = Telling((self._stops, *records), observers)
        self._tools = offered(server.actions, config.profile)
        self._steps = self._replies = 0
        """Calls that were executed or refused, and replies that the memory was told of."""
        self._errand = Errand(0, Doubts(config.profile))
        self._state_hash = self._seen_state = ""
        """Digests of the world after the last answer of the server, and at the last view."""
        self._body: AgentState | None = None
        """The body after the last answer of the server."""

    def run(self, instruction: str) -> Ended:
        """Carry out one instruction; a further one goes on in the same world and memory.

        Returns:
            How it ended. Whatever is raised by the model, the engine, a tool or the record ends it
            as `BROKEN`, for the caller to leave unscored.
        """
        try:
            return self._end(self._pursue(instruction))
        except BudgetError as error:
            return self._end(Stop(TerminationReason.RUN_BUDGET, str(error)))
        except Exception as error:
            spent = error.spent if isinstance(error, ModelError) else None
            return self._end(Stop(TerminationReason.BROKEN, answer=fault(error), spent=spent))

    def _pursue(self, instruction: str) -> Stop:
        """Perceive, reason and act until there is a reason to stop."""
        self._begin(instruction)
        while (stop := self._stops.stop(self._errand, self._steps)) is None:
            turn = self.think()
            if objection := self._errand.doubts.about_turn(turn):
                self._object(turn, objection)
            elif turn.ends:
                self._reply(turn, render("said"))
                return turn.stop
            elif why := self._stops.veto(turn):
                self._leave_out(turn, why)
            else:
                self.act(turn)
        return stop

    def think(self) -> Turn:
        """Ask the model."""
        messages = self._memory.messages()
        asked = time.monotonic()
        reply = tidied(self._model.complete(messages, self._tools, self._sampling), self._tools)
        # Only the reply's own time counts: waits do not, and a recorded reply took its time before.
        self._errand.watch.leave_out(time.monotonic() - asked - reply.seconds)
        turn = read_turn(reply, self._profile)
        state_text, held = self._memory.state_text, sum(m.role == "ai" for m in messages)
        forgotten = max(0, self._replies - held)
        self._tell(Thought(self._steps, state_text, len(messages), turn, forgotten))
        return turn

    def act(self, turn: Turn) -> None:
        """Execute the calls of a turn up to the first surprise; every one gets its answer."""
        results: list[Result] = []
        for wish in turn.wishes:
            if self._stops.ends_here:
                return
            why_not = self._why_not(wish, results)
            results.append(self._left_out(wish, why_not) if why_not else self._carry_out(wish))
        self._look_again(results)
        self._remember(*self._remembered(turn.message, results))

    def happened(self, event: WorldEvent, state_hash: str, *, by_user: bool = False) -> None:
        """Take note that something happened in the world which the body did not do.

        Args:
            event: What happened; the model is told nothing but what it sees.
            state_hash: Digest of the world afterwards.
            by_user: Whether a person who watches brought it about.
        """
        self._state_hash = state_hash
        self._tell(Happened(self._steps, event, state_hash, by_user))

    def lost(self, spent: Spent) -> None:
        """Take note of what was spent on an answer that never came, before it goes on here."""
        self._tell(Lost(self._steps, spent))

    def restore(self, saved: str) -> None:
        """Let the world stand as it did when an earlier instruction began; the model is told.

        Args:
            saved: The saved state of then.
        """
        self._state_hash = self._server.load(saved)
        self._tell(Restored(self._steps, saved, self._state_hash))
        self._memory.remark(render("undone"))

    def _begin(self, instruction: str) -> None:
        self._stops.begin()
        self._errand = Errand(self._steps, Doubts(self._profile))
        saved, sighting = "", None
        try:
            sighting = self._server.observe()
            saved = sighting.saved
            self._note(sighting)
        finally:
            # Without a first view the record still says what was asked.
            self._tell(Started(instruction, self._system_prompt, self._state_hash, saved))
        self._memory.instruct(instruction, self._perceived(sighting.observation))

    def _object(self, turn: Turn, objection: str) -> None:
        """Say why a turn is not carried out, or does not end the episode."""
        self._reply(turn, objection)
        if not (turn.wishes and turn.goes_back):
            self._memory.remark(objection)

    def _reply(self, turn: Turn, text: str) -> None:
        """Remember a turn without an action; every call gets the same answer."""
        if turn.goes_back:
            results = [self._result(wish, text) for wish in turn.wishes]
            self._remember(turn.message, *results)

    def _why_not(self, wish: Wish, results: Sequence[Result]) -> str:
        """Why a call is left out; empty if it is to be executed."""
        if why := self._stops.why_not:
            return why
        if wish.is_finish:
            return "Finish comes alone, when you have seen what the other calls did"
        if len(results) >= self._profile.plan:
            most = self._profile.plan
            return "one action a turn" if most == 1 else f"at most {most} actions a turn"
        if self._steps - self._errand.first_step >= self._limits.max_steps:
            return "the step limit is reached"
        if results and not results[-1].went_as_planned:
            return "an earlier call of this turn did not go as planned"
        return ""

    def _leave_out(self, turn: Turn, why: str) -> None:
        """Do nothing of a turn that a person does not allow."""
        self._tell(Vetoed(self._steps, why))
        told = f"the user did not allow it: {why.rstrip('.')}"
        results = [self._left_out(wish, told) for wish in turn.wishes]
        self._remember(*self._remembered(turn.message, results))

    def _remember(self, message: AIMessage, *results: Result) -> None:
        self._replies += 1
        self._memory.add_step(message, *results)

    def _left_out(self, wish: Wish, why_not: str) -> Result:
        self._tell(LeftOut(self._steps, wish.call.id, wish.call.name, why_not))
        result = self._result(wish, render("not_executed", why=why_not))
        return replace(result, left_out=why_not)

    def _carry_out(self, wish: Wish) -> Result:
        if doubt := self._errand.doubts.about_pick(wish):
            seen = self._execute(action_name(Inspect), wish)
            result = self._result(wish, f"{doubt} {seen.feedback.text}")
            return replace(result, pictures=seen.pictures)
        done = self._execute(wish.call.name, wish)
        return replace(
            self._result(wish, done.feedback.text),
            outcome=done.feedback.outcome,
            view=done.observation,
            pictures=done.pictures,
        )

    def _execute(self, name: str, wish: Wish) -> ActionResult:
        started = time.monotonic()
        result = execute_call(self._server, name, wish.arguments)
        world_s = time.monotonic() - started - result.waited_s
        self._note(result)
        self._steps += 1
        self._tell(
            Acted(
                self._steps,
                wish.call.id,
                name,
                wish.arguments,
                result.feedback,
                result.agent,
                result.state_hash,
                result.saved,
                world_s,
            )
        )
        for frame in result.pictures:
            self._tell(shown(self._steps, frame), frame)
        if result.observation is not None:
            self._perceived(result.observation)
        return result

    def _result(self, wish: Wish, text: str) -> Result:
        assert self._body is not None  # Every errand begins with a view.
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
        self._errand.watch.leave_out(answer.waited_s)

    def _observe(self) -> Observation:
        sighting = self._server.observe()
        self._note(sighting)
        return self._perceived(sighting.observation)

    def _perceived(self, view: Observation) -> Observation:
        self._seen_state = self._state_hash
        self._tell(observed(self._steps, view), view.frame)
        return view

    def _end(self, stop: Stop) -> Ended:
        errand = self._errand
        seconds = errand.watch.seconds
        if stop.reason.is_scored:
            self._server.say(stop.answer)
        ended = Ended(
            self._steps - errand.first_step,
            stop.reason,
            stop.answer,
            self._state_hash,
            seconds,
            stop.why,
            stop.spent,
        )
        try:
            self._tell(ended)
        except Exception:
            # What broke the episode is told; that it could not be written as well is not news.
            if stop.reason is not TerminationReason.BROKEN:
                raise
        return ended

    def _tell(self, event: Event, frame: Frame | None = None) -> None:
        self._telling.tell(event, frame)
