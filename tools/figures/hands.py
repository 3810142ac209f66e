"""Hands: palm, four fingers in a relaxed curl, and a thumb."""

from __future__ import annotations

import numpy as np
from tools.figures.clothes import mix
from tools.figures.shapes import Point, Shape, chain, round_cone, union
from tools.figures.variant import Variant

from adamo_vh.geometry import Array
from adamo_vh.runtime.human.hand import AXES, FINGERS, WRIST, finger_points


def hand(v: Variant) -> Shape:
    """The left hand with the wrist that the cuff hides."""
    origin, axes = np.array(WRIST), AXES["l"]
    s = mix(v, 1.0, 0.90)

    def at(a: float, b: float, c: float) -> Point:
        x, y, z = origin + np.array([a, b * s, c]) @ axes
        return (float(x), float(y), float(z))

    def placed(point: Array) -> Point:
        x, y, z = origin + point @ axes
        return (float(x), float(y), float(z))

    fingers = []
    bones = []
    for name in FINGERS[1:]:
        points = finger_points(name, s, mix(v, 1.0, 0.97))
        (a, b, _), size = points[0] / [1.0, s, 1.0], s * (0.84 if name == "little" else 1.0)
        bones.append(round_cone(at(0.004, b * 0.55, 0), at(a, b, 0), 0.0145 * s, 0.0112 * size))
        radii = [r * size for r in (0.0100, 0.0092, 0.0083, 0.0066)]
        fingers.append(chain([placed(p) for p in points], radii, 0.003))
    palm = union(0.014, *bones)
    heel = round_cone(at(0.018, 0.020, 0.006), at(0.052, 0.034, 0.010), 0.0165 * s, 0.0125 * s)
    thumb = chain(
        [placed(p) for p in finger_points("thumb", s)[1:]],
        [0.0125 * s, 0.0108 * s, 0.0088 * s],
        0.003,
    )
    wrist = union(
        0.02,
        *(
            round_cone(at(-0.05, b, 0), at(0.01, b, 0), 0.0225 * s, 0.0195 * s)
            for b in (-0.009, 0.009)
        ),
    )
    whole = union(0.016, palm, heel, wrist)
    return union(0.007, whole, union(0.0015, *fingers), thumb)
