"""The tools: each pairs an action type with what carries it out. New ones are added here.

A tool from outside the package is the same pair, handed to the server::

    @dataclass(frozen=True, slots=True)
    class Wave:
        '''Wave with the free hand.'''

    def wave(context: ToolContext, action: Wave) -> Feedback: ...

    LocalActionServer(world, tools=(*PAPER_TOOLS, Tool(Wave, wave)))
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Protocol

from adamo_vh.action import Code, Drop, Feedback, Inspect, Look, Pick, Survey, Walk
from adamo_vh.action_server import feedback
from adamo_vh.engine import FLOOR, Body, SceneInfo, supporting_object
from adamo_vh.errors import InvalidActionError
from adamo_vh.geometry import Vec3

OUTSIDE_M = 0.5
"""A point up to this far outside the room means the nearest one inside: models aim a little below
the floor or behind a wall."""


class ToolContext(Protocol):
    """What a tool may use: the body, and the tags that the agent knows; never the whole truth."""

    @property
    def body(self) -> Body:
        """What acts and senses."""
        ...

    @property
    def scene(self) -> SceneInfo:
        """The room's public facts."""
        ...

    def tag(self, object_id: int) -> str:
        """The tag of an object."""
        ...

    def seen_object(self, tag: str) -> int:
        """The object that a tag means.

        Raises:
            InvalidActionError: No object with this tag was seen so far.
        """
        ...

    def show_closeup(self, object_id: int) -> bool:
        """Show an object close up; False if it is neither in view now nor in the hand."""
        ...

    def show_sheet(self) -> tuple[str, ...]:
        """Show all objects in view on one sheet; their tags in order, none if there is none."""
        ...


@dataclass(frozen=True, slots=True)
class Tool:
    """One primitive of the body."""

    action_type: type
    """Frozen dataclass: its name, docstring and fields are the tool schema."""
    execute: Callable[[ToolContext, Any], Feedback]
    """Carries an action of this type out; an `InvalidActionError` from it becomes feedback."""


def inside(context: ToolContext, x: float, y: float, z: float) -> Vec3:
    """The point of the room that is nearest to one that is in it, or a little outside.

    Raises:
        InvalidActionError: It is far outside.
    """
    scene, asked = context.scene, Vec3(x, y, z)
    point = scene.nearest(asked)
    if point.distance(asked) > OUTSIDE_M:
        raise InvalidActionError(
            Code.OUTSIDE_ROOM,
            f"{asked} is outside the room: x from {scene.x_min:g} to {scene.x_max:g}, "
            f"y from {scene.y_min:g} to {scene.y_max:g}, z from 0 to {scene.height_m:g}.",
        )
    return point


def look(context: ToolContext, action: Look) -> Feedback:
    """Turn body and gaze to a point."""
    point = inside(context, action.x, action.y, action.z)
    said = feedback.looked(context.body.look(point))
    return feedback.moved_inside(said, Vec3(action.x, action.y, action.z), point)


def walk(context: ToolContext, action: Walk) -> Feedback:
    """Walk to a point or the nearest reachable place."""
    point = inside(context, action.x, action.y, action.z)
    said = feedback.walked(context.body.walk(point), point)
    return feedback.moved_inside(said, Vec3(action.x, action.y, action.z), point)


def pick(context: ToolContext, action: Pick) -> Feedback:
    """Take a seen object."""
    object_id = context.seen_object(action.object)
    tag, held = context.tag(object_id), context.body.state().held
    if held == object_id:
        raise InvalidActionError(Code.HAND_FULL, f"{tag} is already in your hand.")
    if held is not None:
        raise InvalidActionError(
            Code.HAND_FULL, f"your hand already holds {context.tag(held)}; drop it first."
        )
    return feedback.picked(context.body.pick(object_id), tag)


def drop(context: ToolContext, action: Drop) -> Feedback:
    """Put the held object down."""
    held = context.body.state().held
    if held is None:
        raise InvalidActionError(Code.HAND_EMPTY, "your hand is empty; pick the object first.")
    if context.seen_object(action.object) != held:
        raise InvalidActionError(
            Code.NOT_HELD, f"{action.object} is not in your hand; it holds {context.tag(held)}."
        )
    point = inside(context, action.x, action.y, action.z)
    report = context.body.drop(point)
    support = _support(context, report.support)
    said = feedback.dropped(report, context.tag(held), point, support, context.body.info)
    return feedback.moved_inside(said, Vec3(action.x, action.y, action.z), point)


def inspect(context: ToolContext, action: Inspect) -> Feedback:
    """Show an object close up that is in view or in the hand."""
    object_id = context.seen_object(action.object)
    tag = context.tag(object_id)
    if not context.show_closeup(object_id):
        raise InvalidActionError(Code.NOT_IN_VIEW, f"{tag} is not in view now; look at it first.")
    return feedback.shown(f"{tag} close up")


def survey(context: ToolContext, action: Survey) -> Feedback:
    """Show all objects in view on one sheet."""
    tags = context.show_sheet()
    if not tags:
        raise InvalidActionError(Code.NOT_IN_VIEW, "no object is in view now; look round first.")
    return feedback.shown(f"sheet, row by row: {', '.join(tags)}")


def _support(context: ToolContext, support: str | None) -> str:
    if support is None:
        return "and does not rest on anything"
    below = supporting_object(support)
    if below is not None:
        return f"on {context.tag(below)}"
    if support == FLOOR:
        return "on the floor"
    name, _, level = support.partition("/")
    return f"on the {name} ({level})" if level else f"on the {name}"


PAPER_TOOLS: tuple[Tool, ...] = (
    Tool(Look, look),
    Tool(Walk, walk),
    Tool(Pick, pick),
    Tool(Drop, drop),
)
"""The paper's four primitives."""

INSPECT = Tool(Inspect, inspect)
SURVEY = Tool(Survey, survey)
LEAN_TOOLS: tuple[Tool, ...] = (*PAPER_TOOLS, INSPECT, SURVEY)
"""The paper's four, and two that show more of what is in view."""
