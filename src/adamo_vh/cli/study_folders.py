"""`adamo-vh report`, `merge`, `reindex` and `score`: what is done with recorded studies."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any

import typer
from rich.box import SIMPLE_HEAD
from rich.console import Console
from rich.table import Table

from adamo_vh.analysis.study_json import study_json
from adamo_vh.cli.exits import Exit
from adamo_vh.cli.terminal import complain, line, put_json, say
from adamo_vh.errors import ConfigError
from adamo_vh.readable import readable
from adamo_vh.record.signing import Signer
from adamo_vh.report.page import write_page
from adamo_vh.study.merging import merge
from adamo_vh.study.rescoring import Rescored, score_again
from adamo_vh.study.store import is_study, read_outcomes, read_planned, reindex


def report_and_show(folders: Sequence[Path], *, as_json: bool, timings: bool) -> None:
    """Report a study, or write the page of an episode again."""
    if not any(is_study(folder) for folder in folders):
        if as_json:
            raise ConfigError(
                f"--json reports a study, and {folders[0]} is none: name the folder of one, or "
                "leave --json out for the page of an episode."
            )
        for folder in folders:
            say(write_page(folder))
        return
    if len(folders) > 1:
        raise ConfigError("Report one study at a time.")
    (folder,) = folders
    told, damaged = _told(folder, timings=timings)
    if as_json:
        put_json({**told, "damaged": damaged})
    else:
        _print_cells(told)
        line("study", f"{folder}: {told['episodes']} of {told['planned']} episodes")
    for key, problem in damaged.items():
        complain(f"damaged: {key}: {problem}")
    if damaged:
        raise typer.Exit(Exit.NO)


def _told(folder: Path, *, timings: bool) -> tuple[dict[str, Any], dict[str, str]]:
    outcomes, damaged = read_outcomes(folder)
    _, planned = read_planned(folder)
    return {"planned": len(planned), **study_json(outcomes, timings=timings)}, damaged


def _print_cells(told: Mapping[str, Any]) -> None:
    table = Table(
        "model", "scene", "labeling", "task", "n", "completion", "strict", "would it repeat?",
        box=SIMPLE_HEAD,
    )  # fmt: skip
    for cell in told["cells"]:
        interval = cell["repeat_interval"]
        table.add_row(
            *(readable(str(cell[name])) for name in ("model", "scene", "labeling", "task", "n")),
            *("" if cell[n] is None else f"{cell[n]:.2f}" for n in ("completion", "strict")),
            "" if interval is None else f"{interval[0]:.2f} to {interval[1]:.2f}",
        )
    Console().print(table)


def merge_and_show(out: Path, parts: Sequence[Path], sign: Path | None, *, as_json: bool) -> None:
    """Put parts of a study together."""
    copied, scored = merge(out, parts, Signer(sign) if sign else None)
    _, planned = read_planned(out)
    if as_json:
        put_json({"folder": str(out), "copied": copied, "scored": scored, "episodes": len(planned)})
    else:
        say(f"{out}: {copied} episodes copied, {scored} of {len(planned)} have a score.")


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


def score_and_show(folder: Path, *, diff: bool, write: bool, as_json: bool) -> None:
    """Score again; say what changed."""
    found = score_again(folder, write=write)
    changed = [one for one in found if one.changed]
    failed = [one for one in found if one.problem]
    if as_json:
        put_json(
            {
                "episodes": len(found),
                "changed": len(changed),
                "written": write and bool(changed),
                "scores": [_json(one) for one in (changed + failed if diff else found)],
            }
        )
    else:
        for one in found:
            _print_score(one, diff=diff)
        kept = "kept" if write else "kept as they were; --write keeps the new scores"
        say(f"{len(changed)} of {len(found)} episodes are scored otherwise now ({kept}).")
    if failed:
        raise typer.Exit(Exit.NO)


def _json(one: Rescored) -> dict[str, Any]:
    before, after = (None if score is None else asdict(score) for score in (one.before, one.after))
    return {
        "episode": one.episode,
        "before": before,
        "after": after,
        "changed": list(one.changed),
        "problem": one.problem,
    }


def _print_score(one: Rescored, *, diff: bool) -> None:
    if one.problem:
        line("unreadable", f"{one.episode}: {one.problem}", "yellow")
    elif one.changed:
        line("changed", f"{one.episode}\n" + "\n".join(one.changed))
    elif not diff:
        score = one.after
        said = "no score" if score is None else f"{score.completion:.2f}, strict {score.strict:.0f}"
        line("same", f"{one.episode}: {said}")
