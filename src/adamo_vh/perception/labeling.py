"""Labelings: what an object is called, in the frame and in the text alike.

Two are the paper's (Sec. 4.2). SEM tags tell the class, OPAQ tags tell nothing, so that the model
has to recognise the object by its looks. Others can be handed in: whatever is a `Tagger`. Nothing
else makes a tag or takes one apart.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from enum import StrEnum
from typing import Protocol

_DRESS = " \t\r\n\"'`\u201c\u201d\u2018\u2019[](){}<>*"
"""Blanks, quotes, brackets and stars, which models put round a tag."""
_WRITTEN = re.compile(r"(?P<name>.*?)(?P<gap>[ _-]?)(?P<number>#?)(?P<id>0|[1-9][0-9]{0,8})")
_WHOLE = re.compile(r"(#?[0-9]{1,9})\.0{1,6}")
_LONGEST = 200
_ANY_OBJECT = frozenset({"object", "tag", "id"})
"""Words that name every object alike, so that the number behind them tells all."""


class Tagger(Protocol):
    """Makes tags and reads them: the two of `Labeling`, or an own one."""

    @property
    def described(self) -> str:
        """What the instructions tell the model about its tags, in a sentence or two."""
        ...

    def tag(self, object_id: int, class_name: str) -> str:
        """The tag of an object; no two objects have the same."""
        ...

    def short(self, object_id: int, class_name: str) -> str:
        """The shortest name of an object that `resolve` understands; may be the tag."""
        ...

    def resolve(self, text: str, known: Mapping[int, str]) -> int | None:
        """The object that a model means, or None if it names none without doubt.

        Args:
            text: The tag as the model wrote it.
            known: Class by id of the objects that may be named.
        """
        ...


class Labeling(StrEnum):
    """How tags are made from an object's id and class."""

    SEM = "sem"
    """Class and id: `Plate_57`."""
    OPAQ = "opaq"
    """The id alone: `57`."""

    @property
    def described(self) -> str:
        """What the instructions tell the model about its tags."""
        return _DESCRIBED[self]

    def short(self, object_id: int, class_name: str) -> str:
        """The number alone, which both understand."""
        return str(object_id)

    def tag(self, object_id: int, class_name: str) -> str:
        """The tag of an object."""
        match self:
            case Labeling.SEM:
                return f"{class_name}_{object_id}"
            case Labeling.OPAQ:
                return str(object_id)

    def resolve(self, text: str, known: Mapping[int, str]) -> int | None:
        """Find the object that a model means.

        Case, and quotes and brackets around the tag, do not matter; between class and number may
        stand ``_``, ``-``, a blank or ``#``. The bare id is understood under both labelings, since
        instructions say "the object tagged as 34"; so are ``#34``, ``34.0`` and ``object 34``.
        Nothing is guessed: a right id with a wrong class names no object, nor does a semantic tag
        under OPAQ.

        Args:
            text: The tag as the model wrote it.
            known: Class by id of the objects that may be named.

        Returns:
            The object's id, or None if the text names none of the known objects.
        """
        wanted = text[:_LONGEST].strip(_DRESS)
        wanted = whole[1] if (whole := _WHOLE.fullmatch(wanted)) else wanted
        found = _WRITTEN.fullmatch(wanted)
        if found is None or int(found["id"]) not in known:
            return None
        object_id = int(found["id"])
        name = _folded(found["name"])
        if not found["name"]:
            return None if found["gap"] else object_id
        fits = name in _ANY_OBJECT or (self is Labeling.SEM and name == _folded(known[object_id]))
        return object_id if fits else None


def _folded(name: str) -> str:
    return re.sub(r"[ _-]", "", name.casefold())


_DESCRIBED = {
    Labeling.SEM: "A tag says what an object is and its number: Class_number. "
    "The number alone names the same object.",
    Labeling.OPAQ: "A tag is a number that says nothing about the object: "
    "tell objects apart by how they look in the frame.",
}
