"""The command that opens the studio."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from adamo_vh.cli.listen_options import Address, AllowedHosts
from adamo_vh.serving.admission import TOKEN_VARIABLE

studio_app = typer.Typer()


@studio_app.command("studio")
def studio(
    runs: Annotated[
        list[Path] | None,
        typer.Argument(help="Run folders, studies, or folders of runs to look at; runs/ if none."),
    ] = None,
    port: Annotated[int, typer.Option(help="Port; 0 for a free one.")] = 8000,
    open_page: Annotated[bool, typer.Option("--open", help="Open the page in a browser.")] = False,
    model: Annotated[
        list[str] | None,
        typer.Option(help="One more model that may be chosen on the page; may be repeated."),
    ] = None,
    scene: Annotated[
        list[Path] | None,
        typer.Option(help="One more scene file that may be chosen; may be repeated."),
    ] = None,
    figure: Annotated[
        list[Path] | None,
        typer.Option(help="A figure of your own: FILE.glb or FILE.vrm; may be repeated."),
    ] = None,
    resolution: Annotated[
        str, typer.Option(help="Size of the frames that a mind is shown, WIDTHxHEIGHT.")
    ] = "1920x1080",
    host: Address = "127.0.0.1",
    token: Annotated[
        str,
        typer.Option(help="What visitors must bring; new to make one up.", envvar=TOKEN_VARIABLE),
    ] = "",
    allow_host: AllowedHosts = None,
    ears: Annotated[
        str,
        typer.Option(
            help="What hears: a model's name or folder, or none; what was fetched, by default.",
            show_default=False,
        ),
    ] = "",
    voice: Annotated[
        str,
        typer.Option(
            help="Her voice: a name, FILE.onnx, flite, or none; what was fetched, by default.",
            show_default=False,
        ),
    ] = "",
    rooms: Annotated[
        int, typer.Option(help="So many rooms are open at once; each takes 0.4 GB.", min=1)
    ] = 4,
    out: Annotated[
        Path | None, typer.Option(help="Where run folders of rooms go; runs/ by default.")
    ] = None,
) -> None:
    """Open the studio: a page to see a mind in a body, talk to it, and look at its runs again."""
    from adamo_vh.cli.studio import studio as open_studio

    open_studio(
        runs or [],
        host,
        port,
        out,
        token=token,
        hosts=allow_host or [],
        models=model or [],
        scenes=scene or [],
        figures=figure or [],
        most_rooms=rooms,
        resolution=resolution,
        ears=ears,
        voice=voice,
        opens=open_page,
    )
