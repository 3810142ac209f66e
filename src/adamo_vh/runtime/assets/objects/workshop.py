"""A roll of tape and a screwdriver."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from adamo_vh.runtime.assets.asset import Asset, Collider, Looks, Material
from adamo_vh.runtime.assets.finishes import STEEL, Rgb, metal, plastic
from adamo_vh.runtime.assets.kit import (
    Mesh,
    arc,
    cylinder,
    extrude,
    fillet,
    fit,
    loft,
    merge,
    rectangle,
    revolve,
)

_RED: Rgb = (0.80, 0.06, 0.05)
_RED_DARK: Rgb = (0.42, 0.03, 0.03)
_TAPE_BLUE: Rgb = (0.08, 0.30, 0.90)
_CORE_BLUE: Rgb = (0.14, 0.42, 0.92)


def tape() -> Asset:
    """Roll of blue tape lying flat, its core blue too."""
    size = (0.136, 0.136, 0.043)
    outer, inner, core, half = 0.0675, 0.0440, 0.0400, 0.0215
    section = np.array(((inner, -half), (outer, -half), (outer, half), (inner, half)))
    roll = revolve(fillet(section, [0, 0.0012, 0.0012, 0], 2, closed=True), 72, closed=True)
    wall = np.array(((core, 0.0010 - half), (inner, 0.0010 - half), (inner, half - 0.0010)))
    wall = np.vstack((wall, ((core, half - 0.0010),)))
    tube = revolve(fillet(wall, 0.0008, 1, closed=True), 56, closed=True)
    parts = (
        roll.projected("z").part(
            Material("tape", (1, 1, 1, 1), texture=_wound_layers(), specular=0.15, shininess=0.3)
        ),
        plastic(tube, "core", _CORE_BLUE),
        plastic(_loose_end(outer, half), "end", (0.12, 0.38, 0.94)),
    )
    pieces = 8
    middle, half_width = (outer + core) / 2, (outer - core) / 2
    return Asset(
        class_name="Tape",
        size=size,
        parts=fit(parts, size),
        colliders=tuple(
            Collider(
                "box",
                (half_width, middle * np.tan(np.pi / pieces), half),
                (middle * np.cos(angle), middle * np.sin(angle), 0.0),
                (float(np.cos(angle / 2)), 0.0, 0.0, float(np.sin(angle / 2))),
            )
            for angle in np.arange(pieces) * 2 * np.pi / pieces
        ),
        mass_kg=0.25,
        looks=Looks("blue roll of tape", ("blue",), "ring"),
    )


def screwdriver() -> Asset:
    """Screwdriver with a fluted red handle, lying along x, its tip at +x."""
    size = (0.228, 0.022, 0.021)
    position = np.array((-0.114, -0.1125, -0.108, -0.100, -0.040, -0.030, -0.022, -0.012, -0.008))
    radius = np.array((0.0040, 0.0075, 0.0098, 0.0108, 0.0108, 0.0092, 0.0084, 0.0100, 0.0090))
    depth = np.array((0.0, 0.0, 0.06, 0.12, 0.12, 0.08, 0.0, 0.0, 0.0))
    angle = np.linspace(0.0, 2 * np.pi, 48, endpoint=False)
    grooves = 0.5 + 0.5 * np.cos(8 * angle)
    reach = radius[:, None] * (1.0 - depth[:, None] * grooves**2)
    rings = np.stack(
        (
            np.broadcast_to(position[:, None], reach.shape),
            reach * np.cos(angle),
            reach * np.sin(angle),
        ),
        axis=-1,
    )
    handle = loft(rings, crease_deg=50.0)
    cap = cylinder(0.0085, 0.004, bevel=0.001, segments=28).turned("y", 90).moved(x=-0.0975)
    collar = cylinder(0.0056, 0.006, bevel=0.0012, segments=24).turned("y", 90).moved(x=-0.006)
    band = cylinder(0.0112, 0.006, bevel=0.0008, segments=36).turned("y", 90).moved(x=-0.035)
    shaft = cylinder(0.0033, 0.101, segments=20).turned("y", 90).moved(x=0.0455)
    parts = (
        plastic(merge((handle, cap)), "handle", _RED),
        plastic(band, "band", _RED_DARK),
        metal(merge((collar, shaft, _blade())), "steel", STEEL),
    )
    return Asset(
        class_name="Screwdriver",
        size=size,
        parts=fit(parts, size),
        colliders=(
            Collider("box", (0.0530, 0.0080, 0.0105), (-0.061, 0.0, 0.0)),
            Collider("box", (0.0610, 0.0033, 0.0033), (0.053, 0.0, 0.0)),
        ),
        mass_kg=0.09,
        looks=Looks("screwdriver with red handle", ("red", "grey"), "elongated"),
    )


def _wound_layers() -> NDArray[np.uint8]:
    """(256, 256, 3) concentric rings: the edges of the wound tape, seen from above."""
    axis = np.linspace(-1.0, 1.0, 256)
    radius = np.hypot(axis[:, None], axis[None])
    layers = 0.5 + 0.5 * np.sin(radius * 95.0)
    shade = 0.86 + 0.14 * layers + 0.06 * np.sin(radius * 23.0)
    rgb = shade[:, :, None] * np.array(_TAPE_BLUE)
    return np.asarray(np.rint(255 * np.clip(rgb, 0.0, 1.0)), dtype=np.uint8)


def _loose_end(radius: float, half: float) -> Mesh:
    """Last stretch of tape, lying on the roll a little proud, its end cut straight.

    It stays between the axes, where it cannot widen the roll's box.
    """
    outside = arc((0.0, 0.0), radius + 0.0007, -118.0, -152.0, 12)
    inside = arc((0.0, 0.0), radius - 0.0010, -152.0, -118.0, 12)
    return extrude(np.concatenate((outside, inside)), 2 * half - 0.0020)


def _blade() -> Mesh:
    """Flat tip: the round shaft flares to a wide, thin edge."""
    shapes = (
        (0.090, 0.0062, 0.0062),
        (0.100, 0.0084, 0.0046),
        (0.106, 0.0096, 0.0026),
        (0.114, 0.0088, 0.0012),
    )
    rings = []
    for x, width, thickness in shapes:
        outline = rectangle(width, thickness, thickness * 0.3, 3)
        rings.append(np.column_stack((np.full(len(outline), x), outline)))
    return loft(rings)
