"""Fruit and vegetables: a banana, an apple and a pumpkin."""

from __future__ import annotations

import numpy as np

from adamo_vh.runtime.assets import paint
from adamo_vh.runtime.assets.asset import Asset, Collider, Looks, Material
from adamo_vh.runtime.assets.finishes import Rgb, plastic, rubber
from adamo_vh.runtime.assets.kit import (
    Mesh,
    arc,
    circle,
    fit,
    loft,
    revolve,
    spline,
    sweep,
)

_BANANA: Rgb = (0.93, 0.75, 0.10)
_BANANA_END: Rgb = (0.24, 0.17, 0.07)
_STALK: Rgb = (0.30, 0.20, 0.09)
_LEAF: Rgb = (0.22, 0.47, 0.12)
_PUMPKIN: Rgb = (0.88, 0.42, 0.05)
_PUMPKIN_STALK: Rgb = (0.36, 0.42, 0.14)
_APPLE_RED, _APPLE_GOLD = (176, 24, 22), (206, 158, 52)


def banana() -> Asset:
    """Ripe banana, lying on its side, its hollow side towards -y."""
    size = (0.185, 0.078, 0.036)
    bend, degrees = 0.105, np.linspace(22.0, 158.0, 29)
    path = np.column_stack(
        (bend * np.cos(np.deg2rad(degrees)), bend * np.sin(np.deg2rad(degrees)), degrees * 0)
    )
    along = np.linspace(0.0, 1.0, len(path))
    girth = np.interp(
        along, (0.0, 0.05, 0.22, 0.5, 0.78, 0.88, 1.0), (0.30, 0.58, 0.95, 1.0, 0.86, 0.42, 0.32)
    )
    # Five flat sides with rounded edges, as a banana has.
    corner = np.linspace(0.0, 2 * np.pi, 40, endpoint=False)
    reach = 0.0180 * (1.0 + 0.055 * np.cos(5 * corner))
    section = np.column_stack((reach * np.cos(corner), reach * np.sin(corner)))
    flesh, foot, stalk = (
        sweep(section, path[part], scale=girth[part])
        for part in (slice(1, 26), slice(0, 2), slice(25, 29))
    )
    parts = (
        rubber(flesh, "yellow", _BANANA),
        rubber(foot, "foot", _BANANA_END),
        rubber(stalk, "stalk", (0.45, 0.38, 0.09)),
    )
    third = ((-0.056, -0.008, 38.0), (0.0, 0.021, 0.0), (0.056, -0.008, -38.0))
    return Asset(
        class_name="Banana",
        size=size,
        parts=fit(parts, size),
        colliders=tuple(
            Collider(
                "box",
                (0.027, 0.0155, 0.0180),
                (x, y, 0.0),
                (float(np.cos(np.deg2rad(a) / 2)), 0.0, 0.0, float(np.sin(np.deg2rad(a) / 2))),
            )
            for x, y, a in third
        ),
        mass_kg=0.13,
        looks=Looks("yellow banana", ("yellow",), "irregular"),
    )


def apple() -> Asset:
    """Red apple with a stalk and a leaf."""
    size = (0.078, 0.078, 0.088)
    line = np.array(
        (
            (0.0, 0.005),
            (0.009, 0.002),
            (0.020, 0.0),
            (0.0320, 0.009),
            (0.0380, 0.028),
            (0.0390, 0.046),
            (0.0345, 0.062),
            (0.0230, 0.0705),
            (0.0110, 0.0680),
            (0.0, 0.0610),
        )
    )
    smooth = spline(np.column_stack((line, np.zeros(len(line)))), 40)[:, :2]
    smooth[(0, -1), 0] = 0.0
    skin = paint.ramp(
        ((0.0, _APPLE_GOLD), (0.16, _APPLE_RED), (0.86, _APPLE_RED), (0.97, _APPLE_GOLD)), 256
    )
    stalk = sweep(circle(0.0016, count=10), ((0, 0, 0.060), (0.001, 0, 0.074), (0.005, 0, 0.088)))
    leaf = _leaf(0.034, 0.016).turned("y", -18).moved(x=0.002, z=0.0735)
    parts = (
        revolve(smooth, 40, crease_deg=80.0).part(
            Material("skin", (1, 1, 1, 1), texture=skin, specular=0.14, shininess=0.3)
        ),
        rubber(stalk, "stalk", _STALK),
        rubber(leaf, "leaf", _LEAF),
    )
    return Asset(
        class_name="Apple",
        size=size,
        parts=fit(parts, size),
        colliders=(
            Collider("cylinder", (0.0200, 0.0200, 0.0), (0.0, 0.0, -0.0240)),
            Collider("cylinder", (0.0370, 0.0200, 0.0), (0.0, 0.0, 0.0000)),
        ),
        mass_kg=0.18,
        looks=Looks("red apple with a green leaf", ("red", "green"), "round"),
    )


def pumpkin() -> Asset:
    """Small orange pumpkin with ribs and a green stalk."""
    size = (0.170, 0.170, 0.150)
    height = np.linspace(-1.0, 1.0, 25)
    profile = np.sqrt(np.maximum(1.0 - np.abs(height) ** 2.3, 0.0))
    angle = np.linspace(0.0, 2 * np.pi, 90, endpoint=False)
    furrow = np.abs(np.cos(4.5 * angle)) ** 0.55
    rings = []
    for level, width in zip(height, profile, strict=True):
        reach = 0.085 * np.maximum(width, 0.10) * (0.86 + 0.14 * furrow)
        dip = 0.012 * np.exp(-((width / 0.35) ** 2)) * np.sign(level)
        rings.append(
            np.column_stack(
                (
                    reach * np.cos(angle),
                    reach * np.sin(angle),
                    np.full_like(angle, 0.058 * level - dip),
                )
            )
        )
    stalk = sweep(
        circle(0.012, count=7),
        ((0, 0, 0.040), (0, 0, 0.062), (0.004, 0, 0.078), (0.014, 0, 0.092)),
        scale=(1.5, 0.95, 0.75, 0.85),
    )
    parts = (
        plastic(loft(rings, crease_deg=50.0), "orange", _PUMPKIN),
        rubber(stalk, "stalk", _PUMPKIN_STALK),
    )
    return Asset(
        class_name="Pumpkin",
        size=size,
        parts=fit(parts, size),
        colliders=(
            Collider("cylinder", (0.055, 0.0300, 0.0), (0.0, 0.0, -0.0450)),
            Collider("cylinder", (0.082, 0.0300, 0.0), (0.0, 0.0, -0.0150)),
            Collider("cylinder", (0.012, 0.0300, 0.0), (0.0, 0.0, 0.0400)),
        ),
        mass_kg=1.2,
        looks=Looks("orange pumpkin with a green stalk", ("orange", "green"), "round"),
    )


def _leaf(length: float, width: float) -> Mesh:
    """A thin pointed leaf along +x, its foot at the origin."""
    upper = arc((0.0, 0.0), 1.0, 0.0, 180.0, 13)
    outline = np.concatenate((upper, upper[-2:0:-1] * (1, -1)))
    flat = np.column_stack(
        (
            length / 2 * (1 - outline[:, 0]),
            width / 2 * outline[:, 1] * np.abs(outline[:, 1]) ** 0.4,
        )
    )
    lower = np.column_stack((flat, 0.25 * np.abs(flat[:, 1])))[::-1]
    return loft([lower, lower + np.array((0.0, 0.0, 0.0012))])
