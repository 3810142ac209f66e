"""What was asked, what was answered, and what moved in between, once or many times."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import pairwise

from adamo_vh.engine import WorldState
from adamo_vh.perception import Labeling
from adamo_vh.record.trajectory import Ended
from adamo_vh.report.contradictions import contradictions
from adamo_vh.report.timeline import ShownTurn
from adamo_vh.report.whereabouts import Whereabouts, followed


@dataclass(frozen=True, slots=True)
class Exchange:
    """One instruction with everything that was done for it."""

    number: int
    """From 1."""
    instruction: str
    turns: tuple[ShownTurn, ...]
    """At least one."""
    moved: tuple[Whereabouts, ...]
    """Where things were put in it, as the feedback says."""
    doubts: tuple[str, ...]
    """Where the answer contradicts the feedback."""

    @property
    def anchor(self) -> str:
        """Names it within the page."""
        return f"exchange-{self.number}"

    @property
    def ended(self) -> Ended | None:
        """How it ended; None if the record stops before."""
        return self.turns[-1].ended

    @property
    def steps(self) -> int:
        """Calls that were executed or refused."""
        return sum(len(turn.acts) for turn in self.turns)


def exchanges(
    turns: Sequence[ShownTurn], instruction: str, world: WorldState, labeling: Labeling
) -> tuple[Exchange, ...]:
    """Group turns by what they were asked for.

    Args:
        turns: The episode or conversation.
        instruction: The first one.
        world: The world at the start.
        labeling: What the things are called.
    """
    starts = [i for i, turn in enumerate(turns) if turn.started and i] if turns else []
    known: dict[str, Whereabouts] = {}
    found: list[Exchange] = []
    for first, after in pairwise([0, *starts, len(turns)]):
        part = tuple(turns[first:after])
        if not part:
            continue
        acts = [act for turn in part for act in turn.acts]
        before, known = known, followed(acts, known)
        said = "\n".join(_said(part)) if part[-1].ended else ""
        started = part[0].started
        found.append(
            Exchange(
                len(found) + 1,
                started.instruction if started else instruction,
                part,
                tuple(item for tag, item in known.items() if before.get(tag) != item),
                contradictions(said, world, labeling, known, acts),
            )
        )
    return tuple(found)


def _said(turns: Sequence[ShownTurn]) -> Iterable[str]:
    """The answer, and what was said to be verified."""
    ended, closing = turns[-1].ended, turns[-1].closing
    if ended and ended.reason.is_scored:
        yield ended.answer
        if closing:
            yield closing.verified
