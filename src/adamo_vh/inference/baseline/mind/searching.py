"""Looking for things: round the room from where the body stands, then from other places."""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import IntEnum

from adamo_vh.geometry import Vec3
from adamo_vh.inference.baseline.language.plan import Act
from adamo_vh.inference.baseline.mind.happenings import FAR_M, NEARBY_M
from adamo_vh.inference.baseline.mind.memory import Memory, Search, Thing
from adamo_vh.inference.baseline.prompt.reading import Prompt, Room

SURVEY = 3
"""Steps of the first round: with the first frame they show the whole circle."""
_MOST_VISITS = 14
"""Steps at most to see far things from nearby."""
_LOOKS = 4
"""Views that make a full circle, each a quarter turn on."""
_MOVED_M = 0.3
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


class Stage(IntEnum):
    """How thoroughly the room was searched."""

    BEGUN = 0
    ROUND = 1
    """Looked all round from the start; some things were seen from afar only."""
    CLOSE = 2
    """All that was seen was seen from nearby."""
    OVER = 3
    """Looked from everywhere."""


@dataclass(frozen=True, slots=True)
class SearchStep:
    """A step of the search."""

    name: str
    """"Look" or "Walk"."""
    point: Vec3
    search: Search


def stage(prompt: Prompt, memory: Memory) -> Stage:
    """How far the search is."""
    if memory.views < SURVEY:
        return Stage.BEGUN
    if _far_thing(prompt, memory):
        return Stage.ROUND
    steps = SURVEY + len(places(prompt.room)) * (1 + _LOOKS)
    return Stage.CLOSE if memory.views < steps else Stage.OVER


def next_step(prompt: Prompt, memory: Memory) -> SearchStep:
    """The next step of the search.

    Args:
        prompt: For the room and the body.
        memory: How far the search is; not over yet.
    """
    if memory.views >= SURVEY and (thing := _far_thing(prompt, memory)):
        return _go_closer(prompt, memory, thing)
    at, step = (0, 1) if memory.views < SURVEY else divmod(memory.views - SURVEY, 1 + _LOOKS)
    if step == 0:
        return SearchStep("Walk", places(prompt.room)[at], Search.ROUND)
    body = prompt.body.position
    yaw = _heading(prompt) + math.pi / 2
    ahead = Vec3(
        body.x + _GAZE_AHEAD_M * math.cos(yaw), body.y + _GAZE_AHEAD_M * math.sin(yaw), _GAZE_Z_M
    )
    return SearchStep("Look", _into_room(prompt.room, body, ahead), Search.ROUND)


def aim(act: Act, prompt: Prompt, memory: Memory) -> Vec3 | None:
    """The point to look at or to walk to for an act without a target.

    Args:
        act: With a direction.
        prompt: For the room and the body.
        memory: For where the body stood before.
    """
    body, room = prompt.body.position, prompt.room
    if act.direction == "start":
        begun = memory.began
        moved = begun and body.horizontal_distance(begun.position) > _MOVED_M
        stand = begun if moved else memory.home
        return stand.position if stand else None
    if act.direction == "middle":
        return places(room)[0]
    if act.direction == "corner":
        return min(room.corners(), key=body.horizontal_distance)
    turns = {"left": 90, "right": -90, "back": 180, "round": 120, "up": 0, "down": 0, "ahead": 0}
    yaw = _heading(prompt) + math.radians(turns.get(act.direction, 0))
    far = act.distance_m if act.name == "walk" else _GAZE_AHEAD_M
    ahead = Vec3(body.x + far * math.cos(yaw), body.y + far * math.sin(yaw), _GAZE_Z_M)
    if act.name == "walk":
        return room.clamp(Vec3(ahead.x, ahead.y, 0.0), 0.3)
    point = _into_room(room, body, ahead)
    height = {"up": 2.4, "down": 0.0}.get(act.direction)
    return point if height is None else Vec3(point.x, point.y, height)


def _far_thing(prompt: Prompt, memory: Memory) -> Thing | None:
    """The nearest of the things that were seen from too far."""
    if memory.visits >= _MOST_VISITS:
        return None
    here = prompt.body.position
    far = [t for t in memory.things.values() if memory.seen_m.get(t.tag, 0.0) > _need_m(t, memory)]
    return min(far, key=lambda t: (here.horizontal_distance(t.position), t.tag), default=None)


def _need_m(thing: Thing, memory: Memory) -> float:
    """From how near a thing must be seen."""
    return NEARBY_M if thing.tag in memory.in_doubt else FAR_M


def _go_closer(prompt: Prompt, memory: Memory, thing: Thing) -> SearchStep:
    # An odd count of visits means that the last one was a walk, which has come as near as it can.
    came = memory.visits % 2 == 1
    apart = prompt.body.position.horizontal_distance(thing.position)
    if came or apart < _need_m(thing, memory):
        return SearchStep("Look", thing.position, Search.NEARER)
    place = Vec3(thing.position.x, thing.position.y, 0.0)
    return SearchStep("Walk", place, Search.APPROACH)


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
