"""The Cognitive Server's loop: perceive, reason, act, until the instruction is done."""

from __future__ import annotations

import time
from collections.abc import Sequence

from adamo.action import tool_schema
from adamo.action_server import ActionServer, execute_call
from adamo.cognition.memory import ShortTermMemory
from adamo.cognition.prompts import render
from adamo.cognition.termination import Limits, Stopwatch, TerminationReason
from adamo.cognition.trajectory import Acted, Ended, Event, Observer, Started, Thought, observed
from adamo.errors import AdamoError
from adamo.inference.messages import (
    AIMessage,
    HumanMessage,
    ImagePart,
    TextPart,
    ToolMessage,
)
from adamo.inference.model import Model, Sampling
from adamo.observation import Frame, Observation
from adamo.perception import TextForm, agent_lines, object_lines, point_lines

_ONE_A_TURN = "Not executed: one action a turn."


class Agent:
    """A mind in a body: asks a model what to do and lets the action server do it."""

    def __init__(
        self,
        model: Model,
        server: ActionServer,
        *,
        system_prompt: str,
        k: int = 50,
        text_form: TextForm = TextForm.FULL,
        sampling: Sampling | None = None,
        limits: Limits | None = None,
        observers: Sequence[Observer] = (),
    ) -> None:
        """Bring a model and a body together.

        Args:
            model: Who decides.
            server: What acts.
            system_prompt: The fixed instructions.
            k: Steps that the short-term memory keeps.
            text_form: Which fields the symbolic state has.
            sampling: Decoding settings.
            limits: Caps on steps and seconds.
            observers: Are told of every event.
        """
        self._model = model
        self._server = server
        self._system_prompt = system_prompt
        self._memory = ShortTermMemory(system_prompt, k)
        self._text_form = text_form
        self._sampling = sampling or Sampling()
        self._limits = limits or Limits()
        self._observers = observers
        self._tools = [tool_schema(action) for action in server.actions]
        self._watch = Stopwatch()
        self._steps = 0

    def run(self, instruction: str) -> Ended:
        """Carry out one instruction.

        Returns:
            How it ended. A fault of a provider or of ours ends it as `BROKEN`, for the caller to
            leave unscored.
        """
        try:
            self._begin(instruction)
            while (reason := self._limits.exceeded(self._steps, self._watch.seconds)) is None:
                message = self.think()
                if not message.calls:
                    return self._end(_final(message), message.text)
                self.act(message)
            return self._end(reason, "")
        except AdamoError as error:
            return self._end(TerminationReason.BROKEN, f"{type(error).__name__}: {error}")

    def think(self) -> AIMessage:
        """Ask the model; an empty answer is nudged once."""
        message = self._ask()
        if not message.calls and not message.text.strip():
            nudge = HumanMessage((TextPart(render("nudge")),))
            self._memory.add_step(nudge)
            message = self._ask()
        return message

    def act(self, message: AIMessage) -> None:
        """Execute the first call; answer further ones without executing them."""
        call, *further = message.calls
        started = time.monotonic()
        result = execute_call(self._server, call.name, call.arguments)
        seconds = time.monotonic() - started
        answers = (
            ToolMessage(call.id, call.name, result.feedback.text),
            *(ToolMessage(other.id, other.name, _ONE_A_TURN) for other in further),
        )
        view = result.observation
        frame = () if view is None else (_frame_message(view),)
        self._memory.add_step(message, *answers, *frame)
        self._steps += 1
        self._tell(
            Acted(
                self._steps,
                call.name,
                call.arguments,
                result.feedback,
                result.agent,
                result.state_hash,
                result.saved,
                seconds,
            )
        )
        self._perceived(view)

    def _begin(self, instruction: str) -> None:
        self._watch = Stopwatch()
        self._steps = 0
        server = self._server
        self._tell(Started(instruction, self._system_prompt, server.state_hash(), server.save()))
        self._view = self._server.observe()
        first = HumanMessage((TextPart(instruction), _image(self._view.frame)))
        self._memory.begin(first, self._state_text())
        self._tell(observed(0, self._view), self._view.frame)

    def _perceived(self, view: Observation | None) -> None:
        """Take a new view in, if there is one, and bring the symbolic state up to date."""
        if view is not None:
            self._view = view
            self._tell(observed(self._steps, view), view.frame)
        self._memory.update_state(self._state_text())

    def _state_text(self) -> str:
        form = self._text_form
        return render(
            "symbolic_state",
            objects=object_lines(self._view.objects, form),
            points=point_lines(self._view.points),
            agent=agent_lines(self._server.agent(), form),
        )

    def _ask(self) -> AIMessage:
        messages = self._memory.messages()
        reply = self._model.complete(messages, self._tools, self._sampling)
        self._watch.leave_out(reply.waited_s)
        message = reply.message
        self._tell(
            Thought(
                self._steps,
                self._state_text(),
                len(messages),
                message.text,
                message.calls,
                reply.usage,
                reply.seconds,
                reply.waited_s,
            )
        )
        return message

    def _end(self, reason: TerminationReason, answer: str) -> Ended:
        if reason.is_scored:
            self._server.say(answer)
        ended = Ended(self._steps, reason, answer, self._server.state_hash(), self._watch.seconds)
        self._tell(ended)
        return ended

    def _tell(self, event: Event, frame: Frame | None = None) -> None:
        for observer in self._observers:
            observer.notify(event, frame)


def _final(message: AIMessage) -> TerminationReason:
    said = bool(message.text.strip())
    return TerminationReason.ANSWERED if said else TerminationReason.EMPTY_REPLY


def _image(frame: Frame) -> ImagePart:
    return ImagePart(frame.data, frame.media_type, frame.width_px, frame.height_px)


def _frame_message(view: Observation) -> HumanMessage:
    return HumanMessage((TextPart("New view after your Look."), _image(view.frame)))
