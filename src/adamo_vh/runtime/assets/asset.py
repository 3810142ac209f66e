"""What a builder returns: the visual parts, the collision primitives, the mass and the looks.

Local frame of every asset: metres, Z up, in its resting pose. Objects have the origin in the centre
of their box; furniture has it on the floor below its middle.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True, slots=True, eq=False)
class Material:
    """How a part reflects light. Colours are sRGB in [0, 1]."""

    name: str
    rgba: tuple[float, float, float, float] = (0.7, 0.7, 0.7, 1.0)
    """Tint; multiplied with the texture. An alpha below 1 is glass."""
    texture: NDArray[np.uint8] | None = None
    """(H, W, 3) sRGB picture; v = 0 is the bottom row."""
    specular: float = 0.2
    shininess: float = 0.3
    reflectance: float = 0.0
    emission: float = 0.0
    casts_shadow: bool = True
    """Not for what light goes through: its shadow would be drawn as dark as any."""


@dataclass(frozen=True, slots=True, eq=False)
class Part:
    """A triangle mesh of one material."""

    vertices: NDArray[np.float32]
    """(N, 3) metres."""
    normals: NDArray[np.float32]
    """(N, 3) unit vectors."""
    uvs: NDArray[np.float32]
    """(N, 2) in [0, 1]; v up."""
    faces: NDArray[np.int32]
    """(M, 3) vertex indices, counter-clockwise from outside."""
    material: Material


@dataclass(frozen=True, slots=True)
class Collider:
    """A collision primitive, as MuJoCo has them."""

    shape: str
    """box, cylinder, capsule, sphere or ellipsoid."""
    size: tuple[float, float, float]
    """Half sizes: box (x, y, z); cylinder and capsule (radius, half length, unused)."""
    position: tuple[float, float, float] = (0.0, 0.0, 0.0)
    quaternion: tuple[float, float, float, float] = (1.0, 0.0, 0.0, 0.0)
    """Scalar first."""


@dataclass(frozen=True, slots=True)
class Surface:
    """A horizontal rectangle that things can be put on."""

    name: str
    """Of the level, e.g. "top"; empty when the furniture has one surface only."""
    center: tuple[float, float, float]
    """In the furniture's frame."""
    half_size: tuple[float, float]


@dataclass(frozen=True, slots=True)
class Looks:
    """What an object declares about its appearance; tests hold the pixels against it."""

    description: str
    """A few words a person would use."""
    colours: tuple[str, ...]
    """Plain colour names, the main one first."""
    shape: str
    """Shape class: flat round, ring, cylinder, bottle, box, elongated, irregular, ..."""
    white_parts: bool = False
    label: str | None = None
    """Printed text, if any."""


@dataclass(frozen=True, slots=True, eq=False)
class Asset:
    """An interactable object or a piece of furniture."""

    class_name: str
    """Class in semantic tags, e.g. "Plate"."""
    size: tuple[float, float, float]
    """Full edge lengths of the box that holds all parts, metres."""
    parts: tuple[Part, ...]
    colliders: tuple[Collider, ...]
    mass_kg: float
    looks: Looks
    surfaces: tuple[Surface, ...] = field(default=())
