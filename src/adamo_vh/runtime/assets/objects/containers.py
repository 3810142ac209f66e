"""Jars, cans and bottles with a printed product label.

The straight part of each body carries the print, and with it every rim and stripe that would be too
thin to model; the rest is turned.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from adamo_vh.runtime.assets.asset import Asset, Collider, Looks, Material, Part
from adamo_vh.runtime.assets.finishes import Rgb, plastic, rubber
from adamo_vh.runtime.assets.kit import (
    Mesh,
    circle,
    extrude,
    fillet,
    fit,
    merge,
    revolve,
    rounded_box,
)
from adamo_vh.runtime.assets.labels import (
    PAPER,
    Band,
    Label,
    Line,
    Motif,
    capsule,
    cross,
    grapes,
    peanut,
    tomato,
    wrap,
)
from adamo_vh.runtime.assets.paint import Picture

_SEGMENTS = 48
_WHITE: Rgb = (0.84, 0.84, 0.82)
_TAN: Rgb = (0.70, 0.44, 0.19)
_RED: Rgb = (0.72, 0.05, 0.05)
_CAN: Rgb = (0.50, 0.50, 0.50)
_AMBER: Rgb = (0.78, 0.36, 0.05)
_BOTTLE: Rgb = (0.045, 0.075, 0.045)
_CAPSULE: Rgb = (0.34, 0.03, 0.06)


def peanut_butter() -> Asset:
    """Jar of peanut butter with a red lid; the paste shows above and below a brown label."""
    size = (0.109, 0.109, 0.150)
    radius, low, high = 0.0545, 0.014, 0.104
    brown, gold = (84, 34, 14), (246, 176, 36)
    label = Label(
        ground=brown,
        lines=(
            Line("PEANUT", (0.64, 0.92), gold),
            Line("BUTTER", (0.32, 0.60), gold),
        ),
        bands=(Band((0.0, 0.025), gold), Band((0.975, 1.0), gold)),
        motifs=(Motif(peanut, (0.065, 0.275)),),
    )
    foot = _turned(((0.0, 0.0), (radius, 0.0), (radius, low)), 0.007)
    shoulder = _turned(((radius, high), (radius, 0.118), (0.0465, 0.126), (0.0465, 0.128)), 0.008)
    lid = _turned(((0.0465, 0.1255), (0.0500, 0.1255), (0.0500, 0.150), (0.0, 0.150)), 0.0025)
    parts = (
        _printed(label, radius, low, high),
        plastic(merge((foot, shoulder)), "paste", _TAN),
        _knurled(lid, "lid", _RED, ribs=60, share=0.30),
    )
    return Asset(
        class_name="PeanutButter",
        size=size,
        parts=fit(parts, size),
        colliders=(
            Collider("cylinder", (radius, 0.0625, 0.0), (0.0, 0.0, -0.0125)),
            Collider("cylinder", (0.0500, 0.0125, 0.0), (0.0, 0.0, 0.0625)),
        ),
        mass_kg=0.75,
        looks=Looks(
            "brown jar of peanut butter with a red lid",
            ("brown", "red", "yellow"),
            "cylinder",
            label="PEANUT BUTTER",
        ),
    )


def tomato_soup() -> Asset:
    """Can of tomato soup: red above, white below, dull rims."""
    size = (0.070, 0.070, 0.105)
    radius, height, red = 0.035, 0.105, (168, 12, 16)
    rim, groove = (128, 128, 128), (84, 84, 84)
    label = Label(
        ground=PAPER,
        lines=(
            Line("TOMATO", (0.65, 0.89), PAPER),
            Line("SOUP", (0.355, 0.565), red, 0.86),
        ),
        bands=(
            Band((0.61, 1.0), red),
            Band((0.595, 0.610), (206, 150, 40)),
            *(Band(v, rim) for v in ((0.0, 0.045), (0.955, 1.0))),
            *(Band(v, groove) for v in ((0.036, 0.045), (0.955, 0.964))),
        ),
        motifs=(Motif(tomato, (0.075, 0.315)),),
    )
    inner, deep = 0.0322, 0.0035
    lid = fillet(
        np.array(
            (
                (radius, height),
                (inner, height),
                (inner, height - deep),
                (0.0285, height - deep),
                (0.0270, height - 0.0022),
                (0.0, height - 0.0022),
            )
        ),
        0.0006,
        1,
    )
    bottom = revolve(np.array(((0.0, 0.0), (radius, 0.0))), _SEGMENTS)
    pull = extrude(circle(0.0085, 0.0120), 0.0014, holes=[circle(0.0055, 0.0065)], bevel=0.0004)
    rivet = rounded_box(0.0075, 0.0065, 0.0022, 0.0008, 1).moved(y=-0.010)
    tab = merge((pull, rivet)).moved(y=0.016, z=height - 0.0013)
    parts = (
        _printed(label, radius, 0.0, height),
        rubber(merge((revolve(lid, _SEGMENTS), bottom)), "tin", _CAN),
        rubber(tab, "tab", (0.40, 0.40, 0.40)),
    )
    return Asset(
        class_name="TomatoSoup",
        size=size,
        parts=fit(parts, size),
        colliders=(Collider("cylinder", (radius, height / 2, 0.0)),),
        mass_kg=0.35,
        looks=Looks(
            "red and white can of tomato soup",
            ("red", "white"),
            "cylinder",
            white_parts=True,
            label="TOMATO SOUP",
        ),
    )


def pills() -> Asset:
    """Amber pill bottle with a white cap and label."""
    size = (0.055, 0.055, 0.085)
    radius, low, high = 0.0255, 0.0085, 0.0525
    ink, red = (24, 24, 28), (196, 40, 32)
    label = Label(
        ground=PAPER,
        lines=(Line("PILLS", (0.38, 0.85), ink),),
        bands=(Band((0.90, 1.0), red), Band((0.0, 0.05), red)),
        motifs=(Motif(capsule, (0.12, 0.31)),),
    )
    foot = _turned(((0.0, 0.0), (radius, 0.0), (radius, low)), 0.004)
    shoulder = _turned(((radius, high), (radius, 0.0585), (0.0225, 0.0610), (0.0225, 0.063)), 0.003)
    cap = _turned(((0.0225, 0.0615), (0.0275, 0.0615), (0.0275, 0.085), (0.0, 0.085)), 0.0022)
    parts = (
        _printed(label, radius, low, high),
        plastic(merge((foot, shoulder)), "amber", _AMBER),
        _knurled(cap, "cap", _WHITE, ribs=48, share=0.42),
    )
    return Asset(
        class_name="Pills",
        size=size,
        parts=fit(parts, size),
        colliders=(
            Collider("cylinder", (radius, 0.03075, 0.0), (0.0, 0.0, -0.01175)),
            Collider("cylinder", (0.0275, 0.01175, 0.0), (0.0, 0.0, 0.03075)),
        ),
        mass_kg=0.06,
        looks=Looks(
            "amber pill bottle with a white cap",
            ("orange", "white"),
            "bottle",
            white_parts=True,
            label="PILLS",
        ),
    )


def painkiller() -> Asset:
    """Slim white medicine bottle with a red and green label."""
    size = (0.046, 0.046, 0.112)
    radius, low, high = 0.023, 0.006, 0.078
    red, green = (160, 10, 18), (16, 110, 54)
    label = Label(
        ground=PAPER,
        lines=(
            Line("PAIN", (0.475, 0.705), PAPER),
            Line("KILLER", (0.185, 0.415), PAPER),
        ),
        bands=(Band((0.13, 0.76), red), Band((0.07, 0.13), green), Band((0.76, 0.79), green)),
        motifs=(Motif(cross, (0.82, 0.97)),),
    )
    foot = _turned(((0.0, 0.0), (radius, 0.0), (radius, low)), 0.003)
    shoulder = _turned(((radius, high), (radius, 0.087), (0.0145, 0.091), (0.0145, 0.094)), 0.004)
    cap = _turned(((0.0145, 0.093), (0.0170, 0.093), (0.0170, 0.112), (0.0, 0.112)), 0.0015)
    parts = (
        _printed(label, radius, low, high),
        plastic(merge((foot, shoulder)), "white", _WHITE),
        _knurled(cap, "cap", _WHITE, ribs=40, share=0.42),
    )
    return Asset(
        class_name="Painkiller",
        size=size,
        parts=fit(parts, size),
        colliders=(
            Collider("cylinder", (radius, 0.0460, 0.0), (0.0, 0.0, -0.0100)),
            Collider("cylinder", (0.0170, 0.0100, 0.0), (0.0, 0.0, 0.0460)),
        ),
        mass_kg=0.08,
        looks=Looks(
            "small white medicine bottle with a red label",
            ("white", "red", "green"),
            "bottle",
            white_parts=True,
            label="PAINKILLER",
        ),
    )


def wine_bottle() -> Asset:
    """Dark bottle of red wine with a cream label and a dark red capsule."""
    size = (0.063, 0.064, 0.241)
    radius, low, high = 0.0315, 0.014, 0.122
    wine = (120, 12, 34)
    label = Label(
        ground=PAPER,
        lines=(
            Line("RED", (0.665, 0.905), wine, 0.90),
            Line("WINE", (0.365, 0.605), wine),
        ),
        bands=(Band((0.0, 0.04), wine), Band((0.96, 1.0), wine)),
        motifs=(Motif(grapes, (0.07, 0.33)),),
    )
    foot = _turned(((0.0, 0.0), (radius, 0.0), (radius, low)), 0.004)
    outline = ((radius, high), (radius, 0.144), (0.0145, 0.170), (0.0125, 0.186), (0.0125, 0.190))
    shoulder = revolve(fillet(np.array(outline), [0, 0.016, 0.020, 0.010, 0], 6), _SEGMENTS)
    cap = (
        (0.0125, 0.184),
        (0.0137, 0.184),
        (0.0137, 0.228),
        (0.0148, 0.229),
        (0.0148, 0.241),
        (0.0, 0.241),
    )
    parts = (
        _printed(label, radius, low, high),
        plastic(merge((foot, shoulder)), "glass", _BOTTLE),
        plastic(_turned(cap, 0.0010), "capsule", _CAPSULE),
    )
    return Asset(
        class_name="WineBottle",
        size=size,
        parts=fit(parts, size),
        colliders=(
            Collider("cylinder", (radius, 0.0750, 0.0), (0.0, 0.0, -0.0455)),
            Collider("cylinder", (0.0145, 0.0455, 0.0), (0.0, 0.0, 0.0750)),
        ),
        mass_kg=1.1,
        looks=Looks(
            "dark bottle of red wine with a cream label",
            ("black", "white", "red"),
            "bottle",
            white_parts=True,
            label="RED WINE",
        ),
    )


def _turned(profile: ArrayLike, rounding: float) -> Mesh:
    """Turn a profile with all its corners rounded."""
    return revolve(fillet(profile, rounding, 3), _SEGMENTS)


def _printed(label: Label, radius: float, low: float, high: float) -> Part:
    """The straight wall that carries the print, from one height to another."""
    wall = revolve(np.array(((radius, low), (radius, high))), _SEGMENTS)
    picture = wrap(label, 2 * np.pi * radius, high - low)
    return wall.part(Material("label", (1, 1, 1, 1), texture=picture, specular=0.06, shininess=0.1))


def _knurled(mesh: Mesh, name: str, colour: Rgb, *, ribs: int, share: float) -> Part:
    """A screw cap whose grip is painted: at a distance ribs would be thinner than a pixel.

    Args:
        mesh: Turned from the cap's lower edge to the middle of its top.
        name: Of the material.
        colour: Of the ridges.
        ribs: Count around.
        share: Of the profile that the grip covers.
    """
    picture: Picture = np.full((64, ribs * 12, 3), 255, dtype=np.uint8)
    ridge = 0.86 + 0.14 * np.cos(np.arange(ribs * 12) * 2 * np.pi / 12)
    picture[round(64 * (1 - share)) : 60] = np.rint(255 * ridge).astype(np.uint8)[:, None]
    material = Material(name, (*colour, 1.0), texture=picture, specular=0.12, shininess=0.2)
    return mesh.part(material)
