"""A room of your own: a file with furniture, objects, lights, areas and a place to start.

Where a thing stands in z follows from settling on its support. `adamo-vh scenes check FILE` says
what is wrong with a scene, with pictures; `adamo-vh run --scene FILE` plays in it.
"""

from __future__ import annotations

import tempfile
from pathlib import Path

import adamo_vh

ROOM = """
name = "study"
title = "A table with three things"

[room]
asset = "room"
x_min = -3.0
x_max = 3.0
y_min = -3.0
y_max = 3.0
height_m = 2.8

[agent]
position = [-1.8, 0.0]
heading_deg = 0.0
gaze = [0.2, 0.0, 0.8]

[[lights]]
position = [-1.5, -1.5, 2.7]
target = [0.0, 0.0, 0.6]
diffuse = 0.7
shadow = true

[[furniture]]
name = "table"
asset = "dining_table"
position = [0.2, 0.0]

[[objects]]
id = 1
asset = "cup"
on = "table"
position = [0.0, -0.4]
yaw_deg = -90

[[objects]]
id = 2
asset = "plate"
on = "table"
position = [0.1, 0.1]

[[objects]]
id = 3
asset = "flashlight"
on = "table"
position = [0.0, 0.5]
yaw_deg = -60
"""


def main() -> None:
    """Write the room and let the baseline tidy up in it."""
    path = Path(tempfile.mkdtemp()) / "study.toml"
    path.write_text(ROOM, encoding="utf-8")
    result = adamo_vh.run_episode(
        "Put the cup on the floor", scene=str(path), resolution=(1280, 720)
    )
    print(result.termination, "-", result.answer)


if __name__ == "__main__":
    main()
