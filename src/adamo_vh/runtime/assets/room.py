"""The room's shell: floor, walls with skirting, ceiling, and a window in the wall at +x."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from adamo_vh.runtime.assets import paint
from adamo_vh.runtime.assets.asset import Asset, Collider, Looks, Material, Part
from adamo_vh.runtime.assets.kit import Mesh, box, merge
from adamo_vh.runtime.assets.mesh import Ints

Pair = tuple[float, float]
Triple = tuple[float, float, float]

_WALL_M = 0.12
"""Thickness of everything around the room."""
_SKIRTING = (0.016, 0.09)
"""Depth and height."""
_FLOOR_TILE_M = (2.4, 1.2)
_WALL_TILE_M = (1.6, 1.6)
_CELL_M = 0.4
_OPENING = (2.0, 0.95, 2.45)
"""The window: width, sill and head, metres."""
_FRAME_M = 0.055


def room(x_min: float, x_max: float, y_min: float, y_max: float, height: float) -> Asset:
    """Build the shell of a room, in world coordinates.

    Args:
        x_min: West wall, metres.
        x_max: East wall, which has the window in its middle part.
        y_min: South wall.
        y_max: North wall.
        height: Of the ceiling.
    """
    size = (x_max - x_min, y_max - y_min, height)
    middle = ((x_min + x_max) / 2, (y_min + y_max) / 2)
    window_y = middle[1]
    parts = (
        _floor(size, middle),
        merge(_walls(size, middle, window_y)).part(_plaster()),
        _ceiling(size, middle),
        merge(_skirting(size, middle)).part(Material("skirting", (0.66, 0.60, 0.52, 1.0))),
        merge(_window_frame(x_max, window_y)).part(Material("frame", (0.40, 0.29, 0.20, 1.0))),
        _outside(x_max, window_y),
    )
    return Asset(
        class_name="Room",
        size=size,
        parts=parts,
        colliders=_colliders(size, middle),
        mass_kg=1000.0,
        looks=Looks("room with a window", ("beige",), "box"),
    )


def _plaster() -> Material:
    return Material("walls", texture=paint.plaster(256, (200, 189, 170), 11), specular=0.0)


def _floor(size: Triple, middle: Pair) -> Part:
    length, depth, _ = size
    corner = (middle[0] - length / 2, middle[1] - depth / 2, 0.0)
    mesh = _panel(corner, (0.0, depth, 0.0), (length, 0.0, 0.0), _FLOOR_TILE_M, flip=True)
    oak = paint.planks((512, 1024), 8, 2, (164, 128, 92), 5)
    return mesh.part(Material("parquet", texture=oak, specular=0.05, shininess=0.1))


def _ceiling(size: Triple, middle: Pair) -> Part:
    length, depth, height = size
    corner = (middle[0] - length / 2, middle[1] - depth / 2, height)
    mesh = _panel(corner, (length, 0.0, 0.0), (0.0, depth, 0.0), _WALL_TILE_M, flip=True)
    return mesh.part(Material("ceiling", (0.80, 0.79, 0.76, 1.0), specular=0.0))


def _walls(size: Triple, middle: Pair, window_y: float) -> Iterator[Mesh]:
    """The inner faces, in panels around the window; each runs left to right as seen inside."""
    (x, y), (length, depth, height) = middle, size
    west, east = x - length / 2, x + length / 2
    south, north = y - depth / 2, y + depth / 2
    width, sill, head = _OPENING
    left, right = window_y + width / 2, window_y - width / 2
    panels = [
        ((east, south, 0.0), (-length, 0.0, 0.0), height),
        ((west, north, 0.0), (length, 0.0, 0.0), height),
        ((west, south, 0.0), (0.0, depth, 0.0), height),
        ((east, north, 0.0), (0.0, left - north, 0.0), height),
        ((east, right, 0.0), (0.0, south - right, 0.0), height),
        ((east, left, 0.0), (0.0, right - left, 0.0), sill),
        ((east, left, head), (0.0, right - left, 0.0), height - head),
    ]
    for corner, along, tall in panels:
        yield _panel(corner, along, (0.0, 0.0, tall), _WALL_TILE_M)


def _panel(corner: Triple, along: Triple, across: Triple, tile_m: Pair, flip: bool = False) -> Mesh:
    """A rectangle in small cells, because light is computed at corners only.

    Args:
        corner: Where it starts, metres.
        along: One edge; u follows it.
        across: The other edge; v follows it.
        tile_m: Size of the texture along u and v.
        flip: Face along `across x along` instead of `along x across`.
    """
    u, v = np.array(along), np.array(across)
    counts = [max(1, round(float(np.linalg.norm(edge)) / _CELL_M)) for edge in (u, v)]
    s, t = (
        grid.ravel()
        for grid in np.meshgrid(*(np.linspace(0, 1, n + 1) for n in counts), indexing="ij")
    )
    vertices = np.array(corner) + s[:, None] * u + t[:, None] * v
    # World coordinates keep the texture unbroken from panel to panel.
    axes = [int(np.abs(edge).argmax()) for edge in (u, v)]
    uvs = vertices[:, axes] / np.array(tile_m)
    index = np.arange(len(vertices)).reshape(counts[0] + 1, counts[1] + 1)
    a, b, c, d = (part.ravel() for part in _corners(index))
    faces = np.concatenate([np.stack([a, b, c], axis=1), np.stack([a, c, d], axis=1)])
    normal = np.cross(u, v) / np.linalg.norm(np.cross(u, v))
    if flip:
        normal, faces = -normal, faces[:, ::-1]
    return Mesh(vertices, np.tile(normal, (len(vertices), 1)), uvs, faces)


def _corners(index: Ints) -> tuple[Ints, Ints, Ints, Ints]:
    """The four vertices of every cell, in turn."""
    return index[:-1, :-1], index[1:, :-1], index[1:, 1:], index[:-1, 1:]


def _skirting(size: Triple, middle: Pair) -> Iterator[Mesh]:
    (x, y), (length, depth, _) = middle, size
    thick, tall = _SKIRTING
    for s in (-1, 1):
        yield box(length, thick, tall, 0.004).moved(x, y + s * (depth - thick) / 2, tall / 2)
        yield box(thick, depth, tall, 0.004).moved(x + s * (length - thick) / 2, y, tall / 2)


def _window_frame(x_max: float, window_y: float) -> Iterator[Mesh]:
    width, sill, head = _OPENING
    x, bar, deep = x_max + _WALL_M / 2, _FRAME_M, _WALL_M + 0.02
    middle = (sill + head) / 2
    for s in (-1, 1):
        yield box(deep, bar, head - sill, 0.004).moved(x, window_y + s * (width - bar) / 2, middle)
    yield box(deep, width, bar, 0.004).moved(x, window_y, head - bar / 2)
    yield box(0.05, bar, head - sill, 0.004).moved(x, window_y, middle)
    yield box(0.05, width, bar * 0.7, 0.004).moved(x, window_y, sill + 0.68 * (head - sill))
    # The sill stands out into the room.
    yield box(deep + 0.14, width + 0.12, 0.035, 0.008).moved(x - 0.06, window_y, sill)


def _outside(x_max: float, window_y: float) -> Part:
    """A lit picture of trees and sky behind the window."""
    width, sill, head = _OPENING
    half, low, high = width / 2 + 0.9, sill - 0.7, head + 0.7
    x = x_max + 0.9
    corners = [(half, low, 0), (-half, low, 1), (-half, high, 1), (half, high, 0)]
    vertices = np.array([(x, window_y + y, z) for y, z, _ in corners])
    uvs = np.array([(u, (z - low) / (high - low)) for _, z, u in corners], float)
    normals = np.tile([-1.0, 0.0, 0.0], (4, 1))
    mesh = Mesh(vertices, normals, uvs, np.array([(0, 1, 2), (0, 2, 3)]))
    view = paint.sky(360, 512, 3)
    return mesh.part(Material("outside", texture=view, emission=0.5, specular=0.0))


def _colliders(size: Triple, middle: Pair) -> tuple[Collider, ...]:
    """Thick boxes, so that nothing slips through."""
    (x, y), (length, depth, height) = middle, size
    thick = 0.5
    floor = Collider("box", (length / 2 + 1, depth / 2 + 1, thick), (x, y, -thick))
    return (
        floor,
        *(
            Collider(
                "box", (length / 2, thick, height / 2), (x, y + s * (depth / 2 + thick), height / 2)
            )
            for s in (-1, 1)
        ),
        *(
            Collider(
                "box", (thick, depth / 2, height / 2), (x + s * (length / 2 + thick), y, height / 2)
            )
            for s in (-1, 1)
        ),
    )
