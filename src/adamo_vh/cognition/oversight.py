"""The person beside the agent: lets a turn be carried out or not, and may stop it at any moment."""

from __future__ import annotations

import threading
from collections.abc import Callable

from adamo_vh.record.turn import Turn

Consent = Callable[[Turn], str]
"""Asked with every turn that would act: empty to let it be carried out, or why not."""


class Oversight:
    """What a person decides while an agent carries out an instruction; nobody minds by default."""

    def __init__(self, consent: Consent | None = None) -> None:
        """Begin without an objection.

        Args:
            consent: Is asked with every turn that would act; may take its time.
        """
        self._consent = consent
        self._stopped = threading.Event()

    @property
    def is_stopped(self) -> bool:
        """Whether the instruction is to end."""
        return self._stopped.is_set()

    def begin(self) -> None:
        """A new instruction begins; what was stopped before is over."""
        self._stopped.clear()

    def stop(self) -> None:
        """Let the instruction end before anything more is done; from any thread."""
        self._stopped.set()

    def objection(self, turn: Turn) -> str:
        """Why a turn is not to be carried out; empty if it is."""
        return "" if self._consent is None or self.is_stopped else self._consent(turn).strip()
