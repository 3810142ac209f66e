"""The commands about engines from outside."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

engines_app = typer.Typer()


@engines_app.command()
def conformance(
    target: Annotated[
        str,
        typer.Argument(
            help="built-in; MODULE:NAME of a function of a scene's name that makes a World; or the "
            "address at which an engine is waited for, ws://127.0.0.1:8020/engine.",
        ),
    ] = "built-in",
    scene: Annotated[str, typer.Option(help="The scene in which it is looked at.")] = "s1",
    only: Annotated[
        list[str] | None,
        typer.Option(help="A check by its name, or by its first word; may be repeated."),
    ] = None,
    html: Annotated[Path | None, typer.Option(help="FILE.html: write one page, too.")] = None,
    json: Annotated[bool, typer.Option("--json", help="Print JSON instead of text.")] = False,
) -> None:
    """Say what a 3D engine does otherwise than ADAMO needs, and how to mend it."""
    from adamo_vh.cli.conformance import examine

    examine(target, scene, only or (), html, json=json)
