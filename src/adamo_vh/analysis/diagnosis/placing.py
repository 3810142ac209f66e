"""What is wrong with where an object was put: the one place that knows each kind of condition."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from adamo_vh.action import Outcome
from adamo_vh.analysis.diagnosis.cause import Cause
from adamo_vh.analysis.diagnosis.finding import Code
from adamo_vh.analysis.diagnosis.sight import on_text
from adamo_vh.analysis.diagnosis.story import Putting, Story
from adamo_vh.benchmark.conditions import NEAR_M, Aim, Beside, Holds, InArea, Near, OnFloor
from adamo_vh.engine import FLOOR, ObjectState
from adamo_vh.geometry import Solid, gaps

_BESIDE_M = 0.08
"""Two things with no more than this between them lie beside each other."""
_ELSEWHERE = 2.0
"""So many times the limit away from its anchor, a thing beside another one was put to that one."""


def misplaced(story: Story, condition: Aim, putting: Putting) -> Cause:
    """Why a condition is not met by where its object was put last."""
    item, step = putting.item, putting.step
    name, place = story.name(item.id), on_text(item, story)
    match condition:
        case Near(anchor=anchor):
            return _not_near(story, condition, putting, anchor)
        case InArea(kind=kind) if item.support == FLOOR:
            away = _from_area_m(story, item, kind)
            text = f"{name} was put on the floor, {away:.2f} m outside the nearest {kind} area."
            return Cause(Code.OUTSIDE_AREA, step, text, item.id)
        case InArea() | OnFloor():
            text = f"{name} was put {place}, and was to be on the floor."
            return Cause(Code.WRONG_SUPPORT, step, text, item.id)
        case Holds():
            text = f"{name} was put {place}, and was to stay in the hand."
            return Cause(Code.EXTRA_GOAL, step, text, item.id)
    text = f"{name} was put {place}, which is not as asked ({condition})."
    return Cause(Code.WRONG_SUPPORT, step, text, item.id)


def _not_near(story: Story, condition: Near, putting: Putting, anchor_id: int) -> Cause:
    """Too far from its anchor, on another surface, or beside something else."""
    item, moment = putting.item, story.moments[putting.moment]
    anchor, name = moment.object(anchor_id), story.name(item.id)
    if anchor is None:
        text = f"{story.name(anchor_id)}, beside which {name} was to be, was not in the room."
        return Cause(Code.TOO_FAR, putting.step, text, item.id)
    away = item.box.center.horizontal_distance(anchor.box.center)
    same = item.support == anchor.support
    other = _taken_for_anchor(story, putting, anchor, away, same=same)
    if other is not None:
        text = (
            f"{name} was put beside {story.name(other)}, and was to be near "
            f"{story.name(anchor_id)}, which is {away:.2f} m away."
        )
        return Cause(Code.WRONG_ANCHOR, putting.step, text, anchor_id, other)
    if same:
        text = (
            f"{name} was put {away:.2f} m from {story.name(anchor_id)}; near is {NEAR_M:g} m at "
            f"most.{_correction(putting, anchor)}"
        )
        return Cause(Code.TOO_FAR, putting.step, text, item.id)
    text = (
        f"{name} was put {on_text(item, story)}, while {story.name(anchor_id)} is "
        f"{on_text(anchor, story)}; near is on the same surface.{_correction(putting, anchor)}"
    )
    return Cause(Code.WRONG_SUPPORT, putting.step, text, item.id)


def _taken_for_anchor(
    story: Story, putting: Putting, anchor: ObjectState, away_m: float, *, same: bool
) -> int | None:
    """The object to which a thing was put in place of its anchor; None if it was only put badly.

    It lies beside that object, and either the agent spoke of it and not of the anchor, or it is of
    the anchor's class, or the anchor is somewhere else altogether.
    """
    item, moment = putting.item, story.moments[putting.moment]
    beside = [
        other
        for other in moment.state.objects
        if other.id not in (item.id, anchor.id)
        and other.support == item.support
        and other.box.center.horizontal_distance(item.box.center) <= NEAR_M
    ]
    beside.sort(key=lambda other: _gap_m(item, other))
    note = story.note(putting.step)
    for other in beside:
        spoken = story.names_object(note, other.id) and not story.names_object(note, anchor.id)
        if spoken or other.class_name == anchor.class_name:
            return other.id
    if beside and _gap_m(item, beside[0]) <= _BESIDE_M and item.support != FLOOR:
        is_elsewhere = away_m > _ELSEWHERE * NEAR_M if same else True
        if is_elsewhere and not story.names_object(note, anchor.id):
            return beside[0].id
    return None


def _correction(putting: Putting, anchor: ObjectState) -> str:
    """What the body made of a wish that was close enough, where it put the thing elsewhere."""
    aim = putting.aim
    if putting.act.feedback.outcome is not Outcome.CORRECTED or aim is None:
        return ""
    asked = aim.horizontal_distance(anchor.box.center)
    if asked > NEAR_M:
        return ""
    moved = aim.horizontal_distance(putting.item.box.center)
    return (
        f" It was aimed {asked:.2f} m from it, where there was no free spot, and was put "
        f"{moved:.2f} m from there."
    )


def _gap_m(one: ObjectState, other: ObjectState) -> float:
    """Free distance between two things seen from above."""
    center = np.array([[one.box.center.x, one.box.center.y]])
    return float(gaps(center, Solid.around(one.box), [Solid.around(other.box)])[0])


def _from_area_m(story: Story, item: ObjectState, kind: str) -> float:
    """How far a thing is from the nearest area of a kind."""
    solid = Solid.around(item.box)
    distances = []
    for area in story.start.scene.areas:
        if area.kind == kind:
            x = min(max(item.box.center.x, area.x_min), area.x_max)
            y = min(max(item.box.center.y, area.y_min), area.y_max)
            distances.append(float(solid.distance(np.array([[x, y]]))[0]))
    return min(distances, default=float("inf"))


def with_object(condition: Aim, object_id: int) -> Aim:
    """The same condition of another object."""
    return replace(condition, id=object_id)


def anchor_of(condition: Aim) -> int | None:
    """The object that a condition is relative to; None if there is none."""
    return condition.anchor if isinstance(condition, Near | Beside) else None
