"""What the model believes now: its notes and all other messages put together, and the new view."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import replace

from adamo_vh.inference.baseline.language.plan import Description, Plan
from adamo_vh.inference.baseline.mind import ledger
from adamo_vh.inference.baseline.mind.choosing import degree, thing_of
from adamo_vh.inference.baseline.mind.happenings import FAR_M, happened
from adamo_vh.inference.baseline.mind.memory import Memory, Search, Slot, Thing
from adamo_vh.inference.baseline.prompt.reading import Event, Prompt, Turn
from adamo_vh.inference.baseline.sight.closeups import closeup_sight
from adamo_vh.inference.baseline.sight.kinds import Beliefs, class_of, classify, likeliest
from adamo_vh.inference.baseline.sight.looking import boxed, sights
from adamo_vh.inference.baseline.sight.measures import Sight
from adamo_vh.inference.baseline.sight.printed import WordReader

_NEVER_M = 99.0
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
    memory.things.update(ledger.things_noted(turn.note for turn in turns))
    for tag, listed in prompt.told.items():
        memory.things[tag] = thing_of(tag, listed.position, listed.volume_cm3)
    memory.seen_m.update(prompt.told_from_m)
    names = {ledger.short_of(tag): tag for tag in memory.things}
    for number, turn in enumerate(turns, len(prompt.turns) - len(turns) + 1):
        entry = ledger.read(turn.note)
        newer = {tag for tag, at in prompt.told_at.items() if at >= number}
        ledger.apply(entry, memory, names, newer)
        for tag in memory.kinds.keys() & memory.things.keys():
            thing = memory.things[tag]
            memory.things[tag] = thing_of(tag, thing.position, thing.volume_cm3, memory.kinds[tag])
        judge_by_text(memory, plan)
        searches = [*entry.searches, *[Search.NONE] * len(turn.events)]
        for event, search in zip(turn.events, searches, strict=False):
            happened(event, search, memory, plan, prompt.room)
    judge_by_text(memory, plan)
    if prompt.body.hand is not None:
        memory.hand = "" if prompt.body.hand == "empty" else prompt.body.hand
    return memory


def since_whole(turns: tuple[Turn, ...]) -> tuple[Turn, ...]:
    """The turns from the last one on whose note holds all that was known."""
    starts = [index for index, turn in enumerate(turns) if ledger.read(turn.note).whole]
    return turns[starts[-1] :] if starts else turns


def judge_by_text(memory: Memory, plan: Plan) -> None:
    """Say how well things fit the descriptions that tags alone decide, where that is not known."""
    everything = tuple(memory.things.values())
    for slot, description in slots(plan):
        fits = memory.fits.setdefault(slot, {})
        for thing in everything:
            if thing.tag not in fits and told_by_text(description, thing.tag):
                fits[thing.tag] = degree(description, thing, None, everything)


def told_by_text(description: Description, tag: str) -> bool:
    """Whether the text alone tells if this thing is meant."""
    if description.ids:
        return True
    if description.by_looks:
        return False
    return class_of(tag) is not None or not description.classes


def needs_pixels(plan: Plan, memory: Memory) -> bool:
    """Whether looks decide what some goal is about that is still open."""
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


def settled(plan: Plan, memory: Memory) -> bool:
    """Whether it is known of all goals what they are about."""
    return {job.goal for job in memory.jobs} >= set(range(len(plan.goals)))


def open_slots(plan: Plan, memory: Memory) -> Iterable[tuple[Slot, Description]]:
    """Those of which it is not yet known which things they mean."""
    known = {job.goal for job in memory.jobs}
    return ((slot, d) for slot, d in slots(plan) if slot[1] not in known)


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
    events = prompt.turns[-1].events if prompt.turns else ()
    for event in events:
        if event.pictures and event.tag in memory.things:
            _see_closely(event, prompt, plan, memory, reader)


def _asks_for_outlines(plan: Plan) -> bool:
    """Whether it matters how round things are."""
    return any("round" in description.shapes for _, description in slots(plan))


def _compares(plan: Plan, memory: Memory) -> bool:
    return any(description.compares for _, description in open_slots(plan, memory))


def _measure_distances(prompt: Prompt, memory: Memory) -> None:
    """From how near each listed thing was seen, now and before."""
    here, now = prompt.body.position, len(prompt.turns)
    noted = ledger.things_noted(turn.note for turn in since_whole(prompt.turns))
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
    everything = tuple(memory.things.values())
    for slot, description in open_slots(plan, memory):
        fits = memory.fits.setdefault(slot, {})
        for tag, nearer in closer.items():
            if tag in memory.inspected or told_by_text(description, tag):
                continue
            thing, sight = memory.things[tag], looked_at.get(tag)
            fit = _fit(description, thing, sight, everything, beliefs[tag])
            # The nearest view is believed; of equally near ones, the most favourable.
            fits[tag] = fit if nearer else max(fit, fits.get(tag, 0.0))


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
            fits[tag] = _fit(description, memory.things[tag], sight, everything, beliefs)


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
) -> float:
    return round(degree(description, thing, sight, everything, beliefs), 2)
