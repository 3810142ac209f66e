"""How an export is written, beyond its format."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Form:
    """Choices of the caller."""

    inline_pictures: bool = False
    """In sft, pictures inside the lines as data URLs; otherwise as files beside them."""
    with_score: bool = False
    """In sft, each line also has the name and the score of its episode."""
