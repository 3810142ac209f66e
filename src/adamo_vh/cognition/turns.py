"""What a model may say in a turn under a profile, and what its reply comes to."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Annotated, Any, ClassVar

from pydantic import ConfigDict, Field

from adamo_vh.action import ToolSchema, tool_schema
from adamo_vh.cognition.profile import Profile
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
    noted, can_finish = profile.note_argument, profile.finish_check
    calls = reply.message.calls
    return Turn(reply, tuple(Wish.of(c, noted=noted, can_finish=can_finish) for c in calls))
