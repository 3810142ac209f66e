"""Whether the agent could see an object: in each of its views, from the truth of that moment."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from adamo_vh.analysis.diagnosis.finding import Evidence
from adamo_vh.analysis.diagnosis.story import Moment, Story
from adamo_vh.engine import (
    FLOOR,
    FurnitureOutline,
    ObjectState,
    acting_body,
    supporting_object,
)
from adamo_vh.geometry import Box, Camera, Vec3, wrap_angle
from adamo_vh.record.trajectory import Observed

_BEHIND_M = 0.04
"""What a ray meets this far before an object hides it."""
_MOST_VIEWS = 12
"""Views in which an object is looked for that was listed in none."""


@dataclass(frozen=True, slots=True)
class Glimpse:
    """An object in one view."""

    view: Observed
    moment: Moment
    """The world then."""
    pixels: int
    """How many show it; 0 if it was not listed."""
    box_px: tuple[int, int, int, int] | None
    """Around these pixels, or where it would be if nothing hid it; None if it is not in there."""


def glimpses(story: Story, object_id: int) -> tuple[Glimpse, ...]:
    """An object in every view, in order."""
    found = []
    for view in story.views:
        moment = max((m for m in story.moments if m.step <= view.step), key=lambda m: m.step)
        listed = (i for i in view.objects if story.tagger.resolve(i.tag, story.names) == object_id)
        item = next(listed, None)
        if item is not None:
            found.append(Glimpse(view, moment, item.pixels, item.box_px))
        else:
            found.append(Glimpse(view, moment, 0, _box_px(story, view, moment.object(object_id))))
    return tuple(found)


def best_glimpse(story: Story, object_id: int) -> Glimpse | None:
    """The view that shows most of an object; None if none lists it."""
    listed = [glimpse for glimpse in glimpses(story, object_id) if glimpse.pixels]
    return max(listed, key=lambda glimpse: glimpse.pixels, default=None)


def sight_of(story: Story, object_id: int) -> Evidence:
    """What the agent could see of an object, in a sentence, with the best picture of it."""
    name, seen = story.name(object_id), glimpses(story, object_id)
    listed = [glimpse for glimpse in seen if glimpse.pixels]
    if listed:
        best = max(listed, key=lambda glimpse: glimpse.pixels)
        text = (
            f"{name} was listed in {len(listed)} of {len(seen)} views, first "
            f"{_when(listed[0].view.step)}; the best one shows it with {best.pixels} pixels."
        )
        return Evidence(best.view.step, text, best.view.frame, best.box_px)
    inside = [glimpse for glimpse in seen[:_MOST_VIEWS] if glimpse.box_px is not None]
    where = _whereabouts(story, object_id)
    if inside:
        chosen = inside[0]
        blocker = _hidden_by(story, chosen, object_id)
        why = f"hidden by {blocker}" if blocker else "too small to be listed"
        text = (
            f"{name} was listed in no view. {where} It was inside the frame "
            f"{_when(chosen.view.step)}, {why}."
        )
        return Evidence(chosen.view.step, text, chosen.view.frame, chosen.box_px)
    count = "the only view" if len(seen) == 1 else f"any of {len(seen)} views"
    text = f"{name} was listed in no view, and never inside the frame of {count}. {where}"
    frame = seen[-1].view.frame if seen else ""
    return Evidence(seen[-1].view.step if seen else 0, text, frame)


def _when(step: int) -> str:
    return f"after step {step}" if step else "at the start"


def _camera(story: Story, view: Observed) -> Camera:
    """The eyes of a view."""
    fov = acting_body(story.world).info.fov_y_rad
    size, agent = (view.width_px, view.height_px), view.agent
    return Camera.towards(agent.eyes, agent.gaze, fov, size, agent.heading_rad)


def _box_px(
    story: Story, view: Observed, item: ObjectState | None
) -> tuple[int, int, int, int] | None:
    """Where an object would be in a view, if nothing hid it."""
    if item is None:
        return None
    points = _camera(story, view).project(item.box.corners())
    if (points[:, 2] <= 0).any():
        return None
    (left, top), (right, bottom) = points[:, :2].min(axis=0), points[:, :2].max(axis=0)
    middle_x, middle_y = (left + right) / 2, (top + bottom) / 2
    if not (0 <= middle_x < view.width_px and 0 <= middle_y < view.height_px):
        return None
    return (
        max(0, math.floor(left)),
        max(0, math.floor(top)),
        min(view.width_px, math.ceil(right)),
        min(view.height_px, math.ceil(bottom)),
    )


def _hidden_by(story: Story, glimpse: Glimpse, object_id: int) -> str:
    """What most of the lines to an object meet first; empty if they meet itself."""
    moment, eyes = glimpse.moment, glimpse.view.agent.eyes
    item = moment.object(object_id)
    if item is None:
        return ""
    story.put_back(moment)
    points = np.concatenate([item.box.corners(), [item.box.center.array()]])
    lines = points - eyes.array()
    far = np.linalg.norm(lines, axis=1)
    hits = acting_body(story.world).rays(eyes, lines / far[:, None])
    met = [
        _thing_at(moment, hit, object_id, story)
        for hit, distance in zip(hits, far, strict=True)
        if hit is not None and hit.distance(eyes) < distance - item.box.radius_m - _BEHIND_M
    ]
    return max(sorted(set(met)), key=met.count) if len(met) > len(points) / 2 else ""


def _thing_at(moment: Moment, point: Vec3, but: int, story: Story) -> str:
    """What is at a point that a ray met."""
    for item in moment.state.objects:
        if item.id != but and _is_in(item.box, point):
            return story.name(item.id)
    for piece in moment.state.furniture:
        if piece.bottom_m - 0.02 <= point.z <= piece.top_m + 0.02 and _is_over(piece, point):
            return f"the {piece.name}"
    return "something else"


def _is_in(box: Box, point: Vec3) -> bool:
    local = (point - box.center).array() @ box.orientation.matrix()
    return bool((np.abs(local) <= box.size.array() / 2 + 0.01).all())


def _is_over(piece: FurnitureOutline, point: Vec3) -> bool:
    corners = np.array(piece.points)
    if len(corners) < 3:
        return False
    edges = np.roll(corners, -1, axis=0) - corners
    offset = np.array([point.x, point.y]) - corners
    return bool((edges[:, 0] * offset[:, 1] - edges[:, 1] * offset[:, 0] >= -0.02).all())


def _whereabouts(story: Story, object_id: int) -> str:
    """Where an object was, and in which direction from the agent at the start."""
    item = story.moments[0].object(object_id)
    if item is None:
        return "It was not in the room at the start."
    body = story.start.body
    angle = math.atan2(item.box.center.y - body.position.y, item.box.center.x - body.position.x)
    turn = math.degrees(wrap_angle(angle - body.heading_rad))
    if abs(turn) <= 30:
        side = "ahead of the agent"
    elif abs(turn) >= 150:
        side = "behind the agent"
    else:
        side = f"{abs(turn):.0f} degrees to the {'left' if turn > 0 else 'right'} of the agent"
    return f"At the start it was {on_text(item, story)}, {side}."


def on_text(item: ObjectState, story: Story) -> str:
    """What an object rests on, in words."""
    if item.held:
        return "in the hand"
    if item.support is None:
        return "in the air"
    below = supporting_object(item.support)
    if below is not None:
        return f"on {story.name(below)}"
    if item.support == FLOOR:
        return "on the floor"
    name, _, level = item.support.partition("/")
    return f"on the {name} ({level})" if level else f"on the {name}"
