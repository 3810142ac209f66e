"""What makes a room a home: rug, lamps, curtains, pictures, a vase, a basket.

All of it is static. Things on walls carry their height in their shape, since scenes place furniture
on the floor; they and the rug collide with nothing.
"""

from __future__ import annotations

import numpy as np

from adamo_vh.runtime.assets import paint
from adamo_vh.runtime.assets.asset import Asset, Collider, Looks, Material
from adamo_vh.runtime.assets.kit import (
    Mesh,
    box,
    cylinder,
    extrude,
    loft,
    merge,
    rectangle,
    revolve,
    spline,
    sweep,
)
from adamo_vh.runtime.assets.living.joinery import (
    BLACK_METAL,
    BRASS_METAL,
    cloth,
    draped,
    furniture,
)
from adamo_vh.runtime.assets.living.paintings import bordered_rug, hills, leaves, shapes
from adamo_vh.runtime.assets.living.tables import lamp_shade

RUG_M = 0.001
"""Thickness of the rug: less than the thinnest object, which must not sink into it."""
_PLAIN = (1.0, 1.0, 1.0, 1.0)


def rug() -> Asset:
    """Woven rug, 2.60 x 1.90 m; it counts as floor."""
    sheet = box(2.60, 1.90, RUG_M).moved(z=RUG_M / 2).projected("z")
    wool = Material("wool", texture=bordered_rug(), rgba=_PLAIN, specular=0.0, shininess=0.0)
    return furniture(
        "Rug",
        (2.60, 1.90, RUG_M),
        [sheet.part(wool)],
        (),
        looks=Looks("woven rug", ("brown",), "flat"),
    )


def floor_lamp() -> Asset:
    """Lamp on a tall stem, 1.62 m high."""
    foot = cylinder(0.150, 0.024, bevel=0.006, segments=36).moved(z=0.012)
    stem = cylinder(0.011, 1.42, segments=14).moved(z=0.73)
    shade = cylinder(0.215, 0.30, top_radius=0.175, segments=40).moved(z=1.47)
    return furniture(
        "FloorLamp",
        (0.43, 0.43, 1.62),
        [merge((foot, stem)).part(BLACK_METAL), shade.part(lamp_shade())],
        (
            Collider("cylinder", (0.150, 0.012, 0.0), (0.0, 0.0, 0.012)),
            Collider("cylinder", (0.011, 0.71, 0.0), (0.0, 0.0, 0.73)),
            Collider("cylinder", (0.205, 0.15, 0.0), (0.0, 0.0, 1.47)),
        ),
        looks=Looks("floor lamp", ("black",), "lamp"),
    )


def pendant_lamp() -> Asset:
    """Lamp that hangs from a ceiling at 3.20 m, its lower rim at 2.05 m."""
    bell = spline(((0.235, 0.0), (0.222, 0.07), (0.165, 0.15), (0.085, 0.21), (0.030, 0.235)), 12)
    outside = revolve(np.vstack((bell, ((0.0, 0.235),))), 40)
    inside = revolve(np.vstack((bell * (0.985, 1.0), ((0.0, 0.228),)))[::-1], 40)
    cord = cylinder(0.004, 0.92, segments=8).moved(z=2.74)
    rose = cylinder(0.055, 0.025, bevel=0.006, segments=24).moved(z=3.1875)
    bulb = revolve(((0, -0.05), (0.03, -0.04), (0.045, 0.0), (0.03, 0.04), (0.0, 0.06)), 20)
    glow = Material("glow", (0.95, 0.78, 0.50, 1.0), specular=0.0, emission=0.8)
    return furniture(
        "PendantLamp",
        (0.47, 0.47, 1.15),
        [
            merge((outside.moved(z=2.05), cord, rose)).part(BLACK_METAL),
            inside.moved(z=2.05).part(BRASS_METAL),
            bulb.moved(z=2.15).part(glow),
        ],
        (),
        looks=Looks("hanging lamp", ("black",), "lamp"),
        bottom=2.05,
    )


def curtains() -> Asset:
    """Two ochre curtains beside a window 2 m wide, 0.70 to 2.62 m high; the wall is at +y."""
    meshes = [_folds(0.54).moved(x=s * 1.33) for s in (-1, 1)]
    rod = cylinder(0.013, 3.36, segments=14).turned("y", 90).moved(z=2.60)
    knobs = [cylinder(0.024, 0.05, bevel=0.01).turned("y", 90) for _ in range(2)]
    ends = [m.moved(x=s * 1.70, z=2.60) for m, s in zip(knobs, (-1, 1), strict=True)]
    linen = cloth("linen", (172, 128, 76), 61)
    return furniture(
        "Curtains",
        (3.45, 0.060, 1.924),
        [draped(merge(meshes)).part(linen), merge((rod, *ends)).part(BLACK_METAL)],
        (),
        looks=Looks("ochre curtains", ("brown",), "curtain"),
        bottom=0.70,
    )


def picture_hills() -> Asset:
    """Framed landscape, 1.10 x 0.74 m, its middle at 1.60 m; the wall is at +y."""
    return _picture("landscape with hills", hills(), (1.10, 0.74), 1.60)


def picture_leaves() -> Asset:
    """Framed study of leaves, 0.56 x 0.76 m, its middle at 1.60 m; the wall is at +y."""
    return _picture("study of leaves", leaves(), (0.56, 0.76), 1.60)


def picture_shapes() -> Asset:
    """Framed abstract, 0.76 x 0.76 m, its middle at 1.60 m; the wall is at +y."""
    return _picture("abstract painting", shapes(), (0.76, 0.76), 1.60)


def floor_vase() -> Asset:
    """Tall dark clay vase with dry grass, 1.15 m high."""
    outline = spline(
        ((0.075, 0.0), (0.125, 0.10), (0.140, 0.21), (0.105, 0.34), (0.058, 0.43), (0.068, 0.47)),
        18,
    )
    inner = ((0.052, 0.462), (0.045, 0.40), (0.0, 0.40))
    body = revolve(np.vstack(((0.0, 0.0), outline, inner)), 36)
    clay = Material("clay", texture=_glaze(), rgba=_PLAIN, specular=0.12, shininess=0.2)
    rng = np.random.default_rng(17)
    half = merge(_grass(rng) for _ in range(6))
    stems = merge((half, half.turned("z", 180)))
    straw = Material("straw", (0.66, 0.50, 0.28, 1.0), specular=0.0, shininess=0.0)
    return furniture(
        "Vase",
        (0.28, 0.381, 1.078),
        [body.part(clay), stems.part(straw)],
        (
            Collider("cylinder", (0.138, 0.170, 0.0), (0.0, 0.0, 0.170)),
            Collider("cylinder", (0.070, 0.235, 0.0), (0.0, 0.0, 0.235)),
        ),
        looks=Looks("tall vase with dry grass", ("brown",), "vase"),
    )


def basket() -> Asset:
    """Woven basket with a folded blanket in it, 0.44 m wide and 0.36 m high."""
    profile = ((0.165, 0.0), (0.190, 0.04), (0.215, 0.18), (0.212, 0.29), (0.205, 0.30))
    wall = np.array((*profile, (0.196, 0.29), (0.197, 0.18), (0.170, 0.045), (0.0, 0.04)))
    bowl = revolve(np.vstack(((0.0, 0.0), wall)), 40)
    rolls = [
        loft(_roll(0.085, x, 0.270 - abs(x) * 0.1, turn))
        for x, turn in ((-0.085, 8.0), (0.085, -6.0))
    ]
    wicker = Material("wicker", texture=_wicker(), rgba=_PLAIN, specular=0.05, shininess=0.1)
    uvs = bowl.uvs * (10.0, 5.0)
    return furniture(
        "Basket",
        (0.43, 0.43, 0.346),
        [
            bowl.textured(uvs).part(wicker),
            draped(merge(rolls)).part(cloth("russet", (136, 84, 60), 71)),
        ],
        (Collider("cylinder", (0.205, 0.150, 0.0), (0.0, 0.0, 0.150)),),
        looks=Looks("basket with a blanket", ("brown",), "basket"),
    )


def _folds(width: float) -> Mesh:
    """One hanging curtain, drawn aside in soft folds, 0.70 to 2.57 m above the floor."""
    x = np.linspace(-width / 2, width / 2, 73)
    rings = []
    for z, tight in ((0.70, 1.0), (1.2, 0.97), (1.9, 0.94), (2.57, 0.9)):
        wave = 0.024 * np.sin(x / width * 2 * np.pi * 7 + 0.3 * z) * (1.15 - 0.12 * z)
        front = np.column_stack((x * tight, wave - 0.004))
        outline = np.concatenate((front, (front + np.array((0.0, 0.008)))[::-1]))
        rings.append(np.column_stack((outline, np.full(len(outline), z))))
    return loft(rings, crease_deg=75.0)


def _picture(words: str, paint_work: paint.Picture, size: tuple[float, float], z: float) -> Asset:
    """A painting in a thin dark frame."""
    width, height = size
    opening = rectangle(width - 0.05, height - 0.05)
    frame = extrude(rectangle(width, height), 0.030, holes=[opening], bevel=0.003)
    canvas = box(width - 0.048, 0.012, height - 0.048).projected("-y")
    oil = Material("oil", texture=paint_work, rgba=_PLAIN, specular=0.05, shininess=0.1)
    dark = Material("frame", (0.20, 0.14, 0.10, 1.0), specular=0.2, shininess=0.3)
    return furniture(
        "Picture",
        (width, 0.030, height),
        [frame.turned("x", 90).part(dark), canvas.part(oil)],
        (),
        looks=Looks(words, ("brown",), "picture"),
        bottom=z - height / 2,
    )


def _grass(rng: np.random.Generator) -> Mesh:
    """One stem that leans outwards, with a plume at its end."""
    lean, turn = rng.uniform(0.05, 0.22), rng.uniform(0.0, 2 * np.pi)
    tall = rng.uniform(0.82, 1.13)
    way = np.array((np.cos(turn), np.sin(turn), 0.0))
    rise = np.array((0.0, 0.0, 1.0))
    knots = [
        0.02 * way + 0.41 * rise,
        (0.03 + 0.35 * lean) * way + (0.41 + 0.55 * (tall - 0.41)) * rise,
        (0.03 + lean) * way + tall * rise,
    ]
    path = spline(knots, 12)
    thick = np.array([0.0016] * 6 + [0.004, 0.010, 0.014, 0.012, 0.007, 0.001])
    section = np.column_stack((np.cos(_SIX), np.sin(_SIX)))
    return sweep(section, path, scale=thick, up=(0.3, 0.2, 1.0))


_SIX = np.arange(6) * np.pi / 3


def _roll(radius: float, x: float, z: float, turn_deg: float) -> list[paint.Field]:
    """Rings of a rolled blanket that lies along y."""
    rings = []
    for y, size in ((-0.125, 0.7), (-0.115, 1.0), (0.115, 1.0), (0.125, 0.7)):
        angle = np.linspace(0.0, 2 * np.pi, 20, endpoint=False)
        across, along = x + radius * size * np.sin(angle), np.full(20, y)
        swing = np.deg2rad(turn_deg)
        turned_x = across * np.cos(swing) - along * np.sin(swing)
        turned_y = across * np.sin(swing) + along * np.cos(swing)
        up = z + radius * size * np.cos(angle)
        rings.append(np.column_stack((turned_x, turned_y, up)))
    return rings


def _glaze() -> paint.Picture:
    """Dark clay, a little lighter towards the rim."""
    stops: tuple[tuple[float, paint.Colour], ...] = (
        (0.0, (58, 46, 40)),
        (0.35, (74, 57, 47)),
        (0.62, (92, 68, 52)),
        (1.0, (48, 38, 34)),
    )
    return paint.ramp(stops, 128)


def _wicker() -> paint.Picture:
    """Basket weave: over and under in alternate rows."""
    rows, columns = np.mgrid[0:64, 0:64]
    swap = (rows // 16) % 2
    wave = np.sin((columns / 64 + 0.5 * swap) * 2 * np.pi) + 0.6 * np.sin(rows / 16 * np.pi) ** 2
    return paint.shade((150, 110, 66), wave + 0.3 * paint.noise(64, 64, (2, 8), 9), 0.16)
