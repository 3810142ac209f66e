"""`adamo-vh run --body URL`: the mind is here, and its body on a server."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import typer
from rich.console import Console

from adamo_vh.cli.episode import show_result
from adamo_vh.cli.exits import Exit
from adamo_vh.cli.progress import Progress
from adamo_vh.cli.settings import refuse_if_given
from adamo_vh.cli.terminal import line, put_json, say
from adamo_vh.episode.config import EpisodeConfig
from adamo_vh.errors import ConfigError
from adamo_vh.record.termination import TerminationReason

_THE_SERVERS = (
    "figure grid tool text engine engine_port max_steps max_seconds record out video sign agent_cmd"
)


def run_away(
    context: typer.Context,
    instruction: str | None,
    where: tuple[str, str, str],
    settings: dict[str, Any],
    *,
    as_json: bool,
) -> None:
    """Run an episode whose body is elsewhere, and print what happens.

    Args:
        context: The command, for what was given.
        instruction: What the agent is told; None for a task.
        where: URL of the server, token of players, token of the judge.
        settings: As for any episode.
        as_json: Print one JSON object at the end alone.
    """
    from adamo_vh.session.away import AwaySession

    refuse_if_given(context, "is the server's to say; leave it out.", *_THE_SERVERS.split())
    url, token, judge = where
    config = EpisodeConfig.of(instruction, **settings)
    if config.own_task is not None:
        raise ConfigError("A server scores its own tasks alone: use T1 to T15, or an instruction.")
    observers = () if as_json else (Progress(Console()),)
    with AwaySession(config, url, token=token, observers=observers) as away:
        if not as_json:
            line("session", f"{away.body.session} on {url}")
        ended = away.play()
        session, is_over = away.body.session, away.body.ended
    if judge:
        from adamo_vh.service.judging import fetch_result

        result = fetch_result(url, session, judge)
        show_result(result, Path(result.run or ""), as_json=as_json)
        return
    broke = ended.reason is TerminationReason.BROKEN and not is_over
    if as_json:
        put_json({"session": session, "ended": is_over, "answer": ended.answer})
    else:
        say("")
        line("fault" if broke else "answer", ended.answer or f"(none: {ended.reason})")
        line("score", "kept by the server; --judge-token prints it")
    if broke:
        raise typer.Exit(Exit.NO)
