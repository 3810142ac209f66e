"""Things of kitchen, desk and workbench: a teapot, a wooden spoon, scissors, a remote, a hammer."""

from __future__ import annotations

import numpy as np

from adamo_vh.runtime.assets import paint
from adamo_vh.runtime.assets.asset import Asset, Collider, Looks, Material
from adamo_vh.runtime.assets.finishes import DARK_STEEL, Rgb, metal, plastic, rubber
from adamo_vh.runtime.assets.kit import (
    Mesh,
    arc,
    circle,
    cylinder,
    ellipsoid,
    extrude,
    fillet,
    fit,
    loft,
    merge,
    rectangle,
    revolve,
    rounded_box,
    sphere,
    spline,
    sweep,
)

_GLAZE: Rgb = (0.09, 0.36, 0.22)
_WOOD = (176, 122, 70)
_PINK: Rgb = (0.84, 0.16, 0.42)
_BLACK: Rgb = (0.085, 0.085, 0.09)
_KEYS: Rgb = (0.40, 0.40, 0.41)
_RED: Rgb = (0.80, 0.07, 0.06)
_TURN = np.linspace(0.0, 2 * np.pi, 32, endpoint=False)


def teapot() -> Asset:
    """Green teapot, its spout at +x, its handle at -x."""
    size = (0.230, 0.140, 0.150)
    body = (
        (0.0, 0.0),
        (0.040, 0.0),
        (0.044, 0.006),
        (0.062, 0.026),
        (0.070, 0.056),
        (0.062, 0.088),
        (0.040, 0.110),
        (0.036, 0.114),
        (0.0, 0.114),
    )
    lid = ((0.0, 0.112), (0.040, 0.112), (0.041, 0.116), (0.030, 0.126), (0.0, 0.131))
    spout = spline(
        ((0.050, 0.0, 0.040), (0.085, 0.0, 0.052), (0.102, 0.0, 0.082), (0.126, 0.0, 0.106)), 12
    )
    handle = spline(
        (
            (-0.056, 0.0, 0.092),
            (-0.088, 0.0, 0.104),
            (-0.108, 0.0, 0.082),
            (-0.102, 0.0, 0.050),
            (-0.062, 0.0, 0.032),
        ),
        16,
    )
    pieces = (
        revolve(fillet(np.array(body), [0, 0.002, 0.004, 0.03, 0.03, 0.03, 0.01, 0, 0], 4), 44),
        revolve(fillet(np.array(lid), [0, 0.002, 0.001, 0.02, 0], 3), 40),
        sphere(0.0105, 20, 10).scaled(1.0, 1.0, 0.9).moved(z=0.1395),
        sweep(circle(0.0185, count=18), spout, scale=np.linspace(1.0, 0.50, len(spout))),
        sweep(circle(0.0060, 0.0085, 14), handle, caps=False),
    )
    mouth = cylinder(0.0068, 0.003, segments=18).turned("y", 52).moved(x=0.1262, z=0.1065)
    parts = (plastic(merge(pieces), "green", _GLAZE), rubber(mouth, "mouth", (0.03, 0.08, 0.05)))
    return Asset(
        class_name="Teapot",
        size=size,
        parts=fit(parts, size),
        colliders=(
            Collider("cylinder", (0.044, 0.0150, 0.0), (-0.009, 0.0, -0.0600)),
            Collider("cylinder", (0.068, 0.0420, 0.0), (-0.009, 0.0, -0.0080)),
            Collider("cylinder", (0.038, 0.0200, 0.0), (-0.009, 0.0, 0.0540)),
            Collider("box", (0.024, 0.011, 0.0330), (0.084, 0.0, 0.0020)),
            Collider("box", (0.022, 0.007, 0.0360), (-0.093, 0.0, -0.0070)),
        ),
        mass_kg=0.8,
        looks=Looks("green teapot", ("green",), "irregular"),
    )


def wooden_spoon() -> Asset:
    """Cooking spoon of light brown wood, lying along x, its bowl at +x."""
    size = (0.280, 0.058, 0.020)
    x = np.array((-0.140, -0.136, -0.05, 0.040, 0.062, 0.080, 0.105, 0.128, 0.138, 0.140))
    width = np.array(
        (0.006, 0.0085, 0.0070, 0.0070, 0.0150, 0.0250, 0.0290, 0.0210, 0.0100, 0.0030)
    )
    deep = np.array((0.005, 0.0060, 0.0058, 0.0060, 0.0070, 0.0080, 0.0085, 0.0070, 0.0050, 0.0030))
    rings = np.stack(
        (
            np.broadcast_to(x[:, None], (len(x), 32)),
            width[:, None] * np.cos(_TURN),
            deep[:, None] * np.sin(_TURN),
        ),
        axis=-1,
    )
    hollow = ellipsoid(0.031, 0.0215, 0.0022, 32, 8).moved(x=0.102, z=0.0080)
    grain = Material(
        "wood",
        (1, 1, 1, 1),
        texture=paint.wood(256, 256, _WOOD, 21),
        specular=0.06,
        shininess=0.1,
    )
    parts = (
        loft(rings, crease_deg=60.0).projected("z").part(grain),
        rubber(hollow, "bowl", (0.44, 0.28, 0.14)),
    )
    return Asset(
        class_name="WoodenSpoon",
        size=size,
        parts=fit(parts, size),
        colliders=(
            Collider("box", (0.0950, 0.0070, 0.0100), (-0.045, 0.0, 0.0)),
            Collider("box", (0.0400, 0.0240, 0.0100), (0.098, 0.0, 0.0)),
        ),
        mass_kg=0.05,
        looks=Looks("wooden spoon", ("brown",), "elongated"),
    )


def scissors() -> Asset:
    """Scissors with pink handles, lying a little open along x, their tips at +x."""
    size = (0.190, 0.086, 0.012)
    blade = np.array(
        ((-0.010, -0.007), (0.012, -0.0085), (0.105, -0.001), (0.105, 0.001), (-0.010, 0.006))
    )
    shank = ((-0.002, 0.0, 0.0), (-0.022, -0.004, 0.0), (-0.042, -0.010, 0.0))
    ring = np.column_stack(
        (-0.064 + 0.0240 * np.cos(_TURN), 0.0160 * np.sin(_TURN) - 0.0150, 0.0 * _TURN)
    )
    halves = []
    for side, lift in ((1.0, 0.0018), (-1.0, -0.0018)):
        steel = extrude(blade, 0.0030, bevel=0.0005)
        plastics = merge(
            (
                sweep(circle(0.0058, 0.0050, 14), ring, closed=True),
                sweep(circle(0.0062, 0.0050, 14), shank),
            )
        )
        halves.append(
            tuple(
                mesh.scaled(1.0, side, 1.0).turned("z", 9.0 * side).moved(z=lift * share)
                for mesh, share in ((steel, 1.0), (plastics, 0.3))
            )
        )
    rivet = cylinder(0.0048, 0.0110, bevel=0.0008, segments=20)
    parts = (
        metal(merge((*(steel for steel, _ in halves), rivet)), "steel", (0.52, 0.53, 0.55)),
        plastic(merge(grips for _, grips in halves), "grips", _PINK),
    )
    return Asset(
        class_name="Scissors",
        size=size,
        parts=fit(parts, size),
        colliders=(
            Collider("box", (0.048, 0.016, 0.0060), (0.044, 0.0, 0.0)),
            Collider("box", (0.044, 0.038, 0.0060), (-0.048, 0.0, 0.0)),
        ),
        mass_kg=0.08,
        looks=Looks("scissors with pink handles", ("grey", "pink"), "elongated"),
    )


def remote_control() -> Asset:
    """Black remote control, lying along y: rows of grey keys and one red one at +y."""
    size = (0.046, 0.170, 0.020)
    shell = extrude(rectangle(0.046, 0.170, 0.010, 5), 0.017, bevel=0.003).moved(z=0.0085)
    key = rounded_box(0.0085, 0.0065, 0.004, 0.0015, 2)
    grid = [(x, y) for y in np.arange(-0.068, 0.006, 0.0135) for x in (-0.0125, 0.0, 0.0125)]
    keys = [key.moved(x, float(y), 0.0176) for x, y in grid]
    pad = extrude(circle(0.0155, count=32), 0.004, holes=[circle(0.0075, count=24)], bevel=0.0008)
    keys.append(pad.moved(y=0.034, z=0.0178))
    keys.append(cylinder(0.0055, 0.0045, bevel=0.001, segments=20).moved(y=0.034, z=0.0178))
    power = cylinder(0.0062, 0.005, bevel=0.0012, segments=24).moved(x=-0.0120, y=0.0705, z=0.0175)
    second = cylinder(0.0050, 0.005, bevel=0.0012, segments=24).moved(x=0.0125, y=0.0705, z=0.0173)
    parts = (
        plastic(shell, "shell", _BLACK),
        rubber(merge((*keys, second)), "keys", _KEYS),
        rubber(power, "power", _RED),
    )
    return Asset(
        class_name="RemoteControl",
        size=size,
        parts=fit(parts, size),
        colliders=(Collider("box", (0.0225, 0.0845, 0.0095), (0.0, 0.0, -0.0005)),),
        mass_kg=0.11,
        looks=Looks("black remote control", ("black", "grey", "red"), "elongated"),
    )


def hammer() -> Asset:
    """Claw hammer with a wooden handle, lying along x, its steel head at +x."""
    size = (0.290, 0.120, 0.034)
    x = np.array((-0.150, -0.146, -0.110, -0.060, 0.020, 0.110, 0.128))
    wide = np.array((0.012, 0.0160, 0.0165, 0.0140, 0.0120, 0.0115, 0.0115))
    rings = np.stack(
        (
            np.broadcast_to(x[:, None], (len(x), 32)),
            wide[:, None] * np.cos(_TURN),
            0.78 * wide[:, None] * np.sin(_TURN),
        ),
        axis=-1,
    )
    handle = loft(rings, crease_deg=60.0).projected("z")
    eye = rounded_box(0.034, 0.036, 0.030, 0.005, 3).moved(x=0.122)
    neck = cylinder(0.0110, 0.022, segments=28).turned("x", 90).moved(x=0.122, y=-0.026)
    face = cylinder(0.0165, 0.020, bevel=0.0025, segments=32).turned("x", 90)
    face = face.moved(x=0.122, y=-0.046)
    parts = (
        handle.part(
            Material(
                "handle",
                (1, 1, 1, 1),
                texture=paint.wood(256, 256, (188, 128, 66), 33),
                specular=0.08,
                shininess=0.15,
            )
        ),
        metal(merge((eye, neck, face, _claw())), "steel", DARK_STEEL),
    )
    return Asset(
        class_name="Hammer",
        size=size,
        parts=fit(parts, size),
        colliders=(
            Collider("box", (0.0170, 0.0560, 0.0170), (0.122, 0.0, 0.0)),
            Collider("box", (0.1300, 0.0120, 0.0090), (-0.012, 0.0, 0.0)),
            Collider("box", (0.0060, 0.0120, 0.0170), (-0.136, 0.0, 0.0)),
        ),
        mass_kg=0.55,
        looks=Looks("claw hammer with a wooden handle", ("brown", "grey"), "elongated"),
    )


def _claw() -> Mesh:
    """The two curved prongs at the back of a hammer's head."""
    upper = arc((0.060, 0.012), 0.078, 3.0, 44.0, 14)
    lower = arc((0.060, 0.012), 0.053, 40.0, 3.0, 14)
    prong = extrude(np.concatenate((upper, lower)), 0.0105, bevel=0.0015)
    return merge(prong.moved(z=0.0085 * side) for side in (-1.0, 1.0))
