"""The commands about scenes: list, check, show, vary, export."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

scenes_app = typer.Typer(help="The scenes, built-in and own.", invoke_without_command=True)

Json = Annotated[bool, typer.Option("--json", help="Print JSON instead of text.")]


@scenes_app.callback()
def scenes(context: typer.Context, json: Json = False) -> None:
    """List the scenes that come with the package."""
    if context.invoked_subcommand is None:
        from adamo_vh.cli.scenes import list_scenes

        list_scenes(as_json=json)


@scenes_app.command("check")
def scenes_check(
    file: Annotated[str, typer.Argument(help="A scene file, or the name of a built-in scene.")],
    out: Annotated[
        Path | None, typer.Option(help="Folder for the pictures; scene-NAME by default.")
    ] = None,
    json: Json = False,
) -> None:
    """Say what is wrong with a scene, and draw it from above and from the start."""
    from adamo_vh.cli.scenes import check

    check(file, out, as_json=json)


@scenes_app.command("show")
def scenes_show(
    file: Annotated[str, typer.Argument(help="A scene file, or the name of a built-in scene.")],
    out: Annotated[
        Path | None, typer.Option(help="Folder for the pictures; scene-NAME by default.")
    ] = None,
) -> None:
    """Draw a scene from above, from the start and from each corner."""
    from adamo_vh.cli.scenes import show

    show(file, out)


@scenes_app.command("vary")
def scenes_vary(
    file: Annotated[str, typer.Argument(help="A scene file, or the name of a built-in scene.")],
    variation: Annotated[
        int, typer.Option(help="Which one: 1 to 999 to tune on, from 1000 to test on.")
    ],
    out: Annotated[Path | None, typer.Option(help="Scene file to write: FILE.toml.")] = None,
    json: Json = False,
) -> None:
    """Show a variation of a scene, in words and pictures, and write it as a scene file."""
    from adamo_vh.cli.scenes import vary

    vary(file, variation, out, as_json=json)


@scenes_app.command("export")
def scenes_export(
    file: Annotated[str, typer.Argument(help="A scene file, or the name of a built-in scene.")],
    out: Annotated[Path, typer.Option(help="Folder to write; is made.")],
    variation: Annotated[int, typer.Option(help="Variation of the scene; 0 as it stands.")] = 0,
) -> None:
    """Write a scene for another engine: scene.json, and a GLB with textures for each asset."""
    from adamo_vh.cli.scenes import export_files

    export_files(file, variation, out)
