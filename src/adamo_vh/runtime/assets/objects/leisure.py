"""Binoculars and a flip lighter."""

from __future__ import annotations

import numpy as np

from adamo_vh.runtime.assets.asset import Asset, Collider, Looks
from adamo_vh.runtime.assets.finishes import DARK_STEEL, STEEL, Rgb, metal, plastic, rubber
from adamo_vh.runtime.assets.kit import (
    Mesh,
    cylinder,
    difference,
    extrude,
    fillet,
    fit,
    merge,
    rectangle,
    revolve,
    rounded_box,
)

_BLACK: Rgb = (0.075, 0.075, 0.08)
_LEATHER: Rgb = (0.115, 0.11, 0.11)
_LENS: Rgb = (0.26, 0.11, 0.05)


def binoculars() -> Asset:
    """Black binoculars lying level: objectives at -y, eyepieces at +y."""
    size = (0.192, 0.173, 0.069)
    sides = (-1.0, 1.0)
    barrel = _towards_front(_barrel(), 0.0)
    ocular = _towards_front(_eyepiece(), 0.0)
    lens = _towards_front(_lens(0.0290, 0.0800), 0.0)
    prism = rounded_box(0.070, 0.058, 0.063, 0.012, 3).moved(y=0.022)
    hinge = (
        cylinder(0.0085, 0.088, bevel=0.0015, segments=24).turned("x", 90).moved(y=0.008, z=0.013)
    )
    bridges = merge(
        rounded_box(0.080, 0.012, 0.016, 0.004, 2).moved(y=y, z=0.012) for y in (-0.020, 0.040)
    )
    wheel = _knurled(0.0155, 0.017).turned("x", 90).moved(y=0.012, z=0.016)
    trims = merge(
        _towards_front(_tube(0.0325, 0.0350, 0.0035), 0.066).moved(x=0.0615 * side)
        for side in sides
    )
    body = [barrel.moved(x=0.0615 * side) for side in sides]
    body += [ocular.moved(x=0.036 * side) for side in sides]
    parts = (
        plastic(merge((*body, hinge, bridges)), "black", _BLACK),
        rubber(merge(prism.moved(x=0.053 * side) for side in sides), "leather", _LEATHER),
        metal(merge((wheel, trims)), "trim", DARK_STEEL),
        plastic(merge(lens.moved(x=0.0615 * side) for side in sides), "lenses", _LENS),
    )
    return Asset(
        class_name="Binoculars",
        size=size,
        parts=fit(parts, size),
        colliders=(
            *(Collider("box", (0.030, 0.048, 0.0345), (0.0615 * s, -0.0385, 0.0)) for s in sides),
            Collider("box", (0.086, 0.0290, 0.0330), (0.0, 0.022, -0.0015)),
            *(Collider("box", (0.018, 0.0175, 0.0190), (0.036 * s, 0.0685, 0.0)) for s in sides),
        ),
        mass_kg=0.75,
        looks=Looks("black binoculars", ("black",), "irregular"),
    )


def lighter() -> Asset:
    """Metal flip lighter, standing, its lid open to the right."""
    size = (0.070, 0.022, 0.090)
    case = _hollow_case(0.042, 0.022, 0.048).moved(x=-0.014, z=0.024)
    lid = _hollow_case(0.042, 0.022, 0.028).turned("x", 180)
    lid = lid.turned("y", 90).moved(x=0.0212, z=0.069)
    hinge = cylinder(0.0016, 0.012, segments=12).turned("x", 90).moved(x=0.0074, z=0.048)
    insert = rounded_box(0.0385, 0.0185, 0.010, 0.002).moved(x=-0.014, z=0.0455)
    chimney = extrude(rectangle(0.0200, 0.0135, 0.0055, 4), 0.0190, bevel=0.0006)
    bore = extrude(rectangle(0.0175, 0.0110, 0.0045, 4), 0.0100).moved(z=0.0075)
    chimney = difference(chimney, bore).moved(x=-0.0185, z=0.0580)
    dot = cylinder(0.0015, 0.0143, segments=10).turned("x", 90)
    dots = merge(
        dot.moved(x=-0.0185 + dx, z=z) for z in (0.0545, 0.0615) for dx in (-0.0048, 0.0, 0.0048)
    )
    wick = cylinder(0.0019, 0.012, segments=12).moved(x=-0.0185, z=0.0600)
    wheel = _knurled(0.0062, 0.0065).turned("x", 90).moved(x=-0.0025, z=0.0600)
    fork = rounded_box(0.0080, 0.0095, 0.0130, 0.0015).moved(x=-0.0025, z=0.0550)
    cam = rounded_box(0.0030, 0.0060, 0.0140, 0.0010).moved(x=0.0045, z=0.0540)
    parts = (
        metal(merge((case, lid)), "case", (0.56, 0.56, 0.57)),
        metal(merge((insert, chimney, fork, cam, hinge)), "insert", STEEL),
        rubber(merge((dots, wick)), "holes", (0.05, 0.05, 0.05)),
        metal(wheel, "wheel", (0.22, 0.22, 0.23)),
    )
    return Asset(
        class_name="Lighter",
        size=size,
        parts=fit(parts, size),
        colliders=(
            Collider("box", (0.021, 0.011, 0.024), (-0.014, 0.0, -0.021)),
            Collider("box", (0.014, 0.006, 0.0095), (-0.014, 0.0, 0.0125)),
            Collider("box", (0.004, 0.011, 0.021), (0.031, 0.0, 0.024)),
        ),
        mass_kg=0.06,
        looks=Looks("metal lighter", ("grey",), "box"),
    )


def _barrel() -> Mesh:
    """Objective tube about z, its front rim at the top, hollow down to the lens."""
    profile = np.array(
        (
            (0.0, -0.010),
            (0.0270, -0.010),
            (0.0280, 0.020),
            (0.0345, 0.055),
            (0.0345, 0.0865),
            (0.0300, 0.0865),
            (0.0290, 0.0780),
            (0.0, 0.0780),
        )
    )
    return revolve(fillet(profile, [0, 0.002, 0.01, 0.01, 0.0012, 0.0012, 0, 0], 2), 28)


def _eyepiece() -> Mesh:
    """Eyepiece about z, pointing down, with a wider rubber cup."""
    profile = np.array(
        (
            (0.0, -0.0800),
            (0.0135, -0.0800),
            (0.0150, -0.0865),
            (0.0200, -0.0865),
            (0.0200, -0.0720),
            (0.0165, -0.0700),
            (0.0165, -0.0440),
            (0.0, -0.0440),
        )
    )
    return revolve(fillet(profile, [0, 0, 0.001, 0.001, 0.001, 0.001, 0, 0], 1), 24)


def _lens(radius: float, height: float) -> Mesh:
    """Slightly domed disc, facing up."""
    reach = np.linspace(radius, 0.0, 4)
    dome = height + 0.0030 * (1.0 - (reach / radius) ** 2)
    return revolve(np.column_stack((reach, dome)), 28)


def _tube(inner: float, outer: float, width: float) -> Mesh:
    half = width / 2
    section = np.array(((inner, -half), (outer, -half), (outer, half), (inner, half)))
    return revolve(section, 32, closed=True)


def _towards_front(mesh: Mesh, distance: float) -> Mesh:
    """Turn what points up to -y, then move it that way."""
    return mesh.turned("x", 90).moved(y=-distance)


def _knurled(radius: float, width: float) -> Mesh:
    """Wheel about z with teeth around its rim."""
    angle = np.linspace(0.0, 2 * np.pi, 48, endpoint=False)
    reach = radius * np.where(np.arange(48) % 2, 1.0, 0.93)
    outline = np.column_stack((reach * np.cos(angle), reach * np.sin(angle)))
    return extrude(outline, width, bevel=radius * 0.04, crease_deg=25.0)


def _hollow_case(width: float, depth: float, height: float) -> Mesh:
    """Sheet-metal box about the origin, rounded, open at the top."""
    outside = extrude(rectangle(width, depth, 0.0035, 4), height, bevel=0.0010)
    inside = extrude(rectangle(width - 0.0020, depth - 0.0020, 0.0026, 4), height)
    return difference(outside, inside.moved(z=0.0015))
