"""One turn of a model as it is read: its message, and what each call of it wishes."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from adamo_vh.inference.messages import AIMessage, ToolCall
from adamo_vh.inference.model import Ending
from adamo_vh.record.termination import TerminationReason

NOTE = "note"
CONFIDENCE = "confidence"


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

    @property
    def answer(self) -> str:
        """What a `Finish` tells the user."""
        return str((self.arguments or {}).get("answer") or self.note)


@dataclass(frozen=True, slots=True)
class Turn:
    """What a model said in one turn."""

    message: AIMessage
    wishes: tuple[Wish, ...] = ()
    unreadable: str = ""
    """What is wrong with it; see `Reply.unreadable`. Empty if it is a call or an answer."""
    ending: Ending = Ending.ANSWER
    """What the reply is."""

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
    def reason(self) -> TerminationReason:
        """Why it ends the episode."""
        empty = not self.answer.strip()
        return TerminationReason.EMPTY_REPLY if empty else TerminationReason.ANSWERED

    @property
    def finish(self) -> Wish | None:
        """The wish to end, if it is the only one."""
        return self.wishes[0] if len(self.wishes) == 1 and self.wishes[0].is_finish else None


def reasoning(text: str, calls: Sequence[ToolCall]) -> str:
    """The reasoning note of a reply: its text, or else what its calls carry as a note."""
    if text.strip():
        return text
    notes = [(call.arguments or {}).get(NOTE) for call in calls]
    return "\n".join(note for note in notes if isinstance(note, str) and note.strip())
