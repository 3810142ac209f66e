"""A recorded episode, executed again."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from adamo_vh.action_server import Tool
from adamo_vh.episode.replay import ReplayReport, replay
from adamo_vh.episode.result import read_manifest
from adamo_vh.record.trajectory import read_trajectory
from adamo_vh.session.engines import create_engine, open_server


def replay_episode(
    folder: str | Path, start: int = 0, *, tools: Sequence[Tool] | None = None
) -> ReplayReport:
    """Execute a recorded episode again without its model and compare every state hash.

    Args:
        folder: A run folder.
        start: Begin after this many steps, from the state that was saved there.
        tools: The body's primitives, as when it was recorded; those of the profile by default.

    Raises:
        RecordError: The folder holds no readable run, or has no such step.
    """
    path = Path(folder)
    manifest, recorded = read_manifest(path), read_trajectory(path)
    engine = create_engine(manifest.config.scene, manifest.config.figure)
    try:
        engine.reset(manifest.config.seed)
        return replay(open_server(manifest.config, engine, tools), recorded, start)
    finally:
        engine.close()
