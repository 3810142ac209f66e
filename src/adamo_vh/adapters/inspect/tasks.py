"""Our studies as tasks of Inspect AI; its entry point loads this module.

`inspect eval adamo_vh/paper -T scene=s1 --model openai/gpt-5` plays them: our session keeps the
prompt, the memory, the tools, the limits and the record, Inspect the model, the log and the rest.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from anyio import to_thread
from inspect_ai import Epochs, Task, task
from inspect_ai.dataset import MemoryDataset, Sample
from inspect_ai.model import ChatMessage, ModelOutput, get_model
from inspect_ai.scorer import Score, Scorer, Target, mean, scorer, stderr
from inspect_ai.solver import Generate, Solver, TaskState, generate, solver
from inspect_ai.tool import Tool
from inspect_ai.util import store

from adamo_vh.adapters.exports.dialogue import dialogue
from adamo_vh.adapters.exports.recorded import recorded
from adamo_vh.adapters.inspect.conversation import chat
from adamo_vh.adapters.inspect.mind import NAME, InspectMind, decoding
from adamo_vh.adapters.inspect.scoring import score_of
from adamo_vh.adapters.inspect.seat import Seat
from adamo_vh.episode.config import EpisodeConfig
from adamo_vh.episode.result import EpisodeResult
from adamo_vh.errors import ConfigError
from adamo_vh.inference.model import Sampling
from adamo_vh.record.run_folder import reserve
from adamo_vh.session.pooling import process_engines
from adamo_vh.session.session import Session
from adamo_vh.study.plan import Planned, plan, seed_of
from adamo_vh.study.study_file import read_study

_ANY_MODEL = "random"
"""Stands for the model in the plan, which Inspect names."""
_SCORE = "adamo_vh_score"
_SEAT = "adamo_vh_seat"
_LOOPS = ("adamo", "inspect")
_SEATS: dict[str, Seat] = {}
"""Bodies that agents of Inspect drive now, by sample."""
_Words = str | Sequence[str] | None


@task
def study(
    file: str | None = None,
    tasks: _Words = None,
    scene: _Words = None,
    labeling: _Words = None,
    profile: _Words = None,
    variations: str | int | None = None,
    repetitions: int | None = None,
    resolution: str | None = None,
    out: str | None = None,
    loop: str = "adamo",
) -> Task:
    """Any study: a TOML file, one of the paper's by name, or what the other parameters say.

    Args:
        file: A study file, or paper, memory, sampling, points or resolution.
        tasks: Ids or files of tasks; all by default.
        scene: Scenes; s1 by default.
        labeling: sem, opaq; sem by default.
        profile: paper, lean, ...; paper by default.
        variations: Of the scenes: 0-4 or 0,2,7; 0 by default.
        repetitions: Epochs; those of the study by default.
        resolution: Size of the frames, WIDTHxHEIGHT.
        out: Folder that keeps the run folders; none is kept without.
        loop: "adamo": our session asks the model, with our memory. "inspect": Inspect's own loop,
            or a solver or agent of yours, drives the body with our tools.
    """
    given = {
        "tasks": _words(tasks),
        "scenes": _words(scene),
        "labelings": _words(labeling),
        "profiles": _words(profile),
        "variations": variations if isinstance(variations, str | None) else int(variations),
        "repetitions": repetitions,
        "resolution": resolution,
    }
    options = {name: value for name, value in given.items() if value is not None}
    if loop not in _LOOPS:
        raise ConfigError(f"There is no loop {loop!r}. Use one of {', '.join(_LOOPS)}.")
    return _task(file, {**options, "models": [_ANY_MODEL]}, out, loop)


def _named(name: str) -> Any:
    def made(
        tasks: _Words = None,
        scene: _Words = None,
        labeling: _Words = None,
        profile: _Words = None,
        variations: str | int | None = None,
        repetitions: int | None = None,
        resolution: str | None = None,
        out: str | None = None,
        loop: str = "adamo",
    ) -> Task:
        return study(
            name, tasks, scene, labeling, profile, variations, repetitions, resolution, out, loop
        )

    made.__doc__ = f"The paper's study {name!r}; the parameters replace what it says."
    made.__name__ = made.__qualname__ = name
    return task(made)


paper, memory, sampling, points, resolution = map(
    _named, ("paper", "memory", "sampling", "points", "resolution")
)


def _task(file: str | None, options: dict[str, Any], out: str | None, loop: str) -> Task:
    what = read_study(file, options)
    repetitions = what.repetitions
    episodes = {_id(one): one for one in plan(replace(what, repetitions=1))}
    samples = [
        Sample(
            id=name,
            input=one.config.instruction,
            target=one.config.task or "",
            metadata={
                "task": one.config.task,
                "scene": one.config.scene,
                "labeling": str(one.config.labeling),
                "profile": str(one.config.profile),
                "variation": one.variation,
                **dict(one.cell.axes),
            },
        )
        for name, one in episodes.items()
    ]
    varied = {one.config.sampling for one in episodes.values()}
    usual = next(iter(varied)) if len(varied) == 1 else None
    return Task(
        dataset=MemoryDataset(samples, name=what.name or "study"),
        setup=seated(episodes, out=out) if loop == "inspect" else None,
        solver=generate() if loop == "inspect" else body(episodes, samples=usual is None, out=out),
        cleanup=_leave,
        scorer=episode(),
        epochs=Epochs(repetitions, "mean"),
        config=decoding(usual or Sampling()),
        display_name=f"ADAMO: {what.name or 'study'}",
        version=1,
    )


def _id(one: Planned) -> str:
    """What a sample is called: as in a study's plan, without model and repetition."""
    return one.key.replace(f"/{_ANY_MODEL}/", "/", 1).replace("/r01", "", 1)


def _words(given: _Words) -> list[str] | None:
    if given is None:
        return None
    texts = given.split(",") if isinstance(given, str) else [str(text) for text in given]
    return [text.strip() for text in texts if text.strip()]


@solver
def body(episodes: dict[str, Planned], *, samples: bool, out: str | None) -> Solver:
    """The body in its room, with the model as its mind.

    Args:
        episodes: By the ids of the samples.
        samples: Whether the decoding settings of an episode are sent along.
        out: Folder that keeps the run folders.
    """

    async def solve(state: TaskState, generate: Generate) -> TaskState:
        config = _config(episodes, state)
        mind = InspectMind(get_model(), samples=samples)
        with TemporaryDirectory(prefix="adamo-vh-") as room:
            folder = _folder(out, state) or Path(room) / "run"
            play = partial(_played, config, mind, folder)
            result, state.messages = await to_thread.run_sync(play)
        if mind.fault is not None:
            # Inspect knows what to do with its own limits and faults; nothing is scored as 0.
            raise mind.fault
        score = score_of(result)
        if out:
            score.metadata = {**(score.metadata or {}), "run": str(folder)}
        state.store.set(_SCORE, score.model_dump())
        state.output = ModelOutput.from_content(str(mind.info.name), result.answer)
        state.completed = True
        return state

    return solve


@solver
def seated(episodes: dict[str, Planned], *, out: str | None) -> Solver:
    """The body in its room, waiting for the calls of whatever agent follows.

    Args:
        episodes: By the ids of the samples.
        out: Folder that keeps the run folders.
    """

    async def solve(state: TaskState, generate: Generate) -> TaskState:
        begin = partial(
            Seat, _config(episodes, state), _folder(out, state), f"{NAME}:{state.model}"
        )
        seat = _SEATS[state.uuid] = await to_thread.run_sync(begin)
        state.store.set(_SEAT, state.uuid)
        state.messages = await to_thread.run_sync(seat.opening)
        state.tools = seat.tools()
        return state

    return solve


class BodyTools:
    """The tools of the sample's body, for an agent that is given its own: `react(tools=[...])`."""

    async def tools(self) -> list[Tool]:
        """As Inspect asks a source of tools.

        Raises:
            ConfigError: No body waits for calls.
        """
        seat = _SEATS.get(str(store().get(_SEAT)))
        if seat is None:
            raise ConfigError("No body waits for calls: give the task loop=inspect.")
        return seat.tools()


async def _leave(state: TaskState) -> None:
    if (seat := _SEATS.pop(state.uuid, None)) is not None:
        await to_thread.run_sync(seat.close)


def _config(episodes: dict[str, Planned], state: TaskState) -> EpisodeConfig:
    seed = seed_of(f"{state.sample_id}/e{state.epoch:02d}")
    return replace(episodes[str(state.sample_id)].config, seed=seed)


def _folder(out: str | None, state: TaskState) -> Path | None:
    name = f"{state.sample_id}-e{state.epoch:02d}".replace("/", "-")
    return reserve(Path(out), name) if out else None


def _played(
    config: EpisodeConfig, mind: InspectMind, folder: Path
) -> tuple[EpisodeResult, list[ChatMessage]]:
    """One episode, in a thread."""
    with (
        process_engines().lent(config) as world,
        Session.begin(config, folder, model=mind, engine=world) as session,
    ):
        result = session.play()
    (told,) = recorded([folder])
    return result, chat(dialogue(told))


@scorer(metrics={"completion": [mean(), stderr()], "strict": [mean(), stderr()]})
def episode() -> Scorer:
    """Completion and strict success from the simulator's truth; no model judges anything."""

    async def score(state: TaskState, target: Target) -> Score:
        if (seat := _SEATS.get(state.uuid)) is not None:
            return score_of(await to_thread.run_sync(seat.finish, state.output))
        kept = state.store.get(_SCORE)
        return score_of(None) if kept is None else Score.model_validate(kept)

    return score
