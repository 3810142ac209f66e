"""What a call and its feedback change in what is known."""

from __future__ import annotations

import re
from dataclasses import replace

from adamo_vh.geometry import Vec3
from adamo_vh.inference.baseline.goals import Plan
from adamo_vh.inference.baseline.memory import Job, Memory, Search, Status, Thing
from adamo_vh.inference.baseline.placing import place_reached
from adamo_vh.inference.baseline.reading import Event, Room

MAX_TRIES = 4
"""Failed picks and drops of one thing, after which it is given up."""
FAR_M = 2.6
"""From farther away, small things and looks are not told reliably."""
_SAME_PLACE_M = 0.3


def happened(event: Event, search: Search, memory: Memory, plan: Plan, room: Room) -> None:
    """Take in one call.

    Args:
        event: The call and its feedback.
        search: What the call did for the search.
        memory: Is changed.
        plan: What the instruction asks for.
        room: Where the corners are.
    """
    if not event.executed:
        if event.pictures and event.tag:
            memory.inspected.add(event.tag)
        return
    _count(search, event, memory)
    refused = event.outcome not in ("done", "corrected")
    if event.name == "Pick":
        _picked(event, refused, memory)
    elif event.name == "Drop":
        _dropped(event, refused, memory, plan, room)
    elif event.name == "Inspect":
        memory.inspected.add(event.tag)


def _count(search: Search, event: Event, memory: Memory) -> None:
    match search:
        case Search.ROUND:
            memory.views += 1
        case Search.ASIDE:
            memory.aside += 1
        case Search.APPROACH:
            memory.visits += 1
        case Search.NEARER:
            memory.visits += 2 - memory.visits % 2
            if wish := _wish(event):
                _seen_nearby(wish, memory)


def _wish(event: Event) -> Vec3 | None:
    try:
        return Vec3.of([float(event.arguments[axis]) for axis in "xyz"])
    except (KeyError, TypeError, ValueError):
        return None


def _seen_nearby(place: Vec3, memory: Memory) -> None:
    """Looked at once from as near as one gets, it counts as seen, even if it is hidden there."""
    for tag, thing in memory.things.items():
        if thing.position.horizontal_distance(place) < _SAME_PLACE_M and tag in memory.seen_m:
            memory.seen_m[tag] = min(memory.seen_m[tag], FAR_M)


def _picked(event: Event, refused: bool, memory: Memory) -> None:
    if not refused or "already in your hand" in event.text:
        memory.hand = event.tag
        return
    if holds := re.search(r"holds ([^\s;.,]+)", event.text):
        memory.hand = holds.group(1)
    count_try(event.tag, memory)


def _dropped(event: Event, refused: bool, memory: Memory, plan: Plan, room: Room) -> None:
    tag = event.tag
    if refused:
        if "hand is empty" in event.text:
            memory.hand = ""
        count_try(tag, memory)
        return
    memory.hand = ""
    thing, rest = memory.things.get(tag), event.point
    if thing is None or rest is None:
        count_try(tag, memory)
        return
    moved = replace(thing, position=rest)
    memory.things[tag] = moved
    job = current_job(tag, memory)
    if job is None or job.goal >= len(plan.goals):
        return
    on_floor = "floor" in event.text.split("rests")[-1]
    relation = plan.goals[job.goal].relation
    if place_reached(relation, moved, anchor_of(job.goal, memory), room, on_floor):
        memory.set_job(replace(job, status=Status.DONE))
    else:
        count_try(tag, memory)


def current_job(tag: str, memory: Memory) -> Job | None:
    """The first open job of a thing."""
    return next((j for j in memory.jobs if j.tag == tag and j.status is Status.TODO), None)


def anchor_of(goal: int, memory: Memory) -> Thing | None:
    """The thing that the targets of a goal shall be near, if it is known."""
    targets = {job.tag for job in memory.jobs if job.goal == goal}
    fits = memory.fits.get(("place", goal), {})
    known = [(fit, tag) for tag, fit in fits.items() if tag not in targets and tag in memory.things]
    return memory.things[max(known)[1]] if known else None


def count_try(tag: str, memory: Memory) -> None:
    """A pick or a drop was in vain; after some, the job is given up."""
    job = current_job(tag, memory)
    if job is None:
        return
    tries = job.tries + 1
    status = Status.FAILED if tries >= MAX_TRIES else Status.TODO
    memory.set_job(replace(job, tries=tries, status=status))
