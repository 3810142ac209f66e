"""What the model believes now: its notes and all other messages put together, and the new view."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import replace

from adamo_vh.inference.baseline.language.plan import Ask, Description, Plan, Question
from adamo_vh.inference.baseline.mind import notes
from adamo_vh.inference.baseline.mind.choosing import WELL_SEEN_PX, degree, thing_of
from adamo_vh.inference.baseline.mind.happenings import FAR_M, came_to_rest, happened, taken
from adamo_vh.inference.baseline.mind.memory import Memory, Search, Slot, Stand, Thing
from adamo_vh.inference.baseline.prompt.reading import Event, OwnTurn, Prompt
from adamo_vh.inference.baseline.sight.closeups import closeup_sight
from adamo_vh.inference.baseline.sight.kinds import (
    Beliefs,
    class_of,
    classify,
    likeliest,
)
from adamo_vh.inference.baseline.sight.looking import boxed, sights
from adamo_vh.inference.baseline.sight.measures import Sight, colour_words
from adamo_vh.inference.baseline.sight.outlines import EYES_M
from adamo_vh.inference.baseline.sight.printed import WordReader
from adamo_vh.inference.baseline.sight.prototypes import prototypes

_NEVER_M = 99.0
_HELD_CM3 = 300.0
"""Assumed of what is held and was never listed."""
OF_CONDITION = 99
"""The condition counts as a further question, with this number."""
_LIKE_WOOD = ("orange", "brown", "yellow")
_PERHAPS, _SURELY = 0.15, 0.6
"""Fits in between leave in doubt whether a thing is meant."""
_STEEP = 1.5
"""Height of the eyes above a thing over its distance, from which on they look down on it."""
_CLOSER = 0.9
"""A view from less than this share of the former distance replaces what was believed."""


def recalled(prompt: Prompt, plan: Plan) -> Memory:
    """All that notes, feedback and lists say, without a look at the frame.

    Args:
        prompt: The whole prompt.
        plan: What the instruction asks for.
    """
    memory = Memory()
    turns = since_whole(prompt.turns)
    memory.things.update(notes.things_noted(turn.note for turn in turns))
    for tag, listed in prompt.told.items():
        memory.things[tag] = thing_of(tag, listed.position, listed.volume_cm3)
    memory.seen_m.update(prompt.told_from_m)
    _earlier(prompt, memory)
    _stand(prompt, memory)
    for turn in prompt.turns[: len(prompt.turns) - len(turns)]:
        for event in turn.events:
            if event.name == "Drop" and event.outcome in ("done", "corrected"):
                came_to_rest(event, memory)
    for number, turn in enumerate(turns, len(prompt.turns) - len(turns) + 1):
        entry = notes.read(turn.note)
        newer = {tag for tag, at in prompt.told_at.items() if at >= number}
        notes.apply(entry, memory, newer)
        for tag in memory.kinds.keys() & memory.things.keys():
            thing = memory.things[tag]
            memory.things[tag] = thing_of(tag, thing.position, thing.volume_cm3, memory.kinds[tag])
        judge_by_text(memory, plan)
        searches = [*entry.searches, *[Search.NONE] * len(turn.events)]
        for event, search in zip(turn.events, searches, strict=False):
            happened(event, search, memory, plan, prompt.room)
    if prompt.body.hand is not None:
        memory.hand = "" if prompt.body.hand == "empty" else prompt.body.hand
    if memory.hand and memory.hand not in memory.things:  # no list tells what is held
        held = thing_of(memory.hand, prompt.body.position, _HELD_CM3)
        memory.things[memory.hand] = held
    judge_by_text(memory, plan)
    memory.in_doubt = _in_doubt(plan, memory)
    _stand(prompt, memory)
    return memory


def _earlier(prompt: Prompt, memory: Memory) -> None:
    """What former instructions and what was done for them still tell."""
    for turn in prompt.earlier:
        entry = notes.read(turn.note)
        before = Memory()
        notes.apply(entry, before)
        memory.home = memory.home or before.home or before.began
        for tag, thing in before.things.items():
            memory.things.setdefault(tag, thing)
        memory.rests.update(before.rests)
        memory.came_from.update(before.came_from)
        for event in turn.events:
            if event.name == "Pick" and event.outcome in ("done", "corrected"):
                memory.came_from.pop(event.tag, None)
                taken(event, memory)
            elif event.name == "Drop" and event.outcome in ("done", "corrected"):
                memory.hand = ""
                came_to_rest(event, memory)


def _stand(prompt: Prompt, memory: Memory) -> None:
    """Where the body stood at the instruction, and at the very first."""
    if memory.began is None and (not prompt.turns or prompt.began):
        body = prompt.began or prompt.body
        heading = body.heading_rad
        if heading is None and body.gaze is not None:
            to = body.gaze - body.position
            heading = math.atan2(to.y, to.x)
        memory.began = Stand(body.position, heading or 0.0)
    memory.home = memory.home or memory.began


def since_whole(turns: tuple[OwnTurn, ...]) -> tuple[OwnTurn, ...]:
    """The turns from the last one on whose note holds all that was known."""
    starts = [index for index, turn in enumerate(turns) if notes.read(turn.note).whole]
    return turns[starts[-1] :] if starts else turns


def judge_by_text(memory: Memory, plan: Plan) -> None:
    """Say how well things fit the descriptions that tags alone decide, where that is not known."""
    everything = tuple(memory.things.values())
    open_ = {slot for slot, _ in open_slots(plan, memory)}
    for slot, description in slots(plan):
        fits = memory.fits.setdefault(slot, {})
        for thing in everything:
            # What it is near to may be seen later than the thing.
            new = thing.tag not in fits or (description.source and slot in open_)
            if new and told_by_text(description, thing.tag):
                viewer = memory.began
                fits[thing.tag] = degree(description, thing, None, everything, viewer=viewer)


def told_by_text(description: Description, tag: str) -> bool:
    """Whether the text alone tells if this thing is meant."""
    if description.ids:
        return True
    if description.by_looks or not all(told_by_text(left, tag) for left in description.but):
        return False
    return class_of(tag) is not None or not description.classes


def needs_pixels(plan: Plan, memory: Memory) -> bool:
    """Whether looks decide what some goal is about that is still open."""
    if any(question.ask is Ask.COLOUR for question in plan.questions):
        return True
    return any(
        not told_by_text(description, tag)
        for slot, description in open_slots(plan, memory)
        for tag in memory.things or ("0",)
    )


def slots(plan: Plan) -> Iterable[tuple[Slot, Description]]:
    """All descriptions of a plan with their names."""
    for index, goal in enumerate(plan.goals):
        yield ("goal", index), goal.target
        if goal.anchor:
            yield ("place", index), goal.anchor
        if goal.second:
            yield ("second", index), goal.second
    for index, question in enumerate(plan.questions):
        yield from _asked("question", "seat", index, question)
    for index, act in enumerate(plan.acts):
        if act.target:
            yield ("act", index), act.target
    if plan.condition:
        yield from _asked("if", "seat", OF_CONDITION, plan.condition)


def _asked(
    kind: str, place: str, index: int, question: Question
) -> Iterable[tuple[Slot, Description]]:
    if question.target:
        target = question.target
        quality = question.quality
        if question.ask is Ask.COLOUR:
            target = replace(target, colours=())
        yield (kind, index), target
        if quality:
            yield ("quality", index if kind == "question" else OF_CONDITION), quality
    if question.place and question.place.anchor:
        yield (place, index), question.place.anchor


def settled(plan: Plan, memory: Memory) -> bool:
    """Whether it is known of all goals what they are about."""
    return {job.goal for job in memory.jobs} >= set(range(len(plan.goals)))


def open_slots(plan: Plan, memory: Memory) -> Iterable[tuple[Slot, Description]]:
    """Those of which it is not yet known which things they mean."""
    known = {job.goal for job in memory.jobs}
    of_goals = ("goal", "place", "second")
    return ((s, d) for s, d in slots(plan) if s[0] not in of_goals or s[1] not in known)


def asks_for_colours(plan: Plan) -> bool:
    """Whether the colours of things are to be told, or borne out."""
    questions = [*plan.questions, *([plan.condition] if plan.condition else [])]
    return any(q.ask is Ask.COLOUR or q.quality for q in questions) or any(
        part.colours or part.part_colours for _, d in slots(plan) for part in (d, *d.but)
    )


def look(prompt: Prompt, plan: Plan, memory: Memory, reader: WordReader | None) -> None:
    """Take in a new view and close-ups.

    Args:
        prompt: The whole prompt.
        plan: What the instruction asks for.
        memory: Is changed.
        reader: Reads printed words; None to do without.
    """
    pixels = needs_pixels(plan, memory)
    if prompt.fresh and (pixels or _compares(plan, memory)):
        _measure_distances(prompt, memory)
    if not pixels:
        return
    if prompt.fresh:
        _see(prompt, plan, memory, sights(prompt, reader, _asks_for_outlines(plan)))
        memory.in_doubt = _in_doubt(plan, memory)
    events = prompt.turns[-1].events if prompt.turns else ()
    for event in events:
        if event.pictures and event.tag in memory.things:
            _see_closely(event, prompt, plan, memory, reader)


def _in_doubt(plan: Plan, memory: Memory) -> frozenset[str]:
    """Things that may or may not belong to a group, and those whose colour is not made out."""
    of_open = list(open_slots(plan, memory))
    found = {
        tag
        for slot, description in of_open
        if description.every and (description.classes or description.colours)
        for tag, fit in memory.fits.get(slot, {}).items()
        if _PERHAPS <= fit < _SURELY
    }
    if asks_for_colours(plan):
        kinds = {kind for _, description in of_open for kind in description.classes}
        found |= {t for t in memory.things if class_of(t) in kinds and t not in memory.looks}
    return frozenset(found)


def _asks_for_outlines(plan: Plan) -> bool:
    """Whether it matters how round things are."""
    return any("round" in description.shapes for _, description in slots(plan))


def _compares(plan: Plan, memory: Memory) -> bool:
    return any(description.compares for _, description in open_slots(plan, memory))


def _measure_distances(prompt: Prompt, memory: Memory) -> None:
    """From how near each listed thing was seen, now and before."""
    here, now = prompt.body.position, len(prompt.turns)
    noted = notes.things_noted(turn.note for turn in since_whole(prompt.turns))
    for listed in prompt.things:
        tag = listed.tag
        distance = round(listed.position.horizontal_distance(here), 1)
        is_new = prompt.told_at.get(tag, now) >= now if prompt.lasting else tag not in noted
        # Notes leave out what was seen from nearby.
        before = _NEVER_M if is_new else memory.seen_m.get(tag, FAR_M)
        memory.before_m[tag] = before
        memory.seen_m[tag] = min(distance, before)


def _see(prompt: Prompt, plan: Plan, memory: Memory, looked_at: Mapping[str, Sight]) -> None:
    """A new view of all that it lists."""
    closer = {
        thing.tag: memory.seen_m[thing.tag] < _CLOSER * memory.before_m.get(thing.tag, _NEVER_M)
        for thing in prompt.things
    }
    beliefs = {
        thing.tag: classify(thing.tag, thing.volume_cm3, looked_at.get(thing.tag))
        for thing in prompt.things
    }
    for tag, is_closer in closer.items():
        if class_of(tag) is None and is_closer and tag in looked_at:
            _take_for(tag, likeliest(beliefs[tag]), memory)
    if asks_for_colours(plan):
        for tag, nearer in closer.items():
            sight = looked_at.get(tag)
            words = colour_words(sight) if sight else ""
            kind = prototypes()[likeliest(beliefs[tag])]
            # Around long things much of the box shows the wood behind them.
            untold = kind.transparent or (
                "long" in kind.shape and words.split(" ")[0] in _LIKE_WOOD
            )
            if words and not untold and (nearer or tag not in memory.looks):
                memory.looks[tag] = words
    everything = tuple(memory.things.values())
    for slot, description in open_slots(plan, memory):
        fits = memory.fits.setdefault(slot, {})
        for tag, nearer in closer.items():
            if tag in memory.inspected or told_by_text(description, tag):
                continue
            thing, sight = memory.things[tag], looked_at.get(tag)
            if tag in fits and (sight is None or sight.pixels < WELL_SEEN_PX):
                continue
            fit = _fit(description, thing, sight, everything, beliefs[tag], memory.began)
            # The nearest view is believed; of equally near ones, the most favourable.
            believed = nearer and not _from_above(thing, prompt)
            fits[tag] = fit if believed else max(fit, fits.get(tag, 0.0))


def _from_above(thing: Thing, prompt: Prompt) -> bool:
    """Whether the eyes look down on a thing so steeply that they see its lid and no side."""
    below = EYES_M - thing.position.z
    return below > _STEEP * prompt.body.position.horizontal_distance(thing.position)


def _see_closely(
    event: Event, prompt: Prompt, plan: Plan, memory: Memory, reader: WordReader | None
) -> None:
    """A close-up shows print and colours; shape and size are told by the view of the room."""
    tag, volume = event.tag, memory.things[event.tag].volume_cm3
    box = next((thing.box_px for thing in boxed(prompt) if thing.tag == tag), None)
    slimness = (box[2] - box[0]) / max(box[3] - box[1], 1) if box else None
    sight = closeup_sight(event.pictures[-1], slimness, reader)
    if sight is None:
        return
    far = sights(prompt, None, _asks_for_outlines(plan)).get(tag)
    if far:
        sight = replace(sight, misfits=far.misfits, cut=far.cut, clear=far.clear)
    beliefs = classify(tag, volume, sight)
    _take_for(tag, likeliest(beliefs), memory)
    everything = tuple(memory.things.values())
    for slot, description in open_slots(plan, memory):
        if not told_by_text(description, tag):
            fits = memory.fits.setdefault(slot, {})
            thing = memory.things[tag]
            fits[tag] = _fit(description, thing, sight, everything, beliefs, memory.began)


def _take_for(tag: str, kind: str, memory: Memory) -> None:
    """Remember what a thing behind an opaque tag seems to be."""
    thing = memory.things[tag]
    if class_of(tag) is None:
        memory.kinds[tag] = kind
        memory.things[tag] = thing_of(tag, thing.position, thing.volume_cm3, kind)


def _fit(
    description: Description,
    thing: Thing,
    sight: Sight | None,
    everything: tuple[Thing, ...],
    beliefs: Beliefs,
    viewer: Stand | None,
) -> float:
    return round(degree(description, thing, sight, everything, beliefs, viewer), 2)
