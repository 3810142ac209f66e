"""Old records scored again with today's checkers: what changed, and why."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import partial
from pathlib import Path

from adamo_vh.analysis.diagnosis.finding import DIAGNOSIS
from adamo_vh.benchmark.checkers import Score
from adamo_vh.episode.result import read_manifest, read_result, summarise
from adamo_vh.episode.sealing import write_result
from adamo_vh.errors import AdamoError, RecordError
from adamo_vh.record.run_folder import MANIFEST, RESULT, FolderLock
from adamo_vh.record.trajectory import read_trajectory
from adamo_vh.study.chain import Chain
from adamo_vh.study.index import Index
from adamo_vh.study.store import episode_folder, gathered, is_study, read_planned


@dataclass(frozen=True, slots=True)
class Rescored:
    """One episode, scored then and now."""

    episode: str
    """Its key, or the run folder."""
    before: Score | None
    after: Score | None
    problem: str = ""
    """Why it cannot be scored; empty if it can."""

    @property
    def changed(self) -> tuple[str, ...]:
        """What is different now, in words; empty if nothing is."""
        if self.before == self.after:
            return ()
        if self.before is None or self.after is None:
            return ("it has a score now" if self.after else "it has no score any more",)
        return tuple(_changes(self.before, self.after))


def _changes(before: Score, after: Score) -> Iterator[str]:
    for name in ("completion", "strict"):
        was, now = getattr(before, name), getattr(after, name)
        if was != now:
            yield f"{name} {was:.2f}, now {now:.2f}"
    was_held = {one.text: one.satisfied for one in before.conditions}
    held = {one.text: one.satisfied for one in after.conditions}
    for condition in dict.fromkeys((*was_held, *held)):
        if condition not in held:
            yield f"no condition any more: {condition}"
        elif was_held.get(condition) != held[condition]:
            yield f"{condition}: {'holds' if held[condition] else 'does not hold'} now"
    for violation in sorted({*before.violations} - {*after.violations}):
        yield f"no violation any more: {violation}"
    for violation in sorted({*after.violations} - {*before.violations}):
        yield f"a violation now: {violation}"


def score_again(folder: Path, *, write: bool = False) -> tuple[Rescored, ...]:
    """Score an episode, or all of a study's, from their records.

    Args:
        folder: A run folder, or a study's.
        write: Keep the new scores. A diagnosis that no longer fits is removed, and made again when
            the study is played on.

    Raises:
        RecordError: The folder holds no record.
        FolderInUseError: Somebody writes it now.
        FileError: A new score cannot be written.
    """
    if not is_study(folder):
        if not (folder / MANIFEST).is_file():
            raise RecordError(f"{folder} is neither a run folder nor the folder of a study.")
        return (_again(folder, str(folder), _nothing if write else None),)
    _, episodes = read_planned(folder)
    runs = {one.key: episode_folder(folder, one.key) for one in episodes}
    ended = {key: run for key, run in runs.items() if (run / RESULT).is_file()}
    if not write:
        return tuple(_again(run, key) for key, run in ended.items())
    with FolderLock(folder):
        index, chain, found = Index(folder), Chain(folder), []
        for key, run in ended.items():
            # A row that is not true any more is gone before the result changes, so that whoever
            # is stopped between the two leaves a result that is read and linked when it goes on.
            found.append(_again(run, key, partial(index.drop, [key])))
            if found[-1].changed:
                chain.add(key, run)
        if any(one.changed for one in found):
            outcomes, _ = gathered(folder, index.read(), episodes)
            index.replace(outcomes.values())
    return tuple(found)


def _nothing() -> None:
    """A run on its own is in no index."""


def _again(run: Path, name: str, writing: Callable[[], None] | None = None) -> Rescored:
    """Score one episode.

    Args:
        run: Its run folder.
        name: What it is called.
        writing: Keep a new score, and call this before; the old one stays without.
    """
    try:
        before = read_result(run)
        if before is None:
            raise RecordError(f"{run} has not ended; there is nothing to score.")
        recorded = read_trajectory(run)
        place = Path(before.run) if before.run else None
        after = summarise(read_manifest(run), recorded, before.final, place)
    except AdamoError as error:
        return Rescored(name, None, None, str(error))
    again = Rescored(name, before.score, after.score)
    if writing is not None and again.changed:
        with FolderLock(run):
            writing()
            write_result(run, after, recorded)
            (run / DIAGNOSIS).unlink(missing_ok=True)
    return again
