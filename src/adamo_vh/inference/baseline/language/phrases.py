"""Noun phrases: from symbols to descriptions of things."""

from __future__ import annotations

from dataclasses import dataclass, field

from adamo_vh.inference.baseline.language.cursor import Cursor
from adamo_vh.inference.baseline.language.plan import Description, Relation, Size
from adamo_vh.inference.baseline.language.words import Kind, Token

_BEFORE_NOUN = frozenset(
    (
        Kind.DET,
        Kind.EVERY,
        Kind.COUNT,
        Kind.COLOUR,
        Kind.SHAPE,
        Kind.GLASSY,
        Kind.SIZE,
        Kind.OTHER,
        Kind.NEAREST,
    )
)
_STARTERS = _BEFORE_NOUN | {Kind.CLASS, Kind.OBJECT, Kind.ID, Kind.TAGGED, Kind.LABEL}


_PLURAL_NOUNS = (
    "objects|items|things|articles|ones|stuff|products|locks|padlocks|batteries|flashlights|"
    "torches|tapes|screwdrivers|cans|tins|medicines|keys|bottles|glasses|tumblers|cups|mugs|"
    "plants|plates|dishes|lighters|corners|belongings|food|foods|groceries|edibles|eatables|tools|"
    "kitchenware|tableware|crockery|utensils|vessels|drinkware|drinks|beverages|snacks|others"
)


MEASURED = (Size.NEAREST, Size.FARTHEST)
FARTHEST = ("farthest", "furthest", "most distant", "remotest")
_SPARED = {"but one": 1, "but two": 2, "but three": 3}


def _is_plural(token: Token) -> bool:
    """Whether a noun means several things; "pills" or "field glasses" are one."""
    return token.value != "Binoculars" and any(
        word in _PLURAL_NOUNS.split("|") for word in token.text.split()
    )


@dataclass(slots=True)
class _Draft:
    """A description under construction."""

    ids: list[str] = field(default_factory=list)
    classes: list[str] = field(default_factory=list)
    colours: list[str] = field(default_factory=list)
    part_colours: list[str] = field(default_factory=list)
    shapes: list[str] = field(default_factory=list)
    transparent: bool = False
    label: bool = False
    size: Size | None = None
    rank: int = 1
    other: bool = False
    definite: bool = False
    but: list[Description] = field(default_factory=list)
    every: bool = False
    count: int | None = None
    spared: int = 0
    generic: bool = False
    plural: bool = False
    source: tuple[Relation, tuple[str, ...]] | None = None
    measured_from: tuple[str, ...] = ()

    def narrow(self, value: str) -> None:
        """Add what a class word may mean: of two, what both can, or else the last, the head."""
        new = value.split()
        both = [name for name in self.classes if name in new]
        self.classes = both or new

    def says_something(self) -> bool:
        return bool(
            self.ids or self.classes or self.colours or self.part_colours or self.shapes
            or self.transparent or self.label or self.size or self.every or self.other
            or (self.count and self.plural)
        )  # fmt: skip

    def finish(self, text: str) -> Description:
        return Description(
            text=text,
            ids=tuple(dict.fromkeys(self.ids)),
            classes=tuple(self.classes),
            colours=tuple(dict.fromkeys(self.colours)),
            part_colours=tuple(dict.fromkeys(self.part_colours)),
            shapes=tuple(dict.fromkeys(self.shapes)),
            transparent=self.transparent,
            label=self.label,
            size=self.size,
            rank=self.rank,
            other=self.other,
            definite=self.definite and not self.plural,
            but=tuple(self.but),
            spared=self.spared,
            every=self.every or (self.plural and (self.count or 0) > 1),
            count=self.count if self.plural else None,
            source=self.source,
            measured_from=self.measured_from,
        )


def starts_phrase(cursor: Cursor) -> bool:
    """Whether a noun phrase begins here."""
    return cursor.peek() in _STARTERS


def noun_phrase(cursor: Cursor, placed: bool = False) -> Description:
    """Read a noun phrase.

    Args:
        cursor: At its first word.
        placed: Whether a place behind it may tell which thing is meant.

    Raises:
        NotUnderstood: Here begins none, or it says nothing that tells things apart.
    """
    begin = cursor.mark()
    draft = _Draft()
    _before_noun(cursor, draft)
    _noun(cursor, draft)
    any_of_them = cursor.words_since(begin).startswith("any ")
    while _after_noun(cursor, draft):
        # "any object with a label" on the floor: all such objects.
        draft.every = draft.every or (any_of_them and draft.generic)
    if not draft.says_something() and not draft.generic:
        raise cursor.fail("I expected a thing here")
    text = cursor.words_since(begin)
    if not draft.says_something() and not (placed and cursor.peek() in (Kind.NEAR, Kind.SIDE)):
        cursor.rewind(begin)
        raise cursor.fail("this could be any object")
    return draft.finish(text)


def _before_noun(cursor: Cursor, draft: _Draft) -> None:
    while cursor.peek() in _BEFORE_NOUN or cursor.peek() in (Kind.COMMA, Kind.AND):
        if cursor.peek() in (Kind.COMMA, Kind.AND):
            adjectives = (Kind.COLOUR, Kind.SHAPE, Kind.GLASSY)
            if (draft.colours or draft.shapes) and cursor.peek(1) in adjectives:
                cursor.next()
                continue
            return
        _adjective(cursor.next(), draft)


def _adjective(token: Token, draft: _Draft) -> None:
    match token.kind:
        case Kind.EVERY:
            draft.every = True
            draft.spared = _SPARED.get(" ".join(token.text.split()[1:3]), 0)
        case Kind.COUNT:
            draft.count = int(token.value)
        case Kind.COLOUR:
            draft.colours.append(token.value)
        case Kind.SHAPE:
            draft.shapes.append(token.value)
        case Kind.GLASSY:
            draft.transparent = True
        case Kind.SIZE:
            size, _, rank = token.value.partition(" ")
            draft.size, draft.rank = Size(size), int(rank or 1)
        case Kind.NEAREST:
            draft.size = Size.NEAREST
        case Kind.OTHER:
            draft.other = True
        case Kind.DET:
            draft.definite = draft.definite or token.text in ("the", "this", "that", "my", "your")


def _noun(cursor: Cursor, draft: _Draft) -> bool:
    """The head: a class, a generic noun, or nothing ("the smallest")."""
    found = False
    while cursor.peek() in (Kind.CLASS, Kind.OBJECT) or (
        cursor.peek() is Kind.LABEL and cursor.peek(1) in (Kind.CLASS, Kind.OBJECT)
    ):
        token = cursor.next()
        found = True
        if token.kind is Kind.CLASS:
            draft.narrow(token.value)
        elif token.kind is Kind.LABEL:
            draft.label = True
        else:
            draft.generic = True
        if _is_plural(token):
            draft.plural = True
            draft.every = draft.every or not draft.count
    return found


def _after_noun(cursor: Cursor, draft: _Draft) -> bool:
    """One further remark behind the noun; False if there is none."""
    mark = cursor.mark()
    readers = (_except, _id, _of, _nearest, _location, _being, _having, _text)
    for reader in readers:
        if reader(cursor, draft):
            return True
        cursor.rewind(mark)
    return False


def _except(cursor: Cursor, draft: _Draft) -> bool:
    """Read "except the cup and the plate"."""
    if cursor.peek() is not Kind.EXCEPT:
        return False
    draft.but += left_out(cursor)
    draft.every = draft.every or draft.plural
    return True


def left_out(cursor: Cursor) -> list[Description]:
    """Read "except the cup, the key, and the plate".

    Raises:
        NotUnderstood: No thing follows.
    """
    cursor.next()
    things = [noun_phrase(cursor)]
    while cursor.peek() in (Kind.AND, Kind.COMMA, Kind.OR):
        mark = cursor.mark()
        while cursor.accept(Kind.AND, Kind.COMMA, Kind.OR):
            pass
        if not starts_phrase(cursor):
            cursor.rewind(mark)
            break
        things.append(noun_phrase(cursor))
    return things


def _id(cursor: Cursor, draft: _Draft) -> bool:
    """Read "tagged as 34", "number 34", "34 and 35", "called plate"."""
    cursor.accept(Kind.THAT)
    marked = False
    while cursor.accept(Kind.TAGGED, Kind.BE):
        marked = True
    if marked and (token := cursor.accept(Kind.CLASS)):
        draft.narrow(token.value)
        return True
    if token := cursor.accept(Kind.ID):
        draft.ids.append(token.value)
        while cursor.peek() in (Kind.AND, Kind.COMMA) and cursor.peek(1) is Kind.ID:
            cursor.next()
            draft.ids.append(cursor.next().value)
            draft.every = True
        return True
    return False


def _of(cursor: Cursor, draft: _Draft) -> bool:
    """Read "the smallest of the locks", "of all", "of red colour"."""
    if not cursor.accept(Kind.OF):
        return False
    if cursor.peek() is Kind.COLOUR:
        _adjective(cursor.next(), draft)
        cursor.accept(Kind.PART)
        return True
    every = draft.every
    seen = False
    while cursor.peek() in _BEFORE_NOUN or cursor.peek() is Kind.PRONOUN:
        token = cursor.next()
        seen = True
        if token.kind not in (Kind.PRONOUN, Kind.COUNT):
            _adjective(token, draft)
    seen = _noun(cursor, draft) or seen
    seen = (draft.size is not None and cursor.accept(Kind.MEASURE) is not None) or seen
    draft.every = every  # "one of the locks" is one, "all of the locks" is read before
    return seen


def _location(cursor: Cursor, draft: _Draft) -> bool:
    """Read "that is on the floor", "standing near the plate", "from the table": where it is now."""
    cursor.accept(Kind.THAT)
    is_now = cursor.accept(Kind.BE)
    word = cursor.accept(Kind.FROM) or (
        is_now and cursor.accept(Kind.ON, Kind.NEAR, Kind.IN, Kind.TO)
    )
    if not word:
        return False
    cursor.accept(Kind.ON)
    while cursor.accept(Kind.DET):
        pass
    if cursor.accept(Kind.FLOOR):
        draft.source = (Relation.FLOOR, ())
        return True
    if cursor.accept(Kind.ROOM):
        return True
    if furniture := cursor.accept(Kind.FURNITURE):
        draft.source = (Relation.SURFACE, (furniture.text,))
        return True
    if word.kind is Kind.NEAR and (token := cursor.accept(Kind.CLASS)):
        draft.source = (Relation.NEAR, tuple(token.value.split()))
        return True
    return False


def _nearest(cursor: Cursor, draft: _Draft) -> bool:
    """Read "(that is) closest to the plate", "farthest from you"."""
    cursor.accept(Kind.THAT)
    cursor.accept(Kind.BE)
    while cursor.accept(Kind.DET):
        pass
    far = cursor.peek() is Kind.SIZE and cursor.ahead() in FARTHEST
    if far or cursor.peek() is Kind.NEAREST:
        _adjective(cursor.next(), draft)
    elif draft.size not in MEASURED or cursor.peek() not in (Kind.TO, Kind.FROM):
        return False
    if cursor.accept(Kind.TO, Kind.FROM):
        while cursor.accept(Kind.DET):
            pass
        if token := cursor.accept(Kind.CLASS):
            draft.measured_from = tuple(token.value.split())
    return True


def _being(cursor: Cursor, draft: _Draft) -> bool:
    """Read "that is blue and round", "which are the smallest"."""
    cursor.accept(Kind.THAT)
    if not cursor.accept(Kind.BE, Kind.IN):
        return False
    cursor.accept(Kind.DET, Kind.COUNT)
    seen = False
    while token := cursor.accept(Kind.COLOUR, Kind.SHAPE, Kind.GLASSY, Kind.SIZE):
        seen = True
        if token.kind is Kind.COLOUR and cursor.peek() is Kind.PART:
            draft.part_colours.append(token.value)
        else:
            _adjective(token, draft)
        cursor.accept(Kind.PART)
        if cursor.peek() in (Kind.AND, Kind.COMMA) and cursor.peek(1) in (
            Kind.COLOUR,
            Kind.SHAPE,
            Kind.GLASSY,
        ):
            cursor.next()
    if not seen and cursor.accept(Kind.LABEL):
        draft.label = True
        return True
    return seen


def _having(cursor: Cursor, draft: _Draft) -> bool:
    """Read "with white parts", "that have a printed label", "with the smallest volume"."""
    cursor.accept(Kind.THAT)
    if not cursor.accept(Kind.WITH):
        return False
    return _possession(cursor, draft)


def _possession(cursor: Cursor, draft: _Draft) -> bool:
    while cursor.accept(Kind.DET, Kind.EVERY, Kind.OBJECT):
        pass
    if cursor.peek() is Kind.SIZE:
        _adjective(cursor.next(), draft)
        return cursor.accept(Kind.MEASURE) is not None
    if token := cursor.accept(Kind.COLOUR):
        draft.part_colours.append(token.value)
        cursor.accept(Kind.PART)
        if cursor.peek() is Kind.AND and cursor.peek(1) is Kind.COLOUR:
            cursor.next()
            return _possession(cursor, draft)
        _on_it(cursor)
        return True
    if cursor.accept(Kind.PART):
        if cursor.accept(Kind.BE, Kind.IN, Kind.OF) and (token := cursor.accept(Kind.COLOUR)):
            draft.part_colours.append(token.value)
            return True
        return False
    if _text(cursor, draft):
        return True
    return _id(cursor, draft)


def _text(cursor: Cursor, draft: _Draft) -> bool:
    """Read "a printed label", "labelled TOMATO SOUP"."""
    if not cursor.accept(Kind.LABEL):
        return False
    while cursor.accept(Kind.LABEL, Kind.BE, Kind.DET):
        pass
    if token := cursor.accept(Kind.CLASS):
        draft.narrow(token.value)
    elif token := cursor.accept(Kind.ID):
        draft.ids.append(token.value)
    else:
        draft.label = True
    _on_it(cursor)
    return True


def _on_it(cursor: Cursor) -> None:
    mark = cursor.mark()
    cursor.accept(Kind.BE)
    if not (cursor.accept(Kind.ON, Kind.IN) and cursor.accept(Kind.PRONOUN)):
        cursor.rewind(mark)
