"""Answers to questions, from what was seen and felt: what is where, and what it is like."""

from __future__ import annotations

from dataclasses import replace

from adamo_vh.geometry import Vec3
from adamo_vh.inference.baseline.language.plan import (
    SIDES,
    Ask,
    Description,
    Goal,
    Question,
    Relation,
    Size,
)
from adamo_vh.inference.baseline.language.requests import CAN
from adamo_vh.inference.baseline.mind.beliefs import OF_CONDITION
from adamo_vh.inference.baseline.mind.choosing import extreme
from adamo_vh.inference.baseline.mind.evidence import named, same_surface, side_of
from adamo_vh.inference.baseline.mind.furniture import candidates
from adamo_vh.inference.baseline.mind.memory import Memory, Thing
from adamo_vh.inference.baseline.mind.searching import Stage
from adamo_vh.inference.baseline.prompt.reading import Prompt
from adamo_vh.inference.baseline.tags import parts_of

_FITS = 0.5
_DOES_NOT = 0.3
_FLOOR_M = 0.06
_BESIDE_M = 0.6
_AT_ONCE = (Ask.HELD, Ask.HELP, Ask.STAND)
_AFTER_A_ROUND = (Ask.AT, Ask.SEE, Ask.WHICH)


def ready(question: Question, index: int, memory: Memory, stage: Stage) -> bool:
    """Whether enough was looked at to answer.

    Args:
        question: What is asked.
        index: Its number, `OF_CONDITION` for the condition.
        memory: What is known.
        stage: How far the search is.
    """
    if question.ask in _AT_ONCE or stage is Stage.OVER:
        return True
    if question.ask in _AFTER_A_ROUND:
        return stage >= Stage.ROUND
    close, target = stage >= Stage.CLOSE, question.target
    found = matches(question, index, memory)
    if not found:
        # Where all of a kind were seen from nearby, and none looks as said, there is none.
        return close and bool(question.ask is Ask.COUNT or (target and target.by_looks))
    compares = (target and target.compares) or (question.quality and question.quality.size)
    if question.ask is Ask.COUNT or (compares and not close):
        return close
    if question.ask is Ask.COLOUR:
        return close or found[0] in memory.looks
    if question.quality and question.quality.by_looks:
        unsure = _quality(question, index, found[0], memory) is None
        return close or not (unsure or (question.quality.colours and found[0] not in memory.looks))
    if question.place and question.place.anchor:
        return _anchor(question, index, memory) is not None
    return True


def matches(question: Question, index: int, memory: Memory) -> list[str]:
    """The things that a question is about, the best fit first."""
    fits = memory.fits.get((_kind(index), index), {})
    known = {tag: fit for tag, fit in fits.items() if tag in memory.things or tag == memory.hand}
    if question.target and question.target.size:
        return extreme(question.target, known, memory)
    good = sorted((-fit, tag) for tag, fit in known.items() if fit >= _FITS)
    return [tag for _, tag in good]


def _kind(index: int) -> str:
    return "if" if index == OF_CONDITION else "question"


def _anchor(question: Question, index: int, memory: Memory) -> Thing | None:
    fits = memory.fits.get(("seat", index), {})
    about = matches(question, index, memory)[:1] if question.target else []
    known = [(f, t) for t, f in fits.items() if t in memory.things and t not in about]
    return memory.things[max(known)[1]] if known and max(known)[0] >= _FITS else None


def tell(question: Question, index: int, memory: Memory, prompt: Prompt, stage: Stage) -> str:
    """The answer in sentences.

    Args:
        question: What is asked.
        index: Its number.
        memory: What is known.
        prompt: For the room.
        stage: How far the search went.
    """
    if question.ask is Ask.HELP:
        return f"I am a set of rules in a body. {CAN}"
    if question.ask is Ask.STAND:
        return f"I stand at {prompt.body.position}."
    if question.ask is Ask.HELD:
        return f"I hold {memory.hand}." if memory.hand else "I hold nothing; my hand is empty."
    if question.ask is Ask.IS:
        return _is(question, index, memory, prompt)
    if question.ask is Ask.SEE:
        return _list("I know of", list(memory.things), memory) + _unseen(stage)
    of_many = {Ask.AT: _at, Ask.COUNT: _count, Ask.WHICH: _which}.get(question.ask)
    if of_many:
        return of_many(question, index, memory, prompt) + _unseen(stage)
    found = matches(question, index, memory)
    if not found:
        return _none(question) + _unseen(stage)
    return _about(question, index, found, memory, prompt)


def _about(question: Question, index: int, found: list[str], memory: Memory, prompt: Prompt) -> str:
    """What is asked of certain things."""
    if question.ask is Ask.EXISTS:
        seen = "; ".join(where(tag, memory) for tag in found[:6])
        return f"Yes, I know of {len(found)}: {seen}."
    if question.ask is Ask.COLOUR:
        return " ".join(_colour(tag, memory) for tag in found[:4])
    if question.ask is Ask.SIZE:
        return " ".join(_size(memory.things[t]) for t in found[:4] if t in memory.things)
    if question.ask is Ask.DISTANCE and question.place:
        return _apart(question, index, found[0], memory)
    if question.ask is Ask.DISTANCE:
        here = prompt.body.position
        return " ".join(
            f"{tag} is {memory.things[tag].position.horizontal_distance(here):.2f} m from me."
            for tag in found[:4]
            if tag in memory.things
        )
    return ". ".join(where(tag, memory) for tag in found[:6]) + "."


def _apart(question: Question, index: int, tag: str, memory: Memory) -> str:
    anchor = _anchor(question, index, memory)
    if anchor is None or tag not in memory.things:
        other = question.place.anchor if question.place else None
        return f"I have not seen {bare(other)}." if other else "I cannot tell."
    apart = memory.things[tag].position.horizontal_distance(anchor.position)
    return f"{tag} is {apart:.2f} m from {anchor.tag}."


def verdict(question: Question, index: int, memory: Memory, prompt: Prompt) -> bool | None:
    """Whether a statement holds; None if that cannot be told."""
    found = matches(question, index, memory)
    holds: bool | None = None
    if question.ask is Ask.EXISTS:
        holds = bool(found)
    elif found:
        holds = _holds(question, index, found, memory, prompt)
    if holds is None:
        return None
    return holds is not question.negated


def _holds(
    question: Question, index: int, found: list[str], memory: Memory, prompt: Prompt
) -> bool | None:
    if question.quality:
        return _quality(question, index, found[0], memory)
    place = question.place
    thing = memory.things.get(found[0])
    if place is None:
        return None
    if place.relation is Relation.HOLD or thing is None or memory.hand == found[0]:
        return place.relation is Relation.HOLD and memory.hand in found
    rests, low = memory.rests.get(found[0]), thing.bottom_z < _FLOOR_M
    if place.relation is Relation.FLOOR:
        return "floor" in rests if rests else low
    if place.relation is Relation.SURFACE:
        return named(place.furniture, rests) if rests else False if low else None
    return _by_anchor(question, index, thing, memory, prompt)


def _by_anchor(
    question: Question, index: int, thing: Thing, memory: Memory, prompt: Prompt
) -> bool | None:
    place, anchor = question.place, _anchor(question, index, memory)
    if anchor is None or place is None:
        return None
    apart = thing.position.horizontal_distance(anchor.position)
    if place.relation is Relation.NEAR:
        return apart <= prompt.room.near_m and same_surface(thing, anchor, memory)
    if place.relation is Relation.FAR:
        return apart >= (place.distance_m or 1.0)
    return side_of(thing, anchor, memory) is place.relation if place.relation in SIDES else None


def _quality(question: Question, index: int, tag: str, memory: Memory) -> bool | None:
    assert question.quality is not None
    if question.quality.size:
        fits = memory.fits.get(("quality", index), {})
        if sum(fit >= _DOES_NOT for fit in fits.values()) < len(question.quality.classes):
            return None  # what it is compared with was not seen
        return extreme(question.quality, fits, memory) == [tag]
    fit = memory.fits.get(("quality", index), {}).get(tag)
    if fit is None or (question.quality.by_looks and tag not in memory.looks and fit > 0.05):
        return None
    return True if fit >= _FITS else False if fit <= _DOES_NOT else None


def _is(question: Question, index: int, memory: Memory, prompt: Prompt) -> str:
    found = matches(question, index, memory)
    if not found:
        return _none(question)
    tag, holds = found[0], verdict(question, index, memory, prompt)
    more = where(tag, memory)
    if question.quality and tag in memory.looks:
        more = f"{tag} looks {memory.looks[tag]}"
    elif question.quality and question.quality.size and tag in memory.things:
        more = f"{tag} has a volume of {memory.things[tag].volume_cm3:.0f} cm3"
    if holds is None:
        return f"I cannot tell; {more}."
    return f"{'Yes' if holds else 'No'}: {more}."


def where(tag: str, memory: Memory) -> str:
    """Where a thing is, in words without a full stop."""
    if memory.hand == tag:
        return f"{tag} is in my hand"
    thing = memory.things[tag]
    rests = memory.rests.get(tag)
    words = f"{tag} rests {rests}" if rests else f"{tag} is at {thing.position}"
    if not rests:
        words += f", {thing.bottom_z:.2f} m above the floor"
    near = [
        (other.position.horizontal_distance(thing.position), other.tag)
        for other in memory.things.values()
        if other.tag not in (tag, memory.hand) and same_surface(thing, other, memory)
    ]
    if near and min(near)[0] <= _BESIDE_M:
        words += f", {min(near)[0]:.2f} m from {min(near)[1]}"
    return words


def _colour(tag: str, memory: Memory) -> str:
    if looks := memory.looks.get(tag):
        return f"{tag} looks {looks}."
    return f"I could not make out the colour of {tag}."


def _size(thing: Thing) -> str:
    return f"{thing.tag} has a box of {thing.volume_cm3:.0f} cm3."


def _none(question: Question) -> str:
    assert question.target is not None
    return f"I have not seen {bare(question.target)}."


def bare(description: Description) -> str:
    """What is meant, with "any" instead of an article."""
    words = description.text.split()
    while words and words[0] in ("the", "a", "an", "any", "my", "your", "some", "all", "both"):
        words = words[1:]
    return f"any {' '.join(words)}"


def _unseen(stage: Stage) -> str:
    if stage is Stage.OVER:
        return ""
    return " I have not looked everywhere."


def _list(begin: str, tags: list[str], memory: Memory) -> str:
    if not tags:
        return f"{begin} nothing."
    tags = sorted(tags, key=_number)
    held = f" {memory.hand} is in my hand." if memory.hand in tags else ""
    return f"{begin} {len(tags)} thing{'s' if len(tags) > 1 else ''}: {', '.join(tags)}.{held}"


def _number(tag: str) -> tuple[int, str]:
    _, number = parts_of(tag)
    return (int(number) if number else 10**6, tag)


def _count(question: Question, index: int, memory: Memory, prompt: Prompt) -> str:
    assert question.target is not None
    plain = replace(question.target, count=None)
    found = matches(replace(question, target=plain), index, memory)
    if question.place:
        plainly = replace(question, quality=None)
        told = {tag: _holds(plainly, index, [tag], memory, prompt) for tag in found}
        if None in told.values():
            return _cannot_place(question.place, found, memory, prompt)
        found = [tag for tag in found if told[tag]]
    if not found:
        return f"I saw none that I could tell to be {plain.text.removeprefix('the ')}."
    return f"I saw {len(found)}: {', '.join(sorted(found, key=_number))}."


def _cannot_place(place: Goal, tags: list[str], memory: Memory, prompt: Prompt) -> str:
    """What to say of things of which no text tells whether they are there."""
    seen = f"I saw {len(tags)}: {', '.join(sorted(tags, key=_number))}."
    if place.relation is Relation.SURFACE:
        return f"{seen} {_on_furniture(place.furniture, memory, prompt)}"
    return f"{seen} I cannot tell which of them are there."


def _which(question: Question, index: int, memory: Memory, prompt: Prompt) -> str:
    del prompt
    found = matches(question, index, memory)
    assert question.target is not None
    if not found:
        return _none(question)
    thing = memory.things[found[0]]
    if question.target.size in (Size.NEAREST, Size.FARTHEST):
        return f"Of what I saw, {thing.tag} is {question.target.text}; {where(thing.tag, memory)}."
    return (
        f"Of what I saw, {thing.tag} is {question.target.text}, "
        f"with a box of {thing.volume_cm3:.0f} cm3."
    )


def _at(question: Question, index: int, memory: Memory, prompt: Prompt) -> str:
    place = question.place
    assert place is not None
    resting = [t for t in memory.things.values() if t.tag != memory.hand]
    if place.relation is Relation.FLOOR:
        tags = [t.tag for t in resting if "floor" in memory.rests.get(t.tag, "")
                or (t.tag not in memory.rests and t.bottom_z < _FLOOR_M)]  # fmt: skip
        return _list("On the floor I know of", tags, memory)
    if place.relation is Relation.SURFACE:
        return _on_furniture(place.furniture, memory, prompt)
    anchor = _anchor(question, index, memory)
    if anchor is None:
        return f"I have not seen {bare(place.anchor)}." if place.anchor else "I cannot tell that."
    around = [
        t
        for t in resting
        if t.tag != anchor.tag
        and t.position.horizontal_distance(anchor.position) <= _BESIDE_M
        and same_surface(t, anchor, memory)
    ]
    if place.relation in SIDES:
        around = [t for t in around if side_of(t, anchor, memory) is place.relation]
    around.sort(key=lambda t: t.position.horizontal_distance(anchor.position))
    if not around:
        return f"I saw nothing there within {_BESIDE_M} m of {anchor.tag}."
    told = [
        f"{t.tag} ({t.position.horizontal_distance(anchor.position):.2f} m away)" for t in around
    ]
    return f"There I saw, by {anchor.tag}: {', '.join(told)}."


def _on_furniture(furniture: str, memory: Memory, prompt: Prompt) -> str:
    felt = [tag for tag, rests in memory.rests.items() if named(furniture, rests)]
    parts = [f"{tag} rests {memory.rests[tag]}." for tag in felt]
    for surface in candidates(prompt, memory, "", furniture):
        tags = [
            t.tag
            for t in memory.things.values()
            if t.tag not in (*felt, memory.hand)
            and abs(t.bottom_z - surface.level) < 0.06
            and _stands_on(t.position, surface.places)
        ]
        if tags:
            parts.append(
                f"About {surface.level:.2f} m above the floor, together: "
                f"{', '.join(sorted(tags, key=_number))}."
            )
    if not parts:
        return f"I know of no {furniture} here."
    return f"I cannot tell furniture apart by sight. {' '.join(parts)}"


def _stands_on(place: Vec3, places: tuple[Vec3, ...]) -> bool:
    return min(place.horizontal_distance(p) for p in places) < 0.05
