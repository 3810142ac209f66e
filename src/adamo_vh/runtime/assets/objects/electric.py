"""A torch and two batteries."""

from __future__ import annotations

import numpy as np

from adamo_vh.runtime.assets.asset import Asset, Collider, Looks
from adamo_vh.runtime.assets.finishes import COPPER, DARK_STEEL, Rgb, metal, plastic
from adamo_vh.runtime.assets.kit import (
    Mesh,
    circle,
    cylinder,
    extrude,
    fillet,
    fit,
    merge,
    rectangle,
    revolve,
    rounded_box,
)

_BLACK: Rgb = (0.085, 0.085, 0.09)
_YELLOW: Rgb = (0.92, 0.72, 0.05)
_GREEN: Rgb = (0.10, 0.55, 0.18)


def flashlight() -> Asset:
    """Black torch with yellow rings, lying along x, its lamp at +x."""
    size = (0.180, 0.045, 0.045)
    body = fillet(
        np.array(
            (
                (0.0, -0.090),
                (0.0185, -0.090),
                (0.0205, -0.070),
                (0.0155, -0.066),
                (0.0155, 0.018),
                (0.0220, 0.044),
                (0.0220, 0.0885),
                (0.0185, 0.0885),
                (0.0185, 0.080),
                (0.0, 0.080),
            )
        ),
        [0, 0.004, 0, 0, 0.006, 0.006, 0.001, 0.001, 0, 0],
        2,
    )
    ribs = merge(
        _ring(0.0155, 0.0168, 0.0034).moved(z=z) for z in np.arange(-0.050, -0.001, 0.0080)
    )
    rings = merge(
        (
            _ring(0.015, 0.0225, 0.0075).moved(z=-0.068),
            _ring(0.013, 0.0182, 0.007).moved(z=0.014),
            _ring(0.0185, 0.0225, 0.008).moved(z=0.086),
            _ring(0.0185, 0.0225, 0.004).moved(z=0.052),
        )
    )
    lens = revolve(np.array(((0.0182, 0.083), (0.012, 0.0815), (0.004, 0.0805), (0.0, 0.0805))), 28)
    bulb = cylinder(0.0045, 0.003, bevel=0.0015, round_bevel=2, segments=16).moved(z=0.082)
    switch = rounded_box(0.006, 0.009, 0.017, 0.0025, 2).moved(x=-0.0165, z=0.030)
    button = rounded_box(0.004, 0.006, 0.011, 0.0018, 2).moved(x=-0.0195, z=0.030)
    parts = (
        plastic(_along_x(merge((revolve(body, 30), ribs, switch))), "black", _BLACK),
        plastic(_along_x(merge((rings, button))), "yellow", _YELLOW),
        metal(_along_x(lens), "reflector", (0.55, 0.54, 0.50)),
        plastic(_along_x(bulb), "bulb", (0.80, 0.62, 0.22)),
    )
    return Asset(
        class_name="Flashlight",
        size=size,
        parts=fit(parts, size),
        colliders=(
            Collider("box", (0.011, 0.0185, 0.0225), (-0.076, 0.0, 0.0)),
            Collider("box", (0.0475, 0.0150, 0.0155), (-0.0195, 0.0, 0.0)),
            Collider("box", (0.0310, 0.0185, 0.0225), (0.0590, 0.0, 0.0)),
        ),
        mass_kg=0.22,
        looks=Looks("black torch with yellow rings", ("black", "yellow"), "elongated"),
    )


def battery_large() -> Asset:
    """Larger battery, standing: copper above black, two snap terminals on top."""
    size = (0.046, 0.032, 0.077)
    footprint = rectangle(0.046, 0.032, 0.006, 5)
    lid = rectangle(0.043, 0.029, 0.005, 5)
    black = extrude(footprint, 0.044, bevel=0.0012).moved(z=0.022)
    copper = extrude(footprint, 0.0245, bevel=0.0012).moved(z=0.044 + 0.01225)
    plate = extrude(lid, 0.002, bevel=0.0006).moved(z=0.0690)
    stud = cylinder(0.0055, 0.007, bevel=0.0012, segments=24).moved(x=-0.011, z=0.0735)
    hexagon = circle(0.0082, count=6)
    socket = extrude(hexagon, 0.006, holes=[circle(0.0052, count=18)], bevel=0.0006)
    terminals = merge((stud, socket.moved(x=0.011, z=0.0730)))
    parts = (
        plastic(merge((black, plate)), "black", _BLACK),
        metal(copper, "copper", COPPER),
        metal(terminals, "terminals", (0.55, 0.55, 0.56)),
    )
    return Asset(
        class_name="Battery",
        size=size,
        parts=fit(parts, size),
        colliders=(
            Collider("box", (0.023, 0.016, 0.035), (0.0, 0.0, -0.0035)),
            Collider("box", (0.019, 0.008, 0.0035), (0.0, 0.0, 0.0350)),
        ),
        mass_kg=0.16,
        looks=Looks("large copper and black battery", ("copper", "black"), "box"),
    )


def battery_small() -> Asset:
    """Smaller battery, standing: green, round, one terminal on top."""
    size = (0.022, 0.023, 0.082)
    sleeve = cylinder(0.011, 0.076, bevel=0.0014, round_bevel=3, segments=32).moved(z=0.0392)
    band = _ring(0.010, 0.01115, 0.0100).moved(z=0.0635)
    shoulder = cylinder(0.0088, 0.002, bevel=0.0006, segments=28).moved(z=0.0775)
    nub = cylinder(0.0038, 0.0052, bevel=0.0011, round_bevel=2, segments=20).moved(z=0.0794)
    foot = cylinder(0.0090, 0.002, segments=28).moved(z=0.001)
    parts = (
        plastic(sleeve, "green", _GREEN),
        plastic(band, "band", (0.05, 0.30, 0.10)),
        metal(merge((shoulder, nub, foot)), "terminals", DARK_STEEL),
    )
    return Asset(
        class_name="Battery",
        size=size,
        parts=fit(parts, size),
        colliders=(
            Collider("cylinder", (0.011, 0.0385, 0.0), (0.0, 0.0, -0.0025)),
            Collider("cylinder", (0.0038, 0.0025, 0.0), (0.0, 0.0, 0.0385)),
        ),
        mass_kg=0.06,
        looks=Looks("small green battery", ("green",), "cylinder"),
    )


def _ring(inner: float, outer: float, width: float) -> Mesh:
    """Ring about z around something thick, so open inside; its outer edges are bevelled."""
    half = width / 2
    bevel = min(0.3 * (outer - inner), 0.3 * width)
    profile = np.array(((inner, -half), (outer, -half), (outer, half), (inner, half)))
    return revolve(fillet(profile, bevel, 1), 28)


def _along_x(mesh: Mesh) -> Mesh:
    """Lay down what was modelled upright: top to +x, -x to the top."""
    return mesh.turned("y", 90)
