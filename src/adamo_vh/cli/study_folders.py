"""`adamo-vh report`, `merge`, `reindex` and `score`: what is done with recorded studies."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any

import typer

from adamo_vh.cli.exits import Exit
from adamo_vh.cli.terminal import line, put_json, say
from adamo_vh.record.signing import Signer
from adamo_vh.study.merging import merge
from adamo_vh.study.rescoring import Rescored, score_again
from adamo_vh.study.store import read_planned, reindex


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
