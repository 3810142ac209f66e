"""Whether to go on: every reason to end early is weighed here, before each model call."""

from __future__ import annotations

from collections import deque
from collections.abc import Sequence
from dataclasses import dataclass, field

from adamo_vh.cognition.doubts import Doubts
from adamo_vh.cognition.guards import Guard, LoopGuard, ProtocolGuard
from adamo_vh.observation import Frame
from adamo_vh.record.termination import Limits, Stop, Stopwatch
from adamo_vh.record.trajectory import Ended, Event


@dataclass(frozen=True, slots=True)
class Errand:
    """What belongs to one instruction alone."""

    first_step: int
    """Steps that were made before it."""
    doubts: Doubts
    """What was asked back so far."""
    watch: Stopwatch = field(default_factory=Stopwatch)


class Stops:
    """Limits, loops, protocol, budgets, and what is on record already.

    An agent that carries out again what is on record ends as it did then, whatever stopped it: a
    clock, a budget or a provider that failed. The guards hear everything, and have a say when the
    record is used up.
    """

    def __init__(
        self, limits: Limits, guards: Sequence[Guard], known: Sequence[Event] = ()
    ) -> None:
        """Set the reasons.

        Args:
            limits: Of each instruction.
            guards: Further reasons, e.g. a budget.
            known: What is on record and will come again.
        """
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
        if limit := self._limits.exceeded(steps - errand.first_step, errand.watch.seconds):
            return limit
        return next((stop for guard in self._guards if (stop := guard.stop())), None)
