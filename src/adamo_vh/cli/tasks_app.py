"""The commands of `adamo-vh tasks`."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

Json = Annotated[bool, typer.Option("--json", help="Print JSON instead of text.")]

tasks_app = typer.Typer(help="The benchmark's tasks, and own ones.", invoke_without_command=True)


@tasks_app.callback()
def tasks(context: typer.Context, json: Json = False) -> None:
    """List the tasks with their C-D levels."""
    if context.invoked_subcommand is None:
        from adamo_vh.cli.tasks import list_tasks

        list_tasks(as_json=json)


@tasks_app.command("verify")
def verify(
    scene: Annotated[str | None, typer.Option(help="One scene; all by default.")] = None,
    variation: Annotated[int, typer.Option(help="Variation of the scene; 0 as it stands.")] = 0,
    json: Json = False,
) -> None:
    """Prove that the oracle solves every task and that doing nothing solves none."""
    from adamo_vh.cli.tasks import verify

    verify(scene, variation, as_json=json)


@tasks_app.command("check")
def check(
    file: Annotated[str, typer.Argument(help="A task file, or the id of a built-in task.")],
    scene: Annotated[
        str | None, typer.Option(help="One scene or scene file; all that it fits by default.")
    ] = None,
    random: Annotated[
        int, typer.Option(min=0, max=1000, help="Episodes by lot in each scene; 0 for none.")
    ] = 20,
    json: Json = False,
) -> None:
    """Prove a task: the oracle solves it, doing nothing does not, and luck hardly ever does."""
    from adamo_vh.cli.tasks import check

    check(file, scene, random, as_json=json)


@tasks_app.command("generate")
def generate(
    seed: Annotated[int, typer.Option(help="Of the draws; the same gives the same tasks.")] = 0,
    count: Annotated[int, typer.Option(help="How many tasks: 1 to 1000.")] = 20,
    scene: Annotated[
        list[str] | None,
        typer.Option(help="Scene or scene file; may be repeated; all built-in ones by default."),
    ] = None,
    split: Annotated[
        str, typer.Option(help="dev to tune on, or test; no task is in both.")
    ] = "dev",
    random: Annotated[
        int, typer.Option(min=1, max=1000, help="Episodes by lot that each task must stand.")
    ] = 20,
    out: Annotated[
        Path | None, typer.Option(help="Folder of the files; tasks/SPLIT-SEED by default.")
    ] = None,
    json: Json = False,
) -> None:
    """Make new tasks of C-D levels 1 to 20 from templates, each proved as check does."""
    from adamo_vh.cli.tasks import generate

    generate(seed, count, scene or (), split, random, out, as_json=json)
