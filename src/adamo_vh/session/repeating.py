"""What happens again while a record is executed: what is heard of it, and what is brought about."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Sequence

from adamo_vh.observation import Frame
from adamo_vh.record.trajectory import Event, Happened, Lost, Observer, Restored

BroughtAbout = Happened | Lost | Restored
"""What is on record and not of the agent's doing."""


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

    def __init__(self, known: Sequence[Event], bring_about: Callable[[BroughtAbout], None]) -> None:
        """Prepare.

        Args:
            known: What is on record and will come again.
            bring_about: Lets it happen again.
        """
        self._ahead = deque(known)
        self._bring_about = bring_about

    def notify(self, event: Event, frame: Frame | None = None) -> None:
        """Go on in the record."""
        if self._ahead:
            self._ahead.popleft()
        self.catch_up()

    def catch_up(self) -> None:
        """Let happen what is next, if it is nothing that the agent does."""
        if self._ahead and isinstance(event := self._ahead[0], BroughtAbout):
            self._bring_about(event)
