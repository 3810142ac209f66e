"""The fifteen tasks T1 to T15, each a file in `builtin/`, and tasks of your own.

Prompts name no scene; every task can be done in every scene that has its objects.
"""

from __future__ import annotations

from functools import cache
from importlib import resources
from pathlib import Path
from typing import Any

from adamo_vh.benchmark.tasks.reading import parse_task, read_task
from adamo_vh.benchmark.tasks.task import Family, Task
from adamo_vh.errors import ConfigError

__all__ = ["TASKS", "Family", "Task", "builtin_tasks", "task"]

TASKS: tuple[Task, ...]
"""The fifteen tasks, in order; they are read when this is first asked for."""


@cache
def builtin_tasks() -> tuple[Task, ...]:
    """The fifteen tasks, in order."""
    folder = resources.files(__package__) / "builtin"
    files = sorted((f for f in folder.iterdir() if f.name.endswith(".toml")), key=lambda f: f.name)
    return tuple(parse_task(file.read_text(encoding="utf-8"), file.name) for file in files)


def task(name: str) -> Task:
    """The task with an id, e.g. "T7", or that of a task file.

    Raises:
        ConfigError: There is no such task, or its file is wrong.
        FileError: The file cannot be read.
    """
    for item in builtin_tasks():
        if item.id == name.upper():
            return item
    if name.lower().endswith(".toml"):
        own = read_task(Path(name))
        check_id(own)
        return own
    known = ", ".join(item.id for item in builtin_tasks())
    raise ConfigError(f"There is no task {name!r}. Tasks: {known}, or a task file (.toml).")


def check_id(own: Task) -> None:
    """Make sure that a task of one's own is not taken for a built-in one.

    Raises:
        ConfigError: It has the id of another task.
    """
    for item in builtin_tasks():
        if item.id == own.id.upper() and item != own:
            raise ConfigError(
                f"Task {own.id} is not the built-in task of that name; choose another id."
            )


def __getattr__(name: str) -> Any:
    if name == "TASKS":
        return builtin_tasks()
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
