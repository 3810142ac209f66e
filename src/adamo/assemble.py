"""The one place where a concrete engine, a model, a profile and a task meet."""

from __future__ import annotations

import platform
from collections.abc import Sequence
from datetime import UTC, datetime
from importlib.metadata import version
from pathlib import Path
from typing import TypeVar

from adamo.action_server import PAPER_TOOLS, LocalActionServer, Tool
from adamo.benchmark.conditions import NEAR_M
from adamo.benchmark.episode import (
    MANIFEST,
    RESULT,
    EpisodeConfig,
    EpisodeResult,
    Manifest,
    read_manifest,
    summarise,
    write_record,
)
from adamo.benchmark.page import write_page
from adamo.benchmark.replay import ReplayReport, replay
from adamo.benchmark.tasks import task as find_task
from adamo.cognition.agent import Agent
from adamo.cognition.instructions import system_prompt
from adamo.cognition.termination import Limits
from adamo.cognition.trajectory import (
    Observer,
    Trajectory,
    TrajectoryWriter,
    read_trajectory,
)
from adamo.engine import Engine
from adamo.errors import ConfigError, RecordError
from adamo.inference.messages import AIMessage
from adamo.inference.model import Model, ModelKind, Reply, Sampling
from adamo.inference.registry import create_model
from adamo.inference.resumed import Resumed
from adamo.inference.scripted import ScriptedModel
from adamo.perception import Labeling, PerceptionConfig, TextForm

_REPORTED = ("adamo", "mujoco", "numpy", "pillow", "opencv-python-headless", "pydantic-ai-slim")
_REPLAY = "replay:"
_E = TypeVar("_E", Labeling, TextForm)


def create_engine(scene: str = "s1", figure: str = "mara") -> Engine:
    """The built-in engine with a scene.

    Args:
        scene: Built-in scene or path of a scene file.
        figure: Who the virtual human is: mara, jonas, amina or ken.

    Raises:
        SceneError: The scene is unknown or wrong.
        ConfigError: No figure has this name.
    """
    from adamo.runtime.builtin import BuiltinEngine

    return BuiltinEngine(scene, figure)


def run_episode(
    instruction: str | None = None,
    *,
    task: str | None = None,
    scene: str = "s1",
    figure: str = "mara",
    labeling: str = "sem",
    model: str | Model = "baseline",
    seed: int = 0,
    k: int = 50,
    grid: int = 6,
    resolution: tuple[int, int] = (1920, 1080),
    text_form: str = "full",
    sampling: Sampling | None = None,
    limits: Limits | None = None,
    out: str | Path | None = None,
    tools: Sequence[Tool] = PAPER_TOOLS,
    observers: Sequence[Observer] = (),
    engine: Engine | None = None,
) -> EpisodeResult:
    """Run one episode.

    Args:
        instruction: What the agent is told; the task's prompt if left out.
        task: Id of a benchmark task ("T1" to "T15"), whose checker then scores the episode.
        scene: Built-in scene or path of a scene file.
        figure: Who the virtual human is: mara, jonas, amina or ken.
        labeling: "sem" or "opaq".
        model: URI ("baseline", "scripted:FILE.json", "replay:RUN_DIR", "openai:NAME",
            "openai:NAME@URL", ...) or an own `Model`.
        seed: Seed of the episode.
        k: Steps in the short-term memory.
        grid: Reference points along each side of the frame.
        resolution: Width and height of the frames in pixels.
        text_form: "full", or "paper" for the original's fields alone.
        sampling: Decoding settings; the paper's by default.
        limits: Caps on steps and seconds; 60 and 600 by default.
        out: Run folder for manifest, events, frames, result and page; none is written without.
        tools: The body's primitives.
        observers: Are told of every event.
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
    config = EpisodeConfig(
        instruction=_instruction(instruction, task),
        task=None if task is None else find_task(task).id,
        scene=scene,
        figure=figure,
        labeling=_choice(Labeling, labeling, "labeling"),
        model=model if isinstance(model, str) else model.name,
        seed=seed,
        k=k,
        grid=grid,
        resolution=resolution,
        text_form=_choice(TextForm, text_form, "text form"),
        sampling=sampling or Sampling(),
        limits=limits or Limits(),
    )
    player = _model(model) if isinstance(model, str) else model
    folder = None if out is None else Path(out)
    writer = None if folder is None else TrajectoryWriter(folder)
    world = engine or create_engine(config.scene, config.figure)
    try:
        world.reset(config.seed)
        manifest = _manifest(config, player, world)
        if folder is not None:
            write_record(folder, MANIFEST, manifest)
        record = None if writer is None or folder is None else (writer, folder)
        return _play(manifest, player, world, record, tools, observers)
    finally:
        if engine is None:
            world.close()


def _manifest(config: EpisodeConfig, model: Model, engine: Engine) -> Manifest:
    versions = {"python": platform.python_version(), **{name: version(name) for name in _REPORTED}}
    now = datetime.now(UTC).isoformat(timespec="seconds")
    return Manifest(config, model.name, model.kind, versions, now, engine.state())


def _server(config: EpisodeConfig, engine: Engine, tools: Sequence[Tool]) -> LocalActionServer:
    return LocalActionServer(
        engine,
        perception=PerceptionConfig(labeling=config.labeling, grid=config.grid),
        resolution=config.resolution,
        tools=tools,
    )


def _play(
    manifest: Manifest,
    model: Model,
    engine: Engine,
    record: tuple[TrajectoryWriter, Path] | None,
    tools: Sequence[Tool],
    observers: Sequence[Observer],
) -> EpisodeResult:
    """Play an episode on an engine that was just reset, and write its result."""
    config, trajectory = manifest.config, Trajectory()
    writer, folder = record or (None, None)
    server = _server(config, engine, tools)
    agent = Agent(
        model,
        server,
        system_prompt=system_prompt(engine.scene, config.labeling, server.actions, NEAR_M),
        k=config.k,
        text_form=config.text_form,
        sampling=config.sampling,
        limits=config.limits,
        observers=(*((writer,) if writer else ()), trajectory, *observers),
    )
    try:
        agent.run(config.instruction)
    finally:
        if writer is not None:
            writer.close()
    result = summarise(manifest, trajectory, engine.state(), folder)
    if folder is not None:
        write_record(folder, RESULT, result)
        write_page(folder)
    return result


def _instruction(instruction: str | None, task: str | None) -> str:
    if instruction is not None and task is not None:
        raise ConfigError("Give an instruction or a task, not both.")
    if task is not None:
        return find_task(task).prompt
    if instruction is None:
        raise ConfigError("Say what to do, or name a task (T1 to T15).")
    return instruction


def _choice(kind: type[_E], value: str, what: str) -> _E:
    try:
        return kind(value.lower())
    except ValueError:
        offer = ", ".join(kind)
        raise ConfigError(f"There is no {what} {value!r}. Use one of {offer}.") from None


def _model(uri: str, answered: int = 0) -> Model:
    """The model of a URI; of one that answers from a list, the first answers were given before."""
    if uri.startswith(_REPLAY):
        folder = Path(uri.removeprefix(_REPLAY))
        model: Model = recorded_model(read_trajectory(folder), uri)
    else:
        model = create_model(uri)
    if isinstance(model, ScriptedModel):
        model.skip(answered)
    return model


def recorded_model(trajectory: Trajectory, name: str) -> Model:
    """A model that says again what was said in a recorded episode."""
    said = [AIMessage(thought.note, thought.calls) for thought in trajectory.thoughts]
    return ScriptedModel(name, said, kind=ModelKind.REPLAY)


def replay_episode(folder: str | Path, start: int = 0) -> ReplayReport:
    """Execute a recorded episode again without its model and compare every state hash.

    Args:
        folder: A run folder.
        start: Begin after this many steps, from the state that was saved there.

    Raises:
        RecordError: The folder holds no readable run, or has no such step.
    """
    path = Path(folder)
    manifest, recorded = read_manifest(path), read_trajectory(path)
    engine = create_engine(manifest.config.scene, manifest.config.figure)
    engine.reset(manifest.config.seed)
    try:
        return replay(_server(manifest.config, engine, PAPER_TOOLS), recorded, start)
    finally:
        engine.close()


def resume_episode(
    folder: str | Path,
    *,
    model: Model | None = None,
    tools: Sequence[Tool] = PAPER_TOOLS,
    observers: Sequence[Observer] = (),
) -> EpisodeResult:
    """Go on with an episode that was interrupted at any moment.

    What was recorded is executed again, with the recorded answers in place of the model's; from
    there the model goes on. Nothing is asked or written twice.

    Args:
        folder: Its run folder.
        model: Who goes on; by default the model that the manifest names.
        tools: The body's primitives, as when it began.
        observers: Are told of every event, the repeated ones too.

    Raises:
        RecordError: The folder holds no run, or one that has ended.
    """
    path = Path(folder)
    manifest, recorded = read_manifest(path), read_trajectory(path)
    if recorded.ended is not None:
        raise RecordError(f"{path} has ended ({recorded.ended.reason}); nothing is left to resume.")
    said = [
        Reply(AIMessage(t.note, t.calls), t.usage, t.model_s, t.waited_s) for t in recorded.thoughts
    ]
    player = Resumed(said, model or _model(manifest.config.model, answered=len(said)))
    writer = TrajectoryWriter(path, known=len(recorded.events))
    engine = create_engine(manifest.config.scene, manifest.config.figure)
    try:
        engine.reset(manifest.config.seed)
        return _play(manifest, player, engine, (writer, path), tools, observers)
    finally:
        engine.close()
