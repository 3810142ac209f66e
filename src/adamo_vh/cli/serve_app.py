"""The command that serves the body to programs from outside."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from adamo_vh.cli.listen_options import Address, AllowedHosts
from adamo_vh.serving.admission import JUDGE_VARIABLE, TOKEN_VARIABLE

serve_app = typer.Typer()


@serve_app.command("serve")
def serve(
    scene: Annotated[str, typer.Option(help="Where sessions play that name no scene.")] = "s1",
    labeling: Annotated[str, typer.Option(help="sem or opaq.")] = "sem",
    figure: Annotated[
        str, typer.Option(help="Body: mara, jonas, amina, ken, or a file of your own.")
    ] = "mara",
    engine: Annotated[
        str,
        typer.Option(help="built-in; or remote: engines dial in at /engine (docs/engines.md)."),
    ] = "built-in",
    profile: Annotated[str, typer.Option(help="Of sessions that name none.")] = "paper",
    resolution: Annotated[str, typer.Option(help="Frame size, WIDTHxHEIGHT.")] = "1920x1080",
    host: Address = "127.0.0.1",
    port: Annotated[int, typer.Option(help="Port; 0 for a free one.")] = 8000,
    token: Annotated[
        str,
        typer.Option(help="What players must bring; new to make one up.", envvar=TOKEN_VARIABLE),
    ] = "",
    judge: Annotated[
        str,
        typer.Option(
            help="What a judge brings, to be told state, score and result; new to make one up.",
            envvar=JUDGE_VARIABLE,
        ),
    ] = "",
    allow_host: AllowedHosts = None,
    sessions: Annotated[int, typer.Option(help="So many are played at once.", min=1)] = 16,
    idle: Annotated[
        float, typer.Option(help="Seconds after which an unused session is closed.", min=1)
    ] = 900.0,
    max_steps: Annotated[int, typer.Option(help="Step cap of an episode.")] = 60,
    max_seconds: Annotated[
        float, typer.Option(help="Time cap of an episode; the player's time counts.")
    ] = 600.0,
    out: Annotated[
        Path | None, typer.Option(help="Where run folders go; a new folder below runs/ by default.")
    ] = None,
) -> None:
    """Serve the body to programs from outside: HTTP, WebSocket, and what else is installed."""
    from adamo_vh.cli.serve import serve as serve_body
    from adamo_vh.record.termination import Limits

    serve_body(
        host,
        port,
        out,
        token=token,
        judge=judge,
        hosts=allow_host or [],
        engine=engine,
        scene=scene,
        labeling=labeling,
        figure=figure,
        profile=profile,
        resolution=resolution,
        most_sessions=sessions,
        idle_s=idle,
        limits=Limits(max_steps=max_steps, max_seconds=max_seconds),
    )
