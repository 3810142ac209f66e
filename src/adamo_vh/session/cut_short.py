"""Actions that a person cut short, when a record is executed again: they end where they ended."""

from __future__ import annotations

from collections import deque
from collections.abc import Sequence

from adamo_vh.action import Action
from adamo_vh.action_server import ActionResult, ActionServer, Sighting
from adamo_vh.errors import InvalidActionError
from adamo_vh.record.trajectory import Acted, Event, Observed


class CutShort:
    """An action server that repeats what is on record of a cut action, and does all others.

    At which moment somebody stops an action, no execution brings about again. So the world goes to
    the state that was saved then, and the feedback is the recorded one.
    """

    def __init__(self, server: ActionServer, known: Sequence[Event]) -> None:
        """Prepare.

        Args:
            server: Carries out all that was not cut, and all that is new.
            known: What is on record and will come again.
        """
        self._server = server
        self._ahead = deque(
            (event, isinstance(after, Observed))
            for event, after in zip(known, [*known[1:], None], strict=True)
            if isinstance(event, Acted)
        )
        """Each act on record, and whether it brought a view."""

    @property
    def actions(self) -> tuple[type, ...]:
        """Those of the server."""
        return self._server.actions

    def observe(self) -> Sighting:
        """What is seen now."""
        return self._server.observe()

    def execute(self, action: Action) -> ActionResult:
        """Carry out an action, or go to where it was cut."""
        act, has_view = self._ahead.popleft() if self._ahead else (None, False)
        if act is None or not act.is_cut:
            return self._server.execute(action)
        state_hash = self._server.load(act.saved)
        view = self._server.observe().observation if has_view else None
        return ActionResult(act.feedback, act.agent, view, state_hash, act.saved)

    def refuse(self, error: InvalidActionError) -> ActionResult:
        """Refuse a call."""
        if self._ahead:
            self._ahead.popleft()
        return self._server.refuse(error)

    def say(self, text: str) -> None:
        """Deliver the final answer."""
        self._server.say(text)

    def load(self, saved: str) -> str:
        """Go back to a saved state."""
        return self._server.load(saved)


def as_recorded(server: ActionServer, known: Sequence[Event]) -> ActionServer:
    """The server for executing a record again; itself, where nothing was cut short."""
    cut = any(isinstance(e, Acted) and e.is_cut for e in known)
    return CutShort(server, known) if cut else server
