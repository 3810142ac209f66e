"""What happens again while a record is executed: what is heard of it, and what is brought about."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Sequence

from adamo_vh.engine import WorldEvent
from adamo_vh.inference.model import Spent
from adamo_vh.observation import Frame
from adamo_vh.record.trajectory import Event, Happened, Lost, Observer


def later(observers: Sequence[Observer], known: int) -> Sequence[Observer]:
    """The observers as hearers of what is new alone."""
    return [_FromThen(observer, known) for observer in observers] if known else observers


class _FromThen:
    """Leaves out the events that an observer has no need to hear again."""

    def __init__(self, observer: Observer, known: int) -> None:
        """Leave out the first ones.

        Args:
            observer: Hears the others.
            known: How many are left out.
        """
        self._observer = observer
        self._known = known

    def notify(self, event: Event, frame: Frame | None = None) -> None:
        """Pass an event on, if it is new."""
        if self._known:
            self._known -= 1
        else:
            self._observer.notify(event, frame)


class Again:
    """Lets happen what is on record and not of the agent's doing, at the moment of then."""

    def __init__(
        self,
        known: Sequence[Event],
        apply: Callable[[WorldEvent], None],
        lose: Callable[[Spent], None],
    ) -> None:
        """Prepare.

        Args:
            known: What is on record and will come again.
            apply: Lets something happen in the world.
            lose: Takes note of what an answer took that never came.
        """
        self._ahead = deque(known)
        self._apply = apply
        self._lose = lose

    def notify(self, event: Event, frame: Frame | None = None) -> None:
        """Go on in the record."""
        if self._ahead:
            self._ahead.popleft()
        self.catch_up()

    def catch_up(self) -> None:
        """Let happen what is next, if it is nothing that the agent does."""
        match self._ahead[0] if self._ahead else None:
            case Happened() as happened:
                self._apply(happened.event)
            case Lost() as lost:
                self._lose(lost.spent)
