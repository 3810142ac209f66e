"""Which episodes there are, in OpenEnv's words: a split for each scene, a task for each of ours."""

from __future__ import annotations

from typing import Any

from adamo_vh.benchmark.tasks import TASKS, Task
from adamo_vh.errors import ConfigError
from adamo_vh.session.builtin import scene_names

NAME = "adamo_vh"
"""Of the environment."""


def splits() -> list[dict[str, str]]:
    """A split for each built-in scene."""
    return [{"name": scene.upper(), "type": "test"} for scene in scene_names()]


def tasks_of(split: str) -> list[dict[str, Any]]:
    """The tasks of a split, in order.

    Raises:
        ConfigError: There is no such split.
    """
    return [
        {
            "id": f"{split.upper()}-{task.id}",
            "index": index,
            "task": task.id,
            "scene": split.lower(),
            "instruction": task.prompt,
        }
        for index, task in enumerate(_in(split))
    ]


def chosen(split: str, index: int) -> tuple[str, str]:
    """Scene and task of an entry.

    Raises:
        ConfigError: There is no such entry.
    """
    found = _in(split)
    if not 0 <= index < len(found):
        raise ConfigError(f"Split {split.upper()} has tasks 0 to {len(found) - 1}, and no {index}.")
    return split.lower(), found[index].id


def drawn(seed: int | None) -> str:
    """The task of an episode that names none: the first one, or one that follows from its seed."""
    return TASKS[(seed or 0) % len(TASKS)].id


def _in(split: str) -> list[Task]:
    scene = split.lower()
    if scene not in scene_names():
        offer = ", ".join(name.upper() for name in scene_names())
        raise ConfigError(f"There is no split {split[:40]!r}. Splits: {offer}.")
    return [task for task in TASKS if not task.scenes or scene in task.scenes]
