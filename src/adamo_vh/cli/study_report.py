"""`adamo-vh report`: the report of studies, or the pages of episodes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import typer
from rich.box import SIMPLE_HEAD
from rich.table import Table

from adamo_vh.analysis.study_json import study_json
from adamo_vh.cli.exits import Exit
from adamo_vh.cli.terminal import complain, line, put_json, say, wide_console
from adamo_vh.errors import ConfigError
from adamo_vh.readable import readable
from adamo_vh.report.page import write_page
from adamo_vh.report.study.figures import check_plotting
from adamo_vh.report.study.material import Material
from adamo_vh.report.study.section import OTHER_TASKS, REPEAT
from adamo_vh.report.study.source import Pages, links, source_of
from adamo_vh.report.study.table import Cell
from adamo_vh.report.study.writing import write_report
from adamo_vh.study.store import is_study, read_outcomes, read_planned

SEVERAL = Path("report")
"""Folder of a report over several studies, if nobody names one."""


def report_and_show(
    folders: Sequence[Path],
    *,
    out: Path | None,
    pages: str,
    figures: Path | None,
    as_json: bool,
    timings: bool,
) -> None:
    """Report studies, or write the pages of episodes again."""
    if not any(is_study(folder) for folder in folders):
        _write_pages(folders, as_json=as_json)
        return
    strange = next((folder for folder in folders if not is_study(folder)), None)
    if strange is not None:
        raise ConfigError(
            f"{strange} is no study, and the others are; report episodes and studies apart."
        )
    if as_json:
        damaged = _print_json(folders, timings=timings)
    else:
        wanted = _pages(pages)
        if figures is not None:
            check_plotting()
        place = out or (folders[0] if len(folders) == 1 else SEVERAL)
        damaged = _write_report(folders, place, wanted, figures)
    for key, problem in damaged.items():
        complain(f"damaged: {key}: {problem}")
    if damaged:
        raise typer.Exit(Exit.NO)


def _write_pages(folders: Sequence[Path], *, as_json: bool) -> None:
    if as_json:
        raise ConfigError(
            f"--json reports a study, and {folders[0]} is none: name the folder of one, or "
            "leave --json out for the page of an episode."
        )
    for folder in folders:
        say(write_page(folder))


def _pages(name: str) -> Pages:
    try:
        return Pages(name)
    except ValueError:
        known = ", ".join(Pages)
        raise ConfigError(f"--pages is {name!r}; use one of {known}.") from None


def _write_report(
    folders: Sequence[Path], out: Path, pages: Pages, figures: Path | None
) -> dict[str, str]:
    """Write a report; what could not be read of the studies."""
    sources, names = [], study_names(folders)
    for folder, name in zip(folders, names, strict=True):
        outcomes, damaged = read_outcomes(folder)
        study, planned = read_planned(folder)
        source = source_of(name, folder, outcomes, len(planned), damaged)
        found, failed = links(folder, outcomes, out, pages)
        for key, problem in failed.items():
            complain(f"no page of {key}: {problem}")
        sources.append(replace(source, pages=found))
    title = study.name or names[0] if len(folders) == 1 else " and ".join(names)
    material = Material.of(title, sources)
    page, *beside = write_report(material, out, figures)
    _print_headline(material)
    for source in sources:
        line("study", f"{source.name}: {len(source.outcomes)} of {source.planned} episodes")
    line("report", str(page))
    line(
        "beside it",
        f"{len(beside)} files: Markdown, LaTeX, CSV" + (", figures" * (figures is not None)),
    )
    return {key: problem for source in sources for key, problem in source.damaged.items()}


def _print_headline(material: Material) -> None:
    table = Table("model", "n", "completion", "strict", REPEAT, OTHER_TASKS, box=SIMPLE_HEAD)
    for setting in material.settings:
        row = material.mean(setting)
        assert row is not None
        found = row.figures
        cells = (found.completion.mean, found.strict.mean, found.completion.repeat)
        shown = (Cell(value, "share").text for value in (*cells, found.completion.task))
        table.add_row(readable(material.name(setting)), str(found.n), *shown)
    wide_console().print(table)


def study_names(folders: Sequence[Path]) -> tuple[str, ...]:
    """What studies are called: their folders' names, with as much before them as tells them apart.

    Raises:
        ConfigError: One stands there twice.
    """
    parts = [folder.resolve().parts for folder in folders]
    if len(set(parts)) < len(parts):
        raise ConfigError("A study stands there twice; name each once.")
    for count in range(1, max(map(len, parts)) + 1):
        names = tuple("/".join(part[-count:]) for part in parts)
        if len(set(names)) == len(names):
            return names
    return tuple(str(folder) for folder in folders)


def _print_json(folders: Sequence[Path], *, timings: bool) -> dict[str, str]:
    """Print the figures of a study; what could not be read of it."""
    if len(folders) > 1:
        raise ConfigError("--json reports one study at a time; name a single folder.")
    (folder,) = folders
    outcomes, damaged = read_outcomes(folder)
    _, planned = read_planned(folder)
    put_json({"planned": len(planned), **study_json(outcomes, timings=timings), "damaged": damaged})
    return damaged
