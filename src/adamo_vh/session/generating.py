"""New tasks that are proved: drawn from templates, and kept if they are sound in their scene."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import ExitStack
from dataclasses import dataclass
from pathlib import Path

from adamo_vh.benchmark.tasks import Task, builtin_tasks
from adamo_vh.benchmark.tasks.generating import SPLITS, Drawer, levels_in_turn
from adamo_vh.benchmark.tasks.writing import task_text
from adamo_vh.engine import World
from adamo_vh.errors import ConfigError
from adamo_vh.files import write_whole
from adamo_vh.session.bodies import create_engine
from adamo_vh.session.builtin import check_scene, scene_names
from adamo_vh.session.proving import RANDOM_EPISODES, prove_in

MOST = 1000
"""Tasks at once."""
_VAIN = 60
"""Draws in a row without a sound task after which no more are expected."""


@dataclass(frozen=True, slots=True)
class Generated:
    """A task that is sound."""

    task: Task
    random: float
    """Mean completion of it by lot."""


def generate(
    seed: int,
    count: int,
    scenes: Sequence[str] = (),
    split: str = "dev",
    *,
    random_episodes: int = RANDOM_EPISODES,
    on_refused: Callable[[Task, str], None] = lambda task, why: None,
) -> Iterator[Generated]:
    """Make new tasks, each proved like any own one (see `adamo_vh.session.proving`).

    The same arguments give the same tasks, and a larger count the same ones and more. Levels come
    in turn, and so do scenes.

    Args:
        seed: Of the draws; 0 or more.
        count: How many.
        scenes: Built-in scenes or scene files; all built-in ones by default.
        split: "dev" or "test"; no task is in both, whatever the seeds.
        random_episodes: So many are played by lot to see that luck does not do it.
        on_refused: Is told of each task that was drawn and is not sound, and why.

    Raises:
        ConfigError: An argument is wrong, or a scene has no more such tasks.
        SceneError: There is no such scene.
    """
    if not 1 <= count <= MOST:
        raise ConfigError(f"count is {count}: use 1 to {MOST}.")
    if seed < 0:
        raise ConfigError(f"seed is {seed}: use a whole number from 0.")
    if split not in SPLITS:
        raise ConfigError(f"split is {split!r}: use {' or '.join(SPLITS)}.")
    names = tuple(scenes) or scene_names()
    for name in names:
        check_scene(name)
    with ExitStack() as stack:
        engines = []
        for name in names:
            engines.append(create_engine(name))
            stack.callback(engines[-1].close)
        yield from _drawn(engines, seed, count, split, random_episodes, on_refused)


def _drawn(
    engines: Sequence[World],
    seed: int,
    count: int,
    split: str,
    random_episodes: int,
    on_refused: Callable[[Task, str], None],
) -> Iterator[Generated]:
    drawers = []
    for engine in engines:
        engine.reset(0)
        drawers.append(Drawer(engine.state(), seed, split, builtin_tasks()))
    levels, made, vain = levels_in_turn(seed, split), 0, 0
    while made < count:
        level, turn = next(levels), made % len(engines)
        # A task that is refused is replaced by another of its level, as long as there is one.
        while vain < _VAIN:
            task = drawers[turn].draw(level, f"{split.upper()}-{seed}-{made + 1:03d}")
            if task is None:
                vain += 1
                break
            proofs = list(prove_in(engines[turn], task, random_episodes))
            problems = [problem for proof in proofs for problem in proof.problems]
            if not problems and all(proof.is_sound for proof in proofs):
                yield Generated(task, max(proof.random or 0.0 for proof in proofs))
                made, vain = made + 1, 0
                break
            on_refused(task, problems[0] if problems else "it is not sound")
            vain += 1
        else:
            raise ConfigError(
                f"Scene {engines[turn].scene.name!r} has no more sound tasks of split {split}: "
                f"{made} were made. Ask for fewer, or name further scenes."
            )


def write_task(folder: Path, task: Task) -> Path:
    """Write a task as a file called by its id; what is there already must be the same.

    Args:
        folder: Is made if it is missing.
        task: What is written.

    Raises:
        ConfigError: A file of that name holds another task.
        FileError: The folder cannot be written.
    """
    path, text = folder / f"{task.id}.toml", task_text(task).encode()
    if path.exists() and path.read_bytes() != text:
        raise ConfigError(f"{path} holds another task; choose another --out folder.")
    return write_whole(path, text)
