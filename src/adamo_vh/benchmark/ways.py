"""How far the oracle walks for a task, which is what an agent's way is measured against.

Known for the built-in tasks in the built-in scenes as they are, where it was measured by
`python tools/ways.py`; nothing is known of variations and of own scenes and tasks.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache
from importlib.resources import files
from typing import cast

from adamo_vh.files import read_json

TABLE = "ways.json"
"""Beside this module: metres by scene and task."""


@cache
def ways() -> Mapping[str, Mapping[str, float]]:
    """All that is known: metres by scene and task."""
    return cast(
        Mapping[str, Mapping[str, float]], read_json(str(files("adamo_vh.benchmark") / TABLE))
    )


def way_m(scene: str, variation: int, task: str | None) -> float | None:
    """Metres that the oracle walks; None where nobody has measured.

    Args:
        scene: Its name or file.
        variation: Of the scene.
        task: Id of a task; None for a free instruction.
    """
    return None if variation or task is None else ways().get(scene, {}).get(task)
