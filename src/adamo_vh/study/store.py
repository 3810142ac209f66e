"""The store of a study: one folder that holds its plan, a run folder an episode, and an index.

What has happened is what the run folders say. An episode has ended when its result is written,
which is the last thing that an episode does; everything else here can be made again from that. So
whatever is killed at whatever moment, no finished episode is lost and none is counted twice.
"""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping
from contextlib import ExitStack, suppress
from dataclasses import asdict, replace
from pathlib import Path
from typing import Any, Self

from adamo_vh.analysis.diagnosis.finding import DIAGNOSIS, read_diagnosis
from adamo_vh.analysis.outcome import Outcome, outcome_of
from adamo_vh.benchmark.ways import way_m
from adamo_vh.cognition.profile import told_without
from adamo_vh.episode.result import EpisodeResult, Manifest, read_manifest, read_result
from adamo_vh.errors import AdamoError, ConfigError, FileError, RecordError
from adamo_vh.files import read_json, write_whole
from adamo_vh.record.run_folder import RESULT, FolderLock
from adamo_vh.record.signing import Signer
from adamo_vh.record.trajectory import Trajectory, read_trajectory
from adamo_vh.study.axes import spelled, switches_of
from adamo_vh.study.chain import Chain
from adamo_vh.study.index import Index
from adamo_vh.study.plan import Planned, Study, plan

STUDY = "study.json"
EPISODES = "episodes"
_FORMAT = 1
_MOST_BYTES = 100_000_000


def is_study(folder: Path) -> bool:
    """Whether a folder is that of a study."""
    return (folder / STUDY).is_file()


def episode_folder(folder: Path, key: str) -> Path:
    """The run folder of an episode.

    Args:
        folder: The study's.
        key: The episode's.
    """
    return folder / EPISODES / key


def finished(folder: Path, planned: Planned) -> Outcome | None:
    """What came of an episode, from its run folder; None if it has not ended.

    Args:
        folder: The study's.
        planned: The episode.

    Raises:
        RecordError: Its record is damaged.
    """
    run = episode_folder(folder, planned.key)
    if (result := read_result(run)) is None:
        return None
    return row_of(planned, read_manifest(run), read_trajectory(run), result, _diagnosis(run))


def row_of(
    planned: Planned,
    manifest: Manifest,
    trajectory: Trajectory,
    result: EpisodeResult,
    diagnosis: tuple[str, str] = ("", ""),
) -> Outcome:
    """What came of an episode, from its records.

    Args:
        planned: The episode.
        manifest: How it was set up.
        trajectory: What happened.
        result: What came of it.
        diagnosis: Class and code of the failure, if it was diagnosed.
    """
    cell = planned.cell
    outcome = outcome_of(
        planned.key,
        manifest,
        trajectory,
        result,
        repetition=planned.repetition,
        axes=dict(cell.axes),
        run=f"{EPISODES}/{planned.key}",
        task=planned.config.own_task,
        shortest_m=way_m(planned.config.scene, planned.variation, planned.config.task),
        diagnosis=diagnosis,
    )
    # Called as in the plan: a model that draws lots has its seed in its own name, which would make
    # a cell of every episode. What an axis varies is told by the axis alone.
    profile = told_without(outcome.profile, switches_of(cell.axes))
    return replace(outcome, scene=cell.scene, task=cell.task, model=cell.model, profile=profile)


def lacks_diagnosis(folder: Path, outcome: Outcome) -> bool:
    """Whether an episode failed and nobody has said why: it was killed between the two.

    Args:
        folder: The study's.
        outcome: The episode's.
    """
    failed = outcome.completion is not None and outcome.completion < 1
    return failed and not (episode_folder(folder, outcome.key) / DIAGNOSIS).exists()


def _diagnosis(run: Path) -> tuple[str, str]:
    """Class and code of a failure; empty where there is none."""
    path = run / DIAGNOSIS
    if not path.exists():
        return "", ""
    found = read_diagnosis(read_json(path))
    return str(found.class_ or ""), str(found.code or "")


def write_study(folder: Path, study: Study, episodes: Iterable[Planned]) -> None:
    """Write down what is played.

    Raises:
        FileError: The folder cannot be written.
    """
    told = {"format": _FORMAT, "study": asdict(study), "episodes": [one.key for one in episodes]}
    write_whole(folder / STUDY, json.dumps(told, indent=1).encode(), durable=True)


def read_planned(folder: Path) -> tuple[Study, tuple[Planned, ...]]:
    """What a folder's study is.

    Raises:
        RecordError: The folder holds none, or its plan is damaged or of another version.
    """
    path = folder / STUDY
    if not path.is_file():
        raise RecordError(f"{folder} is no study: {STUDY} is missing.")
    again = (
        "No episode is lost: move that file away and give the same bench command with "
        f"--out {folder} again."
    )
    try:
        told = read_json(path, max_bytes=_MOST_BYTES)
        if told["format"] != _FORMAT:
            raise RecordError(
                f"{path} has format {told['format']}, and this version of ADAMO reads {_FORMAT}; "
                "use the version that wrote it."
            )
        study = _study_of(told["study"])
        episodes = plan(study)
        same = [one.key for one in episodes] == told["episodes"]
    except (FileError, ConfigError) as error:
        raise RecordError(f"{path} is damaged: {error} {again}") from None
    except (LookupError, TypeError, ValueError, AttributeError):
        raise RecordError(f"{path} is damaged: something is missing in it. {again}") from None
    if not same:
        raise RecordError(
            f"{path} was written by another version, which planned otherwise. {again}"
        )
    return study, episodes


def _study_of(told: Mapping[str, Any]) -> Study:
    lists = ("tasks", "scenes", "labelings", "models", "profiles", "variations")
    return Study(
        **{name: tuple(told[name]) for name in lists},
        repetitions=told["repetitions"],
        settings=told["settings"],
        axes={name: tuple(values) for name, values in told["axes"].items()},
        name=told["name"],
    )


class Store:
    """A study's folder while it is played; its owner is the only one that plays it."""

    def __init__(
        self,
        folder: Path,
        study: Study,
        episodes: tuple[Planned, ...],
        signer: Signer | None = None,
    ) -> None:
        """Take a folder for a study, or go on in it.

        Args:
            folder: Is made if it is missing.
            study: What is played.
            episodes: Its plan.
            signer: Signs what is added.

        Raises:
            FolderInUseError: Somebody else plays it now.
            RecordError: It holds another study, or is damaged.
            FileError: It cannot be written.
        """
        self.folder = folder
        self.episodes = {one.key: one for one in episodes}
        self._index = Index(folder)
        self._closing = ExitStack()
        with ExitStack() as stack:
            stack.enter_context(FolderLock(folder))
            self._check(study)
            self._chain = Chain(folder, signer)
            known = self._index.read()
            self.outcomes, self.damaged = gathered(folder, known, episodes)
            write_study(folder, study, episodes)
            # What was finished, or scored again, in the moment before everything was killed: a
            # row is written after its link, and taken out before its result changes.
            for key, outcome in self.outcomes.items():
                if known.get(key) is outcome and self._chain.holds(key):
                    continue
                with suppress(RecordError):  # A damaged result stays out, and verify-run says so.
                    self._chain.add(key, episode_folder(folder, key))
            if known != self.outcomes:
                self._index.replace(self.outcomes.values())
            self._closing.enter_context(stack.pop_all())

    def _check(self, study: Study) -> None:
        """Make sure that a folder is new, or holds this study or a part of it."""
        if not is_study(self.folder):
            return
        before, episodes = read_planned(self.folder)
        lost = [one for one in episodes if self.episodes.get(one.key) != one]
        if lost:
            raise RecordError(
                f"{self.folder} holds another study ({_difference(before, study)}). Choose "
                "another --out, or give the command with which it was begun."
            )

    def is_done(self, key: str) -> bool:
        """Whether an episode needs no playing any more: it has its score and, if it failed, why."""
        outcome = self.outcomes.get(key)
        if outcome is None or not outcome.is_scored:
            return False
        return not lacks_diagnosis(self.folder, outcome)

    def add(self, outcome: Outcome) -> None:
        """Note what came of an episode.

        Raises:
            FileError: It cannot be written; the run folder holds it all the same.
        """
        self.outcomes[outcome.key] = outcome
        self._chain.add(outcome.key, episode_folder(self.folder, outcome.key))
        self._index.put([outcome])

    def close(self) -> None:
        """Let others play it."""
        self._closing.close()

    def __enter__(self) -> Self:
        """Itself."""
        return self

    def __exit__(self, *_: object) -> None:
        """Close it."""
        self.close()


def gathered(
    folder: Path, known: Mapping[str, Outcome], episodes: Iterable[Planned]
) -> tuple[dict[str, Outcome], dict[str, str]]:
    """What has come of a study so far: the index, set right by what the run folders say.

    Args:
        folder: The study's.
        known: The rows of its index.
        episodes: Its plan.

    Returns:
        Outcomes by key, in the order of the plan; and what is wrong with damaged records, by key.
    """
    outcomes: dict[str, Outcome] = {}
    damaged: dict[str, str] = {}
    for planned in episodes:
        if not (episode_folder(folder, planned.key) / RESULT).exists():
            continue
        row = known.get(planned.key)
        if row is not None and row.is_scored:
            outcomes[planned.key] = row
            continue
        try:
            outcome = finished(folder, planned)
        except AdamoError as error:
            damaged[planned.key] = str(error)
        else:
            if outcome is not None:
                outcomes[planned.key] = outcome
    return outcomes, damaged


def read_outcomes(folder: Path) -> tuple[tuple[Outcome, ...], dict[str, str]]:
    """What has come of a study so far, in the order of its plan; nothing is written.

    Returns:
        The outcomes, and what is wrong with damaged records, by key.

    Raises:
        RecordError: The folder holds no study, or its plan or index is damaged.
    """
    _, episodes = read_planned(folder)
    outcomes, damaged = gathered(folder, Index(folder).read(), episodes)
    return tuple(outcomes.values()), damaged


def reindex(folder: Path) -> tuple[int, dict[str, str]]:
    """Make the index of a study again from its run folders.

    Returns:
        How many episodes it holds, and what is wrong with damaged records, by key.

    Raises:
        FolderInUseError: The study is being played now.
        RecordError: The folder holds no study.
    """
    _, episodes = read_planned(folder)
    with FolderLock(folder):
        outcomes, damaged = gathered(folder, {}, episodes)
        Index(folder).replace(outcomes.values())
    return len(outcomes), damaged


def _difference(before: Study, now: Study) -> str:
    """In what two studies differ, in a few words."""
    old, new = asdict(before), asdict(now)
    for name, value in old.items():
        if name != "name" and spelled(value) != spelled(new[name]):
            return f"{name} {spelled(value)}, not {spelled(new[name])}"
    return "other settings"
