"""Padlocks and a key."""

from __future__ import annotations

import numpy as np

from adamo_vh.runtime.assets.asset import Asset, Collider, Looks, Part
from adamo_vh.runtime.assets.finishes import BRASS, DARK_STEEL, STEEL, Rgb, metal, rubber
from adamo_vh.runtime.assets.kit import (
    Mesh,
    arc,
    circle,
    cylinder,
    extrude,
    fillet,
    fit,
    merge,
    rectangle,
    sweep,
)

_KEYHOLE_RGB: Rgb = (0.06, 0.05, 0.05)


def lock_brass() -> Asset:
    """Brass padlock, standing: a solid body under a high shackle."""
    size = (0.045, 0.020, 0.077)
    body = _slab(0.045, 0.020, 0.043, radius=0.006, bevel=0.0018)
    plate = merge(_both_faces(cylinder(0.0105, 0.0009, bevel=0.0004, segments=28), 0.0196, -0.001))
    parts = (
        metal(body, "brass", BRASS),
        metal(plate, "escutcheon", (0.60, 0.41, 0.13)),
        metal(_shackle(0.0125, 0.0042, 0.0165, 0.055), "shackle", STEEL),
        _keyholes(0.0207, 0.0008, 1.15),
    )
    return Asset(
        class_name="Lock",
        size=size,
        parts=fit(parts, size),
        colliders=_padlock_colliders(size, body_height=0.043, arch=0.0335),
        mass_kg=0.18,
        looks=Looks("brass padlock", ("gold", "grey"), "padlock"),
    )


def lock_steel() -> Asset:
    """Smaller steel padlock, standing: wide, built of riveted plates."""
    size = (0.061, 0.026, 0.062)
    layers = 6
    thickness = 0.037 / layers
    body = merge(
        _slab(
            0.061 - 0.001 * (k % 2),
            0.0245,
            thickness * 0.94,
            radius=0.0075,
            bevel=0.0011,
            lying=True,
        ).moved(z=-0.0185 + thickness * (k + 0.5))
        for k in range(layers)
    )
    rivet = cylinder(0.0027, 0.0011, bevel=0.0005, segments=14)
    rivets = merge(
        face.moved(x=x)
        for x in (-0.0235, 0.0235)
        for z in (-0.0135, 0.0135)
        for face in _both_faces(rivet, 0.0242, z)
    )
    plate = merge(_both_faces(cylinder(0.0098, 0.001, bevel=0.0004, segments=28), 0.0242, 0.0))
    parts = (
        metal(body, "plates", (0.50, 0.51, 0.53)),
        metal(merge((rivets, plate)), "rivets", DARK_STEEL),
        metal(_shackle(0.0175, 0.0046, 0.0100, 0.0435 - 0.0046), "shackle", STEEL),
        _keyholes(0.0252, 0.0, 1.05),
    )
    return Asset(
        class_name="Lock",
        size=size,
        parts=fit(parts, size),
        colliders=_padlock_colliders(size, body_height=0.037, arch=0.0443),
        mass_kg=0.15,
        looks=Looks("small steel padlock", ("grey",), "padlock"),
    )


def key() -> Asset:
    """Brass key, lying flat: round bow, notched blade."""
    size = (0.055, 0.024, 0.002)
    bow = arc((-0.0155, 0.0), 0.012, 24.0, 336.0, 40)
    tooth_x = np.array(
        (0.0272, 0.0252, 0.0222, 0.0206, 0.0178, 0.0160, 0.0128, 0.0110, 0.0080, 0.006)
    )
    tooth_y = np.array(
        (0.0005, 0.0035, 0.0010, 0.0034, 0.0034, 0.0012, 0.0012, 0.0038, 0.0038, 0.006)
    )
    blade = np.column_stack((tooth_x, tooth_y))[::-1]
    shoulder = np.array(((-0.002, 0.0068), (0.004, 0.0062)))
    below = np.array(
        (
            (0.0272, -0.0026),
            (0.0255, -0.0042),
            (0.005, -0.0042),
            (0.004, -0.0062),
            (-0.002, -0.0068),
        )
    )
    outline = np.concatenate((bow, below[::-1], blade[::-1], shoulder[::-1]))
    hole = circle(0.0042, 0.0056, 20) + np.array((-0.0185, 0.0))
    flat = extrude(outline, 0.0015, holes=[hole], bevel=0.0002)
    rim = extrude(
        circle(0.0118, count=40), 0.002, holes=[circle(0.0092, count=40)], bevel=0.0002
    ).moved(x=-0.0155)
    spine = extrude(rectangle(0.027, 0.0018), 0.002, bevel=0.0002).moved(x=0.0125, y=-0.0022)
    parts = (
        metal(flat, "brass", BRASS),
        metal(merge((rim, spine)), "raised", (0.66, 0.46, 0.13)),
    )
    return Asset(
        class_name="Key",
        size=size,
        parts=fit(parts, size),
        colliders=(
            Collider("box", (0.012, 0.012, 0.001), (-0.0155, 0.0, 0.0)),
            Collider("box", (0.0155, 0.005, 0.001), (0.0120, 0.0, 0.0)),
        ),
        mass_kg=0.012,
        looks=Looks("small brass key", ("gold",), "elongated"),
    )


def _slab(
    width: float, depth: float, height: float, *, radius: float, bevel: float, lying: bool = False
) -> Mesh:
    """Block with one rounded outline: seen from the front, or from above when lying."""
    if lying:
        return extrude(rectangle(width, depth, radius, 5), height, bevel=bevel)
    return extrude(rectangle(width, height, radius, 5), depth, bevel=bevel).turned("x", 90)


def _both_faces(disc: Mesh, apart: float, height: float) -> list[Mesh]:
    """A flat detail on the front and the back; heights count from the middle of the body."""
    return [disc.turned("x", 90).moved(y=side * apart / 2, z=height) for side in (-1, 1)]


def _keyholes(apart: float, height: float, scale: float) -> Part:
    """Dark keyholes on both faces."""
    half = 0.0013
    foot = ((-half * 1.5, -0.0062), (half * 1.5, -0.0062), (half * 0.8, 0.0), (-half * 0.8, 0.0))
    hole = merge(
        (
            cylinder(0.0027, 0.0006, segments=20).moved(y=0.0016),
            extrude(np.array(foot), 0.0006),
        )
    ).scaled(scale, scale, 1.0)
    faces = [
        hole.turned("x", 90).moved(y=-apart / 2),
        hole.turned("x", 90).turned("z", 180).moved(y=apart / 2),
    ]
    return rubber(merge(faces).moved(z=height), "keyhole", _KEYHOLE_RGB)


def _shackle(half_width: float, radius: float, foot: float, top: float) -> Mesh:
    """U of round steel; `foot` and `top` are heights of its centre line."""
    corners = ((-half_width, foot), (-half_width, top), (half_width, top), (half_width, foot))
    bend = min(half_width * 0.98, (top - foot) * 0.98)
    line = fillet(np.array(corners), bend, 9)
    path = np.column_stack((line[:, 0], np.zeros(len(line)), line[:, 1]))
    return sweep(circle(radius, count=14), path, up=(0.0, 1.0, 0.0))


def _padlock_colliders(
    size: tuple[float, float, float], *, body_height: float, arch: float
) -> tuple[Collider, ...]:
    """A box for the body, a flat one as wide as the arch for the shackle."""
    width, depth, height = size
    rest = height - body_height
    return (
        Collider(
            "box", (width / 2, depth / 2, body_height / 2), (0, 0, (body_height - height) / 2)
        ),
        Collider("box", (arch / 2, 0.004, rest / 2), (0, 0, (height - rest) / 2)),
    )
