"""The command `adamo-vh mcp`."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from adamo_vh.serving.admission import TOKEN_VARIABLE

mcp_app = typer.Typer()


@mcp_app.command()
def mcp(
    instruction: Annotated[
        str | None,
        typer.Argument(
            help="What the one episode is about; without it and --task, clients begin their own.",
            show_default=False,
        ),
    ] = None,
    task: Annotated[
        str | None, typer.Option(help="A task instead: T1 to T15, or a task file.")
    ] = None,
    scene: Annotated[str, typer.Option(help="Built-in scene or scene file.")] = "s1",
    figure: Annotated[
        str, typer.Option(help="Body: mara, jonas, amina, ken, or a file of your own.")
    ] = "mara",
    labeling: Annotated[str, typer.Option(help="sem or opaq.")] = "sem",
    profile: Annotated[
        str, typer.Option(help="How the mind is spoken to: paper, paper-exact, lean or single.")
    ] = "paper",
    switch: Annotated[
        list[str] | None,
        typer.Option(help="One switch of the profile, e.g. pictures=none; may be repeated."),
    ] = None,
    seed: Annotated[int, typer.Option(help="Seed of every draw.")] = 0,
    variation: Annotated[int, typer.Option(help="Variation of the scene; 0 as it stands.")] = 0,
    resolution: Annotated[str, typer.Option(help="Frame size, WIDTHxHEIGHT.")] = "1920x1080",
    max_steps: Annotated[int, typer.Option(help="Step cap.")] = 60,
    max_seconds: Annotated[
        float, typer.Option(help="Time cap; the time in which the mind thinks counts.")
    ] = 600.0,
    out: Annotated[
        Path | None,
        typer.Option(
            help="Run folder of the one episode, which is gone on with if it was begun; else "
            "where the run folders go. Below runs/ by default."
        ),
    ] = None,
    http: Annotated[
        int | None,
        typer.Option(
            help="Serve HTTP on this port instead of the standard streams; 0: a free one."
        ),
    ] = None,
    token: Annotated[
        str,
        typer.Option(help="What HTTP requests must bring as bearer token.", envvar=TOKEN_VARIABLE),
    ] = "",
    sessions: Annotated[int, typer.Option(help="Episodes at once.")] = 16,
    idle: Annotated[
        float, typer.Option(help="Seconds after which an episode nobody plays is closed.")
    ] = 1800.0,
) -> None:
    """Let any MCP client play: a scored episode through look, walk, pick and drop."""
    from adamo_vh.cli.mcp import serve
    from adamo_vh.cli.settings import pairs
    from adamo_vh.record.termination import Limits

    serve(
        out,
        http,
        token,
        most=sessions,
        idle_s=idle,
        instruction=instruction,
        task=task,
        scene=scene,
        figure=figure,
        labeling=labeling,
        profile=profile,
        switches=pairs(switch, "switch"),
        seed=seed,
        variation=variation,
        resolution=resolution,
        limits=Limits(max_steps=max_steps, max_seconds=max_seconds),
    )
