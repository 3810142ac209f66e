"""Hands: palm, four fingers in a relaxed curl, and a thumb."""

from __future__ import annotations

import numpy as np
from tools.figures.clothes import mix
from tools.figures.shapes import Point, Shape, chain, round_cone, union
from tools.figures.variant import Variant

from adamo_vh.geometry import Array
from adamo_vh.runtime.human.skeleton import INDEX, REST

_KNUCKLES = (  # along, towards the thumb, phalanges, spread in degrees
    (0.086, 0.0300, (0.039, 0.024, 0.019), 5.0),
    (0.091, 0.0095, (0.044, 0.027, 0.020), 1.0),
    (0.088, -0.0110, (0.041, 0.025, 0.019), -3.0),
    (0.079, -0.0300, (0.031, 0.019, 0.017), -8.0),
)
_CURL_DEG = (10.0, 20.0, 14.0)


def _frame() -> tuple[Array, Array]:
    """Origin at the left wrist and (3, 3) rows: along the hand, to the thumb, out of the palm."""
    wrist, knuckles = REST[INDEX["hand_l"]], REST[INDEX["fingers_l"]]
    along = (knuckles - wrist) / np.linalg.norm(knuckles - wrist)
    thumb = np.array([1.0, 0.0, 0.0]) - along[0] * along
    thumb /= np.linalg.norm(thumb)
    palm = np.cross(along, thumb)
    return wrist, np.stack([along, thumb, palm if palm[1] < 0 else -palm])


def hand(v: Variant) -> Shape:
    """The left hand with the wrist that the cuff hides."""
    origin, axes = _frame()
    s = mix(v, 1.0, 0.90)

    def at(a: float, b: float, c: float) -> Point:
        x, y, z = origin + np.array([a, b * s, c]) @ axes
        return (float(x), float(y), float(z))

    fingers = []
    bones = []
    for a, b, lengths, spread in _KNUCKLES:
        size = s * (0.84 if b < -0.02 else 1.0)
        bones.append(round_cone(at(0.004, b * 0.55, 0), at(a, b, 0), 0.0145 * s, 0.0112 * size))
        points, angle, place = [(a, b, 0.0)], 0.0, np.array([a, b, 0.0])
        for length, curl in zip(lengths, _CURL_DEG, strict=True):
            angle += np.radians(curl)
            sideways = np.radians(spread)
            place = place + length * mix(v, 1.0, 0.97) * np.array(
                [np.cos(angle) * np.cos(sideways), np.cos(angle) * np.sin(sideways), np.sin(angle)]
            )
            points.append((float(place[0]), float(place[1]), float(place[2])))
        radii = [r * size for r in (0.0100, 0.0092, 0.0083, 0.0066)]
        fingers.append(chain([at(*p) for p in points], radii, 0.003))
    palm = union(0.014, *bones)
    heel = round_cone(at(0.018, 0.020, 0.006), at(0.052, 0.034, 0.010), 0.0165 * s, 0.0125 * s)
    thumb = chain(
        [at(0.046, 0.036, 0.009), at(0.076, 0.052, 0.016), at(0.100, 0.057, 0.022)],
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
