"""The grammar of household instructions: from a text to a plan of goals.

::

    instruction = clause { separator clause }
    clause      = TAKE things | PUT (things | pronoun) place | BRING (things | pronoun) [place]
                | place PUT (things | pronoun) | things BE place
    things      = thing { ("," | "and") thing }
    place       = on the floor | in a corner | near thing | on the FURNITURE
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import lru_cache

from adamo_vh.inference.baseline.language.phrases import (
    Cursor,
    NotUnderstood,
    noun_phrase,
    starts_phrase,
)
from adamo_vh.inference.baseline.language.plan import Description, Goal, Plan, Relation
from adamo_vh.inference.baseline.language.rephrasing import rephrased
from adamo_vh.inference.baseline.language.words import Kind, Token, tokenize

_VERBS = (Kind.TAKE, Kind.FIND, Kind.PUT, Kind.BRING)
_PLACES = (Kind.ON, Kind.IN, Kind.TO, Kind.NEAR, Kind.THERE, Kind.HELD)
_BREAKS = (Kind.THEN, Kind.COMMA, Kind.AND)


_EVERYTHING = Description("everything", every=True)


@dataclass(frozen=True, slots=True)
class _Place:
    relation: Relation
    anchor: Description | None = None
    furniture: str = ""


@dataclass(slots=True)
class _Reading:
    """Goals read so far, and what pronouns refer to."""

    goals: list[Goal] = field(default_factory=list)
    waiting: list[Description] = field(default_factory=list)
    """Taken, and not placed yet."""
    last: list[Description] = field(default_factory=list)
    """What "it" and "them" mean when nothing waits."""
    place: _Place | None = None
    """What "there" means."""

    def take(self, things: Sequence[Description]) -> None:
        self.waiting.extend(things)
        self.last = list(things)

    def put(self, things: Sequence[Description], place: _Place) -> None:
        if place.relation is Relation.HOLD:
            self.take(things)
            return
        for thing in things:
            known = next((w for w in self.waiting if _same(w, thing)), None)
            if known:
                self.waiting.remove(known)
            target = known or thing
            self.goals = [g for g in self.goals if g.target != target]
            anchor = place.anchor and _of_the_same(place.anchor, target)
            self.goals.append(Goal(target, place.relation, anchor, place.furniture))
        self.last = list(things)
        self.place = place

    def meant(self, token: Token) -> list[Description]:
        group = self.waiting or self.last
        return group[-1:] if token.value in ("it", "this one", "that one") else list(group)

    def plan(self) -> Plan:
        # A hand holds one thing: "any" is one of them here, not all of them.
        holds = tuple(
            Goal(replace(thing, every=False) if thing.text.startswith("any ") else thing)
            for thing in self.waiting
        )
        return Plan(tuple(self.goals) + holds)


def _of_the_same(anchor: Description, target: Description) -> Description:
    """Read "the larger one" behind "the smaller battery" as the larger battery."""
    if anchor.size and not anchor.classes and "one" in anchor.text.split():
        return replace(anchor, classes=target.classes)
    return anchor


def _same(one: Description, other: Description) -> bool:
    """Whether a later phrase repeats an earlier one ("the plate ... the plate")."""
    if one.ids or other.ids:
        return one.ids == other.ids
    return replace(one, text="", every=False) == replace(other, text="", every=False)


@lru_cache(maxsize=256)
def understand(instruction: str) -> Plan:
    """Compile an instruction to goals.

    Args:
        instruction: What the user wrote.

    Returns:
        The plan; if any part has no meaning, a plan without goals that names this part.
    """
    tokens = tokenize(rephrased(instruction))
    unknown = [token.text for token in tokens if token.kind is Kind.UNKNOWN]
    if unknown:
        return Plan(problem="'" + "', '".join(dict.fromkeys(unknown)) + "'")
    cursor = Cursor(tokens)
    reading = _Reading()
    try:
        while cursor.peek() is not None:
            if not cursor.accept(*_BREAKS):
                _clause(cursor, reading)
    except NotUnderstood as problem:
        return Plan(problem=str(problem))
    plan = reading.plan()
    return plan if plan.goals else Plan(problem="what to do, as I found no wish in it")


def _clause(cursor: Cursor, reading: _Reading) -> None:
    if verb := cursor.accept(*_VERBS):
        while cursor.peek() in _VERBS and verb.kind is not Kind.PUT:
            verb = cursor.next()
        _verb_clause(verb.kind, cursor, reading)
    elif cursor.accept(Kind.AGAIN):
        if reading.place is None:
            raise NotUnderstood("'the same' (nothing was said before)")
        reading.put(_things(cursor, reading), reading.place)
    elif cursor.peek() in _PLACES:
        _place_first(cursor, reading)
    elif starts_phrase(cursor) or cursor.peek() is Kind.PRONOUN:
        _things_first(cursor, reading)
    else:
        raise cursor.fail("I know picking things up and putting them down")


def _place_first(cursor: Cursor, reading: _Reading) -> None:
    """Read "on the floor, put the plate", "on the floor: the plate"."""
    place = _place(cursor, reading)
    mark = cursor.mark()
    while cursor.accept(Kind.COMMA) and cursor.peek() in (Kind.ON, Kind.IN, Kind.NEAR):
        place = _join(cursor, place, _target_place(cursor, cursor.next().kind))
        mark = cursor.mark()
    cursor.rewind(mark)
    while cursor.accept(Kind.COMMA, Kind.THEN):
        pass
    if not cursor.accept(Kind.PUT, Kind.BRING) and not starts_phrase(cursor):
        raise cursor.fail("I expected a verb like 'put'")
    reading.put(_things(cursor, reading), place)


def _things_first(cursor: Cursor, reading: _Reading) -> None:
    """Read "the plate should be on the floor", or "the plate: put it on the floor"."""
    things = _things(cursor, reading)
    cursor.accept(Kind.GOES)
    if cursor.peek() in _PLACES:
        reading.put(things, _place(cursor, reading))
        _further_pairs(cursor, reading)
        return
    mark = cursor.mark()
    while cursor.accept(*_BREAKS):
        pass
    if cursor.mark() == mark or cursor.peek() not in (Kind.PUT, Kind.BRING, Kind.TAKE):
        cursor.rewind(mark)
        raise cursor.fail("I expected a verb like 'pick' or 'put' before it")
    reading.last = things


def _verb_clause(verb: Kind, cursor: Cursor, reading: _Reading) -> None:
    if verb is not Kind.TAKE and cursor.peek() in _PLACES:  # "put on the floor the plate"
        place = _place(cursor, reading)
        if starts_phrase(cursor) or cursor.peek() is Kind.PRONOUN:
            reading.put(_things(cursor, reading), place)
        else:  # "pick the plate and put on the floor"
            reading.put(reading.waiting or reading.last, place)
        return
    things = _things(cursor, reading)
    if verb is Kind.FIND:
        reading.last = things
        return
    if verb is Kind.TAKE:
        if _is_destination(cursor):
            reading.put(things, _place(cursor, reading))
            _further_pairs(cursor, reading)
        else:
            reading.take(_with_source(cursor, reading, things))
        return
    while cursor.accept(Kind.BE, Kind.GOES, Kind.COMMA):
        pass
    if cursor.peek() not in _PLACES:
        if verb is Kind.BRING:
            reading.take(things)
            return
        raise cursor.fail("where to put it?")
    reading.put(things, _place(cursor, reading))
    _further_pairs(cursor, reading)


def _is_destination(cursor: Cursor) -> bool:
    """Behind "take the plate": whether the place is where to take it, not where it is."""
    if cursor.peek() in (Kind.TO, Kind.THERE, Kind.HELD):
        return True
    words = cursor.ahead()
    return words.startswith(("down ", "onto", "on to", "into"))


def _further_pairs(cursor: Cursor, reading: _Reading) -> None:
    """Read "... and the cup next to the plate": the same verb goes on."""
    while cursor.peek() in _BREAKS:
        mark = cursor.mark()
        while cursor.accept(*_BREAKS):
            pass
        if not starts_phrase(cursor):
            cursor.rewind(mark)
            return
        things = _things(cursor, reading)
        cursor.accept(Kind.GOES, Kind.BE)
        if cursor.peek() in _PLACES:
            reading.put(things, _place(cursor, reading))
        elif reading.place is not None and cursor.peek() in (*_BREAKS, None):
            if _is_topic(cursor):  # "... and the cup, put it on the table"
                cursor.rewind(mark)
                return
            reading.put(things, reading.place)  # "... and then the plate"
        else:
            raise cursor.fail("where to put it?")


def _is_topic(cursor: Cursor) -> bool:
    mark = cursor.mark()
    while cursor.accept(*_BREAKS):
        pass
    found = cursor.peek() in _VERBS and cursor.peek(1) is Kind.PRONOUN
    cursor.rewind(mark)
    return found


def _with_source(cursor: Cursor, reading: _Reading, things: list[Description]) -> list[Description]:
    """Behind "pick the plate": a place says where the plate is now."""
    if cursor.peek() not in (Kind.ON, Kind.NEAR, Kind.IN):
        return things
    place = _place(cursor, reading)
    if place.relation is Relation.FLOOR:
        return [replace(t, source=(Relation.FLOOR, ())) for t in things]
    if place.relation is Relation.NEAR and place.anchor and place.anchor.classes:
        return [replace(t, source=(Relation.NEAR, place.anchor.classes)) for t in things]
    return things


def _things(cursor: Cursor, reading: _Reading) -> list[Description]:
    """A list of noun phrases, or a pronoun."""
    if token := cursor.accept(Kind.PRONOUN):
        if meant := reading.meant(token):
            return meant
        raise NotUnderstood(f"'{token.text}' (I do not know what it refers to)")
    if cursor.peek() is Kind.EVERY and cursor.peek(1) in (*_PLACES, Kind.PRONOUN):
        cursor.next()
        cursor.accept(Kind.PRONOUN)
        return list(reading.waiting or reading.last) or [_EVERYTHING]
    if cursor.peek() is Kind.COUNT and cursor.peek(1) in _PLACES:
        cursor.next()
        if meant := list(reading.waiting or reading.last):
            return meant
    if meant_again := _repeated(cursor, reading):
        return meant_again
    things = [noun_phrase(cursor)]
    while cursor.peek() in (Kind.COMMA, Kind.AND):
        mark = cursor.mark()
        while cursor.accept(Kind.COMMA, Kind.AND):
            pass
        if not starts_phrase(cursor):
            cursor.rewind(mark)
            break
        things.append(noun_phrase(cursor))
    return things


def _repeated(cursor: Cursor, reading: _Reading) -> list[Description]:
    """Read "these objects", "the two items", "the object": what was taken, by a plain noun."""
    group = list(reading.waiting or reading.last)
    mark = cursor.mark()
    while cursor.accept(Kind.DET, Kind.EVERY, Kind.COUNT, Kind.OF):
        pass
    noun = cursor.accept(Kind.OBJECT)
    if group and noun and cursor.peek() in (*_PLACES, None):
        return group
    cursor.rewind(mark)
    return []


def _place(cursor: Cursor, reading: _Reading) -> _Place:
    """Read a destination; two in a row are joined ("on the floor in a corner")."""
    if cursor.accept(Kind.THERE):
        if reading.place is None:
            raise NotUnderstood("'there' (no place was named before)")
        return reading.place
    if cursor.accept(Kind.HELD):
        return _Place(Relation.HOLD)
    place = _target_place(cursor, cursor.next().kind)
    while cursor.peek() in _PLACES:
        word = cursor.next()
        if word.kind in (Kind.THERE, Kind.HELD):
            raise cursor.fail("two places for one thing")
        place = _join(cursor, place, _target_place(cursor, word.kind))
    mark = cursor.mark()
    if cursor.accept(Kind.COMMA) and cursor.peek() in (Kind.ON, Kind.IN):  # "in a corner, on ..."
        more = _target_place(cursor, cursor.next().kind)
        if cursor.peek() not in (*_VERBS, Kind.COMMA):
            return _join(cursor, place, more)
    cursor.rewind(mark)
    return place


def _join(cursor: Cursor, one: _Place, other: _Place) -> _Place:
    relations = {one.relation, other.relation}
    if relations == {Relation.FLOOR, Relation.CORNER}:
        return _Place(Relation.CORNER)
    if relations == {Relation.FLOOR}:
        return one
    if relations == {Relation.SURFACE, Relation.NEAR}:
        return one if one.relation is Relation.NEAR else other
    if relations == {Relation.FLOOR, Relation.NEAR}:
        near = one if one.relation is Relation.NEAR else other
        return _Place(Relation.FLOOR, near.anchor)
    raise cursor.fail("I cannot bring these two places together")


def _target_place(cursor: Cursor, preposition: Kind) -> _Place:
    mark = cursor.mark()
    while cursor.accept(Kind.DET, Kind.COUNT, Kind.ON, Kind.IN):
        pass
    if preposition is not Kind.NEAR and cursor.accept(Kind.NEAR):  # "to beside the plate"
        preposition, mark = Kind.NEAR, cursor.mark()
    if place := _corner(cursor) or _floor(cursor):
        return place
    if furniture := cursor.accept(Kind.FURNITURE):
        return _Place(Relation.SURFACE, furniture=furniture.text)
    if preposition not in (Kind.NEAR, Kind.TO):
        raise cursor.fail("things go on the floor, on furniture or near another thing")
    if cursor.peek() is Kind.PRONOUN:
        raise cursor.fail("near what?")
    cursor.rewind(mark)
    while cursor.accept(Kind.ON, Kind.IN):
        pass
    return _Place(Relation.NEAR, noun_phrase(cursor))


def _corner(cursor: Cursor) -> _Place | None:
    """Read "a corner", "one of the nearest room corners", "the corner of the room"."""
    mark = cursor.mark()
    if cursor.peek() is Kind.OBJECT and cursor.peek(1) is Kind.OF:
        cursor.next()
        cursor.next()
    while cursor.accept(Kind.DET, Kind.COUNT, Kind.NEAREST, Kind.ROOM):
        pass
    if not cursor.accept(Kind.CORNER):
        cursor.rewind(mark)
        return None
    if cursor.accept(Kind.OF):
        cursor.accept(Kind.DET)
        if not cursor.accept(Kind.ROOM, Kind.FLOOR):
            raise cursor.fail("I know the corners of the room")
    return _Place(Relation.CORNER)


def _floor(cursor: Cursor) -> _Place | None:
    """Read "floor", "floor of the room", "floor area"."""
    if not cursor.accept(Kind.FLOOR):
        return None
    if cursor.accept(Kind.OF):
        cursor.accept(Kind.DET)
        cursor.accept(Kind.ROOM)
    cursor.accept(Kind.PART)
    return _Place(Relation.FLOOR)
