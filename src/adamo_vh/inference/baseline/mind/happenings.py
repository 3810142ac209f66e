"""What a call and its feedback change in what is known."""

from __future__ import annotations

import math
import re
from dataclasses import replace

from adamo_vh.geometry import Vec3
from adamo_vh.inference.baseline.language.plan import Plan
from adamo_vh.inference.baseline.mind.memory import Job, Memory, Move, Search, Status, Thing
from adamo_vh.inference.baseline.mind.placing import place_reached, place_words
from adamo_vh.inference.baseline.prompt.reading import Event, Prompt, Room
from adamo_vh.inference.baseline.prompt.state_text import Body

MAX_TRIES = 5
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


def imagined(prompt: Prompt, memory: Memory, move: Move, plan: Plan) -> tuple[Prompt, Memory]:
    """Go on in thought.

    Args:
        prompt: Before the call.
        memory: Before the call; stays as it is.
        move: The call, taken to be done as wished.
        plan: What the instruction asks for.

    Returns:
        Prompt and memory after it.
    """
    after = memory.copy()
    event = Event(move.name, dict(move.arguments), _feedback(move, memory))
    happened(event, move.search, after, plan, prompt.room)
    body = replace(_moved(prompt.body, move), hand=after.hand or "empty")
    return replace(prompt, body=body, event=event, fresh=False), after


def _feedback(move: Move, memory: Memory) -> str:
    if move.name != "Drop" or move.point is None:
        return f"Done: {move.tag}."
    thing = memory.things.get(move.tag)
    height = thing.height_m if thing else 0.1
    rest = move.point + Vec3(0.0, 0.0, height / 2)
    return f"Done: {move.tag} rests at {rest} {place_words(move.point)}."


def _moved(body: Body, move: Move) -> Body:
    here, point = body.position, move.point
    if move.name == "Walk" and point is not None:
        heading = math.atan2(point.y - here.y, point.x - here.x)
        return replace(body, position=Vec3(point.x, point.y, 0.0), heading_rad=heading)
    if move.name == "Look" and point is not None:
        heading = math.atan2(point.y - here.y, point.x - here.x)
        return replace(body, heading_rad=heading, gaze=point)
    return body  # where it will stand to pick or drop is up to the body
