"""A drinking glass, a mug, a plate and a potted plant."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from adamo_vh.runtime.assets import paint
from adamo_vh.runtime.assets.asset import Asset, Collider, Looks, Material, Part
from adamo_vh.runtime.assets.finishes import Rgb
from adamo_vh.runtime.assets.kit import (
    Mesh,
    circle,
    fillet,
    fit,
    loft,
    merge,
    revolve,
    spline,
    sweep,
)

_ORANGE: Rgb = (0.90, 0.38, 0.04)
_ORANGE_INSIDE: Rgb = (0.56, 0.20, 0.02)
_RED: paint.Colour = (176, 20, 22)
_RED_DARK: paint.Colour = (128, 12, 16)
_WHITE: paint.Colour = (214, 213, 207)
"""Lit, it must not be lighter than the light itself."""
_GREENS: tuple[tuple[paint.Colour, paint.Colour], ...] = (
    ((38, 92, 34), (92, 142, 62)),
    ((58, 124, 42), (122, 172, 76)),
    ((96, 150, 52), (158, 196, 98)),
)
"""Blade and ribs of the leaves, from the old to the young."""
_STEM_ROWS, _BLADE_ROWS = 3, 7
_LEAVES = 38
_THICK_ALPHA = 0.4
"""Denser glass casts a shadow."""
_RIM = Material("rim", (0.62, 0.64, 0.63, 1.0), specular=0.05, casts_shadow=False)
"""Bright, so that one sees where the glass ends; alone its shadow would be a dotted ring."""


def glass() -> Asset:
    """Clear tumbler: a thin wall on a thick base, its rim bright."""
    size = (0.100, 0.100, 0.143)
    wall = np.array(
        (
            (0.0405, -0.0545),
            (0.0488, 0.0696),
            (0.0465, 0.0696),
            (0.0383, -0.0545),
        )
    )
    base = fillet(
        np.array(
            (
                (0.0, -0.0690),
                (0.0300, -0.0690),
                (0.0330, -0.0715),
                (0.0395, -0.0715),
                (0.0405, -0.0545),
                (0.0383, -0.0545),
                (0.0330, -0.0570),
                (0.0, -0.0590),
            )
        ),
        [0, 0, 0, 0.002, 0, 0, 0.004, 0],
        3,
    )
    rim = np.array(((0.0487, 0.0694), (0.0500, 0.0705), (0.0490, 0.0715), (0.0474, 0.0715)))
    rim = np.vstack((rim, ((0.0466, 0.0705), (0.0466, 0.0694))))
    parts = (
        _clear(revolve(base, 48), "base", 0.52, paint.flat((172, 179, 176))),
        _clear(revolve(wall, 48), "wall", 0.28, _streaks()),
        revolve(rim, 48).part(_RIM),
    )
    return Asset(
        class_name="Glass",
        size=size,
        parts=fit(parts, size),
        colliders=(Collider("cylinder", (0.050, 0.0715, 0.0)),),
        mass_kg=0.25,
        looks=Looks("transparent drinking glass", ("transparent",), "cylinder"),
    )


def cup() -> Asset:
    """Plain orange mug, its handle at +x."""
    size = (0.149, 0.105, 0.131)
    middle, radius, half = -0.022, 0.0525, 0.0655
    outside = fillet(
        np.array(
            (
                (0.0, 0.002 - half),
                (0.036, 0.002 - half),
                (0.038, -half),
                (0.046, -half),
                (radius, 0.010 - half),
                (radius, half),
                (0.0475, half),
                (0.0475, half - 0.004),
            )
        ),
        [0, 0, 0, 0.001, 0.009, 0.002, 0.002, 0],
        4,
    )
    inside = fillet(
        np.array(((0.0475, half - 0.004), (0.0475, 0.008 - half), (0.0, 0.006 - half))),
        [0, 0.012, 0],
        5,
    )
    path = spline(
        (
            (0.0505, 0.0, 0.036),
            (0.0690, 0.0, 0.0385),
            (0.0870, 0.0, 0.0280),
            (0.0915, 0.0, 0.0020),
            (0.0840, 0.0, -0.0230),
            (0.0680, 0.0, -0.0360),
            (0.0505, 0.0, -0.0400),
        ),
        26,
    )
    handle = sweep(circle(0.0080, 0.0050, 16), path, caps=False)
    parts = (
        _glazed(merge((revolve(outside, 56), handle)), "orange", (*_ORANGE, 1.0)),
        _glazed(revolve(inside, 56), "inside", (*_ORANGE_INSIDE, 1.0)),
    )
    grip = (size[0] / 2 - middle - radius) / 2
    return Asset(
        class_name="Cup",
        size=size,
        parts=fit(tuple(parts), size),
        colliders=(
            Collider("cylinder", (radius, half, 0.0), (middle, 0.0, 0.0)),
            Collider("box", (grip, 0.0080, 0.0430), (size[0] / 2 - grip, 0.0, 0.0)),
        ),
        mass_kg=0.36,
        looks=Looks("orange mug with a handle", ("orange",), "cylinder"),
    )


def plate() -> Asset:
    """Red dinner plate with a broad white rim."""
    size = (0.250, 0.250, 0.030)
    corners = np.array(
        (
            (0.0, -0.0125),
            (0.0700, -0.0125),
            (0.0720, -0.0150),
            (0.0760, -0.0150),
            (0.0790, -0.0120),
            (0.0960, 0.0040),
            (0.1225, 0.0118),
            (0.1250, 0.0136),
            (0.1238, 0.0150),
            (0.1215, 0.0148),
            (0.0950, 0.0078),
            (0.0780, -0.0085),
            (0.0, -0.0090),
        )
    )
    radii = [0, 0, 0, 0, 0, 0.012, 0.002, 0, 0.001, 0.002, 0.012, 0.012, 0]
    profile = fillet(corners, radii, 3)
    top = int(profile[:, 1].argmax())
    steps = np.linalg.norm(np.diff(profile, axis=0), axis=1)
    along = np.concatenate(((0.0,), np.cumsum(steps))) / steps.sum()

    def place(radius: float) -> float:
        """Where the upper side has this radius, along the profile."""
        return float(np.interp(-radius, -profile[top:, 0], along[top:]))

    edge = float(along[top]) - 0.018
    inner, groove = place(0.1005), place(0.0800)
    picture = paint.ramp(
        (
            (0.0, _RED),
            (edge, _RED),
            (edge + 0.001, _WHITE),
            (inner - 0.001, _WHITE),
            (inner + 0.001, _RED),
            (groove - 0.022, _RED_DARK),
            (groove + 0.012, _RED_DARK),
            (groove + 0.030, _RED),
            (1.0, _RED),
        ),
        1024,
    )
    parts = (_glazed(revolve(profile, 72), "glaze", (1.0, 1.0, 1.0, 1.0), picture),)
    return Asset(
        class_name="Plate",
        size=size,
        parts=fit(parts, size),
        colliders=(
            Collider("cylinder", (0.080, 0.0075, 0.0), (0.0, 0.0, -0.0075)),
            Collider("cylinder", (0.125, 0.0050, 0.0), (0.0, 0.0, 0.0050)),
        ),
        mass_kg=0.55,
        looks=Looks("red plate with a white rim", ("red", "white"), "flat round", white_parts=True),
    )


def indoor_plant() -> Asset:
    """Leafy plant in a terracotta pot."""
    size = (0.250, 0.250, 0.340)
    bottom, brim = -0.170, -0.042
    pot = fillet(
        np.array(
            (
                (0.0, bottom),
                (0.056, bottom),
                (0.0735, brim - 0.034),
                (0.0800, brim - 0.034),
                (0.0830, brim),
                (0.0750, brim),
                (0.0725, brim - 0.020),
            )
        ),
        [0, 0.004, 0.001, 0.002, 0.003, 0.002, 0],
        3,
    )
    earth = np.array(((0.074, brim - 0.014), (0.050, brim - 0.011), (0.0, brim - 0.006)))
    leaves = _foliage(brim - 0.010, size)
    parts = (
        revolve(pot, 44).part(
            Material(
                "terracotta", texture=paint.terracotta(256, 5), rgba=(1, 1, 1, 1), specular=0.03
            )
        ),
        revolve(earth, 32)
        .projected("z")
        .part(Material("soil", texture=paint.soil(256, 7), rgba=(1, 1, 1, 1), specular=0.0)),
        *(
            mesh.part(
                Material(
                    f"leaf_{i}",
                    (1.0, 1.0, 1.0, 1.0),
                    texture=paint.leaf(*_GREENS[i], seed=11 + i),
                    specular=0.08,
                    shininess=0.2,
                )
            )
            for i, mesh in enumerate(leaves)
        ),
    )
    return Asset(
        class_name="IndoorPlant",
        size=size,
        parts=fit(parts, size),
        colliders=(
            Collider("cylinder", (0.080, 0.064, 0.0), (0.0, 0.0, -0.106)),
            Collider("cylinder", (0.110, 0.095, 0.0), (0.0, 0.0, 0.065)),
        ),
        mass_kg=1.6,
        looks=Looks("leafy potted plant in a terracotta pot", ("green", "brown"), "irregular"),
    )


def _clear(mesh: Mesh, name: str, alpha: float, picture: paint.Picture) -> Part:
    """Paint as glass; the highlight is as thin as the glass, so it never gets white."""
    return mesh.part(
        Material(
            name,
            (1.0, 1.0, 1.0, alpha),
            texture=picture,
            specular=0.35,
            shininess=0.7,
            casts_shadow=alpha > _THICK_ALPHA,
        )
    )


def _streaks() -> paint.Picture:
    """(8, 256, 3) upright lighter and darker bands: what a round wall mirrors and bends."""
    angle = (np.arange(256) + 0.5) / 256 * 2 * np.pi
    wave = 0.5 * np.cos(5 * angle) + 0.3 * np.cos(11 * angle + 1.0) + 0.2 * np.cos(17 * angle)
    level = np.clip(0.74 + 0.26 * wave, 0.35, 0.97)
    tint = np.array((0.97, 1.0, 0.99))
    row = np.rint(255 * level[:, None] * tint).astype(np.uint8)
    return np.repeat(row[None], 8, axis=0)


def _glazed(
    mesh: Mesh,
    name: str,
    rgba: tuple[float, float, float, float],
    picture: paint.Picture | None = None,
) -> Part:
    """Paint as glazed ceramic."""
    return mesh.part(Material(name, rgba, texture=picture, specular=0.12, shininess=0.4))


def _foliage(root: float, size: tuple[float, float, float]) -> list[Mesh]:
    """Leaves from upright in the middle to arching outside, one mesh for each green.

    Args:
        root: Height at which the stems leave the soil.
        size: Box of the plant; the leaves span its width and reach its top.
    """
    rng = np.random.default_rng(3)
    leaves = []
    for i in range(_LEAVES):
        outer = (i + 0.5) / _LEAVES
        leaf = _leaf(
            stem=0.128 - 0.050 * outer + rng.uniform(-0.012, 0.012),
            blade=0.094 + 0.014 * rng.uniform(-1.0, 1.0),
            width=0.062 + 0.007 * rng.uniform(-1.0, 1.0),
            rise_deg=(86.0 - 34.0 * outer, 50.0 - 105.0 * outer + rng.uniform(-12.0, 12.0)),
        )
        start = 0.006 + 0.028 * outer
        # The golden angle never lets two leaves hide each other.
        leaves.append(leaf.moved(x=start, z=root).turned("z", 137.5 * i + rng.uniform(-9.0, 9.0)))
    crown = merge(leaves)
    span = crown.upper - crown.lower
    middle = (crown.upper + crown.lower) / 2
    factors = (size[0] / span[0], size[1] / span[1], (size[2] / 2 - root) / (crown.upper[2] - root))
    shift = -middle * factors
    shades = len(_GREENS)
    young_first = np.arange(_LEAVES) * shades // _LEAVES
    young_first = np.where(rng.random(_LEAVES) < 0.4, rng.integers(0, shades, _LEAVES), young_first)
    return [
        merge(leaf for leaf, shade in zip(leaves, young_first, strict=True) if shade == green)
        .moved(z=-root)
        .scaled(*factors)
        .moved(float(shift[0]), float(shift[1]), root)
        for green in reversed(range(shades))
    ]


def _leaf(stem: float, blade: float, width: float, rise_deg: tuple[float, float]) -> Mesh:
    """One leaf on its stem, growing from the origin towards +x.

    Args:
        stem: Length, metres.
        blade: Length, metres.
        width: Of the blade, metres.
        rise_deg: How steeply it climbs where it starts and where it ends.
    """
    grown = np.concatenate(
        (np.linspace(0.0, stem, _STEM_ROWS, endpoint=False), stem + blade * _blade_places())
    )
    rise = np.deg2rad(np.interp((grown / grown[-1]) ** 1.6, (0.0, 1.0), rise_deg))
    ahead = np.column_stack((np.cos(rise), np.zeros_like(rise), np.sin(rise)))
    above = np.column_stack((-np.sin(rise), np.zeros_like(rise), np.cos(rise)))
    steps = np.diff(grown, prepend=0.0)[:, None] * ahead
    spine = np.cumsum(steps, axis=0)
    t = np.concatenate((np.zeros(_STEM_ROWS), _blade_places()))
    broad = np.sin(np.pi * t**0.72) ** 0.85
    half = np.maximum(width / 2 * broad, 0.0012 * (t < 0.5))[:, None]
    thick = np.where(t > 0, 0.0004, 0.0012)[:, None] * (t < 1)[:, None]
    fold = 0.35 * half * (t > 0)[:, None]
    side = np.array((0.0, 1.0, 0.0))
    rings = np.stack(
        (
            spine + half * side + fold * above,
            spine + thick * above,
            spine - half * side + fold * above,
            spine - thick * above,
        ),
        axis=1,
    )
    mesh = loft(rings, caps=False, crease_deg=50.0)
    around, row = mesh.uvs[:, 0], mesh.uvs[:, 1] * (len(grown) - 1)
    return mesh.textured(
        np.column_stack((np.interp(row, np.arange(len(t)), t), 1.0 - np.abs(1.0 - 2.0 * around)))
    )


def _blade_places() -> NDArray[np.float64]:
    """Rows of a blade from its foot (0) to its tip (1)."""
    return np.linspace(0.0, 1.0, _BLADE_ROWS + 1)
