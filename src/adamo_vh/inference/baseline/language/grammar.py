"""The grammar of household instructions: from a text to a plan of goals.

::

    instruction = clause { separator clause }
    clause      = TAKE things | PUT (things | pronoun) place | BRING (things | pronoun) [place]
                | place PUT (things | pronoun) | things BE place
    things      = thing { ("," | "and") thing }
    place       = on the floor | in a corner | near thing | on the FURNITURE | left of thing
                | between thing and thing | under FURNITURE | far from thing | where it was | ...
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import lru_cache
from typing import TypeVar

from adamo_vh.inference.baseline.language.cursor import Cursor, NotUnderstood
from adamo_vh.inference.baseline.language.phrases import left_out, noun_phrase, starts_phrase
from adamo_vh.inference.baseline.language.places import (
    BREAKS,
    PLACES,
    VERBS,
    _join,
    _target_place,
    read_spot,
)
from adamo_vh.inference.baseline.language.plan import SIDES, Description, Goal, Plan, Relation
from adamo_vh.inference.baseline.language.referring import TOGETHER, Place, Reading, resolved_other
from adamo_vh.inference.baseline.language.rephrasing import rephrased
from adamo_vh.inference.baseline.language.words import Kind, Token, tokenize

_LET_GO = (
    "drop",
    "dropping",
    "put down",
    "set down",
    "lay down",
    "place down",
    "release",
    "let go of",
    "drop off",
    "deposit",
    "lower",
    "leave",
)

_SOURCES = (Kind.SIDE, Kind.BETWEEN, Kind.UNDER, Kind.FAR, Kind.EDGE)
"""Places that tell, behind "pick the plate", which plate is meant."""
_KNOWN = ("the", "this", "that", "these", "those", "both")
"""Words before a noun that point at what was named before."""
_EVERYTHING = Description("everything", every=True)


@lru_cache(maxsize=256)
def wishes(instruction: str, before: tuple[str, ...] = ()) -> Plan:
    """Compile wishes about things to goals.

    Args:
        instruction: Plain words, lower case.
        before: Tags that were spoken of before, the latest first: what "it" may mean.

    Returns:
        The plan; if any part has no meaning, a plan without goals that names this part.
    """
    tokens = tokenize(rephrased(instruction))
    unknown = [token.text for token in tokens if token.kind is Kind.UNKNOWN]
    if unknown:
        return Plan(problem="'" + "', '".join(dict.fromkeys(unknown)) + "'")
    cursor = Cursor(tokens)
    reading = Reading(earlier=_spoken_of(before))
    try:
        while cursor.peek() is not None:
            if not cursor.accept(*BREAKS):
                _clause(cursor, reading)
    except NotUnderstood as problem:
        return Plan(problem=str(problem))
    plan = reading.plan()
    return plan if plan.goals else Plan(problem="what to do, as I found no wish in it")


def _spoken_of(tags: Sequence[str]) -> list[Description]:
    return [Description(tag, ids=(tag.lower(),)) for tag in reversed(tags)]


def read_things(text: str, before: tuple[str, ...] = ()) -> list[Description] | None:
    """The things that words mean; None if they are no list of things and nothing else."""
    return _whole(text, before, _things)


def read_place(text: str, before: tuple[str, ...] = ()) -> Goal | None:
    """The place that words mean, as a wish for nothing; None if they are none."""
    place = _whole(text, before, read_spot)
    if place is None or place is TOGETHER:
        return None
    nothing = Description("")
    rest = (place.furniture, place.second, place.distance_m, place.direction)
    return Goal(nothing, place.relation, place.anchor, *rest)


_Read = TypeVar("_Read")


def _whole(
    text: str, before: tuple[str, ...], reader: Callable[[Cursor, Reading], _Read]
) -> _Read | None:
    tokens = tokenize(rephrased(text))
    if not tokens or any(token.kind is Kind.UNKNOWN for token in tokens):
        return None
    cursor = Cursor(tokens)
    try:
        found = reader(cursor, Reading(earlier=_spoken_of(before)))
    except (NotUnderstood, IndexError):
        return None
    while cursor.accept(Kind.THEN, Kind.COMMA):
        pass
    return found if cursor.peek() is None else None


def _clause(cursor: Cursor, reading: Reading) -> None:
    if verb := cursor.accept(*VERBS):
        while cursor.peek() in VERBS and verb.kind is not Kind.PUT:
            verb = cursor.next()
        _verb_clause(verb, cursor, reading)
    elif cursor.accept(Kind.AGAIN):
        if reading.place is None:
            raise NotUnderstood("'the same' (nothing was said before)")
        reading.put(_things(cursor, reading), reading.place)
    elif cursor.peek() in PLACES:
        _place_first(cursor, reading)
    elif starts_phrase(cursor) or cursor.peek() is Kind.PRONOUN:
        _things_first(cursor, reading)
    else:
        raise cursor.fail("I know picking things up and putting them down")


def _place_first(cursor: Cursor, reading: Reading) -> None:
    """Read "on the floor, put the plate", "on the floor: the plate"."""
    place = read_spot(cursor, reading)
    mark = cursor.mark()
    while cursor.accept(Kind.COMMA) and cursor.peek() in (Kind.ON, Kind.IN, Kind.NEAR):
        place = _join(cursor, place, _target_place(cursor, cursor.next().kind, reading))
        mark = cursor.mark()
    cursor.rewind(mark)
    while cursor.accept(Kind.COMMA, Kind.THEN):
        pass
    if cursor.peek() in (None, *VERBS[:2]) and (meant := reading.spoken_of()):
        reading.put(meant, place)  # "put it on the floor, then on the table"
        return
    if not cursor.accept(Kind.PUT, Kind.BRING) and not starts_phrase(cursor):
        raise cursor.fail("I expected a verb like 'put'")
    reading.put(_things(cursor, reading), place)


def _things_first(cursor: Cursor, reading: Reading) -> None:
    """Read "the plate should be on the floor", or "the plate: put it on the floor"."""
    things = _things(cursor, reading)
    cursor.accept(Kind.GOES)
    if cursor.peek() in PLACES:
        _put(cursor, reading, things)
        _further_pairs(cursor, reading)
        return
    mark = cursor.mark()
    while cursor.accept(*BREAKS):
        pass
    if cursor.mark() == mark or cursor.peek() not in (Kind.PUT, Kind.BRING, Kind.TAKE):
        cursor.rewind(mark)
        raise cursor.fail("I expected a verb like 'pick' or 'put' before it")
    reading.last = things


def _verb_clause(spoken: Token, cursor: Cursor, reading: Reading) -> None:
    verb = spoken.kind
    if verb is not Kind.TAKE and cursor.peek() in PLACES:  # "put on the floor the plate"
        place = read_spot(cursor, reading)
        if starts_phrase(cursor) or cursor.peek() is Kind.PRONOUN:
            reading.put(_things(cursor, reading), place)
        else:  # "pick the plate and put on the floor"
            reading.put(reading.spoken_of(), place)
        return
    things = _things(cursor, reading, verb is Kind.TAKE)
    if verb is Kind.FIND:
        reading.last = things
        return
    if verb is Kind.TAKE:
        if _is_destination(cursor):
            reading.put(things, read_spot(cursor, reading))
            _further_pairs(cursor, reading)
        else:
            reading.take(_with_source(cursor, reading, things))
        return
    while cursor.accept(Kind.BE, Kind.GOES, Kind.COMMA):
        pass
    if cursor.peek() not in PLACES:
        if verb is Kind.BRING:
            reading.take(things)
            return
        if spoken.text in _LET_GO and cursor.peek() in (*BREAKS, None):
            reading.put(things, Place(Relation.FLOOR))
            return
        raise cursor.fail("where to put it?")
    _put(cursor, reading, things)
    _further_pairs(cursor, reading)


def _put(cursor: Cursor, reading: Reading, things: list[Description]) -> None:
    place = read_spot(cursor, reading)
    if place is TOGETHER:
        reading.together(things)
    else:
        reading.put(_with_left_out(cursor, things), place)


def _with_left_out(cursor: Cursor, things: list[Description]) -> list[Description]:
    """Read "put everything on the floor EXCEPT THE PLATE"."""
    if cursor.peek() is not Kind.EXCEPT:
        return things
    if not any(thing.every for thing in things):
        raise cursor.fail("nothing can be left out of one thing")
    but = tuple(left_out(cursor))
    if cursor.peek() in PLACES:
        raise cursor.fail("two places for one thing")
    return [replace(t, but=(*t.but, *but)) if t.every else t for t in things]


def _is_destination(cursor: Cursor) -> bool:
    """Behind "take the plate": whether the place is where to take it, not where it is."""
    if cursor.peek() in (Kind.TO, Kind.THERE, Kind.HELD, Kind.HOME, Kind.SHIFT):
        return True
    words = cursor.ahead()
    return words.startswith(("down ", "onto", "on to", "into"))


def _further_pairs(cursor: Cursor, reading: Reading) -> None:
    """Read "... and the cup next to the plate": the same verb goes on."""
    while cursor.peek() in BREAKS:
        mark = cursor.mark()
        while cursor.accept(*BREAKS):
            pass
        if not starts_phrase(cursor):
            cursor.rewind(mark)
            return
        things = _things(cursor, reading)
        cursor.accept(Kind.GOES, Kind.BE)
        if cursor.peek() in PLACES:
            _put(cursor, reading, things)
        elif reading.place is not None and cursor.peek() in (*BREAKS, None):
            if _is_topic(cursor):  # "... and the cup, put it on the table"
                cursor.rewind(mark)
                return
            if reading.place.anchor and cursor.peek() is None and cursor.bare_and(mark):
                raise NotUnderstood(
                    f"'{reading.place.anchor.text} and {things[0].text}' (which of the two?)"
                )
            reading.put(things, reading.place)  # "... and then the plate"
        else:
            raise cursor.fail("where to put it?")


def _is_topic(cursor: Cursor) -> bool:
    mark = cursor.mark()
    while cursor.accept(*BREAKS):
        pass
    found = cursor.peek() in VERBS and cursor.peek(1) is Kind.PRONOUN
    cursor.rewind(mark)
    return found


def _with_source(cursor: Cursor, reading: Reading, things: list[Description]) -> list[Description]:
    """Behind "pick the plate": a place says where the plate is now."""
    if cursor.peek() not in (Kind.ON, Kind.NEAR, Kind.IN, *_SOURCES):
        return things
    if cursor.peek() in (Kind.ON, Kind.IN) and cursor.peek(1) is Kind.ROOM:
        cursor.next()
        cursor.next()
        return things
    mark = cursor.mark()
    place = read_spot(cursor, reading)
    source: tuple[Relation, tuple[str, ...]]
    if place.relation is Relation.FLOOR and place.anchor is None:
        source = (Relation.FLOOR, ())
    elif place.relation is Relation.SURFACE:
        source = (Relation.SURFACE, (place.furniture,))
    elif place.relation in (Relation.NEAR, *SIDES) and place.anchor and place.anchor.classes:
        source = (place.relation, place.anchor.classes)
    else:
        cursor.rewind(mark)
        raise cursor.fail("I cannot tell things apart by that place")
    return [replace(t, source=source) for t in things]


def _things(cursor: Cursor, reading: Reading, taken: bool = False) -> list[Description]:
    """A list of noun phrases, or a pronoun.

    Args:
        cursor: At the first word.
        reading: What was read before.
        taken: Behind a verb like "pick", where a place tells which thing is meant.
    """
    if token := cursor.accept(Kind.PRONOUN):
        if meant := reading.meant(token):
            reading.pointed = meant
            return meant
        raise NotUnderstood(f"'{token.text}' (I do not know what it refers to)")
    if cursor.peek() is Kind.EVERY and cursor.peek(1) in (*PLACES, Kind.PRONOUN):
        cursor.next()
        cursor.accept(Kind.PRONOUN)
        return list(reading.waiting or reading.last) or [_EVERYTHING]
    if cursor.peek() is Kind.COUNT and cursor.peek(1) in PLACES:
        cursor.next()
        if meant := list(reading.waiting or reading.last):
            return meant
    if meant_again := _repeated(cursor, reading, taken):
        return meant_again
    things = [noun_phrase(cursor, taken)]
    while cursor.peek() in (Kind.COMMA, Kind.AND):
        mark = cursor.mark()
        while cursor.accept(Kind.COMMA, Kind.AND):
            pass
        if not starts_phrase(cursor):
            cursor.rewind(mark)
            break
        things.append(noun_phrase(cursor))
    while cursor.peek() is Kind.OR:
        mark = cursor.mark()
        cursor.next()
        if not starts_phrase(cursor):
            cursor.rewind(mark)
            break
        other = noun_phrase(cursor)
        reading.remarks.append(f"Of {things[-1].text} or {other.text} I chose {things[-1].text}.")
    return [resolved_other(thing, reading) for thing in things]


def _repeated(cursor: Cursor, reading: Reading, taken: bool) -> list[Description]:
    """Read "these objects", "the two items", "the object": what was taken, by a plain noun."""
    group = list(reading.waiting or reading.last)
    mark = cursor.mark()
    while cursor.accept(Kind.DET, Kind.EVERY, Kind.COUNT, Kind.OF):
        pass
    known = any(word in _KNOWN for word in cursor.words_since(mark).split())
    if not group and known:  # of what was spoken of before, as many as the noun says
        group = reading.earlier
        several = cursor.ahead().endswith("s")
        group = group if several is (len(group) > 1) else [] if several else group[-1:]
    noun = cursor.accept(Kind.OBJECT)
    follows = (None, Kind.TO, *BREAKS) if taken else (*PLACES, None)
    if group and noun and cursor.peek() in follows:
        return group
    cursor.rewind(mark)
    return []
