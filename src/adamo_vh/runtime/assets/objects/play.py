"""Toys: a rubber duck and a car."""

from __future__ import annotations

import numpy as np

from adamo_vh.runtime.assets.asset import Asset, Collider, Looks
from adamo_vh.runtime.assets.finishes import Rgb, metal, plastic, rubber
from adamo_vh.runtime.assets.kit import (
    cylinder,
    ellipsoid,
    extrude,
    fillet,
    fit,
    merge,
    rounded_box,
    sphere,
)

_YELLOW: Rgb = (0.95, 0.76, 0.06)
_BEAK: Rgb = (0.90, 0.36, 0.03)
_BLACK: Rgb = (0.06, 0.06, 0.065)
_RED: Rgb = (0.76, 0.05, 0.05)
_WINDOW: Rgb = (0.10, 0.12, 0.13)
_LAMP: Rgb = (0.80, 0.62, 0.18)


def rubber_duck() -> Asset:
    """Yellow bath duck with an orange beak, looking to -y."""
    size = (0.090, 0.110, 0.105)
    body = ellipsoid(0.045, 0.053, 0.034, 32, 16).moved(z=0.034)
    tail = ellipsoid(0.019, 0.024, 0.009, 20, 10).turned("x", 40).moved(y=0.046, z=0.046)
    wings = merge(
        ellipsoid(0.010, 0.028, 0.017, 20, 10)
        .turned("x", 16)
        .moved(x=0.041 * side, y=0.012, z=0.042)
        for side in (-1.0, 1.0)
    )
    head = sphere(0.0300, 28, 14).moved(y=-0.024, z=0.075)
    beak = merge(
        (
            ellipsoid(0.015, 0.016, 0.0048, 20, 10).moved(y=-0.053, z=0.0735),
            ellipsoid(0.012, 0.012, 0.0040, 20, 10).moved(y=-0.050, z=0.0675),
        )
    )
    eyes = merge(
        sphere(0.0050, 14, 8).moved(x=0.0135 * s, y=-0.0475, z=0.0845) for s in (-1.0, 1.0)
    )
    parts = (
        plastic(merge((body, tail, wings, head)), "yellow", _YELLOW),
        plastic(beak, "beak", _BEAK),
        plastic(eyes, "eyes", _BLACK),
    )
    return Asset(
        class_name="RubberDuck",
        size=size,
        parts=fit(parts, size),
        colliders=(
            Collider("box", (0.030, 0.036, 0.0180), (0.0, 0.008, -0.0345)),
            Collider("box", (0.044, 0.046, 0.0120), (0.0, 0.008, -0.0100)),
            Collider("box", (0.026, 0.026, 0.0240), (0.0, -0.022, 0.0270)),
        ),
        mass_kg=0.07,
        looks=Looks("yellow rubber duck with an orange beak", ("yellow", "orange"), "irregular"),
    )


def toy_car() -> Asset:
    """Red toy car with dark windows and black wheels, its front at -y."""
    size = (0.066, 0.130, 0.056)
    side = fillet(
        np.array(
            ((-0.065, 0.010), (0.065, 0.010), (0.065, 0.032), (-0.030, 0.034), (-0.065, 0.028))
        ),
        [0.004, 0.004, 0.008, 0.006, 0.008],
        3,
    )
    cabin = fillet(
        np.array(((-0.034, 0.030), (0.052, 0.030), (0.040, 0.052), (-0.008, 0.052))),
        [0, 0, 0.006, 0.008],
        3,
    )
    glass = fillet(
        np.array(((-0.030, 0.031), (0.048, 0.031), (0.0375, 0.0495), (-0.0075, 0.0495))),
        [0, 0, 0.004, 0.006],
        3,
    )
    # Outlines are drawn seen from the side: their x runs along the car.
    hull, top = (
        extrude(line, width, bevel=0.003).turned("x", 90).turned("z", 90)
        for line, width in ((side, 0.060), (cabin, 0.052))
    )
    panes = extrude(glass, 0.0535, bevel=0.0002).turned("x", 90).turned("z", 90)
    pillar = rounded_box(0.0545, 0.0055, 0.019, 0.0015, 2).moved(y=0.016, z=0.041)
    shield = (
        rounded_box(0.044, 0.0015, 0.017, 0.0006, 1).turned("x", -50).moved(y=-0.0215, z=0.0425)
    )
    rear = rounded_box(0.044, 0.0015, 0.016, 0.0006, 1).turned("x", 29).moved(y=0.0468, z=0.0425)
    wheel = cylinder(0.0145, 0.012, bevel=0.002, segments=28).turned("y", 90)
    hub = cylinder(0.0070, 0.0135, bevel=0.001, segments=18).turned("y", 90)
    axles = [(0.027 * x, y) for x in (-1.0, 1.0) for y in (-0.040, 0.040)]
    lamps = merge(
        cylinder(0.0060, 0.004, bevel=0.001, segments=18)
        .turned("x", 90)
        .moved(x=x, y=-0.0635, z=0.022)
        for x in (-0.020, 0.020)
    )
    bumper = rounded_box(0.058, 0.006, 0.007, 0.0025, 2)
    bumpers = merge(bumper.moved(y=y, z=0.0125) for y in (-0.0635, 0.0635))
    parts = (
        plastic(merge((hull, top, pillar)), "red", _RED),
        plastic(merge((panes, shield, rear)), "windows", _WINDOW),
        rubber(merge(wheel.moved(x, y, 0.0145) for x, y in axles), "tyres", _BLACK),
        metal(merge(hub.moved(x, y, 0.0145) for x, y in axles), "hubs", (0.52, 0.52, 0.53)),
        plastic(lamps, "lamps", _LAMP),
        rubber(bumpers, "bumpers", (0.2, 0.2, 0.2)),
    )
    return Asset(
        class_name="ToyCar",
        size=size,
        parts=fit(parts, size),
        colliders=(
            Collider("box", (0.033, 0.064, 0.0170), (0.0, 0.0, -0.0110)),
            Collider("box", (0.026, 0.038, 0.0110), (0.0, 0.009, 0.0160)),
        ),
        mass_kg=0.14,
        looks=Looks("red toy car", ("red", "black"), "irregular"),
    )
