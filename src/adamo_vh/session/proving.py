"""Proof that a task is sound in a scene: it can be done, is not done already, and not by luck."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

from adamo_vh.action_server.frame_cache import FrameCache
from adamo_vh.benchmark.tasks import Task
from adamo_vh.benchmark.verify import Verification, verify_tasks
from adamo_vh.engine import World
from adamo_vh.episode.config import EpisodeConfig
from adamo_vh.errors import ConfigError
from adamo_vh.inference.players.random import RandomModel
from adamo_vh.perception import Labeling
from adamo_vh.session.bodies import check_task, create_engine
from adamo_vh.session.builtin import scene_names
from adamo_vh.session.runs import run_episode

RANDOM_EPISODES = 20
"""Episodes in which calls are drawn by lot, half of them under either labeling."""
LUCK = 0.2
"""Mean completion by lot that a task must stay below."""


@dataclass(frozen=True, slots=True)
class Proof:
    """What came of one task in one scene under one labeling."""

    found: Verification
    """What the oracle and doing nothing give."""
    random: float | None
    """Mean completion by lot, over both labelings; None if it was not tried."""

    @property
    def problems(self) -> tuple[str, ...]:
        """What is wrong; nothing, if the task is sound here."""
        if self.random is None or self.random < LUCK:
            return self.found.problems
        luck = f"too much of it comes about by lot: {self.random:.2f}, and {LUCK:g} is the limit"
        return (*self.found.problems, luck)

    @property
    def is_sound(self) -> bool:
        """Whether the task can be done, is not done already, and is not done by luck."""
        return self.found.is_sound and not self.problems


def prove(
    task: Task, scene: str | None = None, random_episodes: int = RANDOM_EPISODES
) -> Iterator[Proof]:
    """Prove a task in every scene that it fits, under both labelings.

    Args:
        task: Any.
        scene: One scene or scene file; by default those that the task names, else all built-in
            ones that have what it is about.
        random_episodes: So many are played by lot in each scene; 0 for none.

    Raises:
        ConfigError: The task does not fit the scene, or no scene.
        SceneError: There is no such scene.
    """
    names = (scene,) if scene else task.scenes or scene_names()
    refused = []
    for name in names:
        engine = create_engine(name)
        try:
            check_task(_config(task, name), engine)
            yield from prove_in(engine, task, random_episodes)
        except ConfigError as error:
            if scene or task.scenes:
                raise
            refused.append(str(error))
        finally:
            engine.close()
    if len(refused) == len(names):
        raise ConfigError(f"No built-in scene fits. {refused[0]}")


def prove_in(engine: World, task: Task, random_episodes: int) -> Iterator[Proof]:
    """Prove a task in one world, under both labelings.

    Args:
        engine: Is reset.
        task: Fits its scene.
        random_episodes: So many are played by lot; 0 for none.
    """
    found = [row for labeling in Labeling for row in verify_tasks(engine, labeling, [task])]
    random = None
    if random_episodes and all(row.is_sound for row in found):
        random = by_lot(engine, task, random_episodes)
    for row in found:
        yield Proof(row, random)


def by_lot(engine: World, task: Task, episodes: int) -> float:
    """Mean completion of a task when all calls are drawn by lot; the same every time.

    Args:
        engine: Is reset.
        task: Fits its scene.
        episodes: So many at most: none is played when those before have settled whether the mean
            stays below `LUCK`.
    """
    config = _config(task, engine.scene.name)
    frames = FrameCache()  # Half of all episodes begin with the same view.
    total = 0.0
    for seed in range(episodes):
        if is_settled(total, seed, episodes):
            return total / seed
        labeling = list(Labeling)[seed % len(Labeling)]
        result = run_episode(
            replace(config, labeling=labeling, seed=seed),
            engine=engine,
            model=RandomModel(seed),
            frame_cache=frames,
        )
        if result.completion is None:
            raise ConfigError(f"Task {task.id} cannot be played by lot: {result.answer}.")
        total += result.completion
    return total / episodes


def is_settled(total: float, played: int, episodes: int) -> bool:
    """Whether the mean over all episodes is known to be below `LUCK`, or not to be.

    Args:
        total: Completions of those that were played, added up.
        played: How many that were.
        episodes: How many there are.
    """
    enough = LUCK * episodes
    return total >= enough or total + (episodes - played) < enough


def _config(task: Task, scene: str) -> EpisodeConfig:
    # Little sight and memory are enough for a player that draws lots.
    return EpisodeConfig.of(task=task, scene=scene, resolution=(320, 180), grid=3, k=4)
