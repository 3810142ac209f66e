"""`adamo-vh chat`: a conversation on the terminal."""

from __future__ import annotations

from contextlib import ExitStack
from pathlib import Path
from typing import Any

from rich.console import Console

from adamo_vh.cli.episode import run_folder
from adamo_vh.cli.progress import Progress
from adamo_vh.cognition.budget import Budget, BudgetGuard, Ledger
from adamo_vh.episode.result import EpisodeConfig
from adamo_vh.perception import Labeling
from adamo_vh.record.trajectory import Ended
from adamo_vh.session.chat import ChatSession
from adamo_vh.session.episode import chosen_profile, member


def talk(
    *,
    resume: Path | None,
    out: Path | None,
    record: bool,
    budget: Budget,
    profile: str,
    switches: dict[str, str],
    labeling: str,
    **settings: Any,
) -> None:
    """Read instructions from the terminal, or from a pipe, until they end."""
    console = Console()
    observers = (Progress(console),)
    guards = (BudgetGuard(Budget(), Ledger(), budget),)
    with ExitStack() as stack:
        if resume is not None:
            console.print(f"Going back to where {resume} was left ...", style="dim")
            session = ChatSession.resume(resume, guards=guards, observers=observers)
            first = None
        else:
            first = _ask(console)
            if first is None:
                return
            config = EpisodeConfig(
                instruction=first,
                labeling=member(Labeling, labeling, "labeling"),
                profile=chosen_profile(profile, switches),
                **settings,
            )
            folder = stack.enter_context(run_folder(out, first))
            session = ChatSession.begin(
                config, folder, record=record, guards=guards, observers=observers
            )
        stack.enter_context(session)
        said = first or _ask(console)
        while said is not None:
            _answer(console, session.say(said))
            said = _ask(console)
    kept = f"Kept in {session.folder}; go on with: adamo-vh chat --resume {session.folder}"
    console.print(kept, markup=False, highlight=False, soft_wrap=True)


def _ask(console: Console) -> str | None:
    """The next instruction; None at the end of the conversation."""
    try:
        said = console.input("[bold]you[/bold]         ").strip()
    except EOFError:
        console.print()
        return None
    return None if said in ("", "/quit", "/exit") else said


def _answer(console: Console, ended: Ended) -> None:
    if ended.answer:
        console.print("[bold]agent[/bold]      ", end=" ")
        console.print(ended.answer, markup=False, highlight=False, soft_wrap=True)
    else:
        why = f"; {ended.why}" if ended.why else ""
        console.print(
            f"(stopped: {ended.reason}{why})", style="yellow", markup=False, soft_wrap=True
        )
