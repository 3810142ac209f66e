"""Tables and chairs."""

from __future__ import annotations

import numpy as np

from adamo_vh.runtime.assets.asset import Asset, Collider, Looks, Material, Surface
from adamo_vh.runtime.assets.kit import Mesh, cylinder, merge, rectangle, sweep
from adamo_vh.runtime.assets.living.books import book_stack, bound
from adamo_vh.runtime.assets.living.joinery import (
    BLACK_METAL,
    BRASS_METAL,
    Board,
    box_mapped,
    cloth,
    cushion,
    draped,
    furniture,
    oak,
    solids,
    timber,
    walnut,
)


def _legs(span: tuple[float, float], thick: float, height: float, foot: float = 0.0) -> list[Board]:
    """Four square legs whose outer faces span a rectangle."""
    x, y = span[0] / 2 - thick / 2, span[1] / 2 - thick / 2
    middle = foot + height / 2
    return [
        Board((thick, thick, height), (sx * x, sy * y, middle), "z", 0.004)
        for sx in (-1, 1)
        for sy in (-1, 1)
    ]


def dining_table() -> Asset:
    """Oak table, 1.05 x 1.66 m, its top at 0.78 m."""
    top = [
        Board((0.349, 1.66, 0.034), (x, 0.0, 0.763), "y", 0.003, collides=False)
        for x in (-0.3505, 0.0, 0.3505)
    ]
    slab = Board((1.05, 1.66, 0.034), (0.0, 0.0, 0.763))
    apron = [
        *(Board((0.022, 1.40, 0.080), (s * 0.435, 0.0, 0.706), "y") for s in (-1, 1)),
        *(Board((0.80, 0.022, 0.080), (0.0, s * 0.740, 0.706)) for s in (-1, 1)),
    ]
    legs = _legs((0.95, 1.56), 0.072, 0.746)
    return furniture(
        "DiningTable",
        (1.05, 1.66, 0.78),
        [timber((*top, *apron, *legs), oak())],
        solids((slab, *apron, *legs)),
        (Surface("", (0.0, 0.0, 0.78), (0.525, 0.83)),),
        looks=Looks("oak dining table", ("brown",), "table"),
    )


def coffee_table() -> Asset:
    """Walnut table, 1.30 x 0.65 m, its top at 0.46 m, with a board for books below."""
    top = Board((1.30, 0.65, 0.030), (0.0, 0.0, 0.445), "x", 0.005)
    lower = Board((1.12, 0.47, 0.018), (0.0, 0.0, 0.141))
    legs = _legs((1.20, 0.55), 0.045, 0.430)
    rails = [
        *(Board((0.020, 0.46, 0.045), (s * 0.572, 0.0, 0.4075), "y") for s in (-1, 1)),
        *(Board((1.11, 0.020, 0.045), (0.0, s * 0.248, 0.4075)) for s in (-1, 1)),
    ]
    stack = book_stack(((0.26, 0.19, 0.030), (0.23, 0.17, 0.024)), (-0.30, 0.02, 0.150), seed=3)
    return furniture(
        "CoffeeTable",
        (1.30, 0.65, 0.46),
        [timber((top, lower, *rails), walnut()), timber(legs, oak()), bound([stack])],
        (*solids((top, lower, *legs, *rails)), *stack.colliders),
        (
            Surface("top", (0.0, 0.0, 0.46), (0.65, 0.325)),
            Surface("lower", (0.0, 0.0, 0.150), (0.54, 0.22)),
        ),
        looks=Looks("walnut coffee table", ("brown",), "table"),
    )


def side_table() -> Asset:
    """Small square table on thin legs, 0.42 m wide and 0.52 m high."""
    top = Board((0.42, 0.42, 0.024), (0.0, 0.0, 0.508), "x", 0.005)
    legs = _legs((0.36, 0.36), 0.022, 0.496)
    braces = [
        *(Board((0.32, 0.014, 0.014), (0.0, s * 0.169, 0.16)) for s in (-1, 1)),
        *(Board((0.014, 0.32, 0.014), (s * 0.169, 0.0, 0.16), "y") for s in (-1, 1)),
    ]
    frame = merge(board.mesh() for board in (*legs, *braces)).part(BLACK_METAL)
    return furniture(
        "SideTable",
        (0.42, 0.42, 0.52),
        [timber([top], oak()), frame],
        solids((top, *legs, *braces)),
        (Surface("", (0.0, 0.0, 0.52), (0.21, 0.21)),),
        looks=Looks("small oak side table", ("brown", "black"), "table"),
    )


def console() -> Asset:
    """Narrow table for a wall, 1.10 x 0.34 m, its top at 0.78 m, with two drawers and a lamp."""
    top = Board((1.10, 0.34, 0.024), (0.0, 0.0, 0.768), "x", 0.004)
    case = Board((1.02, 0.29, 0.130), (0.0, 0.0, 0.691))
    fronts = [
        Board((0.49, 0.012, 0.108), (s * 0.252, -0.149, 0.690), collides=False) for s in (-1, 1)
    ]
    legs = _legs((1.02, 0.30), 0.034, 0.640)
    shelf = Board((0.97, 0.25, 0.018), (0.0, 0.0, 0.190))
    knobs = merge(_knob(s * 0.252, -0.160, 0.690) for s in (-1, 1))
    foot = cylinder(0.070, 0.016, bevel=0.004, segments=28).moved(0.40, 0.03, 0.788)
    stem = cylinder(0.009, 0.190, segments=12).moved(0.40, 0.03, 0.890)
    shade = cylinder(0.115, 0.170, top_radius=0.085, segments=32).moved(0.40, 0.03, 1.055)
    return furniture(
        "Console",
        (1.10, 0.34, 1.14),
        [
            timber((top, case, shelf, *legs), walnut()),
            timber(fronts, oak()),
            merge((knobs, foot, stem)).part(BRASS_METAL),
            shade.part(lamp_shade()),
        ],
        (
            *solids((top, case, shelf, *legs)),
            Collider("cylinder", (0.070, 0.050, 0.0), (0.40, 0.03, 0.83)),
            Collider("cylinder", (0.115, 0.140, 0.0), (0.40, 0.03, 1.00)),
        ),
        (Surface("", (0.0, 0.0, 0.78), (0.55, 0.17)),),
        looks=Looks("narrow walnut table with a lamp", ("brown",), "table"),
    )


def chair() -> Asset:
    """Oak chair with a dark pad, 0.46 x 0.50 m, its seat at 0.47 m; one sits facing -y."""
    front = [Board((0.034, 0.034, 0.430), (s * 0.205, -0.222, 0.215), "z") for s in (-1, 1)]
    seat = Board((0.46, 0.44, 0.022), (0.0, -0.030, 0.436), "y", 0.006)
    rails = [
        Board((0.385, 0.018, 0.045), (0.0, -0.222, 0.400), collides=False),
        Board((0.385, 0.018, 0.045), (0.0, 0.175, 0.400), collides=False),
        *(Board((0.018, 0.38, 0.045), (s * 0.205, -0.02, 0.400), "y") for s in (-1, 1)),
    ]
    posts = merge(_back_post(s * 0.208) for s in (-1, 1))
    slats = merge(_slat(z) for z in (0.830, 0.730, 0.630))
    pad = draped(cushion((0.43, 0.40, 0.030), 9.0, 3.0).moved(0.0, -0.030, 0.455))
    pad_cloth = cloth("charcoal", (74, 68, 62), 5)
    back = Collider("box", (0.225, 0.020, 0.150), (0.0, 0.222, 0.730))
    rear = tuple(Collider("box", (0.017, 0.022, 0.440), (s * 0.208, 0.208, 0.440)) for s in (-1, 1))
    wood = merge([*(b.mesh() for b in (*front, seat, *rails)), posts, slats])
    return furniture(
        "Chair",
        (0.46, 0.50, 0.88),
        [wood.part(oak()), pad.part(pad_cloth)],
        (
            *solids((*front, seat, *rails)),
            Collider("box", (0.200, 0.185, 0.0115), (0.0, -0.030, 0.4585)),
            back,
            *rear,
        ),
        (Surface("", (0.0, -0.030, 0.470), (0.195, 0.180)),),
        looks=Looks("oak chair", ("brown",), "chair"),
    )


def lamp_shade() -> Material:
    """Lit cloth of a lamp."""
    return Material("shade", (0.84, 0.62, 0.34, 1.0), specular=0.0, emission=0.25)


def _knob(x: float, y: float, z: float) -> Mesh:
    return cylinder(0.013, 0.020, bevel=0.004, segments=16).turned("x", 90).moved(x, y, z)


def _back_post(x: float) -> Mesh:
    """Rear leg that goes on as the post of the back, leaning away above the seat."""
    path = np.array(((x, 0.215, 0.0017), (x, 0.190, 0.25), (x, 0.190, 0.46), (x, 0.233, 0.880)))
    post = sweep(rectangle(0.034, 0.034, 0.006, 2), path, up=(0.0, -1.0, 0.0))
    return box_mapped(post, (0.9, 0.45), "z", x)


def _slat(z: float) -> Mesh:
    """Slat of the back, bent around who sits."""
    x = np.linspace(-0.205, 0.205, 9)
    lean = 0.190 + (z - 0.46) * 0.102
    path = np.column_stack((x, lean - 0.012 + 0.016 * np.cos(x / 0.205 * np.pi / 2), x * 0 + z))
    slat = sweep(rectangle(0.014, 0.062, 0.005, 2), path)
    return box_mapped(slat, (0.9, 0.45), "x", z)
