"""Why one condition was not met."""

from __future__ import annotations

from dataclasses import dataclass

from adamo_vh.analysis.diagnosis.finding import Code


@dataclass(frozen=True, slots=True)
class Cause:
    """What kept one condition from being met."""

    code: Code
    step: int
    """Where it was decided; the earliest of several causes is that of the episode."""
    text: str
    """What happened there, in a sentence."""
    object: int | None = None
    """Id of the object that was asked for."""
    other: int | None = None
    """Id of what was taken for it, or for its anchor."""
