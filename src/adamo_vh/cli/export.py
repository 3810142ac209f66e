"""`adamo-vh export`: recorded episodes in the formats of other tools."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import typer

from adamo_vh.adapters.exports.exporting import Write, export
from adamo_vh.adapters.exports.form import Form
from adamo_vh.adapters.exports.recorded import Choice
from adamo_vh.cli.exits import Exit
from adamo_vh.cli.terminal import line, put_json, say
from adamo_vh.extras import extra

PAGE = "page"
"""The one format that comes from above the exports: a page of the studio that needs no server."""


def export_and_show(
    runs: Sequence[Path], to: str, out: Path, choice: Choice, form: Form, *, as_json: bool
) -> None:
    """Export; say what was written and what was left out."""
    done = export(runs, to, out, choice=choice, form=form, others={PAGE: _page})
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


def _page() -> Write:
    with extra("serve", "The page"):
        from adamo_vh.studio.one_page import write_pages
    return write_pages
