"""How deep hand and forearms are in furniture while she takes things, in films and in the studio.

    python benchmarks/reaches.py [--variations 4]

Every object of both scenes and of their variations is taken, 15 moments a second are looked at,
and the deepest one counts: of the middle of the right hand (a ball of 4 cm, further than 12 cm from
what is taken) and of points along each forearm (balls of 3.5 cm). The first line is of reaches as
they would be if no arm kept out of anything, the second of reaches as they are.
"""

from __future__ import annotations

import argparse
from unittest.mock import patch

import numpy as np

from adamo_vh.geometry import Array
from adamo_vh.runtime import physics
from adamo_vh.runtime.builtin import BuiltinEngine
from adamo_vh.runtime.human.handling import Handling
from adamo_vh.runtime.human.skeleton import INDEX
from adamo_vh.session.variations import built_in_engine

_PARTS = ("right hand", "right forearm", "left forearm")
_DEEP_CM = (1, 3)
_NEAR_M = 0.12
_HAND_M, _FOREARM_M = 0.04, 0.035
_ALONG = np.linspace(0.15, 0.9, 6)[:, None]


def deepest(engine: BuiltinEngine, object_id: int) -> list[float] | None:
    """How deep each part is at most while an object is taken; None if it is not."""
    solids = physics.gathered(engine.world.solids)
    target = engine.world.box(object_id).center
    deep = [0.0, 0.0, 0.0]

    def moment(_: float) -> bool:
        frame = engine.stage.shown(engine.body.stance)
        places = frame.joints()[0]
        for part, side in ((1, "r"), (2, "l")):
            elbow, wrist = places[INDEX[f"forearm_{side}"]], places[INDEX[f"hand_{side}"]]
            points = elbow + _ALONG * (wrist - elbow)
            deep[part] = max(deep[part], *solids.depth(points, _FOREARM_M).tolist())
        hand = frame.hand
        if hand.distance(target) > _NEAR_M:
            deep[0] = max(deep[0], *solids.depth(hand.array()[None], _HAND_M).tolist())
        return True

    # The way there is not looked at.
    if (path := engine.body.way_to(target)) is None:
        return None
    engine.body.walk(path.end)
    engine.stage.watch(moment)
    report = engine.body.pick(object_id)
    engine.stage.watch(None)
    return deep if report.outcome == "done" else None


def reaches(variations: int) -> Array:
    """(N, 3) how deep each part is at most in each reach."""
    rows = []
    for scene in ("s1", "s2"):
        for variation in range(variations):
            engine = built_in_engine(scene, "mara", variation)
            start = engine.snapshot()
            for item in engine.state().objects:
                engine.restore(start)
                if (row := deepest(engine, item.id)) is not None:
                    rows.append(row)
            engine.close()
    return np.array(rows)


def main() -> None:
    """Measure both, and print them."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--variations", type=int, default=4, help="of each scene, from 0 on")
    variations = parser.parse_args().variations
    with patch.object(Handling, "clear", lambda self, _: self):
        before = reaches(variations)
    for label, rows in (("plain", before), ("as it is", reaches(variations))):
        print(f"{label} ({len(rows)} reaches):")
        for part, deep in zip(_PARTS, 100 * rows.T, strict=True):
            shares = ", ".join(f"{(deep > most).mean():.0%} over {most} cm" for most in _DEEP_CM)
            print(f"  {part}: {shares}, mean {deep.mean():.2f} cm, at most {deep.max():.1f} cm")


if __name__ == "__main__":
    main()
