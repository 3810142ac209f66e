"""One episode of a study in its run folder: begun, or gone on with, whatever stopped it before."""

from __future__ import annotations

import shutil
from pathlib import Path
from typing import Unpack

from adamo_vh.analysis.outcome import Outcome
from adamo_vh.errors import FileError, FolderInUseError, RecordError
from adamo_vh.files import naming
from adamo_vh.record.run_folder import LOCK, MANIFEST, RESULT, FolderLock, reserve
from adamo_vh.session.parts import Parts
from adamo_vh.session.runs import resume_episode
from adamo_vh.session.session import Session
from adamo_vh.study.plan import Planned
from adamo_vh.study.store import EPISODES, episode_folder, finished

ASIDE = "set-aside"
"""Folder of records that could not be gone on with."""


def play(study: Path, planned: Planned, **parts: Unpack[Parts]) -> Outcome:
    """Play an episode to its end, unless it has one that counts.

    An interrupted episode is gone on with, so that no reply is paid for twice: what is on record is
    executed again, and from there the model goes on, which comes to the same as if nothing had
    happened. A record that does not come out the same is set aside, and the episode begun anew.

    Args:
        study: The study's folder.
        planned: The episode.
        **parts: What is handed in; see `Parts`.

    Raises:
        FolderInUseError: Somebody else plays it now.
        RecordError: Its record is damaged.
        FileError: The folder cannot be written.
    """
    before = finished(study, planned)
    if before is not None and before.is_scored:
        return before
    folder = episode_folder(study, planned.key)
    if not _gone_on(study, folder, planned.key, parts):
        config = planned.config
        with Session.begin(config, folder, page=False, **parts) as session:
            session.say(config.instruction)
            session.result()
    outcome = finished(study, planned)
    if outcome is None:
        raise FileError(
            f"{folder / RESULT} is not written: the disk may be full. Free some room; the same "
            "command then goes on."
        )
    return outcome


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
