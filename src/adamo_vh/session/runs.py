"""Single episodes: run, continued after an interruption, and executed again."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import ExitStack
from dataclasses import replace
from pathlib import Path
from typing import Unpack

from adamo_vh.action_server import Tool
from adamo_vh.action_server.frame_cache import FrameCache
from adamo_vh.cognition.budget import Budget
from adamo_vh.cognition.guards import Guard
from adamo_vh.cognition.memory.protocol import NewMemory
from adamo_vh.engine import World
from adamo_vh.episode.config import EpisodeConfig, Settings
from adamo_vh.episode.replay import ReplayReport, replay
from adamo_vh.episode.result import EpisodeResult, read_manifest
from adamo_vh.errors import ConfigError, RecordError
from adamo_vh.inference.model import Model
from adamo_vh.perception import Tagger
from adamo_vh.record.run_folder import RESULT
from adamo_vh.record.trajectory import Event, Observer, read_trajectory
from adamo_vh.session.bodies import check_handed, open_server, opened
from adamo_vh.session.parts import Parts
from adamo_vh.session.session import Session, read_unfinished

Watch = Callable[[World], Callable[[Event], None]]
"""Is given the world before its record is executed again; what it gives back is told of every event
as soon as it has come again."""


def run_episode(
    instruction: str | EpisodeConfig | None = None,
    *,
    out: str | Path | None = None,
    record: bool = False,
    engine: World | None = None,
    model: str | Model | None = None,
    tools: Sequence[Tool] | None = None,
    memory: NewMemory | None = None,
    guards: Sequence[Guard] = (),
    observers: Sequence[Observer] = (),
    frame_cache: FrameCache | None = None,
    **settings: Unpack[Settings],
) -> EpisodeResult:
    """Run one episode.

    Args:
        instruction: What the agent is told; or all settings as one `EpisodeConfig`. Left out, it
            is the task's prompt.
        out: Run folder for manifest, events, frames, result and page; none is written without.
        record: Also keep every request and reply of the model there, as a cassette.
        engine: In place of the scene's; is reset, and not closed.
        model: URI ("baseline", "scripted:FILE.json", "replay:RUN_DIR", "cassette:DIR",
            "openai:NAME", "openai:NAME@URL", ...) or an own `Model`.
        tools: The body's primitives; those of the profile by default.
        memory: Makes the memory; the short-term memory by default.
        guards: Further reasons to stop, e.g. the budget of a whole run.
        observers: Are told of every event.
        frame_cache: Keeps views for several episodes, so that the same picture is drawn once.
        **settings: Every other setting by its name: task, scene, labeling, profile, switches,
            seed, resolution, limits, budget, ... See `EpisodeConfig` and `Settings`.

    Returns:
        The scored and counted result. `score` is None if there is no task or the episode broke
        through no fault of the model.

    Raises:
        ConfigError: A setting is wrong; nothing was started.
        SceneError: The scene is wrong.
        ModelConfigError: The model is unknown or lacks a key or an extra.
        RecordError: `out` already holds an episode, or somebody else writes it.
        FileError: `out` cannot be written.
    """
    labeling = settings.get("labeling")
    config = _config(instruction, model, settings)
    with Session.begin(
        config,
        out,
        record=record,
        engine=engine,
        model=None if isinstance(model, str) else model,
        tools=tools,
        memory=memory,
        labeling=None if isinstance(labeling, str) else labeling,
        guards=guards,
        observers=observers,
        frame_cache=frame_cache,
    ) as session:
        return session.play()


def _config(
    instruction: str | EpisodeConfig | None, model: str | Model | None, settings: Settings
) -> EpisodeConfig:
    if isinstance(instruction, EpisodeConfig):
        if settings:
            raise ConfigError(
                f"Set {', '.join(settings)} in the EpisodeConfig, or give the instruction alone."
            )
        return replace(instruction, model=model) if isinstance(model, str) else instruction
    if isinstance(model, str):
        return EpisodeConfig.of(instruction, model=model, **settings)
    return EpisodeConfig.of(instruction, **settings)


def resume_episode(
    folder: str | Path,
    *,
    budget: Budget | None = None,
    page: bool = True,
    **parts: Unpack[Parts],
) -> EpisodeResult:
    """Go on with an episode that was interrupted at any moment, or broke.

    What was recorded is executed again, with the recorded answers in place of the model's; from
    there the model goes on. Nothing is asked or written twice.

    Args:
        folder: Its run folder.
        budget: Holds from now on, in place of the recorded one.
        page: Write the page too.
        **parts: What is handed in, as when it began (see `Parts`); a model, to let another one go
            on.

    Raises:
        RecordError: The folder holds no run, or one that has ended, or a conversation; or somebody
            else writes it; or it came out otherwise. The record is as it was.
    """
    path = Path(folder)
    read_manifest(path)
    recorded = read_unfinished(path)
    if len(recorded.instructions) > 1:
        raise RecordError(f"{path} is a conversation; go on with: adamo-vh chat --resume {path}")
    ended = recorded.ended
    if ended is not None and ended.reason.is_scored and (path / RESULT).exists():
        raise RecordError(f"{path} has ended ({ended.reason}); nothing is left to resume.")
    with Session.resume(path, budget=budget, page=page, **parts) as session:
        return session.result() if session.trajectory.instructions else session.play()


def replay_episode(
    folder: str | Path,
    start: int = 0,
    *,
    engine: World | None = None,
    tools: Sequence[Tool] | None = None,
    labeling: Tagger | None = None,
    watch: Watch | None = None,
) -> ReplayReport:
    """Execute a recorded episode again without its model and compare every state hash.

    Args:
        folder: A run folder.
        start: Begin after this many steps, from the state that was saved there.
        engine: As when it was recorded; made from the record by default.
        tools: The body's primitives, as when it was recorded; those of the profile by default.
        labeling: As when it was recorded, if it was handed in.
        watch: Looks on.

    Raises:
        RecordError: The folder holds no readable run, or has no such step, or it needs an engine
            or a tool that is not here.
    """
    path = Path(folder)
    manifest, recorded = read_manifest(path), read_trajectory(path)
    config = manifest.config
    check_handed(path, manifest, recorded, tools, labeling)
    with ExitStack() as stack:
        world = opened(stack, config, engine, (path, manifest))
        server = open_server(config, world, tools, labeling)
        came = None if watch is None else watch(world)
        return replay(server, world, recorded, start, came)
