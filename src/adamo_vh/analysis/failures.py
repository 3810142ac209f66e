"""What failed, and how often for which reason."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass

from adamo_vh.analysis.cells import in_order, natural
from adamo_vh.analysis.outcome import Outcome

PAPER_CLASSES = ("perceptual", "execution", "reasoning")
"""The paper's percentages are taken over these three."""
UNDIAGNOSED = "undiagnosed"


@dataclass(frozen=True, slots=True)
class Share:
    """How many failures of some models under a labeling are of one class and code."""

    labeling: str
    model: str | None
    """None: all models together, as in the paper."""
    class_: str
    code: str | None
    """None: the whole class."""
    count: int
    share: float | None
    """Of the failures of the paper's three classes; None for a class that is none of them."""


def failures(outcomes: Iterable[Outcome]) -> tuple[Outcome, ...]:
    """The scored episodes below 1.0."""
    return tuple(o for o in in_order(outcomes) if o.is_scored and not o.is_complete)


def shares(outcomes: Iterable[Outcome]) -> tuple[Share, ...]:
    """Failures by labeling, for all models and for each, by class and then by code."""
    failed = failures(outcomes)
    models: list[str | None] = [None, *sorted({o.model for o in failed}, key=natural)]
    found = []
    for labeling in sorted({o.labeling for o in failed}, key=natural):
        for model in models:
            here = [o for o in failed if o.labeling == labeling and model in (None, o.model)]
            found += _shares(labeling, model, here)
    return tuple(found)


def _shares(labeling: str, model: str | None, failed: list[Outcome]) -> list[Share]:
    classes = Counter(o.diagnosis or UNDIAGNOSED for o in failed)
    codes = Counter((o.diagnosis or UNDIAGNOSED, o.diagnosis_code) for o in failed)
    whole = sum(classes[name] for name in PAPER_CLASSES)
    order = [*PAPER_CLASSES, *sorted(classes.keys() - set(PAPER_CLASSES))]
    rows = []
    for name in order:
        known = whole if name in PAPER_CLASSES else 0
        count = classes[name]
        rows.append(Share(labeling, model, name, None, count, count / known if known else None))
        for (of, code), times in sorted(codes.items()):
            if of == name and code:
                share = times / known if known else None
                rows.append(Share(labeling, model, name, code, times, share))
    return rows
