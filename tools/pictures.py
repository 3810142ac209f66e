"""Draw the pictures of the README anew: python tools/pictures.py [FOLDER]."""

from __future__ import annotations

import io
import math
import sys
from pathlib import Path

from PIL import Image

from adamo_vh.geometry import Camera, Vec3
from adamo_vh.perception import PerceptionConfig, perceive
from adamo_vh.runtime.builtin import BuiltinEngine

FOLDER = Path(__file__).parents[1] / "docs" / "images"
FULL_PX = (1920, 1080)
SMALL_PX = (1600, 900)
QUALITY = 82


def tabletop() -> bytes:
    """What a model sees first in S1."""
    engine = BuiltinEngine("s1")
    engine.reset(0)
    config = PerceptionConfig(jpeg_quality=QUALITY)
    seen = perceive(engine.body.see(*FULL_PX), engine.body.rays, config, engine.object_names)
    engine.close()
    return seen.frame.data


def living_room() -> bytes:
    """The virtual human in S2, with the mug in her hand."""
    engine = BuiltinEngine("s2")
    engine.reset(0)
    engine.body.pick(45)
    engine.body.walk(Vec3(-0.55, -0.35, 0.0))
    engine.body.look(Vec3(0.43, 0.67, 0.46))
    picture = engine.view(_camera(Vec3(2.1, -1.2, 1.55), Vec3(-0.65, 0.3, 0.8))).rgb
    engine.close()
    kept = io.BytesIO()
    Image.fromarray(picture).save(kept, "JPEG", quality=QUALITY)
    return kept.getvalue()


def _camera(eye: Vec3, target: Vec3) -> Camera:
    line = target - eye
    pitch = math.atan2(line.z, math.hypot(line.x, line.y))
    return Camera(eye, math.atan2(line.y, line.x), pitch, math.radians(58), *SMALL_PX)


def main() -> None:
    """Write both."""
    folder = Path(sys.argv[1]) if len(sys.argv) > 1 else FOLDER
    folder.mkdir(parents=True, exist_ok=True)
    for name, draw in (("tabletop.jpg", tabletop), ("living_room.jpg", living_room)):
        (folder / name).write_bytes(draw())
        print(folder / name)


if __name__ == "__main__":
    main()
