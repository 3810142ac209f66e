"""`adamo-vh reindex` and other commands about the folder of a study."""

from __future__ import annotations

from pathlib import Path

import typer

from adamo_vh.cli.exits import Exit
from adamo_vh.cli.terminal import line, put_json, say
from adamo_vh.study.store import reindex


def reindex_and_show(folder: Path, *, as_json: bool) -> None:
    """Make an index again; say what of the study could not be read."""
    count, damaged = reindex(folder)
    if as_json:
        put_json({"episodes": count, "damaged": damaged})
    else:
        say(f"{folder}: the index holds {count} episodes.")
        for key, problem in damaged.items():
            line("damaged", f"{key}: {problem}", "yellow")
    if damaged:
        raise typer.Exit(Exit.NO)
