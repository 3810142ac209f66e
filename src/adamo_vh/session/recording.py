"""A run folder from its beginning to its result, whoever decides in the episode."""

from __future__ import annotations

import warnings
from contextlib import ExitStack
from pathlib import Path

from adamo_vh.engine import World, WorldState
from adamo_vh.episode.result import EpisodeResult, Manifest, summarise, write_record
from adamo_vh.episode.sealing import write_result
from adamo_vh.errors import FileError
from adamo_vh.record.run_folder import MANIFEST, FolderLock, check_unused
from adamo_vh.record.trajectory import Trajectory
from adamo_vh.record.writer import TrajectoryWriter
from adamo_vh.session.bodies import store_sources
from adamo_vh.session.figures import keep_figure


def begin_record(
    stack: ExitStack, folder: Path, manifest: Manifest, world: World
) -> TrajectoryWriter:
    """Begin the run folder of an episode.

    Args:
        stack: Closes the folder.
        folder: A new one.
        manifest: How the episode is set up.
        world: Just reset.

    Raises:
        RecordError: It already holds a run, or somebody else writes it.
        FileError: It cannot be written.
    """
    lock = stack.enter_context(FolderLock(folder))
    check_unused(folder)
    store_sources(folder, manifest.config, world)
    keep_figure(folder, manifest)
    # What a power cut takes of it in its first seconds, it takes of the events as well.
    write_record(folder, MANIFEST, manifest, durable=False)
    writer = TrajectoryWriter(folder, lock=lock)
    stack.callback(writer.close)
    return writer


def told_result(
    manifest: Manifest, trajectory: Trajectory, world: World, folder: Path | None, again: str
) -> EpisodeResult:
    """Score and count an episode that has ended; written into its run folder.

    Args:
        manifest: How it was set up.
        trajectory: What happened.
        world: As it ended.
        folder: The run folder, if there is one.
        again: The command with which a result that could not be written is made later.

    Raises:
        RecordError: It has not ended.
    """
    result = summarise(manifest, trajectory, _last_state(world, manifest), folder)
    if folder is None:
        return result
    try:
        return write_result(folder, result, trajectory)
    except FileError as error:
        # A full disk may take the files, never the score.
        text = f"the result is not written: {error} (once that is mended: {again})"
        warnings.warn(text, stacklevel=3)
        return result


def _last_state(world: World, manifest: Manifest) -> WorldState:
    """The world at the end; as it began, if the engine has nothing to say any more."""
    try:
        return world.state()
    except Exception:
        return manifest.initial
