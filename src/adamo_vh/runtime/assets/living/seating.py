"""The sofa."""

from __future__ import annotations

import numpy as np

from adamo_vh.runtime.assets.asset import Asset, Collider, Looks, Surface
from adamo_vh.runtime.assets.kit import Mesh, cylinder, fillet, loft, merge, rounded_box
from adamo_vh.runtime.assets.living.joinery import (
    cloth,
    cushion,
    draped,
    furniture,
    upright_box,
    walnut,
)

_WIDTH, _DEPTH = 2.65, 0.92
_ARM = 0.17
_ARM_X = (_WIDTH - _ARM) / 2 - 0.010
"""Middle of an arm; the base stands out a little."""
_SEATS = 3
_SEAT_TOP = 0.440


def sofa() -> Asset:
    """Sage green sofa for three, 2.65 x 0.92 m; one sits facing -y."""
    inner = 2 * _ARM_X - _ARM
    wide = inner / _SEATS
    places = [(k - (_SEATS - 1) / 2) * wide for k in range(_SEATS)]
    frame = rounded_box(_WIDTH, _DEPTH - 0.06, 0.17, 0.025, 2).moved(z=0.205)
    spine = rounded_box(_WIDTH - 0.06, 0.15, 0.58, 0.05, 2).moved(0.0, _DEPTH / 2 - 0.075, 0.41)
    arms = [
        rounded_box(_ARM, _DEPTH - 0.03, 0.48, 0.055, 3).moved(s * _ARM_X, -0.015, 0.36)
        for s in (-1, 1)
    ]
    seats = [
        cushion((wide - 0.006, 0.66, 0.165), 12.0, 5.0).moved(x, -0.125, _SEAT_TOP - 0.0825)
        for x in places
    ]
    backs = [
        cushion((wide - 0.01, 0.20, 0.42), 7.0, 4.5).turned("x", -13).moved(x, 0.235, 0.610)
        for x in places
    ]
    cover = draped(merge((frame, spine, *arms, *seats, *backs)))
    legs = merge(
        cylinder(0.016, 0.125, top_radius=0.024, segments=10).moved(sx * 1.22, sy * 0.38, 0.0625)
        for sx in (-1, 1)
        for sy in (-1, 1)
    )
    left, right = _throw_pillow(-0.90, 24.0), _throw_pillow(0.93, -20.0)
    blanket = _blanket()
    solid = (frame, spine, *arms)
    back = Collider("box", (inner / 2, 0.105, 0.20), (0.0, 0.240, 0.610))
    seat = Collider("box", (inner / 2, 0.33, 0.0825), (0.0, -0.125, _SEAT_TOP - 0.0825))
    feet = tuple(
        Collider("cylinder", (0.022, 0.0625, 0.0), (sx * 1.22, sy * 0.38, 0.0625))
        for sx in (-1, 1)
        for sy in (-1, 1)
    )
    return furniture(
        "Sofa",
        (2.65, 0.92, 0.823),
        [
            cover.part(cloth("sage", (126, 128, 100), 41)),
            legs.part(walnut()),
            draped(left).part(cloth("mustard", (178, 128, 52), 42)),
            draped(right).part(cloth("rust", (142, 78, 52), 43)),
            draped(blanket).part(cloth("blanket", (158, 118, 84), 44)),
        ],
        (*map(upright_box, solid), seat, back, *feet, upright_box(left), upright_box(right)),
        (Surface("", (0.0, -0.175, _SEAT_TOP), (inner / 2 - 0.02, 0.270)),),
        looks=Looks("sage green sofa with cushions", ("green",), "sofa"),
    )


def _throw_pillow(x: float, yaw_deg: float) -> Mesh:
    """A loose square cushion that leans on the back of the sofa."""
    flat = cushion((0.42, 0.42, 0.15), 5.0, 1.6)
    return flat.turned("x", 72).turned("z", yaw_deg).moved(x, 0.075, _SEAT_TOP + 0.175)


def _blanket() -> Mesh:
    """A woven blanket that hangs over the left arm."""
    half, top = _ARM / 2 + 0.006, 0.607
    line = np.array(((half, 0.47), (half, top), (-half + 0.003, top), (-half + 0.003, 0.30)))
    line = fillet(line, [0.0, 0.05, 0.05, 0.0], 5)
    inward = np.column_stack((np.gradient(line[:, 1]), -np.gradient(line[:, 0])))
    inward /= np.linalg.norm(inward, axis=1, keepdims=True)
    outline = np.concatenate((line, (line + 0.007 * inward)[::-1]))
    rings = []
    for y in np.linspace(-0.28, 0.10, 5):
        wave = 0.004 * np.sin(y * 40)
        ring = np.column_stack((outline[:, 0], np.full(len(outline), y), outline[:, 1] + wave))
        rings.append(ring + np.array((-_ARM_X, 0.0, 0.0)))
    return loft(rings[::-1])
