"""`adamo-vh chat`: a conversation on the terminal."""

from __future__ import annotations

import sys
from contextlib import ExitStack
from pathlib import Path
from typing import Any

import typer
from rich.console import Console

from adamo_vh.cli.episode import mark_latest, run_folder
from adamo_vh.cli.exits import Exit
from adamo_vh.cli.progress import Progress
from adamo_vh.cli.terminal import is_text, line, say
from adamo_vh.cognition.budget import Budget
from adamo_vh.episode.config import EpisodeConfig
from adamo_vh.readable import readable
from adamo_vh.record.trajectory import Ended
from adamo_vh.session.session import Session

_LEAVE = ("quit", "exit", "/quit", "/exit", "/q")
_ASK = ("/help", "/?", "help", "?")
_GREETING = "Say what to do, in plain words. /help says more; /quit or Ctrl+D leaves."
_HELP = """\
Say what to do: "Put the plate on the floor". World and memory stay from one line to the next.
  /help           this
  /quit, Ctrl+D   leave; so do quit, exit and /exit. The conversation can be gone on with.
  Ctrl+C          stop what is being done, and leave"""


def talk(
    *,
    resume: Path | None,
    out: Path | None,
    record: bool,
    budget: Budget,
    **settings: Any,
) -> None:
    """Read instructions from the terminal, or from a pipe, until they end."""
    console = Console()
    observers = (Progress(console),)
    say(_GREETING, "dim")
    heard = _Ear(console)
    with ExitStack() as stack:
        first = None
        if resume is not None:
            say(f"Going back to where {resume} was left ...", "dim")
            session = Session.resume(resume, cap=budget, observers=observers)
        else:
            first = heard.next()
            if first is None:
                raise typer.Exit(heard.code)
            config = EpisodeConfig.of(first, **settings)
            folder = stack.enter_context(run_folder(out, first))
            session = Session.begin(config, folder, record=record, cap=budget, observers=observers)
            mark_latest(folder)
        kept = f"Kept in {session.folder}; go on with: adamo-vh chat --resume {session.folder}"
        stack.callback(say, kept)
        stack.enter_context(session)
        said = first or heard.next()
        while said is not None:
            _answer(session.say(said))
            said = heard.next()
    raise typer.Exit(heard.code)


class _Ear:
    """What the user says; what is meant for the terminal alone is answered here."""

    def __init__(self, console: Console) -> None:
        self._console = console
        self.code = Exit.DONE
        """How the command ends: a pipe that was not understood is told so."""

    def next(self) -> str | None:
        """The next instruction; None at the end of the conversation."""
        while (said := self._line()) is not None:
            word = said.lower()
            if word in _LEAVE:
                return None
            if word in _ASK:
                say(_HELP)
            elif said.startswith("/"):
                say(f"There is no {said.split()[0]}; /help lists what there is.", "yellow")
            elif said:
                return said
        return None

    def _line(self) -> str | None:
        """A line as it may be kept and shown; empty if there is nothing in it."""
        typed = sys.stdin is not None and sys.stdin.isatty()
        try:
            said = self._console.input("[bold]you[/bold]         " if typed else "")
        except EOFError:
            if typed:
                self._console.print()
            return None
        if not is_text(said):
            say("That is not UTF-8 text and is left out; set the terminal to UTF-8.", "yellow")
            self.code = self.code if typed else Exit.WRONG
            return ""
        said = readable(said).strip()
        if said and not typed:
            line("you", said)  # What a pipe says is shown, as what is typed is.
        return said


def _answer(ended: Ended) -> None:
    if ended.answer:
        line("agent", ended.answer)
    else:
        why = f"; {ended.why}" if ended.why else ""
        say(f"(stopped: {ended.reason}{why})", "yellow")
