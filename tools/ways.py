"""Measure how far the oracle walks for each task, and write the table that comes with the package.

    python tools/ways.py

Takes some two minutes.
"""

from __future__ import annotations

import json
from pathlib import Path

import adamo_vh
from adamo_vh.benchmark import ways
from adamo_vh.benchmark.verify import verify_tasks
from adamo_vh.files import write_whole
from adamo_vh.perception import Labeling
from adamo_vh.runtime.scenes import scene_names


def main() -> None:
    """Play the oracle in every scene."""
    table = {}
    for scene in scene_names():
        engine = adamo_vh.create_engine(scene)
        rows = list(verify_tasks(engine, Labeling.SEM))
        engine.close()
        if unsound := [row.task for row in rows if not row.is_sound]:
            raise SystemExit(f"{scene}: the oracle does not do {', '.join(unsound)}.")
        table[scene] = {row.task: round(row.walked_m, 3) for row in rows}
    text = json.dumps(table, indent=1) + "\n"
    write_whole(Path(ways.__file__).with_name(ways.TABLE), text.encode())


if __name__ == "__main__":
    main()
