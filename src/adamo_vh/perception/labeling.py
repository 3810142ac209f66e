"""Labelings: what an object is called, in the frame and in the text alike.

The two are the paper's (Sec. 4.2). SEM tags tell the class, OPAQ tags tell nothing, so that the
model has to recognise the object by its looks.
"""

from __future__ import annotations

from collections.abc import Mapping
from enum import StrEnum

_QUOTES = "\"'`\u201c\u201d\u2018\u2019"
"""Straight, back and curly quotes."""


class Labeling(StrEnum):
    """How tags are made from an object's id and class."""

    SEM = "sem"
    """Class and id: `Plate_57`."""
    OPAQ = "opaq"
    """The id alone: `57`."""

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
