"""Live progress of an episode: what is thought, done and answered, as it happens."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from typing import Any

from rich.console import Console

from adamo_vh.action import Outcome
from adamo_vh.cli.terminal import line
from adamo_vh.observation import Frame
from adamo_vh.record.trajectory import (
    Acted,
    Ended,
    Event,
    LeftOut,
    Observed,
    Shown,
    Started,
    Thought,
)
from adamo_vh.record.turn import Wish

_STYLE = {Outcome.DONE: "green", Outcome.CORRECTED: "yellow", Outcome.REFUSED: "red"}


class Progress:
    """Prints each event: coloured on a terminal, plain lines otherwise."""

    def __init__(self, console: Console) -> None:
        """Print to a console."""
        self._console = console
        self._wishes: Sequence[Wish] = ()
        """The calls of the turn that nothing has come of so far."""
        self._said = ""
        """What may be the answer; the caller prints it if it is."""

    def notify(self, event: Event, frame: Frame | None = None) -> None:
        """Print an event."""
        match event:
            case Started():
                self._line("instruction", event.instruction, "bold")
            case Observed():
                seen = f"{len(event.objects)} objects, {len(event.points)} reference points"
                self._line("view", seen, "dim")
            case Thought():
                self._settle()
                self._thought(event)
            case Acted():
                self._acted(event)
            case LeftOut():
                self._left_out(event)
            case Shown():
                self._line("close-up", f"{event.width_px} x {event.height_px} pixels", "dim")
            case Ended():
                self._said = ""
                self._settle()

    def _thought(self, event: Thought) -> None:
        wishes, text = event.turn.wishes, event.reply.message.text.strip()
        if event.reply.unreadable:
            self._line("unreadable", event.reply.unreadable, "red")
        elif len(wishes) == 1 and wishes[0].is_finish:
            self._finish(wishes[0])
        elif wishes:
            note = text or " ".join(dict.fromkeys(wish.note for wish in wishes))
            self._line(f"step {event.step + 1}", note.strip() or "(no note)", "")
            self._wishes = wishes
        else:
            self._said = text or "(nothing)"

    def _finish(self, wish: Wish) -> None:
        said = wish.arguments or {}
        self._line("finish", f"{wish.note or '(no note)'}{_sure(wish)}", "")
        for label, key in (("verified", "verified"), ("not seen", "unseen")):
            if said.get(key):
                self._line(label, str(said[key]), "dim")
        self._said = wish.answer

    def _acted(self, event: Acted) -> None:
        wish = self._next_wish()
        if wish is not None and wish.call.name != event.name:
            self._line("not done", f"{_spelt(wish)}: too unsure, so shown close up first", "yellow")
        elif wish is not None:
            self._line("call", _spelt(wish), "cyan")
        else:
            self._line("call", f"{event.name} {_json(event.arguments)}", "cyan")
        self._line("feedback", event.feedback.text, _STYLE[event.feedback.outcome])

    def _left_out(self, event: LeftOut) -> None:
        wish = self._next_wish()
        what = event.name if wish is None or wish.is_finish else _spelt(wish)
        self._line("not done", f"{what}: {event.why}", "dim")

    def _next_wish(self) -> Wish | None:
        wish, self._wishes = next(iter(self._wishes), None), self._wishes[1:]
        return wish

    def _settle(self) -> None:
        """Say what became of the last turn, now that something else follows."""
        for wish in self._wishes:
            self._line("not done", wish.call.name if wish.is_finish else _spelt(wish), "dim")
        if self._said:
            self._line("not ended", f"{self._said} (asked to go on)", "yellow")
        self._wishes, self._said = (), ""

    def _line(self, label: str, text: str, style: str) -> None:
        line(label, " ".join(text.split()), style, console=self._console)


def _spelt(wish: Wish) -> str:
    arguments = wish.call.raw if wish.arguments is None else _json(wish.arguments)
    return f"{wish.call.name} {arguments}{_sure(wish)}"


def _json(arguments: Mapping[str, Any] | None) -> str:
    return json.dumps(arguments, ensure_ascii=False)


def _sure(wish: Wish) -> str:
    return "" if wish.confidence is None else f" (confidence {wish.confidence:g})"
