"""What the model believes now: its last note, brought up to date with the newest prompt."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from dataclasses import replace

from adamo.inference.baseline.goals import Description, Plan, Relation
from adamo.inference.baseline.grounding import degree, remembered
from adamo.inference.baseline.memory import Job, Memory, Slot, Status, Thing, read
from adamo.inference.baseline.placing import place_reached
from adamo.inference.baseline.prototypes import class_of
from adamo.inference.baseline.reading import Event, Listed, Prompt
from adamo.inference.baseline.sight import Sight
from adamo.inference.baseline.vision import sights

MAX_TRIES = 4
"""Failed picks and drops of one thing, after which it is given up."""


def up_to_date(prompt: Prompt, plan: Plan) -> Memory:
    """Read the last note and add what happened and what is seen since.

    Args:
        prompt: The whole prompt.
        plan: What the instruction asks for.
    """
    memory = read(prompt.note)
    event = prompt.event
    if not prompt.note or (event and event.name == "Look" and event.outcome != "refused"):
        _see(prompt, plan, memory)
    else:
        _keep(prompt, memory)
    if event:
        _happened(event, prompt, plan, memory)
    if prompt.body.hand is not None:
        memory.hand = "" if prompt.body.hand == "empty" else prompt.body.hand
    return memory


def slots(plan: Plan) -> Iterable[tuple[Slot, Description]]:
    """All descriptions of a plan with their names."""
    for index, goal in enumerate(plan.goals):
        yield ("goal", index), goal.target
        if goal.anchor:
            yield ("place", index), goal.anchor


def _see(prompt: Prompt, plan: Plan, memory: Memory) -> None:
    """A new frame: its list replaces what was remembered of the same things."""
    looked_at = _sights(prompt, plan)
    for thing in memory.things.values():
        memory.things[thing.tag] = replace(thing, moved=False)
    before = dict(memory.things)
    for listed in prompt.things:
        memory.things[listed.tag] = _seen(prompt, listed, looked_at.get(listed.tag), before)
    everything = tuple(memory.things.values())
    for slot, description in slots(plan):
        fits = memory.fits.setdefault(slot, {})
        for listed in prompt.things:
            tag = listed.tag
            fit = degree(description, memory.things[tag], looked_at.get(tag), everything)
            closer = tag not in before or memory.things[tag].seen_m < 0.9 * before[tag].seen_m
            # The nearest view is believed; of equally near ones, the most favourable.
            fits[tag] = fit if closer else max(fit, fits.get(tag, 0.0))


def _seen(
    prompt: Prompt, listed: Listed, sight: Sight | None, before: Mapping[str, Thing]
) -> Thing:
    thing = remembered(listed, sight)
    distance = round(listed.position.horizontal_distance(prompt.body.position), 1)
    if known := before.get(listed.tag):
        distance = min(distance, known.seen_m)
    return replace(thing, seen_m=distance)


def _keep(prompt: Prompt, memory: Memory) -> None:
    """The frame is the one already seen: add the things that the note left to the list."""
    for listed in prompt.things:
        if listed.tag not in memory.things:
            memory.things[listed.tag] = remembered(listed, None)


def _sights(prompt: Prompt, plan: Plan) -> Mapping[str, Sight]:
    """Look at the pixels, if any description needs them."""
    needed = any(
        not description.ids
        and (description.by_looks or any(class_of(t.tag) is None for t in prompt.things))
        for _, description in slots(plan)
    )
    return sights(prompt) if needed else {}


def _happened(event: Event, prompt: Prompt, plan: Plan, memory: Memory) -> None:
    tag = str(event.arguments.get("object", ""))
    refused = event.outcome not in ("done", "corrected")
    if event.name == "Pick":
        _picked(event, tag, refused, memory)
    elif event.name == "Drop":
        _dropped(event, tag, refused, prompt, plan, memory)


def _picked(event: Event, tag: str, refused: bool, memory: Memory) -> None:
    if not refused or "already in your hand" in event.text:
        memory.hand = tag
        return
    if holds := re.search(r"holds ([^\s;.,]+)", event.text):
        memory.hand = holds.group(1)
    _count_try(tag, memory)


def _dropped(
    event: Event, tag: str, refused: bool, prompt: Prompt, plan: Plan, memory: Memory
) -> None:
    if refused:
        if "hand is empty" in event.text:
            memory.hand = ""
        _count_try(tag, memory)
        return
    memory.hand = ""
    thing = memory.things.get(tag)
    rest = event.point
    if thing is None or rest is None:
        _count_try(tag, memory)
        return
    moved = replace(thing, position=rest, moved=True)
    memory.things[tag] = moved
    job = current_job(tag, memory)
    if job is None:
        return
    goal = plan.goals[job.goal]
    anchor = anchor_of(job.goal, memory)
    on_floor = "floor" in event.text.split("rests")[-1]
    if place_reached(goal.relation, moved, anchor, prompt.room, on_floor):
        memory.set_job(replace(job, status=Status.DONE))
    else:
        _count_try(tag, memory)


def current_job(tag: str, memory: Memory) -> Job | None:
    """The first open job of a thing."""
    return next((j for j in memory.jobs if j.tag == tag and j.status is Status.TODO), None)


def anchor_of(goal: int, memory: Memory) -> Thing | None:
    """The thing that the targets of a goal shall be near, if it is known."""
    targets = {job.tag for job in memory.jobs if job.goal == goal}
    fits = memory.fits.get(("place", goal), {})
    known = [(fit, tag) for tag, fit in fits.items() if tag not in targets and tag in memory.things]
    if not known:
        return None
    return memory.things[max(known)[1]]


def _count_try(tag: str, memory: Memory) -> None:
    job = current_job(tag, memory)
    if job is None:
        return
    tries = job.tries + 1
    status = Status.FAILED if tries >= MAX_TRIES else Status.TODO
    memory.set_job(replace(job, tries=tries, status=status))


def is_hold(plan: Plan, job: Job) -> bool:
    """Whether a job ends in the hand."""
    return plan.goals[job.goal].relation is Relation.HOLD
