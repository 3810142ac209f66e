"""One turn of a model as it is read: its message, and what each call of it wishes."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from adamo_vh.inference.messages import AIMessage, ToolCall
from adamo_vh.inference.model import Ending, Reply
from adamo_vh.record.termination import Stop, TerminationReason

NOTE = "note"
CONFIDENCE = "confidence"
FINISH = "Finish"
"""The call that ends an episode, where it is offered."""


@dataclass(frozen=True, slots=True)
class Wish:
    """One call of a turn, with its note taken out of the arguments."""

    call: ToolCall
    arguments: Mapping[str, Any] | None
    """The action's own; None if they could not be read."""
    note: str = ""
    confidence: float | None = None
    """0 to 1; None if it was not said."""
    is_finish: bool = False
    """Whether it asks to end the episode, where the profile offers that."""

    @classmethod
    def of(cls, call: ToolCall, *, noted: bool, can_finish: bool) -> Wish:
        """Read a call.

        Args:
            call: As the model made it.
            noted: Whether calls carry a note and a confidence.
            can_finish: Whether a call of Finish ends the episode.
        """
        ends = can_finish and call.name == FINISH
        if call.arguments is None or not noted:
            return cls(call, call.arguments, is_finish=ends)
        own = {k: v for k, v in call.arguments.items() if k not in (NOTE, CONFIDENCE)}
        note, confidence = call.arguments.get(NOTE), call.arguments.get(CONFIDENCE)
        sure = None
        if isinstance(confidence, int | float) and not isinstance(confidence, bool):
            # Also keeps a number that is too large for a float out.
            sure = float(min(max(confidence, 0), 1))
        return cls(call, own, note if isinstance(note, str) else "", sure, ends)

    @property
    def answer(self) -> str:
        """What a `Finish` tells the user."""
        return str((self.arguments or {}).get("answer") or self.note)


@dataclass(frozen=True, slots=True)
class Turn:
    """What a model said in one turn."""

    reply: Reply
    wishes: tuple[Wish, ...] = ()
    """One for each call of the reply."""

    @property
    def message(self) -> AIMessage:
        """What goes back into the conversation."""
        return self.reply.message

    @property
    def unreadable(self) -> str:
        """What is wrong with it; see `Reply.unreadable`. Empty if it is a call or an answer."""
        return self.reply.unreadable

    @property
    def ending(self) -> Ending:
        """What the reply is."""
        return self.reply.ending

    @property
    def note(self) -> str:
        """The reasoning note: the text, or else what the calls carry as theirs."""
        text = self.message.text.strip()
        return text or "\n".join(dict.fromkeys(w.note.strip() for w in self.wishes if w.note))

    @property
    def is_empty(self) -> bool:
        """Whether nothing was said at all."""
        return not (self.wishes or self.unreadable or self.message.text.strip())

    @property
    def goes_back(self) -> bool:
        """Whether the model is shown it again: not if a filter refused it, nor if it is empty.

        A conversation with a refused answer in it is refused ever after.
        """
        return self.ending is not Ending.FILTERED and bool(self.wishes or self.message.text.strip())

    @property
    def is_prose(self) -> bool:
        """Whether it is text alone: the paper's way to end an episode."""
        return not (self.wishes or self.unreadable)

    @property
    def ends(self) -> bool:
        """Whether it ends the episode."""
        return self.is_prose or self.finish is not None

    @property
    def answer(self) -> str:
        """The final answer, if it ends the episode."""
        return self.message.text if self.finish is None else self.finish.answer

    @property
    def stop(self) -> Stop:
        """The end that it brings, if it ends the episode."""
        said = TerminationReason.ANSWERED if self.answer.strip() else TerminationReason.EMPTY_REPLY
        return Stop(said, answer=self.answer)

    @property
    def finish(self) -> Wish | None:
        """The wish to end, if it is the only one."""
        return self.wishes[0] if len(self.wishes) == 1 and self.wishes[0].is_finish else None
