"""Surface finishes that several objects share: metal, plastic, rubber."""

from __future__ import annotations

from functools import cache

import numpy as np
from numpy.typing import NDArray

from adamo_vh.runtime.assets.asset import Material, Part
from adamo_vh.runtime.assets.kit import Mesh

Rgb = tuple[float, float, float]

BRASS: Rgb = (0.80, 0.61, 0.23)
COPPER: Rgb = (0.78, 0.42, 0.22)
STEEL: Rgb = (0.64, 0.65, 0.67)
DARK_STEEL: Rgb = (0.38, 0.38, 0.40)

_HORIZON = (
    (0.0, 0.62),
    (0.36, 0.60),
    (0.49, 0.70),
    (0.53, 0.98),
    (0.68, 1.0),
    (0.85, 0.80),
    (1.0, 0.95),
)
"""What metal mirrors, from straight below to straight above: (height, brightness)."""


def metal(mesh: Mesh, name: str, colour: Rgb) -> Part:
    """Paint as polished metal.

    The mirrored room is baked: brightness follows where the surface faces, and a little where it
    lies, so that flat faces show a gradient too. It is darker than a mirror would be, because a
    highlight must not pass for a white part.
    """
    middle, span = (mesh.lower + mesh.upper) / 2, np.maximum(mesh.upper - mesh.lower, 1e-6)
    place = (mesh.vertices - middle) / span
    facing = 0.5 + 0.42 * mesh.normals + 0.14 * place
    uvs = np.clip(facing[:, (0, 2)], 0.01, 0.99)
    material = Material(
        name, (*colour, 1.0), texture=_mirrored_room(), specular=0.25, shininess=0.5
    )
    return mesh.textured(uvs).part(material)


def plastic(mesh: Mesh, name: str, colour: Rgb) -> Part:
    """Paint as smooth plastic or lacquer, one colour."""
    return mesh.part(Material(name, (*colour, 1.0), specular=0.22, shininess=0.35))


def rubber(mesh: Mesh, name: str, colour: Rgb) -> Part:
    """Paint as a dull surface, one colour."""
    return mesh.part(Material(name, (*colour, 1.0), specular=0.08, shininess=0.1))


@cache
def _mirrored_room() -> NDArray[np.uint8]:
    """(64, 64, 3) grey picture: v is how far up a surface faces, u how far right."""
    v = np.linspace(1.0, 0.0, 64)
    heights, brightness = zip(*_HORIZON, strict=True)
    column = np.interp(v, heights, brightness)
    window = 1.0 - 0.12 * np.cos(np.linspace(0.0, 3 * np.pi, 64)) ** 2
    grey = np.rint(255 * np.outer(column, window)).astype(np.uint8)
    return np.repeat(grey[:, :, None], 3, axis=2)
