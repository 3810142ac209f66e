"""What may be claimed: where things are with respect to a wish, from feedback and lists alone.

A support is named in the words of the feedback, never in those of the instruction. Distances are
measured between the places that feedback and lists tell.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterable

from adamo_vh.geometry import Vec3
from adamo_vh.inference.baseline.language.plan import SIDES, Goal, Relation
from adamo_vh.inference.baseline.mind.memory import Memory, Stand, Thing
from adamo_vh.inference.baseline.prompt.reading import Room

LEVEL_M = 0.12
"""Things whose bottoms differ by less are taken to stand on the same surface."""
FAR_FROM_M = 1.0
"""Least distance of what is "far from" something."""
BESIDE_M = 0.5
"""Greatest distance of what is left of, behind ... something."""
_MARGIN_M = 0.005
"""Places are told to a centimetre."""
_BACK_M = 0.05
_SHIFT_OFF_M = 0.12
_SAME = {
    "couch": "sofa", "settee": "sofa", "bookshelf": "shelf", "bookcase": "shelf", "rack": "shelf",
    "shelves": "shelf", "tabletop": "table", "table top": "table", "carpet": "rug", "mat": "rug",
    "console table": "console", "end table": "side table", "chairs": "chair", "tables": "table",
    "windowsill": "window sill", "sill": "window sill",
}  # fmt: skip
_LIKE = ("bookshelf", "bookcase")
"""Words that a shelf may be meant by, and something else as well."""
TOP = ("top", "upper", "highest")
LOW = ("lower", "bottom", "lowest")


def named(furniture: str, support: str) -> bool:
    """Whether what feedback names is what was asked for.

    Args:
        furniture: The user's word, e.g. "table" or "top shelf".
        support: E.g. "on the coffee table (top)".
    """
    if "floor" in support:
        return False
    wanted = _SAME.get(furniture, furniture)
    found = re.sub(r"^(?:on|in|at) (?:the )?", "", support.lower())
    body, _, level = found.partition("(")
    body, level = re.sub(r"\s*\d+$", "", body.strip()), level.strip(" )")
    if wanted.startswith("top of the "):
        wanted = "top " + wanted.rsplit(" ", 1)[-1]
    words = wanted.split()
    if words[-1] == "surface" and len(words) == 1:
        return True
    if words[-1] != body.split()[-1]:
        return False
    return all(_qualifies(word, body, level) for word in words[:-1])


def taken_for(furniture: str, support: str) -> str:
    """What was taken for furniture that it is not surely; empty if it is what the word says.

    Args:
        furniture: The user's word, e.g. "bookcase".
        support: What feedback names, e.g. "on the tall shelf (middle)".
    """
    if furniture not in _LIKE or not support or not named(furniture, support):
        return ""
    return re.sub(r"^(?:on|in|at) ", "", support.lower()).partition(" (")[0]


def _qualifies(word: str, body: str, level: str) -> bool:
    """Whether a word before the noun is true of what feedback names."""
    for same in (TOP, LOW, ("middle",)):
        if word in same:
            return level in same
    return word in body.split()


def claim(goal: Goal, index: int, tag: str, memory: Memory, room: Room) -> str | None:
    """How a wish is fulfilled, in words that hold; None if it is not, as far as is known.

    Args:
        goal: The wish.
        index: Its place in the plan.
        tag: The thing.
        memory: What is known.
        room: Where the corners are, and what "near" means.
    """
    if goal.relation is Relation.HOLD:
        return f"I hold {tag}" if memory.hand == tag else None
    thing, rests = memory.things.get(tag), memory.rests.get(tag)
    if thing is None or rests is None or memory.hand == tag:
        return None
    where = f"{tag} rests {rests}"
    anchor = anchor_of(index, memory)
    on_floor = "floor" in rests
    if goal.relation in (Relation.FLOOR, Relation.CORNER, Relation.UNDER):
        return _on_floor(where, goal, thing, anchor, memory, room) if on_floor else None
    if goal.relation is Relation.SURFACE:
        return where if named(goal.furniture, rests) else None
    if goal.relation in (Relation.HOME, Relation.SHIFT):
        return _from_origin(where, goal, thing, memory)
    if goal.relation is Relation.EDGE:
        return _at_edge(where, tag, memory)
    return _by_anchor(where, goal, index, thing, anchor, memory, room)


def _on_floor(
    where: str, goal: Goal, thing: Thing, anchor: Thing | None, memory: Memory, room: Room
) -> str | None:
    if goal.relation is Relation.CORNER:
        return f"{where}, in a corner of the room" if _in_corner(thing, room) else None
    if goal.relation is Relation.UNDER:
        under = things_above(thing.position, memory, thing.tag)
        return f"{where}, below {_and(under)}, under what these stand on" if under else None
    return where if goal.anchor is None else _near(where, thing, anchor, room.near_m)


def _by_anchor(
    where: str,
    goal: Goal,
    index: int,
    thing: Thing,
    anchor: Thing | None,
    memory: Memory,
    room: Room,
) -> str | None:
    if anchor is None:
        return None
    distance = thing.position.horizontal_distance(anchor.position)
    if goal.relation is Relation.FAR:
        least = goal.distance_m or FAR_FROM_M
        return f"{where}, {distance:.2f} m from {anchor.tag}" if distance >= least else None
    if not same_surface(thing, anchor, memory):
        return None
    if goal.relation is Relation.NEAR:
        return _near(where, thing, anchor, room.near_m)
    if goal.relation is Relation.BETWEEN:
        return _between(where, thing, anchor, second_of(index, memory))
    if goal.relation in SIDES:
        most = BESIDE_M if goal.distance_m is None else goal.distance_m + _SHIFT_OFF_M
        least = 0.0 if goal.distance_m is None else goal.distance_m - _SHIFT_OFF_M
        if least <= distance <= most and side_of(thing, anchor, memory) is goal.relation:
            side = f"{_SIDE_WORDS[goal.relation]} {anchor.tag}"
            return f"{where}, {side} as seen from where I was told, {distance:.2f} m from it"
    return None


_SIDE_WORDS = {
    Relation.LEFT: "to the left of",
    Relation.RIGHT: "to the right of",
    Relation.FRONT: "in front of",
    Relation.BEHIND: "behind",
}


def _near(where: str, thing: Thing, anchor: Thing | None, near_m: float) -> str | None:
    if anchor is None:
        return None
    distance = thing.position.horizontal_distance(anchor.position)
    if distance > near_m - _MARGIN_M:
        return None
    return f"{where}, {distance:.2f} m from {anchor.tag}"


def _between(where: str, thing: Thing, one: Thing, other: Thing | None) -> str | None:
    if other is None:
        return None
    a, b, p = one.position, other.position, thing.position
    length = a.horizontal_distance(b)
    if length < 0.05:
        return None
    along = ((p.x - a.x) * (b.x - a.x) + (p.y - a.y) * (b.y - a.y)) / length
    aside = abs((p.x - a.x) * (b.y - a.y) - (p.y - a.y) * (b.x - a.x)) / length
    if not 0.15 < along / length < 0.85 or aside > max(0.08, length / 4):
        return None
    return f"{where}, between {one.tag} and {other.tag}"


def _from_origin(where: str, goal: Goal, thing: Thing, memory: Memory) -> str | None:
    origin = memory.came_from.get(thing.tag)
    if origin is None:
        return None
    moved = thing.position.horizontal_distance(origin)
    if goal.relation is Relation.HOME:
        if abs(thing.position.z - origin.z) > _BACK_M or moved > _BACK_M - _MARGIN_M:
            return None
        return f"{where}, {round(moved * 100)} cm from where it was before"
    wished = shifted(origin, goal.direction, goal.distance_m or 0.25, memory.began)
    if thing.position.horizontal_distance(wished) > _SHIFT_OFF_M:
        return None
    way = {"front": "further away", "back": "nearer"}.get(goal.direction)
    way = way or f"to the {goal.direction}"
    return f"{where}, {round(moved * 100)} cm {way} as seen from where I was told"


def _at_edge(where: str, tag: str, memory: Memory) -> str | None:
    off = memory.edges.get(tag)
    if off is None:
        return None
    return f"{where}, {round(off * 100)} cm from a point further out that was not free or supported"


def _in_corner(thing: Thing, room: Room) -> bool:
    half = room.corner_m / 2 - _MARGIN_M
    p = thing.position
    return any(abs(p.x - c.x) <= half and abs(p.y - c.y) <= half for c in room.corners())


def same_level(one: Thing, other: Thing) -> bool:
    """Whether two things seem to stand equally high."""
    return abs(one.bottom_z - other.bottom_z) < LEVEL_M


def same_surface(one: Thing, other: Thing, memory: Memory) -> bool:
    """Whether two things rest on the same surface, as far as is known."""
    rests = [memory.rests.get(thing.tag) for thing in (one, other)]
    if all(rests):
        return rests[0] == rests[1]
    return same_level(one, other)


def things_above(place: Vec3, memory: Memory, but: str = "") -> list[str]:
    """Things that stand on something above a place on the floor, close to it as seen from above."""
    found = [
        (thing.position.horizontal_distance(place), tag)
        for tag, thing in memory.things.items()
        if tag not in (but, memory.hand) and 0.3 < thing.bottom_z < 1.3
    ]
    return [tag for distance, tag in sorted(found) if distance <= 0.15][:2]


def axes(place: Vec3, viewer: Stand | None) -> tuple[tuple[float, float], tuple[float, float]]:
    """Away from the viewer and to the viewer's right, at a place; unit vectors on the floor."""
    if viewer is None:
        return (1.0, 0.0), (0.0, -1.0)
    dx, dy = place.x - viewer.position.x, place.y - viewer.position.y
    length = math.hypot(dx, dy)
    if length < 0.3:
        dx, dy, length = math.cos(viewer.heading_rad), math.sin(viewer.heading_rad), 1.0
    away = (dx / length, dy / length)
    return away, (away[1], -away[0])


def shifted(place: Vec3, direction: str, distance_m: float, viewer: Stand | None) -> Vec3:
    """A place some way to the viewer's left or right, away from the viewer or nearer."""
    away, right = axes(place, viewer)
    along, sign = {
        "right": (right, 1.0),
        "left": (right, -1.0),
        "front": (away, 1.0),
        "back": (away, -1.0),
    }.get(direction, (right, 1.0))
    step = sign * distance_m
    return Vec3(place.x + step * along[0], place.y + step * along[1], place.z)


def side_of(thing: Thing, anchor: Thing, memory: Memory) -> Relation:
    """On which side of another thing a thing is, as seen from where the instruction was given."""
    return side_seen(thing, anchor, memory.began)


def side_seen(thing: Thing, anchor: Thing, viewer: Stand | None) -> Relation:
    """On which side of another thing a thing is for a viewer."""
    away, right = axes(anchor.position, viewer)
    dx = thing.position.x - anchor.position.x
    dy = thing.position.y - anchor.position.y
    far, aside = dx * away[0] + dy * away[1], dx * right[0] + dy * right[1]
    if abs(aside) >= abs(far):
        return Relation.RIGHT if aside > 0 else Relation.LEFT
    return Relation.BEHIND if far > 0 else Relation.FRONT


def anchor_of(goal: int, memory: Memory, kind: str = "place") -> Thing | None:
    """The thing that the targets of a goal shall be near, if it is known."""
    targets = {job.tag for job in memory.jobs if job.goal == goal}
    fits = memory.fits.get((kind, goal), {})
    known = [(fit, tag) for tag, fit in fits.items() if tag not in targets and tag in memory.things]
    return memory.things[max(known)[1]] if known and max(known)[0] > 0.0 else None


def second_of(goal: int, memory: Memory) -> Thing | None:
    """The second thing of "between"."""
    first = anchor_of(goal, memory)
    targets = {job.tag for job in memory.jobs if job.goal == goal}
    fits = memory.fits.get(("second", goal), {})
    known = [
        (fit, tag)
        for tag, fit in fits.items()
        if tag not in targets and tag in memory.things and (first is None or tag != first.tag)
    ]
    return memory.things[max(known)[1]] if known and max(known)[0] > 0.0 else None


def _and(words: Iterable[str]) -> str:
    *most, last = words
    return f"{', '.join(most)} and {last}" if most else last
