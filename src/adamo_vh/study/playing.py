"""One episode of a study in its run folder: begun, or gone on with, whatever stopped it before."""

from __future__ import annotations

import shutil
import warnings
from contextlib import AbstractContextManager, nullcontext
from pathlib import Path
from typing import Unpack

from adamo_vh.analysis.outcome import Outcome
from adamo_vh.cognition.telling import fault
from adamo_vh.errors import FileError, FolderInUseError, RecordError
from adamo_vh.files import naming
from adamo_vh.record.run_folder import LOCK, MANIFEST, RESULT, FolderLock, reserve
from adamo_vh.session.explaining import explain_run
from adamo_vh.session.parts import Parts
from adamo_vh.session.runs import resume_episode
from adamo_vh.session.session import Session
from adamo_vh.study.plan import Planned
from adamo_vh.study.store import EPISODES, episode_folder, finished, lacks_diagnosis, row_of

ASIDE = "set-aside"
"""Folder of records that could not be gone on with."""


def play(
    study: Path,
    planned: Planned,
    *,
    explaining: AbstractContextManager[object] | None = None,
    **parts: Unpack[Parts],
) -> Outcome:
    """Play an episode to its end, unless it has one that counts.

    An interrupted episode is gone on with, so that no reply is paid for twice: what is on record is
    executed again, and from there the model goes on, which comes to the same as if nothing had
    happened. A record that does not come out the same is set aside, and the episode begun anew.

    Args:
        study: The study's folder.
        planned: The episode.
        explaining: Is entered while it is found out why the episode failed, which asks no model.
        **parts: What is handed in; see `Parts`.

    Raises:
        FolderInUseError: Somebody else plays it now.
        RecordError: Its record is damaged.
        FileError: The folder cannot be written.
    """
    folder = episode_folder(study, planned.key)
    before = finished(study, planned)
    if before is not None and before.is_scored:
        return _explained(study, planned, before, explaining, parts)
    if _gone_on(study, folder, planned.key, parts):
        outcome = finished(study, planned)
    else:
        with Session.begin(planned.config, folder, page=False, **parts) as session:
            result = session.play()
            outcome = row_of(planned, session.manifest, session.trajectory, result)
    if outcome is None or not (folder / RESULT).exists():
        raise FileError(
            f"{folder / RESULT} is not written: the disk may be full. Free some room; the same "
            "command then goes on."
        )
    return _explained(study, planned, outcome, explaining, parts)


def _explained(
    study: Path,
    planned: Planned,
    outcome: Outcome,
    explaining: AbstractContextManager[object] | None,
    parts: Parts,
) -> Outcome:
    """The outcome with the reason of its failure, if it is one; the score needs none."""
    if not lacks_diagnosis(study, outcome):
        return outcome
    folder = episode_folder(study, planned.key)
    try:
        with explaining or nullcontext():
            explain_run(folder, parts.get("engine"), task=planned.config.own_task)
    except FileError:
        raise
    except Exception as error:
        # Whatever fails in it, the episode was played and scored.
        warnings.warn(f"{planned.key} is not explained: {fault(error)}", stacklevel=2)
        return outcome
    return finished(study, planned) or outcome


def _gone_on(study: Path, folder: Path, key: str, parts: Parts) -> bool:
    """Go on with what is on record; false if there is nothing, or nothing any more."""
    if not folder.is_dir():
        return False
    try:
        if (folder / MANIFEST).exists():
            resume_episode(folder, page=False, **parts)
            return True
    except FolderInUseError:
        raise
    except RecordError:
        set_aside(study, key)
        return False
    # Killed before its first word: nothing in it is worth keeping.
    with FolderLock(folder), naming("written", folder):
        for left in folder.iterdir():
            if left.is_dir():
                shutil.rmtree(left)
            elif left.name != LOCK:
                left.unlink()
    return False


def set_aside(study: Path, key: str) -> Path:
    """Move a run folder out of the way; where it is now.

    Raises:
        FileError: It cannot be moved.
    """
    place = study / ASIDE / key
    there = reserve(place.parent, place.name)
    with naming("written", there):
        (study / EPISODES / key).replace(there)
    return there
