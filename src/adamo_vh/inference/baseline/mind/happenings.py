"""What a call and its feedback change in what is known."""

from __future__ import annotations

import math
import re
from dataclasses import replace

from adamo_vh.geometry import Vec3
from adamo_vh.inference.baseline.language.plan import Plan, Relation
from adamo_vh.inference.baseline.mind.evidence import anchor_of, claim
from adamo_vh.inference.baseline.mind.memory import Job, Memory, Move, Search, Status
from adamo_vh.inference.baseline.mind.placing import place_words
from adamo_vh.inference.baseline.prompt.reading import Event, Prompt, Room, first_point
from adamo_vh.inference.baseline.prompt.state_text import Body

MAX_TRIES = 5
"""Failed picks and drops of one thing, after which it is given up."""
_FEW_TRIES = 2
"""The same for a place that allows of no other."""
FAR_M = 2.6
"""From farther away, small things and looks are not told reliably."""
NEARBY_M = 1.3
"""What is in doubt is looked at from no farther than this, or from as near as one gets."""
_SAME_PLACE_M = 0.3
_EDGE_M = 0.3
_RESTS = re.compile(r"rests at (\([^)]*\)),? ((?:on|in|under|inside|at) .+?)(?:[,;]|\.?$|\. )")


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
    elif event.name == "Walk":
        memory.walked = event.text


def _count(search: Search, event: Event, memory: Memory) -> None:
    match search:
        case Search.ROUND:
            memory.views += 1
        case Search.ASIDE:
            memory.aside += 1
        case Search.ACT:
            memory.acts += 1
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
            memory.seen_m[tag] = min(memory.seen_m[tag], NEARBY_M)


def _picked(event: Event, refused: bool, memory: Memory) -> None:
    if not refused or "already in your hand" in event.text:
        taken(event, memory)
        return
    memory.refusals[event.tag] = event.text
    if holds := re.search(r"holds ([^\s;.,]+)", event.text):
        memory.hand = holds.group(1)
    count_try(event.tag, memory)


def taken(event: Event, memory: Memory) -> None:
    """Take in that a thing is in the hand."""
    tag = event.tag
    memory.hand = tag
    memory.rests.pop(tag, None)
    memory.edges.pop(tag, None)
    thing = memory.things.get(tag)
    origin = event.origin or (thing.position if thing else None)
    if origin is not None:
        memory.came_from.setdefault(tag, origin)


def _dropped(event: Event, refused: bool, memory: Memory, plan: Plan, room: Room) -> None:
    tag = event.tag
    if refused:
        if "hand is empty" in event.text:
            memory.hand = ""
        memory.refusals[tag] = event.text
        if aim := _wish(event):
            memory.aims.append(aim)
        count_try(tag, memory)
        return
    memory.hand = ""
    came_to_rest(event, memory)
    job = current_job(tag, memory)
    if tag not in memory.rests or job is None or job.goal >= len(plan.goals):
        count_try(tag, memory)
        return
    goal = plan.goals[job.goal]
    if goal.relation is Relation.EDGE:
        _beyond_edge(event, memory)
    if claim(goal, job.goal, tag, memory, room):
        memory.set_job(replace(job, status=Status.DONE))
    elif goal.relation in (Relation.HOME, Relation.SHIFT):
        count_try(tag, memory, _FEW_TRIES)
    else:
        # A thing on the wrong furniture is put back in the end.
        count_try(tag, memory, MAX_TRIES + (goal.relation is Relation.SURFACE))


def came_to_rest(event: Event, memory: Memory) -> None:
    """Take in where a thing rests, and on what, as the feedback tells."""
    found = _RESTS.search(event.text)
    place = first_point(found[1]) if found else None
    if found is None or place is None:
        memory.rests.pop(event.tag, None)
        return
    if aim := _wish(event):
        memory.aims.append(aim)
    memory.rests[event.tag] = found[2].strip()
    memory.supports.append((place, found[2].strip()))
    thing = memory.things.get(event.tag)
    if thing is not None:
        memory.things[event.tag] = replace(thing, position=place)


def _beyond_edge(event: Event, memory: Memory) -> None:
    """A point beyond the edge was corrected: how far is the thing from there?"""
    wish, thing = _wish(event), memory.things.get(event.tag)
    if wish is None or thing is None or event.outcome != "corrected":
        return
    off = wish.horizontal_distance(thing.position)
    if off <= _EDGE_M:
        memory.edges[event.tag] = round(off, 2)


def current_job(tag: str, memory: Memory) -> Job | None:
    """The first open job of a thing."""
    return next((j for j in memory.jobs if j.tag == tag and j.status is Status.TODO), None)


def count_try(tag: str, memory: Memory, most: int = MAX_TRIES) -> None:
    """A pick or a drop was in vain; after some, the job is given up."""
    job = current_job(tag, memory)
    if job is None:
        return
    tries = job.tries + 1
    status = Status.FAILED if tries >= most else Status.TODO
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
    event = Event(move.name, dict(move.arguments), _feedback(move, memory, plan), (), move.origin)
    happened(event, move.search, after, plan, prompt.room)
    body = replace(_moved(prompt.body, move), hand=after.hand or "empty")
    return replace(prompt, body=body, event=event, fresh=False), after


def _feedback(move: Move, memory: Memory, plan: Plan) -> str:
    if move.name != "Drop" or move.point is None:
        return f"Done: {move.tag}."
    thing = memory.things.get(move.tag)
    height = thing.height_m if thing else 0.1
    rest = move.point + Vec3(0.0, 0.0, height / 2)
    return f"Done: {move.tag} rests at {rest} {_support(move, memory, plan)}."


def _support(move: Move, memory: Memory, plan: Plan) -> str:
    """What feedback would name if all goes as wished."""
    job = current_job(move.tag, memory)
    goal = plan.goals[job.goal] if job and job.goal < len(plan.goals) else None
    if goal and goal.relation is Relation.SURFACE:
        return f"on the {goal.furniture}"
    assert move.point is not None
    words = place_words(move.point)
    near = anchor_of(job.goal, memory) if job else None
    return memory.rests.get(near.tag, words) if near and words != "on the floor" else words


def _moved(body: Body, move: Move) -> Body:
    here, point = body.position, move.point
    if move.name == "Walk" and point is not None:
        heading = math.atan2(point.y - here.y, point.x - here.x)
        return replace(body, position=Vec3(point.x, point.y, 0.0), heading_rad=heading)
    if move.name == "Look" and point is not None:
        heading = math.atan2(point.y - here.y, point.x - here.x)
        return replace(body, heading_rad=heading, gaze=point)
    return body  # where it will stand to pick or drop is up to the body
