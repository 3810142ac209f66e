"""Tags of objects as texts show them: "Plate_57", "57", "Wine_Bottle_36", or an own labeling's."""

from __future__ import annotations

TAG = r"\b(?:[A-Za-z]\w*_)?\d+\b"
"""A tag in running text: a number, with a name before it or without one."""


def parts_of(tag: str) -> tuple[str, str]:
    """The name and the number of a tag; what it lacks is empty.

    The name ends at the last underscore, and only a number stands behind it.
    """
    name, _, number = tag.rpartition("_")
    return (name, number) if number.isdigit() else (tag, "")
