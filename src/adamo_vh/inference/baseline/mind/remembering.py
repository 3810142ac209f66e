"""What of all that is known the note must carry over to the next turn."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from adamo_vh.geometry import Vec3
from adamo_vh.inference.baseline.language.plan import Plan, Relation
from adamo_vh.inference.baseline.mind import notes
from adamo_vh.inference.baseline.mind.beliefs import (
    judge_by_text,
    needs_pixels,
    settled,
    since_whole,
    slots,
)
from adamo_vh.inference.baseline.mind.evidence import anchor_of, second_of
from adamo_vh.inference.baseline.mind.happenings import FAR_M
from adamo_vh.inference.baseline.mind.memory import (
    Memory,
    Move,
    Status,
)
from adamo_vh.inference.baseline.prompt.reading import Prompt
from adamo_vh.inference.baseline.sight.kinds import class_of

_LIKELY = 0.5
"""Fit from which a thing counts as what is meant."""
_SAME_M = 0.02
"""Feedback rounds places to a centimetre."""

_AROUND_M = 0.7

_RELEVANT_FIT = 0.08

_ON_FURNITURE = (Relation.SURFACE, Relation.UNDER, Relation.EDGE)


def carried_over(
    prompt: Prompt, plan: Plan, memory: Memory, before: Memory, moves: list[Move]
) -> str:
    """The sentence of the note that carries what the messages do not tell."""
    numbers = [notes.read(turn.note).number for turn in prompt.turns]
    number = (numbers[-1] if numbers else 0) + 1
    whole = number == 2 or _first_falls_out(prompt)
    groups = [slot for slot, d in slots(plan) if d.compares]
    start = before
    lasting = _lasting(prompt, memory, whole, moves)
    if number == 1:
        start = replace(before, began=None)
    if whole:
        start = Memory(things=memory.things)
        judge_by_text(start, plan)
        lasting |= _done_with(plan, memory)
    distances = _distances(plan, memory, start)
    entry = notes.Entry(number, whole, notes.called(move.search for move in moves))
    relevant = _relevant(plan, memory)
    shown = replace(memory, looks={t: w for t, w in memory.looks.items() if t in relevant})
    places = (set(memory.things) & relevant) - lasting
    return notes.write(shown, start, places, groups, distances, entry)


def _relevant(plan: Plan, memory: Memory) -> set[str]:
    """Things that matter for the instruction: those that may be meant, and what is by them."""
    if plan.questions or any(goal.relation in _ON_FURNITURE for goal in plan.goals):
        return set(memory.things)
    likely = {t for fits in memory.fits.values() for t, fit in fits.items() if fit >= _RELEVANT_FIT}
    kinds = {kind for _, description in slots(plan) for kind in description.classes}
    likely |= {tag for tag in memory.things if class_of(tag) in kinds}
    likely |= {job.tag for job in memory.jobs} | {memory.hand}
    anchors = [
        memory.things[tag]
        for (kind, _), fits in memory.fits.items()
        for tag, fit in fits.items()
        if kind != "goal" and fit >= _LIKELY and tag in memory.things
    ]
    near = {
        tag
        for tag, thing in memory.things.items()
        if any(thing.position.distance(anchor.position) < _AROUND_M for anchor in anchors)
    }
    return likely | near


def _distances(plan: Plan, memory: Memory, before: Memory) -> list[str]:
    """Things of which it must be noted from how near they were seen."""
    if settled(plan, memory) and not plan.questions and memory.decided is not None:
        return []
    if settled(plan, memory) and not plan.questions and plan.condition is None:
        return []
    new = {tag: m for tag, m in memory.seen_m.items() if before.seen_m.get(tag) != m}
    if needs_pixels(plan, memory):
        return list(new)
    return [tag for tag, m in new.items() if max(m, before.seen_m.get(tag, m)) > FAR_M]


def _done_with(plan: Plan, memory: Memory) -> set[str]:
    """Things that no goal is about any more, once it is known what all goals are about."""
    if not settled(plan, memory) or plan.questions or plan.acts or plan.condition:
        return set()
    open_jobs = [job for job in memory.jobs if job.status is Status.TODO]
    if any(plan.goals[job.goal].relation in _ON_FURNITURE for job in open_jobs):
        return set()
    anchors = [anchor_of(job.goal, memory) for job in open_jobs]
    anchors += [second_of(job.goal, memory) for job in open_jobs]
    # Where things were put matters for where to put the next ones.
    needed = {job.tag for job in memory.jobs} | {thing.tag for thing in anchors if thing}
    return set(memory.things) - needed - {memory.hand}


def _lasting(prompt: Prompt, memory: Memory, whole: bool, moves: list[Move]) -> set[str]:
    """Things whose places the next prompt will tell without this note."""
    told = {tag: thing.position for tag, thing in prompt.told.items()}
    if prompt.lasting:
        return _still_there(memory, told) & prompt.pinned if whole else set(told)
    looks = any(move.name == "Look" for move in moves)
    kept = set() if looks else _still_there(memory, told)
    if whole:
        return kept
    noted = notes.things_noted([turn.note for turn in since_whole(prompt.turns)])
    return kept | _still_there(memory, {tag: thing.position for tag, thing in noted.items()})


def _still_there(memory: Memory, places: Mapping[str, Vec3]) -> set[str]:
    things = memory.things
    return {
        t
        for t, place in places.items()
        if t in things and things[t].position.distance(place) < _SAME_M
    }


def _first_falls_out(prompt: Prompt) -> bool:
    """Whether older turns have left the prompt, and with the next one the last whole line would."""
    entries = [notes.read(turn.note) for turn in prompt.turns]
    if not entries or entries[0].number <= 1:
        return False
    return not any(entry.whole for entry in entries[1:])
