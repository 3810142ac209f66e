"""`adamo-vh export`: recorded episodes in the formats of other tools."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import typer

from adamo_vh.adapters.exports.exporting import FORMATS, Write, export
from adamo_vh.adapters.exports.form import Form
from adamo_vh.adapters.exports.recorded import Choice
from adamo_vh.cli.exits import Exit
from adamo_vh.cli.terminal import line, put_json, say
from adamo_vh.errors import ConfigError
from adamo_vh.extras import extra

PAGE = "page"
"""The one format that comes from above the exports: a page of the studio that needs no server."""


def export_and_show(
    runs: Sequence[Path], to: str, out: Path, choice: Choice, form: Form, *, as_json: bool
) -> None:
    """Export; say what was written and what was left out."""
    write: Write | None = None
    if to.lower() == PAGE:
        with extra("serve", "The page"):
            from adamo_vh.studio.one_page import write_pages
        write = write_pages
    elif to.lower() not in FORMATS:
        raise ConfigError(f"There is no format {to!r}. Use one of {', '.join((*FORMATS, PAGE))}.")
    done = export(runs, to, out, choice=choice, form=form, write=write)
    if as_json:
        put_json(
            {
                "folder": str(done.folder),
                "format": to.lower(),
                "episodes": done.episodes,
                "left_out": done.problems,
            }
        )
    else:
        say(f"{done.folder}: {done.episodes} episodes as {to.lower()}.")
        for problem in done.problems:
            line("left out", problem, "yellow")
    if done.problems:
        raise typer.Exit(Exit.NO)
