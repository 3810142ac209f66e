"""One turn of a model: what it may say under a profile, and what a reply comes to."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Annotated, Any, ClassVar

from pydantic import ConfigDict, Field

from adamo_vh.action import ToolSchema, action_name, tool_schema
from adamo_vh.cognition.profile import Profile
from adamo_vh.cognition.termination import TerminationReason
from adamo_vh.inference.messages import AIMessage, ToolCall
from adamo_vh.inference.model import Reply

NOTE = "note"
CONFIDENCE = "confidence"
_NOTE_FIELDS: dict[str, Any] = {
    NOTE: {"type": "string", "description": "Evidence, conclusion, what comes next."},
    CONFIDENCE: {
        "type": "number",
        "minimum": 0,
        "maximum": 1,
        "description": "How sure you are that this is the right step.",
    },
}
_IN_WORDS = ("description", "minimum", "maximum", "maxLength")
"""Parts of a field's schema that the instructions tell as well, or a refusal does."""


@dataclass(frozen=True, slots=True)
class Finish:
    """End the episode, when you have seen the results of all that you did."""

    __pydantic_config__: ClassVar[ConfigDict] = ConfigDict(
        extra="ignore", coerce_numbers_to_str=True
    )

    asked: Annotated[str, Field(description="What was asked.")]
    verified: Annotated[str, Field(description="What you have verified, and from what.")]
    unseen: Annotated[str, Field(description="What you have not looked at or are not sure of.")]
    answer: Annotated[str, Field(description="A short sentence for the user.")]


FINISH = action_name(Finish)


def offered(actions: Sequence[type], profile: Profile) -> list[ToolSchema]:
    """The tools that a model is offered: the body's actions, and what the profile adds to them."""
    types = (*actions, Finish) if profile.finish_check else tuple(actions)
    schemas = [tool_schema(action) for action in types]
    if profile.note_argument:
        schemas = [_with_note(schema) for schema in schemas]
    return [_shortened(schema) for schema in schemas] if profile.terse else schemas


def _shortened(schema: ToolSchema) -> ToolSchema:
    """The same tool with names and types alone: the instructions say what the fields mean."""
    own = {key: value for key, value in schema.parameters.items() if key != "additionalProperties"}
    fields = {
        name: {key: value for key, value in field.items() if key not in _IN_WORDS}
        for name, field in own.get("properties", {}).items()
    }
    return ToolSchema(schema.name, schema.description, {**own, "properties": fields})


def _with_note(schema: ToolSchema) -> ToolSchema:
    own = schema.parameters
    parameters = {
        **own,
        "properties": {**_NOTE_FIELDS, **own.get("properties", {})},
        "required": [*_NOTE_FIELDS, *own.get("required", [])],
    }
    return ToolSchema(schema.name, schema.description, parameters)


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
    """Why it is neither a call nor an answer; empty if it is one."""

    @property
    def is_empty(self) -> bool:
        """Whether nothing was said at all."""
        return not (self.wishes or self.unreadable or self.message.text.strip())

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


def read_turn(reply: Reply, profile: Profile) -> Turn:
    """Read a reply."""
    wishes = tuple(_wish(call, profile) for call in reply.message.calls)
    return Turn(reply.message, wishes, reply.unreadable)


def _wish(call: ToolCall, profile: Profile) -> Wish:
    ends = profile.finish_check and call.name == FINISH
    if call.arguments is None or not profile.note_argument:
        return Wish(call, call.arguments, is_finish=ends)
    own = {key: value for key, value in call.arguments.items() if key not in _NOTE_FIELDS}
    note, confidence = call.arguments.get(NOTE), call.arguments.get(CONFIDENCE)
    sure = None
    if isinstance(confidence, int | float) and not isinstance(confidence, bool):
        # Also keeps a number that is too large for a float out.
        sure = float(min(max(confidence, 0), 1))
    return Wish(call, own, note if isinstance(note, str) else "", sure, ends)


def reasoning(text: str, calls: Sequence[ToolCall]) -> str:
    """The reasoning note of a reply: its text, or else what its calls carry as a note."""
    if text.strip():
        return text
    notes = [(call.arguments or {}).get(NOTE) for call in calls]
    return "\n".join(note for note in notes if isinstance(note, str) and note.strip())
