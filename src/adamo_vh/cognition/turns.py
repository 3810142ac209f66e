"""What a model may say in a turn under a profile, and what its reply comes to."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Annotated, Any, ClassVar

from pydantic import ConfigDict, Field

from adamo_vh.action import ToolSchema, action_name, tool_schema
from adamo_vh.cognition.profile import Profile
from adamo_vh.inference.messages import ToolCall
from adamo_vh.inference.model import Reply
from adamo_vh.record.turn import CONFIDENCE, NOTE, Turn, Wish

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


def read_turn(reply: Reply, profile: Profile) -> Turn:
    """Read a reply."""
    wishes = tuple(_wish(call, profile) for call in reply.message.calls)
    return Turn(reply.message, wishes, reply.unreadable, reply.ending)


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
