"""A person's word before each step: waits for it, and lets it be taken back."""

from __future__ import annotations

import threading
from collections.abc import Callable

from adamo_vh.errors import ConfigError
from adamo_vh.record.turn import Turn
from adamo_vh.studio.messages import Approval, Approve, Veto

_LOOK_S = 0.2
"""So often is looked after what happens meanwhile."""
_NO_REASON = "no reason was given"


class Consent:
    """Asks before a turn is carried out, if somebody wants to be asked."""

    def __init__(
        self,
        cut: threading.Event,
        between: Callable[[], None],
        ask: Callable[[Turn | None], None],
        *,
        is_on: bool,
    ) -> None:
        """Begin.

        Args:
            cut: Ends any wait.
            between: Does what may be done between two steps.
            ask: Tells what is asked; with None, that it was answered.
            is_on: Whether somebody wants to be asked.
        """
        self._cut = cut
        self._between = between
        self._ask = ask
        self.is_on = is_on
        """Whether somebody wants to be asked."""
        self._asking = False
        self._word: str | None = None
        """What was said to the turn that is asked about; empty for yes."""
        self._change = threading.Condition()

    def about(self, turn: Turn) -> str:
        """Why a turn is not to be carried out; empty if it is. In the thread of the session."""
        self._between()
        if not self.is_on:
            return ""
        with self._change:
            self._asking, self._word = True, None
        self._ask(turn)
        try:
            while self._waits():
                self._between()
        finally:
            with self._change:
                self._asking, word = False, self._word
        self._ask(None)
        return word or ""

    def _waits(self) -> bool:
        with self._change:
            self._change.wait_for(lambda: not self._is_open(), _LOOK_S)
            return self._is_open()

    def _is_open(self) -> bool:
        return self._word is None and self.is_on and not self._cut.is_set()

    def hear(self, said: Approve | Veto | Approval) -> None:
        """Take a word, from any thread.

        Raises:
            ConfigError: Nothing is asked now.
        """
        with self._change:
            match said:
                case Approval(on=on):
                    self.is_on = on
                case _ if not self._asking:
                    raise ConfigError("Nothing is asked at this moment.")
                case Approve():
                    self._word = ""
                case Veto(why=why):
                    self._word = why.strip() or _NO_REASON
            self._change.notify_all()

    def give_up(self) -> None:
        """Wait no longer."""
        with self._change:
            self._change.notify_all()
