"""Measure how far the oracle walks for each task, and write the table that comes with the package.

    python tools/ways.py

In the scenes as they stand, and in the first variations of each split. Takes some ten minutes on
two cores.
"""

from __future__ import annotations

import json
import multiprocessing
from pathlib import Path

from adamo_vh.benchmark import ways
from adamo_vh.benchmark.verify import verify_tasks
from adamo_vh.files import write_whole
from adamo_vh.perception import Labeling
from adamo_vh.runtime.scenes import scene_names
from adamo_vh.session.variations import FIRST, accepted, built_in_engine

PROCESSES = 2
VARIATIONS = 20
"""Of each split in each scene: as many as studies play."""


def main() -> None:
    """Play the oracle in every scene and variation."""
    places = [(scene, number) for scene in scene_names() for number in _numbers(scene)]
    table: dict[str, dict[int, dict[str, float]]] = {scene: {} for scene in scene_names()}
    with multiprocessing.get_context("spawn").Pool(PROCESSES) as pool:
        for count, (place, walked) in enumerate(pool.imap(_measure, places), 1):
            table[place[0]][place[1]] = walked
            print(f"{count} of {len(places)}", end="\r", flush=True)
    write_whole(Path(ways.__file__).with_name(ways.TABLE), _written(table).encode())


def _numbers(scene: str) -> list[int]:
    splits = accepted().get(scene, {})
    return [0, *(FIRST[name] + i for name in splits for i in range(VARIATIONS))]


def _measure(place: tuple[str, int]) -> tuple[tuple[str, int], dict[str, float]]:
    scene, number = place
    engine = built_in_engine(scene, "mara", number)
    rows = list(verify_tasks(engine, Labeling.SEM))
    engine.close()
    if unsound := [row.task for row in rows if not row.is_sound]:
        raise SystemExit(f"{scene} {number}: the oracle does not do {', '.join(unsound)}.")
    return place, {row.task: round(row.walked_m, 2) for row in rows}


def _written(table: dict[str, dict[int, dict[str, float]]]) -> str:
    """The table as JSON, a line for each variation."""
    scenes = []
    for scene, numbers in table.items():
        lines = [f'  "{number}": {json.dumps(found)}' for number, found in numbers.items()]
        scenes.append(f' "{scene}": {{\n' + ",\n".join(lines) + "\n }")
    return "{\n" + ",\n".join(scenes) + "\n}\n"


if __name__ == "__main__":
    main()
