"""From events and poses to the messages of a track."""

from __future__ import annotations

from collections.abc import Callable

from adamo_vh.inference.model import Spent
from adamo_vh.observation import Frame
from adamo_vh.record.trajectory import (
    Acted,
    Ended,
    Event,
    Lost,
    Observed,
    Started,
    Stood,
    Thought,
)
from adamo_vh.session.posing import Posing
from adamo_vh.studio import messages
from adamo_vh.studio.messages import Doing, Href, Message

Tell = Callable[[Message, float], None]
"""Takes a message and the simulated second that it belongs to."""


class Telling:
    """Tells what happens in one world. An observer of its events."""

    def __init__(
        self,
        tell: Tell,
        href: Href,
        posing: Posing | None,
        thinking: Doing = "thinking",
        *,
        rests: bool = True,
    ) -> None:
        """Begin.

        Args:
            tell: Takes the messages.
            href: Where a picture can be had.
            posing: Tells the poses; None if nothing is executed.
            thinking: What is being done while the mind decides.
            rests: Whether nothing is being done as soon as an instruction has ended.
        """
        self._rests = rests
        self._thinking = thinking
        self._tell_at = tell
        self._href = href
        self._posing = posing
        self._acts = 0
        self.doing: Doing = "idle"
        """What is being done."""
        self.speed = 1.0
        """How fast simulated time passes."""
        self.can_undo = False
        """Whether there is something to put back."""
        self._spent: Spent | None = None

    @property
    def seconds(self) -> float:
        """Simulated seconds so far; the number of steps, where nothing is executed."""
        return float(self._acts) if self._posing is None else self._posing.seconds

    def tell(self, message: Message) -> None:
        """Tell something that belongs to this moment."""
        self._tell_at(message, self.seconds)

    def notify(self, event: Event, frame: Frame | None = None) -> None:
        """Tell of an event, with the world as it is after it."""
        if isinstance(event, Stood):
            return  # It repeats for the checker what the poses show.
        self._acts += isinstance(event, Acted)
        self.pose()
        self.tell(messages.event(event, self._href))
        before = self.doing, self._spent
        match event:
            case Started():
                self.doing = "seeing"
            case Observed():
                self.doing = self._thinking
            case Thought():
                self.doing = "acting"
                self._spend(Spent.on(event.reply))
            case Acted():
                self.doing = self._thinking
            case Lost():
                self._spend(event.spent)
            case Ended():
                self.doing = "idle" if self._rests else self.doing
                if event.spent is not None:
                    self._spend(event.spent)
            case _:
                pass
        if (self.doing, self._spent) != before:
            self.status()

    def pose(self) -> None:
        """Tell how figure and things stand, if that changed."""
        if self._posing is not None and (shown := self._posing.pose()) is not None:
            self.tell(messages.pose(shown))

    def status(self) -> None:
        """Tell what is being done."""
        spent = self._spent or Spent()
        self.tell(messages.status(self.doing, self.speed, spent, can_undo=self.can_undo))

    def _spend(self, spent: Spent) -> None:
        self._spent = spent if self._spent is None else self._spent + spent
