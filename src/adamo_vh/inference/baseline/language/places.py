"""Places: from symbols to where a thing shall be."""

from __future__ import annotations

from dataclasses import replace

from adamo_vh.inference.baseline.language.cursor import Cursor, NotUnderstood
from adamo_vh.inference.baseline.language.phrases import noun_phrase
from adamo_vh.inference.baseline.language.plan import Description, Relation
from adamo_vh.inference.baseline.language.referring import TOGETHER, Place, Reading, resolved_other
from adamo_vh.inference.baseline.language.words import Kind

VERBS = (Kind.TAKE, Kind.FIND, Kind.PUT, Kind.BRING)

_SPOTS = (Kind.SIDE, Kind.BETWEEN, Kind.UNDER, Kind.FAR, Kind.EDGE, Kind.HOME, Kind.SHIFT)

PLACES = (
    *(Kind.ON, Kind.IN, Kind.TO, Kind.NEAR, Kind.THERE, Kind.HELD, Kind.TOGETHER),
    *_SPOTS,
)

BREAKS = (Kind.THEN, Kind.COMMA, Kind.AND)

_SPECIAL = (
    Relation.BETWEEN, Relation.UNDER, Relation.EDGE, Relation.HOME, Relation.SHIFT, Relation.FAR,
    Relation.LEFT, Relation.RIGHT, Relation.FRONT, Relation.BEHIND,
)  # fmt: skip


def read_spot(cursor: Cursor, reading: Reading) -> Place:
    """Read a destination; two in a row are joined ("on the floor in a corner")."""
    if cursor.accept(Kind.THERE):
        if reading.place is None:
            raise NotUnderstood("'there' (no place was named before)")
        return reading.place
    if cursor.accept(Kind.HELD):
        return Place(Relation.HOLD)
    if cursor.accept(Kind.TOGETHER):
        return TOGETHER
    place = _one_place(cursor, reading)
    while cursor.peek() in PLACES:
        if cursor.peek() in (Kind.THERE, Kind.HELD, Kind.TOGETHER):
            raise cursor.fail("two places for one thing")
        if _landmark(cursor, reading):
            continue
        place = _join(cursor, place, _one_place(cursor, reading))
    mark = cursor.mark()
    if cursor.accept(Kind.COMMA) and cursor.peek() in (Kind.ON, Kind.IN):  # "in a corner, on ..."
        more = _target_place(cursor, cursor.next().kind, reading)
        if cursor.peek() not in (*VERBS, Kind.COMMA):
            return _join(cursor, place, more)
    cursor.rewind(mark)
    return place


def _landmark(cursor: Cursor, reading: Reading) -> bool:
    """Read "in the corner NEAR THE WINDOW": which corner that is, cannot be told."""
    mark = cursor.mark()
    cursor.next()
    while cursor.accept(Kind.DET):
        pass
    token = cursor.accept(Kind.LANDMARK)
    if token is None:
        cursor.rewind(mark)
        return False
    reading.remarks.append(f"I cannot tell where the {token.text} is, so I did not heed that.")
    return True


def _one_place(cursor: Cursor, reading: Reading) -> Place:
    """Read one destination without what follows it."""
    distance = None
    if cursor.peek() is Kind.SHIFT:
        word = cursor.next().value
        direction, centimetres = (
            word.rstrip("0123456789"),
            word.lstrip("abcdefghijklmnopqrstuvwxyz"),
        )
        distance = int(centimetres or 25) / 100
        if direction:
            return Place(Relation.SHIFT, distance_m=distance, direction=direction)
        if cursor.peek() is Kind.FROM:
            cursor.next()
            return Place(Relation.FAR, _anchor(cursor, reading), distance_m=distance)
        if cursor.peek() not in (Kind.SIDE, Kind.FAR):
            raise NotUnderstood(f"'{centimetres} cm' (which way, or from what?)")
    token = cursor.next()
    if token.kind is Kind.HOME:
        return Place(Relation.HOME)
    if token.kind in (Kind.SIDE, Kind.FAR):
        relation = Relation(token.value) if token.kind is Kind.SIDE else Relation.FAR
        return Place(relation, _anchor(cursor, reading), distance_m=distance)
    if token.kind is Kind.BETWEEN:
        return _between(cursor, reading)
    if token.kind is Kind.EDGE:
        _optional_furniture(cursor)
        return Place(Relation.EDGE)
    if token.kind is Kind.UNDER:
        furniture = _optional_furniture(cursor)
        if not furniture:
            raise cursor.fail("things can lie under furniture only")
        return Place(Relation.UNDER, furniture=furniture)
    return _target_place(cursor, token.kind, reading)


def _between(cursor: Cursor, reading: Reading) -> Place:
    one = _anchor(cursor, reading)
    if one.every and one.count == 2:
        return Place(Relation.BETWEEN, replace(one, every=False, count=None), second=one)
    if not cursor.accept(Kind.AND):
        raise cursor.fail("between what and what?")
    return Place(Relation.BETWEEN, one, second=_anchor(cursor, reading))


def _optional_furniture(cursor: Cursor) -> str:
    while cursor.accept(Kind.DET, Kind.OF, Kind.COUNT):
        pass
    token = cursor.accept(Kind.FURNITURE)
    if token is None:
        cursor.accept(Kind.PRONOUN)
    return token.text if token else ""


def _anchor(cursor: Cursor, reading: Reading) -> Description:
    """The thing that a place is told by."""
    if token := cursor.accept(Kind.PRONOUN):
        meant = reading.last or reading.waiting
        if reading.before and meant == reading.pointed:  # "take the cup and put it next to it"
            meant = reading.before
        if not meant:
            raise NotUnderstood(f"'{token.text}' (I do not know what it refers to)")
        return meant[-1] if len(meant) == 1 or not token.text.startswith("th") else meant[0]
    mark = cursor.mark()
    while cursor.accept(Kind.DET):
        pass
    if token := cursor.accept(Kind.FURNITURE, Kind.LANDMARK):
        raise NotUnderstood(
            f"'{token.text}' (I cannot tell where the {token.text} is, only where things are)"
        )
    cursor.rewind(mark)
    return resolved_other(noun_phrase(cursor), reading)


def _join(cursor: Cursor, one: Place, other: Place) -> Place:
    relations = {one.relation, other.relation}
    if relations == {Relation.FLOOR, Relation.CORNER}:
        return Place(Relation.CORNER)
    if relations == {Relation.FLOOR}:
        return one
    if relations == {Relation.SURFACE, Relation.NEAR}:
        return one if one.relation is Relation.NEAR else other
    if relations == {Relation.FLOOR, Relation.NEAR}:
        near = one if one.relation is Relation.NEAR else other
        return Place(Relation.FLOOR, near.anchor)
    special = [p for p in (one, other) if p.relation in _SPECIAL]
    plain = [p for p in (one, other) if p.relation in (Relation.FLOOR, Relation.SURFACE)]
    if len(special) == len(plain) == 1:  # "on the table between the plate and the cup"
        return special[0]
    raise cursor.fail("I cannot bring these two places together")


def _target_place(cursor: Cursor, preposition: Kind, reading: Reading) -> Place:
    mark = cursor.mark()
    while cursor.accept(Kind.DET, Kind.COUNT, Kind.ON, Kind.IN):
        pass
    if "another" in cursor.words_since(mark) and cursor.peek() is Kind.FURNITURE:
        raise cursor.fail("I cannot tell one from another")
    if preposition is not Kind.NEAR and cursor.accept(Kind.NEAR):  # "to beside the plate"
        preposition, mark = Kind.NEAR, cursor.mark()
    if place := _corner(cursor) or _floor(cursor):
        return place
    if furniture := cursor.accept(Kind.FURNITURE):
        if preposition is Kind.NEAR:
            raise NotUnderstood(
                f"'{furniture.text}' (I cannot tell where the {furniture.text} is, only where "
                "things are)"
            )
        return Place(Relation.SURFACE, furniture=furniture.text)
    if landmark := cursor.accept(Kind.LANDMARK):
        raise NotUnderstood(
            f"'{landmark.text}' (I cannot tell where the {landmark.text} is, only where things are)"
        )
    if preposition not in (Kind.NEAR, Kind.TO):
        raise cursor.fail("things go on the floor, on furniture or near another thing")
    if cursor.peek() is not Kind.PRONOUN:
        cursor.rewind(mark)
        while cursor.accept(Kind.ON, Kind.IN):
            pass
    return Place(Relation.NEAR, _anchor(cursor, reading))


def _corner(cursor: Cursor) -> Place | None:
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
    return Place(Relation.CORNER)


def _floor(cursor: Cursor) -> Place | None:
    """Read "floor", "floor of the room", "floor area"."""
    if not cursor.accept(Kind.FLOOR):
        return None
    if cursor.accept(Kind.OF):
        cursor.accept(Kind.DET)
        cursor.accept(Kind.ROOM)
    cursor.accept(Kind.PART)
    return Place(Relation.FLOOR)
