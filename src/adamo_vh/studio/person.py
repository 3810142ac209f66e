"""A person as the mind of a body: the page hands in the calls."""

from __future__ import annotations

import time
from contextlib import suppress

from adamo_vh.errors import ConfigError, ModelError
from adamo_vh.inference.players.outside import HUMAN, OutsideModel
from adamo_vh.studio.messages import Act, Finish

_FOR_EVER_S = 1e9
_SOON_S = 2.0
"""A call that comes a moment too early waits so long for the question."""
_STEP_S = 0.05
_GAVE_UP = "I stop here."


class Person:
    """Hands what a person decides to the session that waits for it."""

    def __init__(self) -> None:
        """Begin with nothing decided."""
        # Whoever plays on the page sees the whole room, and not only what the body sees.
        self.model = OutsideModel(HUMAN, _FOR_EVER_S, isolation="none")
        """What the session asks."""

    def play(self, wish: Act | Finish) -> None:
        """Make a call, or give the final answer.

        Raises:
            ConfigError: It is not this person's turn.
        """
        until = time.monotonic() + _SOON_S
        while True:
            try:
                if isinstance(wish, Act):
                    self.model.call(wish.name, wish.arguments)
                else:
                    self.model.answer(wish.answer or "Done.")
                return
            except ModelError as error:
                if time.monotonic() > until:
                    raise ConfigError(f"{error} Say first what is to be done.") from None
            time.sleep(_STEP_S)

    def give_up(self) -> None:
        """End what this person was doing: nothing more is decided."""
        with suppress(ModelError):
            self.model.answer(_GAVE_UP)

    def leave(self) -> None:
        """The room closes: what is asked is not answered any more."""
        self.model.cut_off("The room was closed.")
