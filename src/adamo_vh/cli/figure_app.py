"""The commands about figures: export one, check an own one."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any

import typer
from typer.core import TyperGroup


class _Figures(TyperGroup):
    """`adamo-vh figure FILE.glb` is short for `adamo-vh figure export FILE.glb`."""

    def resolve_command(self, ctx: Any, args: list[str]) -> Any:
        """Which command is meant."""
        if args and args[0] not in self.commands:
            args = ["export", *args]
        return super().resolve_command(ctx, args)


figure_app = typer.Typer(
    cls=_Figures,
    help="The virtual human: export one as GLB, or check one of your own.",
    no_args_is_help=True,
)


@figure_app.command("export")
def export_figure(
    file: Annotated[Path, typer.Argument(help="FILE.glb to write.")],
    who: Annotated[
        str, typer.Option(help="mara, jonas, amina, ken, or a file of your own: .glb or .vrm.")
    ] = "mara",
) -> None:
    """Export the virtual human as a skinned GLB with the clips walk, reach and idle."""
    from adamo_vh.cli.figure import export

    export(file, who)


@figure_app.command("check")
def check_figure(
    file: Annotated[Path, typer.Argument(help="A rigged humanoid: FILE.glb or FILE.vrm.")],
    out: Annotated[
        Path | None,
        typer.Option(help="Also draw it standing, walking, reaching and holding: FILE.png."),
    ] = None,
    json: Annotated[bool, typer.Option("--json", help="Print JSON instead of text.")] = False,
) -> None:
    """Say what of a character of your own is used, what it lacks, and whose it is."""
    from adamo_vh.cli.figure import check

    check(file, out, as_json=json)
