"""A model whose replies come from outside: whoever it is calls in when it has decided.

The session asks it like any model and waits, in a thread of its own, while the other side takes
its time. The other side, in any thread, fetches what the prompt brought since it spoke last and
posts one reply to it. What it remembers of all the rest is its own affair.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from adamo_vh.action import ToolSchema
from adamo_vh.errors import ModelError
from adamo_vh.inference.arguments import clean_arguments, dump_arguments
from adamo_vh.inference.messages import AIMessage, Message, SystemMessage, ToolCall
from adamo_vh.inference.model import Isolation, ModelInfo, ModelKind, Reply, Sampling, Spent
from adamo_vh.readable import readable

HUMAN = "human"
"""The name of a person who drives the body: he too replies when he has decided."""
OUTSIDE = "outside"
"""First word of the name of every such model."""
UNKNOWN: Isolation = "unknown"
_LONGEST_NAME = 60
_WAIT_S = 3600.0
"""A thread waits so long at once; longer waits are made of several."""


def outside_name(client: str) -> str:
    """The name of a mind outside, e.g. ``outside:claude-code``.

    Args:
        client: What it calls itself; nobody vouches for it.
    """
    name = "-".join(readable(client).split())[:_LONGEST_NAME]
    return f"{OUTSIDE}:{name or 'unknown'}"


@dataclass(frozen=True, slots=True)
class Asked:
    """What the mind outside is asked."""

    number: int
    """Counts the questions."""
    prompt: tuple[Message, ...]
    """All of it, as any model gets it."""
    new: tuple[Message, ...]
    """What it brought since the last reply, without the system's messages; all of them, if this
    mind has not replied yet."""
    tools: tuple[ToolSchema, ...]


class OutsideModel:
    """Hands each prompt to whoever is outside, and waits for the reply.

    Nobody may ever come. So all replies together may take only so long; afterwards it says nothing,
    which lets the limits of the episode end it.
    """

    def __init__(
        self, name: str, within_s: float, answered: int = 0, isolation: Isolation = UNKNOWN
    ) -> None:
        """Wait for nobody yet.

        Args:
            name: As of `outside_name`, or `HUMAN`.
            within_s: Seconds that all replies may take together.
            answered: Replies that were given before an interruption.
            isolation: How far it is kept from all but its body; see `ModelInfo`.
        """
        self._name, self._isolation = name, isolation
        self._left_s = within_s
        self._answered = answered
        self._change = threading.Condition()
        self._asked: Asked | None = None
        """The question that stands; None while the body acts."""
        self._last: Asked | None = None
        self._reply: Reply | None = None
        self._gone = self._broken = ""
        """Why no reply comes any more: the mind hung up, or was cut off."""
        self._over = False

    @property
    def info(self) -> ModelInfo:
        """From outside; of a person, that it is one."""
        kind = ModelKind.HUMAN if self._name == HUMAN else ModelKind.OUTSIDE
        return ModelInfo(self._name, kind, isolation=self._isolation)

    def complete(
        self, messages: Sequence[Message], tools: Sequence[ToolSchema], sampling: Sampling
    ) -> Reply:
        """Wait for the reply from outside; an empty one if there will be none.

        Raises:
            ModelError: It was cut off: the episode is unscored and can be gone on with.
        """
        began = time.monotonic()
        with self._change:
            new = _new(self._last, messages)
            self._asked = self._last = Asked(
                self._last.number + 1 if self._last else 1, tuple(messages), new, tuple(tools)
            )
            self._reply = None
            self._change.notify_all()
            while not (self._reply or self._gone or self._broken):
                left = self._left_s - (time.monotonic() - began)
                if left <= 0:
                    break
                self._change.wait(min(left, _WAIT_S))
            self._asked = None
            seconds = time.monotonic() - began
            self._left_s -= seconds
            return self._said(seconds)

    def _said(self, seconds: float) -> Reply:
        if self._reply is not None:
            self._answered += 1
            return Reply(self._reply.message, seconds=seconds, warning=self._reply.warning)
        if self._broken:
            error = ModelError(self._broken)
            error.spent = Spent(seconds=seconds)
            raise error
        why = self._gone or "The mind outside let the time run out without a call or an answer."
        return Reply(AIMessage(""), seconds=seconds, warning=why)

    @property
    def is_over(self) -> bool:
        """Whether nothing will be asked any more."""
        return self._over

    def asked(self, after: int = 0) -> Asked | None:
        """Wait until a question stands.

        Args:
            after: Number of a question that was replied to: wait for a later one.

        Returns:
            The question; None if the episode is over.
        """
        with self._change:
            self._change.wait_for(
                lambda: self._over or (self._asked is not None and self._asked.number > after)
            )
            return self._asked

    def call(
        self, name: str, arguments: Mapping[str, Any] | None, note: str = "", client: str = ""
    ) -> None:
        """Reply with a call to the question that stands.

        Args:
            name: Of the tool.
            arguments: As the mind gave them; None if they are no JSON object.
            note: What it says with the call.
            client: Who replies, if it says so: somebody else may have gone on in its place.
        """
        read = None if arguments is None else clean_arguments(arguments)
        raw = "" if read is None else dump_arguments(read)
        call = ToolCall(f"call_{self._answered + 1}", name, read, raw)
        self._post(AIMessage(note, (call,)), client)

    def answer(self, text: str, client: str = "") -> None:
        """Reply with text alone, which is a final answer.

        Args:
            text: The answer.
            client: Who replies.
        """
        self._post(AIMessage(text), client)

    def _post(self, message: AIMessage, client: str) -> None:
        warning = ""
        if client and outside_name(client) != self._name:
            other = outside_name(client)
            warning = f"{other} went on with what {self._name} had begun."
        with self._change:
            if self._asked is None or self._reply is not None:
                raise ModelError("Nothing is asked at this moment.")
            self._reply = Reply(message, warning=warning)
            self._change.notify_all()

    def hang_up(self, why: str) -> None:
        """Say for the mind outside that it says nothing any more: its own end of the episode."""
        with self._change:
            self._gone = why
            self._change.notify_all()

    def cut_off(self, why: str) -> None:
        """Let nobody reply any more, through no fault of the mind outside."""
        with self._change:
            self._broken = why
            self._change.notify_all()

    def end(self) -> None:
        """Tell who waits outside that nothing will be asked any more."""
        with self._change:
            self._over, self._asked = True, None
            self._change.notify_all()


def _new(last: Asked | None, prompt: Sequence[Message]) -> tuple[Message, ...]:
    """What a prompt brought since the last one, without the system's messages."""
    if last is None:
        return tuple(m for m in prompt if not isinstance(m, SystemMessage))
    said, tail = _tail(prompt)
    before, told = _tail(last.prompt)
    # A reply that is not shown again, such as an empty one, leaves what was told before in place.
    return tail if said != before else tail[len(told) :]


def _tail(prompt: Sequence[Message]) -> tuple[AIMessage | None, tuple[Message, ...]]:
    """The last message of the model's own, and what came after it."""
    for number in range(len(prompt) - 1, -1, -1):
        message = prompt[number]
        if isinstance(message, AIMessage):
            return message, tuple(prompt[number + 1 :])
    return None, tuple(m for m in prompt if not isinstance(m, SystemMessage))
