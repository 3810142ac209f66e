"""Looking for things: round the room from where the body stands, then from other places."""

from __future__ import annotations

import math

from adamo.geometry import Vec3
from adamo.inference.baseline.reading import Prompt, Room

SURVEY = 3
"""Steps of the first round: with the first frame they show the whole circle."""
_LOOKS = 4
"""Views that make a full circle, each a quarter turn on."""
_GAZE_Z_M = 1.0
_GAZE_AHEAD_M = 2.0


def places(room: Room) -> tuple[Vec3, ...]:
    """Where to look from after the first round: the middle of the room, then its quarters."""
    x, y = (room.x_min + room.x_max) / 2, (room.y_min + room.y_max) / 2
    dx, dy = (room.x_max - room.x_min) / 4, (room.y_max - room.y_min) / 4
    return (
        Vec3(x, y, 0.0),
        Vec3(x + dx, y + dy, 0.0),
        Vec3(x + dx, y - dy, 0.0),
        Vec3(x - dx, y - dy, 0.0),
        Vec3(x - dx, y + dy, 0.0),
    )


def is_over(room: Room, views: int) -> bool:
    """Whether everything was looked at from everywhere."""
    return views >= SURVEY + len(places(room)) * (1 + _LOOKS)


def next_step(prompt: Prompt, views: int) -> tuple[str, Vec3]:
    """The next step of the search.

    Args:
        prompt: For the room and the body.
        views: Steps made so far; fewer than `is_over` asks for.

    Returns:
        "Look" or "Walk", and the point.
    """
    at, step = (0, 1) if views < SURVEY else divmod(views - SURVEY, 1 + _LOOKS)
    if step == 0:
        return "Walk", places(prompt.room)[at]
    body = prompt.body.position
    yaw = _heading(prompt) + math.pi / 2
    ahead = Vec3(
        body.x + _GAZE_AHEAD_M * math.cos(yaw), body.y + _GAZE_AHEAD_M * math.sin(yaw), _GAZE_Z_M
    )
    return "Look", _into_room(prompt.room, body, ahead)


def _heading(prompt: Prompt) -> float:
    """Where the body faces; where the text does not say, from the last look or the things seen."""
    body = prompt.body
    if body.heading_rad is not None:
        return body.heading_rad
    faced = None
    if prompt.event and prompt.event.name == "Look":
        faced = prompt.event.point
    if faced is None and prompt.points:
        n = len(prompt.points)
        faced = Vec3(sum(p.x for p in prompt.points) / n, sum(p.y for p in prompt.points) / n, 0.0)
    if faced is None:
        return 0.0
    return math.atan2(faced.y - body.position.y, faced.x - body.position.x)


def _into_room(room: Room, body: Vec3, point: Vec3) -> Vec3:
    """The point drawn towards the body until it is in the room; the direction stays."""
    shrink = 1.0
    for low, high, start, end in (
        (room.x_min, room.x_max, body.x, point.x),
        (room.y_min, room.y_max, body.y, point.y),
    ):
        span = end - start
        if end > high and span > 1e-9:
            shrink = min(shrink, (high - start) / span)
        elif end < low and span < -1e-9:
            shrink = min(shrink, (low - start) / span)
    shrink = max(shrink * 0.98, 0.05)
    # Closer points are looked at less steeply, so that the view stays the same.
    drop = (_GAZE_Z_M - 1.6) * shrink
    return Vec3(
        body.x + (point.x - body.x) * shrink, body.y + (point.y - body.y) * shrink, 1.6 + drop
    )
