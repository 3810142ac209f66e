"""What the furniture of the living room is made of: boards, cloth, and how pictures lie on them.

Furniture is mostly boards. A `Board` gives both the mesh that is seen and the box that collides,
so the two cannot disagree.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from functools import cache

import numpy as np
from numpy.typing import NDArray

from adamo_vh.runtime.assets import paint
from adamo_vh.runtime.assets.asset import Asset, Collider, Looks, Material, Part, Surface
from adamo_vh.runtime.assets.kit import Mesh, box, fit, loft, merge

Triple = tuple[float, float, float]

_AXES = {"x": 0, "y": 1, "z": 2}
_ACROSS = ((1, 2), (0, 2), (0, 1))
"""By the axis that a face looks along: the two axes of its picture."""


@dataclass(frozen=True, slots=True)
class Board:
    """A piece of timber, upright in the furniture's frame."""

    size: Triple
    """Full edge lengths, metres."""
    center: Triple
    grain: str = "x"
    """Axis that the fibres follow."""
    bevel: float = 0.003
    collides: bool = True

    def mesh(self) -> Mesh:
        """Its surface, with the grain along the board."""
        raw = box(*self.size, self.bevel).moved(*self.center)
        # Boards of one tree look alike, not the same.
        shift = 7.31 * self.center[0] + 3.17 * self.center[1] + 5.71 * self.center[2]
        return box_mapped(raw, (0.9, 0.45), self.grain, shift)

    def collider(self) -> Collider:
        """The box that collides."""
        x, y, z = self.size
        return Collider("box", (x / 2, y / 2, z / 2), self.center)


def timber(boards: Iterable[Board], material: Material) -> Part:
    """All boards of one wood as one part."""
    return merge(board.mesh() for board in boards).part(material)


def solids(boards: Iterable[Board]) -> tuple[Collider, ...]:
    """What collides of the boards."""
    return tuple(board.collider() for board in boards if board.collides)


def box_mapped(
    mesh: Mesh, tile_m: tuple[float, float], grain: str = "x", shift: float = 0.0
) -> Mesh:
    """Lay a repeating picture on a mesh, each face from the axis that it looks along most.

    Args:
        mesh: What to cover.
        tile_m: Size of the picture along its u and v, metres.
        grain: Axis that u follows where it can.
        shift: Moves the picture, in tiles along u and half of that along v.
    """
    corners = mesh.vertices[mesh.faces]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    axis = np.abs(normals).argmax(axis=1)
    keys = mesh.faces * 3 + axis[:, None]
    kept, index = np.unique(keys.ravel(), return_inverse=True)
    vertex, side = kept // 3, kept % 3
    points = mesh.vertices[vertex]
    along = np.array([_u_axis(k, grain) for k in range(3)])[side]
    across = np.array([sum(_ACROSS[k]) - _u_axis(k, grain) for k in range(3)])[side]
    row = np.arange(len(points))
    uvs = np.column_stack((points[row, along] / tile_m[0], points[row, across] / tile_m[1]))
    uvs += np.array((shift % 1.0, shift / 2 % 1.0))
    return Mesh(points, mesh.normals[vertex], uvs, index.reshape(-1, 3))


def _u_axis(side: int, grain: str) -> int:
    wished = _AXES[grain]
    return wished if wished != side else _ACROSS[side][0]


def cushion(size: Triple, plan: float = 7.0, crown: float = 3.2, detail: int = 24) -> Mesh:
    """A stuffed cushion about the origin: a superellipsoid.

    Args:
        size: Full edge lengths.
        plan: How square it is seen from above; 2 is round.
        crown: How flat its top is.
        detail: Facets around.
    """
    around = np.linspace(0.0, 2 * np.pi, detail, endpoint=False)
    rise = np.linspace(-np.pi / 2, np.pi / 2, detail * 3 // 8 + 1)
    outline = np.column_stack((_power(np.cos(around), plan), _power(np.sin(around), plan)))
    spread, height = _power(np.cos(rise), crown), _power(np.sin(rise), crown)
    rings = [
        np.column_stack((outline * max(wide, 0.02), np.full(detail, up)))
        for wide, up in zip(spread, height, strict=True)
    ]
    return loft(rings).scaled(*(edge / 2 for edge in size)).shaded(70.0)


def _power(wave: NDArray[np.float64], exponent: float) -> NDArray[np.float64]:
    return np.asarray(np.sign(wave) * np.abs(wave) ** (2 / exponent))


def upright_box(mesh: Mesh) -> Collider:
    """The box around a mesh as its collider."""
    low, high = mesh.lower, mesh.upper
    half, middle = (high - low) / 2, (low + high) / 2
    return Collider("box", _triple(half), _triple(middle))


def furniture(
    name: str,
    size: Triple,
    parts: Sequence[Part],
    colliders: tuple[Collider, ...],
    surfaces: tuple[Surface, ...] = (),
    *,
    looks: Looks,
    bottom: float = 0.0,
) -> Asset:
    """A static piece.

    Args:
        name: Class of the piece.
        size: What its parts span; they are brought to it exactly, in the last millimetre.
        parts: What is seen.
        colliders: What collides.
        surfaces: What carries.
        looks: Its appearance.
        bottom: Height of its lowest point above the floor, for what hangs.
    """
    rise = np.array((0.0, 0.0, size[2] / 2 + bottom), dtype=np.float32)
    placed = (replace(part, vertices=part.vertices + rise) for part in fit(parts, size))
    return Asset(name, size, tuple(placed), colliders, 20.0, looks, surfaces)


def _triple(values: NDArray[np.float64]) -> Triple:
    x, y, z = (float(v) for v in values)
    return x, y, z


@cache
def oak() -> Material:
    """Light, warm wood."""
    return Material("oak", texture=paint.wood(256, 512, (186, 139, 88), 11), rgba=_PLAIN)


@cache
def walnut() -> Material:
    """Dark, warm wood."""
    return Material("walnut", texture=paint.wood(256, 512, (112, 72, 46), 23), rgba=_PLAIN)


def cloth(name: str, colour: tuple[int, int, int], seed: int) -> Material:
    """Coarse upholstery; lay it with `draped`."""
    texture = paint.fabric(128, colour, seed)
    return Material(name, texture=texture, rgba=_PLAIN, specular=0.04, shininess=0.05)


def draped(mesh: Mesh) -> Mesh:
    """Lay cloth on a mesh."""
    return box_mapped(mesh, (0.11, 0.11))


_PLAIN = (1.0, 1.0, 1.0, 1.0)
BLACK_METAL = Material("black_metal", (0.13, 0.12, 0.115, 1.0), specular=0.3, shininess=0.4)
BRASS_METAL = Material("brass_metal", (0.58, 0.43, 0.2, 1.0), specular=0.4, shininess=0.5)
