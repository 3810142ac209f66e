"""Which episodes are exported: run folders, or the scored ones of a study, read one at a time."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from pathlib import Path

from adamo_vh.analysis.outcome import Outcome
from adamo_vh.episode.result import EpisodeResult, Manifest, read_manifest, read_result
from adamo_vh.errors import AdamoError, ConfigError, RecordError
from adamo_vh.observation import Frame
from adamo_vh.record.run_folder import FRAMES
from adamo_vh.record.trajectory import Observed, Shown, Trajectory, frame_type, read_trajectory
from adamo_vh.study.store import EPISODES, episode_folder, is_study, read_outcomes


@dataclass(frozen=True, slots=True)
class Episode:
    """One recorded episode."""

    name: str
    """Names it within an export, and is a relative path there."""
    folder: Path
    manifest: Manifest
    trajectory: Trajectory
    result: EpisodeResult | None
    """What came of it; None if it did not get that far."""
    problems: list[str] | None = None
    """Takes what is wrong with it, if it may be left out; None if that ends the export."""

    @contextmanager
    def tolerated(self) -> Iterator[None]:
        """Leave the episode out if its record turns out to be damaged, where it may be.

        Raises:
            RecordError: It may not.
        """
        try:
            yield
        except RecordError as error:
            if self.problems is None:
                raise
            self.problems.append(str(error))

    @property
    def completion(self) -> float | None:
        """Fraction of satisfied conditions; None without a score."""
        return None if self.result is None else self.result.completion

    @property
    def strict(self) -> float | None:
        """1 or 0; None without a score."""
        return None if self.result is None else self.result.strict

    def picture(self, shown: Observed | Shown) -> Frame:
        """A recorded picture.

        Raises:
            RecordError: Its file is missing or its name is none of a picture.
        """
        kind = frame_type(shown.frame)
        path = self.folder / FRAMES / shown.frame
        if not kind or not path.is_file():
            raise RecordError(
                f"{self.folder} lacks the picture {FRAMES}/{shown.frame}: copy the run folder "
                "again with all of its pictures, or leave the episode out."
            )
        return Frame(path.read_bytes(), kind, shown.width_px, shown.height_px)


@dataclass(frozen=True, slots=True)
class Choice:
    """Which of the named episodes are wanted."""

    strict_only: bool = False
    """Only those that succeeded strictly."""
    min_completion: float = 0.0
    """Only those with at least this completion; above 0, those without a score stay out."""

    def __post_init__(self) -> None:
        """Refuse what no episode can meet."""
        if not 0 <= self.min_completion <= 1:
            raise ConfigError(f"min-completion is {self.min_completion}: use 0 to 1.")

    def takes(self, completion: float | None, strict: float | None) -> bool:
        """Whether an episode with this score is wanted.

        Args:
            completion: None without a score.
            strict: 1 or 0; None without a score.
        """
        if self.strict_only and not strict:
            return False
        return not self.min_completion or (completion or 0.0) >= self.min_completion


def recorded(
    folders: Iterable[Path], choice: Choice | None = None, problems: list[str] | None = None
) -> Iterator[Episode]:
    """Read the episodes of run folders and studies, one after the other.

    A run folder is taken as it is, finished or not. Of a study, the scored episodes are taken, and
    one that cannot be read is left out.

    Args:
        folders: Run folders and folders of studies.
        choice: Which episodes are wanted; all by default.
        problems: Takes a line for each episode of a study that cannot be read.

    Raises:
        RecordError: A folder holds neither, or a run folder is damaged.
    """
    chosen = choice or Choice()
    names: dict[str, int] = {}
    for folder in folders:
        found = _of_study if is_study(folder) else _of_run
        for name, run in found(folder, chosen, problems if problems is not None else []):
            lenient = problems if is_study(folder) else None
            try:
                episode = _read(name, run, lenient)
            except AdamoError as error:
                if lenient is None:
                    raise
                lenient.append(str(error))
                continue
            if not chosen.takes(episode.completion, episode.strict):
                continue
            # Two folders of the same name stay two episodes.
            count = names[name] = names.get(name, 0) + 1
            yield episode if count == 1 else replace(episode, name=f"{name}-{count}")


def _of_run(folder: Path, choice: Choice, problems: list[str]) -> Iterator[tuple[str, Path]]:
    yield re.sub(r"[^\w.=-]+", "-", folder.resolve().name) or "run", folder


def _of_study(folder: Path, choice: Choice, problems: list[str]) -> Iterator[tuple[str, Path]]:
    outcomes, damaged = read_outcomes(folder)
    problems.extend(f"{folder / EPISODES / key}: {what}" for key, what in damaged.items())
    for outcome in outcomes:
        if _is_wanted(outcome, choice):
            yield outcome.key, episode_folder(folder, outcome.key)


def _is_wanted(outcome: Outcome, choice: Choice) -> bool:
    return outcome.is_scored and choice.takes(outcome.completion, outcome.strict)


def _read(name: str, folder: Path, problems: list[str] | None) -> Episode:
    manifest, trajectory = read_manifest(folder), read_trajectory(folder)
    return Episode(name, folder, manifest, trajectory, read_result(folder), problems)
