"""How far the oracle walks for a task, which is what an agent's way is measured against.

Known for the built-in tasks in the built-in scenes and in the first twenty of their variations in
each split, where it was measured by `python tools/ways.py`; nothing is known of other variations,
own scenes and own tasks.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache
from importlib.resources import files
from typing import cast

from adamo_vh.files import read_json

TABLE = "ways.json"
"""Beside this module: metres by scene, variation and task."""
Ways = Mapping[str, Mapping[str, Mapping[str, float]]]


@cache
def ways() -> Ways:
    """All that is known: metres by scene, number of the variation, and task."""
    return cast(Ways, read_json(str(files("adamo_vh.benchmark") / TABLE)))


def way_m(scene: str, variation: int, task: str | None) -> float | None:
    """Metres that the oracle walks; None where nobody has measured.

    Args:
        scene: Its name or file.
        variation: Of the scene; 0 is the scene as it stands.
        task: Id of a task; None for a free instruction.
    """
    return None if task is None else ways().get(scene, {}).get(str(variation), {}).get(task)
