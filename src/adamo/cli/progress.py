"""Live progress of an episode: what is thought, done and answered, as it happens."""

from __future__ import annotations

import json

from rich.console import Console
from rich.text import Text

from adamo.action import Outcome
from adamo.cognition.trajectory import Acted, Event, Observed, Started, Thought
from adamo.observation import Frame

_STYLE = {Outcome.DONE: "green", Outcome.CORRECTED: "yellow", Outcome.REFUSED: "red"}


class Progress:
    """Prints each event: coloured on a terminal, plain lines otherwise."""

    def __init__(self, console: Console) -> None:
        """Print to a console."""
        self._console = console

    def notify(self, event: Event, frame: Frame | None = None) -> None:
        """Print an event."""
        match event:
            case Started():
                self._line("instruction", event.instruction, "bold")
            case Observed():
                seen = f"{len(event.objects)} objects, {len(event.points)} reference points"
                self._line("view", seen, "dim")
            case Thought() if event.calls:
                self._line(f"step {event.step + 1}", event.note or "(no note)", "")
                call = event.calls[0]
                arguments = json.dumps(call.arguments) if call.arguments is not None else call.raw
                self._line("call", f"{call.name} {arguments}", "cyan")
            case Acted():
                self._line("feedback", event.feedback.text, _STYLE[event.feedback.outcome])
            case _:
                pass

    def _line(self, label: str, text: str, style: str) -> None:
        words = Text(" ".join(text.split()), style)
        self._console.print(Text(f"{label:<11} ", "bold") + words, soft_wrap=True)
