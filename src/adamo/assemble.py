"""The one place where a concrete engine, a model, a profile and a task meet."""

from __future__ import annotations

import platform
from collections.abc import Sequence
from dataclasses import dataclass, replace
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
from adamo.errors import ConfigError
from adamo.inference.messages import AIMessage
from adamo.inference.model import Model, ModelKind, Sampling
from adamo.inference.registry import create_model
from adamo.inference.scripted import ScriptedModel
from adamo.perception import Labeling, PerceptionConfig, TextForm

_REPORTED = ("adamo", "mujoco", "numpy", "pillow", "opencv-python-headless", "pydantic-ai-slim")
_REPLAY = "replay:"
_E = TypeVar("_E", Labeling, TextForm)


def create_engine(scene: str = "s1") -> Engine:
    """The built-in engine with a scene.

    Raises:
        SceneError: The scene is unknown or wrong.
    """
    from adamo.runtime.builtin import BuiltinEngine

    return BuiltinEngine(scene)


def run_episode(
    instruction: str | None = None,
    *,
    task: str | None = None,
    scene: str = "s1",
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
    world = engine or create_engine(config.scene)
    try:
        return _play(config, player, world, folder, tools, observers)
    finally:
        if engine is None:
            world.close()


def _play(
    config: EpisodeConfig,
    model: Model,
    engine: Engine,
    folder: Path | None,
    tools: Sequence[Tool],
    observers: Sequence[Observer],
) -> EpisodeResult:
    trajectory = Trajectory()
    writer = None if folder is None else TrajectoryWriter(folder)
    recorders = (trajectory,) if writer is None else (writer, trajectory)
    engine.reset(config.seed)
    manifest = Manifest(
        config,
        model.name,
        model.kind,
        {"python": platform.python_version(), **{name: version(name) for name in _REPORTED}},
        datetime.now(UTC).isoformat(timespec="seconds"),
        engine.state(),
    )
    if folder is not None:
        write_record(folder, MANIFEST, manifest)
    server = LocalActionServer(
        engine,
        perception=PerceptionConfig(labeling=config.labeling, grid=config.grid),
        resolution=config.resolution,
        tools=tools,
    )
    agent = Agent(
        model,
        server,
        system_prompt=system_prompt(engine.scene, config.labeling, server.actions, NEAR_M),
        k=config.k,
        text_form=config.text_form,
        sampling=config.sampling,
        limits=config.limits,
        observers=(*recorders, *observers),
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


def _model(uri: str) -> Model:
    if uri.startswith(_REPLAY):
        folder = Path(uri.removeprefix(_REPLAY))
        return recorded_model(read_trajectory(folder), uri)
    return create_model(uri)


def recorded_model(trajectory: Trajectory, name: str) -> Model:
    """A model that says again what was said in a recorded episode."""
    said = [AIMessage(thought.note, thought.calls) for thought in trajectory.thoughts]
    return ScriptedModel(name, said, kind=ModelKind.REPLAY)


@dataclass(frozen=True, slots=True)
class ReplayReport:
    """Whether a recorded episode came out the same when it was executed again."""

    steps: int
    """Actions executed again."""
    mismatches: tuple[str, ...]
    """What differed, in order; empty if every state hash is the same."""
    frames_differ: int
    """Frames with other bytes: possible on another machine, no error there."""


def replay_episode(folder: str | Path) -> ReplayReport:
    """Execute a recorded episode again without its model and compare every state hash.

    Raises:
        RecordError: The folder holds no readable run.
    """
    path = Path(folder)
    manifest, recorded = read_manifest(path), read_trajectory(path)
    engine = create_engine(manifest.config.scene)
    again = Trajectory()
    model = recorded_model(recorded, f"{_REPLAY}{path}")
    steps = len(recorded.acts)
    config = replace(manifest.config, limits=Limits(max_steps=max(1, steps)))
    try:
        _play(config, model, engine, None, PAPER_TOOLS, (again,))
    finally:
        engine.close()
    return _compare(recorded, again)


def _compare(recorded: Trajectory, again: Trajectory) -> ReplayReport:
    mismatches = [
        f"step {then.step}: {then.name} led to state {now.state_hash[:12]}, "
        f"recorded {then.state_hash[:12]}"
        for then, now in zip(recorded.acts, again.acts, strict=False)
        if then.state_hash != now.state_hash
    ]
    if len(recorded.acts) != len(again.acts):
        mismatches.append(f"{len(recorded.acts)} actions recorded, {len(again.acts)} executed")
    then_end, now_end = recorded.ended, again.ended
    if then_end and now_end and then_end.state_hash != now_end.state_hash:
        mismatches.append("the final states differ")
    frames = zip(recorded.views, again.views, strict=False)
    return ReplayReport(
        len(again.acts), tuple(mismatches), sum(a.frame != b.frame for a, b in frames)
    )
