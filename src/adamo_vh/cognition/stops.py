"""Whether to go on: every reason to end early is weighed here, before each model call."""

from __future__ import annotations

from collections import deque
from collections.abc import Sequence
from dataclasses import dataclass, field

from adamo_vh.cognition.doubts import Doubts
from adamo_vh.cognition.guards import Guard, LoopGuard, ProtocolGuard
from adamo_vh.cognition.oversight import Oversight
from adamo_vh.observation import Frame
from adamo_vh.record.termination import Limits, Stop, Stopwatch, TerminationReason
from adamo_vh.record.trajectory import Ended, Event, LeftOut, Vetoed
from adamo_vh.record.turn import Turn


@dataclass(frozen=True, slots=True)
class Errand:
    """What belongs to one instruction alone."""

    first_step: int
    """Steps that were made before it."""
    doubts: Doubts
    """What was asked back so far."""
    watch: Stopwatch = field(default_factory=Stopwatch)


class Stops:
    """Limits, loops, protocol, budgets, a person's word, and what is on record already.

    An agent that carries out again what is on record ends as it did then, whatever stopped it: a
    clock, a budget, a person or a provider that failed. The guards hear everything, and have a say
    when the record is used up.
    """

    def __init__(
        self,
        limits: Limits,
        guards: Sequence[Guard],
        known: Sequence[Event] = (),
        oversight: Oversight | None = None,
    ) -> None:
        """Set the reasons.

        Args:
            limits: Of each instruction.
            guards: Further reasons, e.g. a budget.
            known: What is on record and will come again.
            oversight: The word of a person.
        """
        self._oversight = oversight or Oversight()
        self._limits = limits
        self._guards: tuple[Guard, ...] = (
            ProtocolGuard(limits.max_unreadable),
            LoopGuard(limits.max_repeats),
            *guards,
        )
        self._ahead = deque(known)

    def notify(self, event: Event, frame: Frame | None = None) -> None:
        """Go on in the record, and tell the guards: of what was recorded, where it comes again."""
        if self._ahead:
            event = self._ahead.popleft()
        for guard in self._guards:
            guard.notify(event, frame)

    @property
    def ends_here(self) -> bool:
        """Whether the end comes next in the record: what it broke on then is not tried again."""
        return bool(self._ahead) and isinstance(self._ahead[0], Ended)

    def begin(self) -> None:
        """An instruction begins."""
        self._oversight.begin()

    def veto(self, turn: Turn) -> str:
        """Why a person does not let a turn be carried out; empty if nobody minds."""
        if self._ahead:
            return self._ahead[0].why if isinstance(self._ahead[0], Vetoed) else ""
        return self._oversight.objection(turn)

    @property
    def why_not(self) -> str:
        """Why the next call is not carried out: a person has stopped the agent meanwhile."""
        if self._ahead:
            return self._ahead[0].why if isinstance(self._ahead[0], LeftOut) else ""
        return "the user stopped you" if self._oversight.is_stopped else ""

    def stop(self, errand: Errand, steps: int) -> Stop | None:
        """Why to stop now; None to go on.

        Args:
            errand: The instruction that is being carried out.
            steps: All steps so far, those of earlier instructions too.
        """
        if self._ahead:
            if not isinstance(ended := self._ahead[0], Ended):
                return None
            return Stop(ended.reason, ended.why, ended.answer, ended.spent)
        if self._oversight.is_stopped:
            return Stop(TerminationReason.STOPPED, "The user stopped it.")
        if limit := self._limits.exceeded(steps - errand.first_step, errand.watch.seconds):
            return limit
        return next((stop for guard in self._guards if (stop := guard.stop())), None)
