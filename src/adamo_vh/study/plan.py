"""The plan of a study: a list of episodes, each with a key that says what it is.

The same study gives the same list on every machine. What an episode draws depends on its key alone,
so that it comes out the same in whatever order, and beside whatever else, it is played.
"""

from __future__ import annotations

import hashlib
import itertools
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Any

from adamo_vh.episode.config import EpisodeConfig
from adamo_vh.errors import ConfigError
from adamo_vh.session.minds import is_deterministic
from adamo_vh.study.axes import settings_of, slug, spelled

_MOST = 1_000_000
"""Episodes of a study."""


@dataclass(frozen=True, slots=True)
class CellKey:
    """What all episodes of a cell have in common: everything but repetition and variation."""

    scene: str
    task: str
    labeling: str
    model: str
    profile: str
    axes: tuple[tuple[str, str], ...] = ()
    """Further settings that the study varies, by name, as they are spelled."""


@dataclass(frozen=True, slots=True)
class Planned:
    """One episode of a study."""

    key: str
    """Names it; also its folder within the study's episodes."""
    cell: CellKey
    variation: int
    """Of the scene's layout."""
    repetition: int
    """From 1, within cell and variation."""
    config: EpisodeConfig


@dataclass(frozen=True, slots=True)
class Study:
    """What is played: every combination of the lists."""

    tasks: tuple[str, ...]
    """Ids of tasks, or files of own ones."""
    scenes: tuple[str, ...] = ("s1",)
    labelings: tuple[str, ...] = ("sem",)
    models: tuple[str, ...] = ("baseline",)
    """Model URIs."""
    profiles: tuple[str, ...] = ("paper",)
    repetitions: int = 1
    """Of every cell and variation. A model that is deterministic in a deterministic world is
    played once a variation: all of its repetitions would be the same."""
    variations: tuple[int, ...] = (0,)
    settings: Mapping[str, Any] = field(default_factory=dict)
    """Other settings of all episodes, by the names in `adamo_vh.study.axes.SETTINGS`."""
    axes: Mapping[str, tuple[Any, ...]] = field(default_factory=dict)
    """Further settings that are varied."""
    name: str = ""
    """What it is called, for people."""

    def __post_init__(self) -> None:
        """Refuse what cannot be planned."""
        for what in ("tasks", "scenes", "labelings", "models", "profiles", "variations"):
            _check_list(what, getattr(self, what))
        for axis, values in self.axes.items():
            _check_list(f"axis {axis}", tuple(map(spelled, values)))
        if isinstance(self.repetitions, bool) or not isinstance(self.repetitions, int):
            raise ConfigError(f"repetitions is {self.repetitions!r}: use a whole number from 1.")
        if self.repetitions < 1:
            raise ConfigError(f"repetitions is {self.repetitions}: use a whole number from 1.")
        if both := self.settings.keys() & self.axes.keys():
            raise ConfigError(f"{min(both)} is set and varied as well; leave one of them out.")


def _check_list(what: str, values: tuple[Any, ...]) -> None:
    if not values:
        raise ConfigError(f"The study has no {what}: name at least one.")
    twice = next((value for value in values if values.count(value) > 1), None)
    if twice is not None:
        raise ConfigError(f"{twice} stands twice in {what}; leave one out.")


def plan(study: Study) -> tuple[Planned, ...]:
    """Every episode of a study, in order.

    Raises:
        ConfigError: A setting is wrong; says what can be used.
        ModelConfigError: A model is unknown.
    """
    runs = {model: 1 if is_deterministic(model) else study.repetitions for model in study.models}
    count = sum(runs.values()) * len(study.variations)
    lists = (study.tasks, study.scenes, study.labelings, study.profiles, *study.axes.values())
    for values in lists:
        count *= len(values)
    if count > _MOST:
        raise ConfigError(f"The study has {count:,} episodes; split it: {_MOST:,} at most.")
    episodes = [episode for scene in study.scenes for episode in _of_scene(study, scene, runs)]
    found: dict[str, Planned] = {}
    for episode in episodes:
        if (other := found.setdefault(episode.key, episode)) is not episode:
            raise ConfigError(
                f"{other.cell} and {episode.cell} would be played twice, as {episode.key}; leave "
                "one out."
            )
    return tuple(episodes)


def _of_scene(study: Study, scene: str, runs: Mapping[str, int]) -> list[Planned]:
    points = [
        dict(zip(study.axes, values, strict=True))
        for values in itertools.product(*study.axes.values())
    ]
    episodes = []
    for task, labeling, model, profile, point in itertools.product(
        study.tasks, study.labelings, study.models, study.profiles, points
    ):
        config = EpisodeConfig.of(
            task=task,
            scene=scene,
            labeling=labeling,
            model=model,
            profile=profile,
            **settings_of({**study.settings, **point}),
        )
        named = tuple((name, spelled(value)) for name, value in point.items())
        cell = CellKey(
            scene, config.task or task, str(config.labeling), model, profile.lower(), named
        )
        for variation in study.variations:
            varied = replace(config, variation=variation)
            for repetition in range(1, runs[model] + 1):
                key = key_of(cell, variation, repetition)
                episodes.append(
                    Planned(key, cell, variation, repetition, replace(varied, seed=seed_of(key)))
                )
    return episodes


def key_of(cell: CellKey, variation: int, repetition: int) -> str:
    """The key of an episode: readable, stable, and a relative folder.

    Such as ``s1/T08/opaq/baseline/paper/v0000/r01``, with ``/NAME=VALUE`` for each further axis.
    """
    parts = [
        slug(cell.scene),
        _task_name(cell.task),
        slug(cell.labeling),
        slug(cell.model),
        slug(cell.profile),
        f"v{variation:04d}",
        f"r{repetition:02d}",
        *(slug(f"{name}={value}") for name, value in cell.axes),
    ]
    return "/".join(parts)


def _task_name(task: str) -> str:
    """T8 as T08, so that names stand in order."""
    head, number = task[:1], task[1:]
    return f"T{int(number):02d}" if head == "T" and number.isdecimal() else slug(task)


def seed_of(key: str) -> int:
    """The seed of an episode: 32 bits that follow from its key."""
    return int.from_bytes(hashlib.sha256(key.encode()).digest()[:4], "big")
