"""Labelings: what an object is called, in the frame and in the text alike.

Two are the paper's (Sec. 4.2). SEM tags tell the class, OPAQ tags tell nothing, so that the model
has to recognise the object by its looks. Others can be handed in: whatever is a `Tagger`. Nothing
else makes a tag or takes one apart.
"""

from __future__ import annotations

from collections.abc import Mapping
from enum import StrEnum
from typing import Protocol

_QUOTES = "\"'`\u201c\u201d\u2018\u2019"
"""Straight, back and curly quotes."""


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

        Case, white space around the tag and quotes do not matter. The bare id is understood under
        both labelings, since instructions say "the object tagged as 34". Nothing is guessed: a
        right id with a wrong class names no object, nor does a semantic tag under OPAQ.

        Args:
            text: The tag as the model wrote it.
            known: Class by id of the objects that may be named.

        Returns:
            The object's id, or None if the text names none of the known objects.
        """
        wanted = text.strip().strip(_QUOTES).strip().casefold()
        for object_id, class_name in known.items():
            if wanted in (str(object_id), self.tag(object_id, class_name).casefold()):
                return object_id
        return None


_DESCRIBED = {
    Labeling.SEM: "A tag says what an object is and its number: Class_number. "
    "The number alone names the same object.",
    Labeling.OPAQ: "A tag is a number that says nothing about the object: "
    "tell objects apart by how they look in the frame.",
}
