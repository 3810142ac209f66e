"""What became of each thing that was handled, as the feedback tells it."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass

from adamo_vh.record.trajectory import Acted

_RESTS = re.compile(
    r"(?P<tag>\S+) rests at \((?P<point>[^()]+)\) "
    r"(?P<support>[^,]+?)(?:, [\d.]+ m from it)?\.$"
)
"""The sentence of a Drop, see `adamo_vh.action_server.feedback.dropped`."""


@dataclass(frozen=True, slots=True)
class Whereabouts:
    """Where a thing is, as the last feedback on it says."""

    tag: str
    """As the agent calls it."""
    step: int
    """Of that feedback."""
    place: str
    """In words: "on the shelf (top)", or "in the hand"."""
    plan: tuple[float, float] | None = None
    """X and Y where it rests, metres; None in the hand."""

    @property
    def is_held(self) -> bool:
        """Whether it is in the hand."""
        return self.plan is None

    @property
    def support(self) -> str:
        """What it rests on, without article and level; empty in the hand or in the air."""
        words = self.place.split(" (")[0]
        return words.removeprefix("on ").removeprefix("the ") if words.startswith("on ") else ""


def followed(
    acts: Iterable[Acted], before: Mapping[str, Whereabouts] | None = None
) -> dict[str, Whereabouts]:
    """Follow things through what was executed.

    Args:
        acts: In order.
        before: What is known already.

    Returns:
        By tag, everything that was handled; what left the hand in a way that no feedback tells is
        not among it.
    """
    known = dict(before or {})
    held = next((tag for tag, item in known.items() if item.is_held), None)
    for act in acts:
        now = act.agent.held
        if held is not None and now != held:
            known.pop(held, None)
        if now is not None and now != held:
            known[now] = Whereabouts(now, act.step, "in the hand")
        elif now is None and (rests := _RESTS.search(act.feedback.text)):
            plan = _plan(rests["point"])
            if plan is not None and held is not None and rests["tag"] == held:
                known[held] = Whereabouts(held, act.step, rests["support"], plan)
        held = now
    return known


def _plan(point: str) -> tuple[float, float] | None:
    try:
        x, y, _ = (float(number) for number in point.split(","))
    except ValueError:
        return None
    return x, y
