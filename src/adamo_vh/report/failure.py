"""Why an episode failed, ready for its page: each fact with the step and the crop that shows it."""

from __future__ import annotations

import io
from collections.abc import Callable, Sequence
from dataclasses import dataclass

from adamo_vh.analysis.diagnosis.finding import Diagnosis, Evidence
from adamo_vh.report.timeline import ShownTurn

_AROUND = 1.2
"""So much of its own size is shown on each side of a thing."""
_LEAST_PX = 90
"""A crop is at least this wide and high, so that one sees where it is."""


@dataclass(frozen=True, slots=True)
class Fact:
    """One fact of a diagnosis."""

    evidence: Evidence
    anchor: str
    """Of the turn that it is about; empty if the page has none."""
    crop: bytes | None
    """JPEG of the part of the picture that it is about."""


def facts(
    diagnosis: Diagnosis, turns: Sequence[ShownTurn], frames: Callable[[str], bytes]
) -> tuple[Fact, ...]:
    """The evidence of a diagnosis.

    Args:
        diagnosis: Of the episode.
        turns: Of its page.
        frames: Gives a recorded picture by its name; one that it fails to find is left out.
    """
    anchors = {act.step: turn.anchor for turn in turns for act in turn.acts}
    first = turns[0].anchor if turns else ""
    return tuple(
        Fact(item, anchors.get(item.step, "" if item.step else first), _crop(item, frames))
        for item in diagnosis.evidence
    )


def _crop(item: Evidence, frames: Callable[[str], bytes]) -> bytes | None:
    """The part of a picture around what it shows, with a frame around that."""
    from PIL import Image, ImageDraw

    if not item.frame or item.box_px is None:
        return None
    try:
        picture = Image.open(io.BytesIO(frames(item.frame))).convert("RGB")
    except (OSError, LookupError, ValueError):
        return None
    left, top, right, bottom = item.box_px
    half_x = max(_LEAST_PX / 2, (right - left) * (0.5 + _AROUND))
    half_y = max(_LEAST_PX / 2, (bottom - top) * (0.5 + _AROUND))
    x, y = (left + right) / 2, (top + bottom) / 2
    part = (
        max(0, round(x - half_x)),
        max(0, round(y - half_y)),
        min(picture.width, round(x + half_x)),
        min(picture.height, round(y + half_y)),
    )
    if part[0] >= part[2] or part[1] >= part[3]:
        return None
    ImageDraw.Draw(picture).rectangle((left - 2, top - 2, right + 1, bottom + 1), outline="#e5484d")
    data = io.BytesIO()
    picture.crop(part).save(data, "JPEG", quality=85)
    return data.getvalue()
