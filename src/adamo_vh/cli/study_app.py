"""The commands about studies: bench, report, export, merge, reindex, score, verify-run."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from adamo_vh.inference.uris import HELP

study_app = typer.Typer()

Json = Annotated[bool, typer.Option("--json", help="Print JSON instead of text.")]


def _words(given: list[str] | None) -> list[str] | None:
    """What was listed with commas, or by repeating the option; None if nothing was."""
    words = [word.strip() for text in given or () for word in text.split(",")]
    return [word for word in words if word] or None


@study_app.command()
def bench(
    study: Annotated[
        str | None,
        typer.Option(
            help="A study file (TOML), or paper, memory, sampling, points or resolution; what is "
            "given beside it replaces what it says.",
            show_default=False,
        ),
    ] = None,
    tasks: Annotated[
        list[str] | None, typer.Option("--tasks", "--task", help="T1,T8; all by default.")
    ] = None,
    scene: Annotated[list[str] | None, typer.Option(help="s1,s2; s1 by default.")] = None,
    labeling: Annotated[list[str] | None, typer.Option(help="sem,opaq; sem by default.")] = None,
    model: Annotated[list[str] | None, typer.Option(help=f"May be repeated. {HELP}")] = None,
    profile: Annotated[list[str] | None, typer.Option(help="paper,lean; paper by default.")] = None,
    repetitions: Annotated[
        int | None,
        typer.Option(
            help="Of each cell and variation; what is deterministic is played once.",
            show_default=False,
        ),
    ] = None,
    variations: Annotated[
        str | None,
        typer.Option(help="Variations of the scenes: 0-4 or 0,2,7; 0 by default."),
    ] = None,
    resolution: Annotated[str | None, typer.Option(help="Frame size, WIDTHxHEIGHT.")] = None,
    setting: Annotated[
        list[str] | None,
        typer.Option("--set", help="Another setting of all episodes, e.g. limits.max_steps=40."),
    ] = None,
    axis: Annotated[
        list[str] | None,
        typer.Option(help="A further setting to vary, e.g. k=4,6,10,50; may be repeated."),
    ] = None,
    workers: Annotated[
        int | None,
        typer.Option(help="Processes; as many as cores by default, on one machine at most 4."),
    ] = None,
    executor: Annotated[
        str, typer.Option(help="Where to play: local, or ray for the machines of a cluster.")
    ] = "local",
    cluster: Annotated[
        str,
        typer.Option(
            help="With ray: address of the cluster, HOST:PORT; the one that Ray finds by default.",
            show_default=False,
        ),
    ] = "",
    shared: Annotated[
        str,
        typer.Option(
            help="With ray: where machines publish episodes, a folder that all see or a URL for "
            "fsspec; the study's folder by default.",
            show_default=False,
        ),
    ] = "",
    in_flight: Annotated[
        int | None,
        typer.Option(help="Episodes at once in each; 1, or 16 for remote models, by default."),
    ] = None,
    budget: Annotated[
        list[str] | None,
        typer.Option(
            help="A cap on the whole study: tokens=5000000, usd=20 or calls=3000; may be repeated."
        ),
    ] = None,
    shard: Annotated[
        str, typer.Option(help="Play part I of N of the study: I/N; see adamo-vh merge.")
    ] = "1/1",
    frame_cache: Annotated[
        bool,
        typer.Option(help="Draw views that episodes share once; they come out the same without."),
    ] = True,
    concurrent: Annotated[
        int | None, typer.Option(help="Requests at once to each provider, from all processes.")
    ] = None,
    requests_per_minute: Annotated[
        int | None, typer.Option(help="Requests a minute to each provider, from all processes.")
    ] = None,
    tokens_per_minute: Annotated[
        int | None, typer.Option(help="Tokens a minute of each provider, for all processes.")
    ] = None,
    dry_run: Annotated[
        bool,
        typer.Option(
            "--dry-run", help="List the episodes, forecast tokens, money and hours; start nothing."
        ),
    ] = False,
    sign: Annotated[
        Path | None,
        typer.Option(
            help="Sign every result and the chain of all with this Ed25519 private key.",
            metavar="KEYFILE",
        ),
    ] = None,
    out: Annotated[
        Path | None,
        typer.Option(
            help="The study's folder; one below studies/ that follows from it by default."
        ),
    ] = None,
    json: Annotated[
        bool, typer.Option("--json", help="Print every event as a line of JSON.")
    ] = False,
) -> None:
    """Play a study: tasks x scenes x labelings x models x ...; the same command again goes on."""
    from adamo_vh.cli.bench import play_and_show
    from adamo_vh.cli.settings import (
        axes_of,
        pairs,
        read_budget,
        read_cluster,
        read_shard,
        values_of,
    )
    from adamo_vh.cli.study_forecast import forecast_and_show
    from adamo_vh.study.limiter import Rates
    from adamo_vh.study.running import Means
    from adamo_vh.study.study_file import read_study

    lists = {
        "tasks": _words(tasks),
        "scenes": _words(scene),
        "labelings": _words(labeling),
        "models": model,
        "profiles": _words(profile),
        "repetitions": repetitions,
        "variations": variations,
        "resolution": resolution,
    }
    options = {name: value for name, value in lists.items() if value is not None}
    planned = read_study(study, {**options, **values_of(setting), "axes": axes_of(axis)})
    means = Means(
        workers=workers,
        in_flight=in_flight,
        shard=read_shard(shard),
        budget=read_budget(pairs(budget, "budget")),
        frame_cache=frame_cache,
        rates=Rates(concurrent, requests_per_minute, tokens_per_minute),
        sign=sign,
        cluster=read_cluster(executor, cluster, shared),
    )
    if dry_run:
        forecast_and_show(planned, out, means, as_json=json)
    else:
        play_and_show(planned, out, means, as_json=json)


@study_app.command()
def report(
    folders: Annotated[
        list[Path],
        typer.Argument(
            help="The folder of a study; of several, to see them side by side; or run folders.",
            metavar="RUN...",
        ),
    ],
    out: Annotated[
        Path | None,
        typer.Option(
            help="Folder of the report; by default the study's, or report/ for several studies."
        ),
    ] = None,
    pages: Annotated[
        str,
        typer.Option(
            help="Episodes that get a page of their own, if they have none: examples (some "
            "failures of each kind), failed, all, or none (no link leads out of the report then)."
        ),
    ] = "examples",
    figures: Annotated[
        Path | None,
        typer.Option(help="Also draw every chart into this folder, as PDF and SVG for a paper."),
    ] = None,
    json: Annotated[
        bool, typer.Option("--json", help="Print the figures of a study; write nothing.")
    ] = False,
    timings: Annotated[
        bool,
        typer.Option(
            "--timings/--no-timings",
            help="With --json: tell what depends on the clock as well.",
        ),
    ] = True,
) -> None:
    """Write the report of a study: page, tables and figures; or the page of an episode."""
    from adamo_vh.cli.study_report import report_and_show

    report_and_show(folders, out=out, pages=pages, figures=figures, as_json=json, timings=timings)


@study_app.command()
def export(
    runs: Annotated[
        list[Path],
        typer.Argument(
            help="Run folders, or folders of studies: of these, all scored episodes.",
            metavar="RUN...",
        ),
    ],
    to: Annotated[
        str,
        typer.Option(
            help="sft (chat examples for fine-tuning), parquet (a data set for Hugging Face), "
            "atif (trajectories), inspect (logs of Inspect AI), rerun (.rrd recordings) or page "
            "(an HTML file each that shows it in 3D)."
        ),
    ],
    out: Annotated[Path, typer.Option(help="A new folder.")],
    strict_only: Annotated[
        bool, typer.Option("--strict-only", help="Only episodes that succeeded strictly.")
    ] = False,
    min_completion: Annotated[
        float, typer.Option(help="Only episodes with at least this completion, 0 to 1.")
    ] = 0.0,
    inline_pictures: Annotated[
        bool,
        typer.Option(
            "--inline-pictures",
            help="With sft: pictures inside the lines, as data URLs; as files without.",
        ),
    ] = False,
    with_score: Annotated[
        bool,
        typer.Option(
            "--with-score", help="With sft: also name the episode and its score in each line."
        ),
    ] = False,
    json: Json = False,
) -> None:
    """Write recorded episodes in the formats of other tools; nothing is played."""
    from adamo_vh.adapters.exports.form import Form
    from adamo_vh.adapters.exports.recorded import Choice
    from adamo_vh.cli.export import export_and_show

    choice, form = Choice(strict_only, min_completion), Form(inline_pictures, with_score)
    export_and_show(runs, to, out, choice, form, as_json=json)


@study_app.command()
def merge(
    out: Annotated[Path, typer.Argument(help="The folder of the whole study; made if missing.")],
    parts: Annotated[list[Path], typer.Argument(help="Folders of its parts, e.g. of its shards.")],
    sign: Annotated[
        Path | None,
        typer.Option(
            help="Sign what is added to the whole with this Ed25519 private key.", metavar="KEYFILE"
        ),
    ] = None,
    json: Json = False,
) -> None:
    """Put the parts of one study together, e.g. the shards that several machines have played."""
    from adamo_vh.cli.study_folders import merge_and_show

    merge_and_show(out, parts, sign, as_json=json)


@study_app.command()
def score(
    folder: Annotated[
        Path, typer.Argument(help="A run folder, or the folder of a study.", metavar="RUN")
    ],
    diff: Annotated[bool, typer.Option("--diff", help="Show only what changed.")] = False,
    write: Annotated[bool, typer.Option("--write", help="Keep the new scores.")] = False,
    json: Json = False,
) -> None:
    """Score recorded episodes again with today's checkers; nothing is played."""
    from adamo_vh.cli.study_folders import score_and_show

    score_and_show(folder, diff=diff, write=write, as_json=json)


@study_app.command("verify-run")
def verify_run(
    folder: Annotated[
        Path, typer.Argument(help="A run folder, or the folder of a study.", metavar="RUN")
    ],
    key: Annotated[
        Path | None,
        typer.Option(help="Ed25519 public key that must have signed it.", metavar="FILE"),
    ] = None,
    replay: Annotated[
        bool, typer.Option(help="Execute every episode again and compare every state hash.")
    ] = True,
    json: Json = False,
) -> None:
    """Check that records are as they were written: digests, chain, signatures, score, states."""
    from adamo_vh.cli.verify_run import verify_and_show

    verify_and_show(folder, key, replayed=replay, as_json=json)


@study_app.command()
def reindex(
    study: Annotated[Path, typer.Argument(help="The folder of a study.")], json: Json = False
) -> None:
    """Make the index of a study again from its run folders."""
    from adamo_vh.cli.study_folders import reindex_and_show

    reindex_and_show(study, as_json=json)
