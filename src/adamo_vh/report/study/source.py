"""A study folder as a source of a report: its episodes, and links to their pages."""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator, Mapping, Sequence
from enum import StrEnum
from itertools import zip_longest
from pathlib import Path, PurePosixPath
from urllib.parse import quote

from adamo_vh.analysis.diagnosis.finding import load_diagnosis
from adamo_vh.analysis.outcome import Outcome
from adamo_vh.errors import AdamoError
from adamo_vh.report.page import PAGE, write_page
from adamo_vh.report.study.material import Source

_EXAMPLES = 2
"""Of each setting, labeling and code."""
_MOST_EXAMPLES = 40


class Pages(StrEnum):
    """For which episodes a page is made, if there is none yet."""

    EXAMPLES = "examples"
    """Some failures of each kind."""
    FAILED = "failed"
    """All scored episodes below 1.0, and unscored ones."""
    ALL = "all"
    NONE = "none"
    """Of no episode; and nothing leads out of the report, so that it can be passed on."""


def source_of(
    name: str,
    folder: Path,
    outcomes: Sequence[Outcome],
    planned: int,
    damaged: Mapping[str, str],
) -> Source:
    """A study as a source of a report, yet without links.

    Args:
        name: Of the study.
        folder: Its folder.
        outcomes: Its episodes.
        planned: How many it is to have.
        damaged: What is wrong with records that cannot be read, by key.
    """
    # A report is passed on; where it was made is nobody's business.
    told = {key: line.replace(f"{folder}{os.sep}", "") for key, line in damaged.items()}
    return Source(name, tuple(outcomes), planned, told, _distances(folder, outcomes))


def _distances(folder: Path, outcomes: Iterable[Outcome]) -> dict[str, tuple[int, ...]]:
    """The way to done of each episode that was diagnosed."""
    found = {}
    for outcome in outcomes:
        run = _run(folder, outcome)
        if not outcome.diagnosis or run is None:
            continue
        try:
            diagnosis = load_diagnosis(run)
        except AdamoError:
            continue  # Its class and code are known all the same.
        if diagnosis is not None and diagnosis.distance:
            found[outcome.key] = diagnosis.distance
    return found


def _run(folder: Path, outcome: Outcome) -> Path | None:
    """Its run folder; None if the index names one outside of the study."""
    inside = PurePosixPath(outcome.run)
    if not outcome.run or inside.is_absolute() or ".." in inside.parts:
        return None
    return folder / inside


def links(
    folder: Path, outcomes: Sequence[Outcome], out: Path, pages: Pages
) -> tuple[dict[str, str], dict[str, str]]:
    """Make the pages that are wanted, and link to what there is.

    Args:
        folder: The study's.
        outcomes: Its episodes.
        out: Folder of the report.
        pages: Which are wanted.

    Returns:
        By key, where an episode's page is, or else its run folder; and why pages could not be made.
    """
    if pages is Pages.NONE:
        return {}, {}
    found, failed = {}, {}
    wanted = {outcome.key for outcome in _wanted(outcomes, pages)}
    for outcome in outcomes:
        run = _run(folder, outcome)
        if run is None or not run.is_dir():
            continue
        page = run / PAGE
        if outcome.key in wanted and not page.exists():
            try:
                write_page(run)
            except AdamoError as error:
                failed[outcome.key] = str(error)
        target = page if page.exists() else run
        found[outcome.key] = _link(target, out)
    return found, failed


def _link(target: Path, out: Path) -> str:
    path = os.path.relpath(target.resolve(), out.resolve())
    return quote(Path(path).as_posix()) + ("" if target.name == PAGE else "/")


def _wanted(outcomes: Sequence[Outcome], pages: Pages) -> Iterator[Outcome]:
    if pages is Pages.ALL:
        yield from outcomes
        return
    failed = [outcome for outcome in outcomes if not outcome.is_complete]
    if pages is Pages.FAILED:
        yield from failed
        return
    kinds: dict[tuple[str, ...], list[Outcome]] = {}
    for one in failed:
        kind = (one.model, one.profile, one.labeling, one.diagnosis_code)
        kinds.setdefault(kind, []).append(one)
    # One of each kind before a second of any.
    turns = zip_longest(*(group[:_EXAMPLES] for group in kinds.values()))
    yield from [one for turn in turns for one in turn if one is not None][:_MOST_EXAMPLES]
