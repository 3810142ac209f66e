"""One episode: run, and gone on with after an interruption."""

from __future__ import annotations

import platform
import warnings
from collections.abc import Callable, Mapping, Sequence
from contextlib import ExitStack
from dataclasses import replace
from datetime import UTC, datetime
from importlib.metadata import version
from pathlib import Path
from typing import Any, TypeVar

from adamo_vh.action_server import Tool
from adamo_vh.benchmark.tasks import task as find_task
from adamo_vh.cognition.agent import Agent, AgentConfig
from adamo_vh.cognition.budget import Budget, BudgetGuard
from adamo_vh.cognition.forecast import Forecast
from adamo_vh.cognition.guards import AsRecorded, Guard
from adamo_vh.cognition.profile import Profile
from adamo_vh.cognition.profile import profile as find_profile
from adamo_vh.engine import World
from adamo_vh.episode.result import (
    EpisodeConfig,
    EpisodeResult,
    Manifest,
    read_manifest,
    summarise,
    write_record,
)
from adamo_vh.errors import ConfigError, FileError, RecordError
from adamo_vh.inference.model import Model, ModelKind, Sampling
from adamo_vh.inference.players.cassette import FOLDER, Cassette, taped
from adamo_vh.inference.players.resumed import resumed
from adamo_vh.perception import Labeling, TextForm
from adamo_vh.record.run_folder import EVENTS, MANIFEST, RESULT, FolderLock, check_unused
from adamo_vh.record.termination import Limits
from adamo_vh.record.trajectory import Event, Observer, Trajectory, read_trajectory
from adamo_vh.record.writer import TrajectoryWriter
from adamo_vh.report.page import try_page
from adamo_vh.session.engines import create_engine, instructions, open_server
from adamo_vh.session.forecasting import forecast_episodes
from adamo_vh.session.players import create_player, fitting

_REPORTED = ("adamo-vh", "mujoco", "numpy", "pillow", "opencv-python-headless", "pydantic-ai-slim")
_E = TypeVar("_E", Labeling, TextForm)


def run_episode(
    instruction: str | None = None,
    *,
    task: str | None = None,
    scene: str = "s1",
    figure: str = "mara",
    labeling: str = "sem",
    model: str | Model = "baseline",
    tool_calls: str = "auto",
    profile: str | Profile = "paper",
    switches: Mapping[str, Any] | None = None,
    seed: int = 0,
    k: int = 50,
    grid: int = 6,
    resolution: tuple[int, int] = (1920, 1080),
    text_form: str = "full",
    sampling: Sampling | None = None,
    limits: Limits | None = None,
    budget: Budget | None = None,
    out: str | Path | None = None,
    record: bool = False,
    tools: Sequence[Tool] | None = None,
    guards: Sequence[Guard] = (),
    observers: Sequence[Observer] = (),
    announce: Callable[[Forecast], None] | None = None,
    engine: World | None = None,
) -> EpisodeResult:
    """Run one episode.

    Args:
        instruction: What the agent is told; the task's prompt if left out.
        task: Id of a benchmark task ("T1" to "T15"), whose checker then scores the episode.
        scene: Built-in scene or path of a scene file.
        figure: Who the virtual human is: mara, jonas, amina or ken.
        labeling: "sem" or "opaq".
        model: URI ("baseline", "scripted:FILE.json", "replay:RUN_DIR", "cassette:DIR",
            "openai:NAME", "openai:NAME@URL", ...) or an own `Model`.
        tool_calls: How a remote model is asked for its calls: "auto" (what a probe found best),
            "native", "schema" or "react".
        profile: "paper", "paper-exact", "lean", or an own `Profile`.
        switches: Single switches of the profile, set otherwise.
        seed: Seed of the episode.
        k: Steps in the short-term memory.
        grid: Reference points along each side of the frame.
        resolution: Width and height of the frames in pixels.
        text_form: "full", or "paper" for the original's fields alone.
        sampling: Decoding settings; the paper's by default.
        limits: Caps on steps and seconds; 60 and 600 by default.
        budget: Caps on tokens, money, calls and seconds of this episode; none by default.
        out: Run folder for manifest, events, frames, result and page; none is written without.
        record: Also keep every request and reply of the model there, as a cassette.
        tools: The body's primitives; those of the profile by default.
        guards: Further reasons to stop, e.g. the budget of a whole run.
        observers: Are told of every event.
        announce: Is told what the episode will take, before a provider is asked.
        engine: Reuse an engine of the same scene; made and closed here otherwise.

    Returns:
        The scored and counted result. `completion` is None if there is no task or the episode
        broke through no fault of the model.

    Raises:
        ConfigError: A setting is wrong; nothing was started.
        SceneError: The scene is wrong.
        ModelConfigError: The model is unknown or lacks a key or an extra.
        RecordError: `out` already holds an episode.
    """
    if record and out is None:
        raise ConfigError("A recording needs a run folder: give out as well.")
    chosen = chosen_profile(profile, switches)
    config = EpisodeConfig(
        instruction=_instruction(instruction, task),
        task=None if task is None else find_task(task).id,
        scene=scene,
        figure=figure,
        labeling=member(Labeling, labeling, "labeling"),
        model=model if isinstance(model, str) else model.info.name,
        tool_calls=tool_calls,
        profile=chosen,
        seed=seed,
        k=k,
        grid=grid,
        resolution=resolution,
        text_form=member(TextForm, text_form, "text form"),
        sampling=sampling or Sampling(),
        limits=limits or Limits(),
        budget=budget or Budget(),
    )
    player: Model = (
        model
        if not isinstance(model, str)
        else create_player(model, tools=tool_calls, profile=chosen, seed=seed)
    )
    config = replace(config, profile=fitting(chosen, player, tools))
    with ExitStack() as stack:
        if isinstance(model, str):
            stack.callback(player.info.close)
        world = engine or create_engine(config.scene, config.figure)
        if engine is None:
            stack.callback(world.close)
        world.reset(config.seed)
        manifest = describe(config, player, world)
        is_asked = player.info.kind is ModelKind.VLM and not isinstance(player, Cassette)
        if announce is not None and is_asked:
            announce(forecast_episodes(config, world))
        kept = None
        if out is not None:
            folder = Path(out)
            lock = stack.enter_context(FolderLock(folder))
            check_unused(folder)
            write_record(folder, MANIFEST, manifest)
            kept = (TrajectoryWriter(folder, lock=lock), folder)
            if record:
                player = taped(player, folder / FOLDER)
        return _play(manifest, player, world, kept, tools, (guards, observers))


def chosen_profile(name: str | Profile, switches: Mapping[str, Any] | None) -> Profile:
    """A profile by name or as it is, with some switches set otherwise."""
    if isinstance(name, str):
        return find_profile(name, switches)
    return replace(name, **(switches or {}))


def describe(config: EpisodeConfig, model: Model, engine: World) -> Manifest:
    """The manifest of an episode that is about to begin."""
    versions = {"python": platform.python_version(), **{name: version(name) for name in _REPORTED}}
    now = datetime.now(UTC).isoformat(timespec="seconds")
    who = model.info
    state = engine.state()
    return Manifest(config, who.name, who.kind, versions, now, state, who.capabilities)


def create_agent(
    config: EpisodeConfig,
    model: Model,
    engine: World,
    tools: Sequence[Tool] | None,
    guards: Sequence[Guard],
    observers: Sequence[Observer],
    known: Sequence[Event] = (),
) -> Agent:
    """The agent of an episode, on an engine that was just reset; what is known comes again."""
    server = open_server(config, engine, tools)
    return Agent(
        model,
        server,
        instructions(config, engine, server),
        AgentConfig(config.profile, config.k, config.text_form, config.sampling, config.limits),
        guards=(AsRecorded(known, (BudgetGuard(config.budget), *guards)),),
        observers=observers,
    )


def _play(
    manifest: Manifest,
    model: Model,
    engine: World,
    kept: tuple[TrajectoryWriter, Path] | None,
    tools: Sequence[Tool] | None,
    watchers: tuple[Sequence[Guard], Sequence[Observer]],
    known: Sequence[Event] = (),
) -> EpisodeResult:
    """Play an episode on an engine that was just reset, and write its result."""
    trajectory = Trajectory()
    writer, folder = kept or (None, None)
    guards, others = watchers
    observers = (*((writer,) if writer else ()), trajectory, *others)
    agent = create_agent(manifest.config, model, engine, tools, guards, observers, known)
    try:
        agent.run(manifest.config.instruction)
    finally:
        if writer is not None:
            writer.close()
    if writer is not None and writer.fault is not None:
        raise writer.fault
    result = summarise(manifest, trajectory, engine.state(), folder)
    if folder is not None:
        _keep(folder, result)
    return result


def _keep(folder: Path, result: EpisodeResult) -> None:
    """Write what came of an episode; a full disk may take the files, never the score."""
    try:
        write_record(folder, RESULT, result)
    except FileError as error:
        again = f"once that is mended: adamo-vh run --resume {folder}"
        warnings.warn(f"the result is not kept: {error} ({again})", stacklevel=2)
    try_page(folder)


def _instruction(instruction: str | None, task: str | None) -> str:
    if instruction is not None and task is not None:
        raise ConfigError("Give an instruction or a task, not both.")
    if task is not None:
        return find_task(task).prompt
    if instruction is None:
        raise ConfigError("Say what to do, or name a task (T1 to T15).")
    return instruction


def member(kind: type[_E], value: str, what: str) -> _E:
    """A member of an enumeration by its value, in any case."""
    try:
        return kind(value.lower())
    except ValueError:
        offer = ", ".join(kind)
        raise ConfigError(f"There is no {what} {value!r}. Use one of {offer}.") from None


def resume_episode(
    folder: str | Path,
    *,
    model: Model | None = None,
    tools: Sequence[Tool] | None = None,
    guards: Sequence[Guard] = (),
    observers: Sequence[Observer] = (),
) -> EpisodeResult:
    """Go on with an episode that was interrupted at any moment.

    What was recorded is executed again, with the recorded answers in place of the model's; from
    there the model goes on. Nothing is asked or written twice.

    Args:
        folder: Its run folder.
        model: Who goes on; by default the model that the manifest names.
        tools: The body's primitives, as when it began.
        guards: Further reasons to stop.
        observers: Are told of every event, the repeated ones too.

    Raises:
        RecordError: The folder holds no run, or one that has ended, or a conversation; or somebody
            else writes it; or it came out otherwise. The record is as it was.
    """
    path = Path(folder)
    read_manifest(path)
    with ExitStack() as stack:
        lock = stack.enter_context(FolderLock(path))
        manifest, recorded = read_manifest(path), read_unfinished(path)
        if len(recorded.instructions) > 1:
            raise RecordError(
                f"{path} is a conversation; go on with: adamo-vh chat --resume {path}"
            )
        known = recorded.events
        if (ended := recorded.ended) is not None:
            if ended.reason.is_scored and (path / RESULT).exists():
                raise RecordError(f"{path} has ended ({ended.reason}); nothing is left to resume.")
            # It broke, or its result is missing: let it go on from there.
            known = known[:-1]
        player = resumed_player(path, manifest.config, recorded, model)
        if model is None:
            stack.callback(player.info.close)
        engine = create_engine(manifest.config.scene, manifest.config.figure)
        stack.callback(engine.close)
        engine.reset(manifest.config.seed)
        kept = (TrajectoryWriter(path, known=known, lock=lock), path)
        return _play(manifest, player, engine, kept, tools, (guards, observers), known)


def read_unfinished(folder: Path) -> Trajectory:
    """What was recorded so far; nothing, if the run was stopped before its first event."""
    return read_trajectory(folder) if (folder / EVENTS).exists() else Trajectory()


def resumed_player(
    folder: Path, config: EpisodeConfig, recorded: Trajectory, model: Model | None
) -> Model:
    """A model that says again what was recorded, and then goes on live."""
    said = [thought.reply for thought in recorded.thoughts]
    live = model or create_player(
        config.model,
        tools=config.tool_calls,
        profile=config.profile,
        answered=len(said),
        seed=config.seed,
    )
    if (folder / FOLDER).is_dir():
        live = taped(live, folder / FOLDER, known=len(said))
    return resumed(said, live)
