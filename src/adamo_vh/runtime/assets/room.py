"""The room's shell: floor, walls with skirting, ceiling, and a window in the wall at +x."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from adamo_vh.runtime.assets import paint
from adamo_vh.runtime.assets.asset import Asset, Collider, Looks, Material, Part
from adamo_vh.runtime.assets.kit import Mesh, box, merge
from adamo_vh.runtime.assets.mesh import Ints

Pair = tuple[float, float]
Triple = tuple[float, float, float]
Quad = tuple[float, float, float, float]
Floats = NDArray[np.float64]

_WALL_M = 0.12
"""Thickness of everything around the room."""
_SKIRTING = (0.016, 0.11)
"""Depth and height."""
_FLOOR_TILE_M = (2.4, 1.2)
_WALL_PX_PER_M = 80
_CEILING_PX_PER_M = 24
_CELL_M = 0.4
_OPENING = (2.0, 0.95, 2.45)
"""The window: width, sill and head, metres."""
_FRAME_M = 0.055
_OUTLOOK_M = (1.3, 1.4, 0.9)
"""How far off the picture behind the window is, and how far it reaches beyond the opening, to the
sides and up and down."""


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
        merge(_walls(size, middle, window_y)).part(_wall_paint(size)),
        _ceiling(size, middle),
        merge(_skirting(size, middle)).part(Material("skirting", (0.74, 0.69, 0.61, 1.0))),
        merge(_window_frame(x_max, window_y)).part(Material("frame", (0.46, 0.32, 0.21, 1.0))),
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


def _floor(size: Triple, middle: Pair) -> Part:
    length, depth, _ = size
    corner = (middle[0] - length / 2, middle[1] - depth / 2, 0.0)
    tiles = (0.0, 0.0, depth / _FLOOR_TILE_M[0], length / _FLOOR_TILE_M[1])
    mesh = _panel(corner, (0.0, depth, 0.0), (length, 0.0, 0.0), tiles, flip=True)
    oak = paint.planks((512, 1024), 8, 2, (172, 131, 90), 5)
    return mesh.part(Material("parquet", (0.8, 0.8, 0.8, 1.0), oak, specular=0.05, shininess=0.1))


def _ceiling(size: Triple, middle: Pair) -> Part:
    length, depth, height = size
    corner = (middle[0] - length / 2, middle[1] - depth / 2, height)
    mesh = _panel(corner, (0.0, depth, 0.0), (length, 0.0, 0.0), (0.0, 0.0, 1.0, 1.0))
    shades = [
        _left_by_edge(np.minimum(place, side - place), 0.16, 0.45)
        for side, place in ((side, _middles(side, _CEILING_PX_PER_M)) for side in (length, depth))
    ]
    picture = np.outer(*shades)[..., None] * np.array([204.0, 200.0, 191.0])
    texture = np.rint(picture).astype(np.uint8)
    return mesh.part(Material("ceiling", (1.0, 1.0, 1.0, 1.0), texture, specular=0.0))


def _wall_paint(size: Triple) -> Material:
    """Warm plaster, one picture around the room, with the soft shade of its corners."""
    length, depth, height = size
    corners = np.cumsum([0.0, length, depth, length, depth])
    up = _middles(height, _WALL_PX_PER_M)[::-1]
    around = _middles(float(corners[-1]), _WALL_PX_PER_M)
    from_corner = np.abs(around[:, None] - corners).min(axis=1)
    light = np.outer(
        _left_by_edge(up, 0.20, 0.22) * _left_by_edge(height - up, 0.16, 0.30),
        _left_by_edge(from_corner, 0.15, 0.35),
    )
    picture = paint.plaster((len(up), len(around)), (190, 170, 143), 11) * light[..., None]
    texture = np.rint(picture).astype(np.uint8)
    return Material("walls", (1.0, 1.0, 1.0, 1.0), texture, specular=0.0)


def _middles(length_m: float, px_per_m: float) -> Floats:
    """Where the pixels of a picture lie along an edge of the surface that it covers, metres."""
    count = round(length_m * px_per_m)
    return (np.arange(count) + 0.5) / count * length_m


def _left_by_edge(distance_m: Floats, share: float, reach_m: float) -> Floats:
    """How much light is left near an edge, where two surfaces take it from each other."""
    return np.asarray(1.0 - share * np.exp(-distance_m / reach_m))


def _walls(size: Triple, middle: Pair, window_y: float) -> Iterator[Mesh]:
    """The inner faces, in panels around the window; each runs left to right as seen inside."""
    (x, y), (length, depth, height) = middle, size
    west, east = x - length / 2, x + length / 2
    south, north = y - depth / 2, y + depth / 2
    width, sill, head = _OPENING
    left, right = window_y + width / 2, window_y - width / 2
    # The paint runs around the room as the panels do, from the south-east corner on.
    around = 2 * (length + depth)
    panels = [
        (0.0, (east, south), (west, south), 0.0, height),
        (length, (west, south), (west, north), 0.0, height),
        (length + depth, (west, north), (east, north), 0.0, height),
        (around - depth, (east, north), (east, left), 0.0, height),
        (around - left + south, (east, left), (east, right), 0.0, sill),
        (around - left + south, (east, left), (east, right), head, height),
        (around - right + south, (east, right), (east, south), 0.0, height),
    ]
    for start, (x0, y0), (x1, y1), low, high in panels:
        end = start + abs(x1 - x0) + abs(y1 - y0)
        uvs = (start / around, low / height, end / around, high / height)
        yield _panel((x0, y0, low), (x1 - x0, y1 - y0, 0.0), (0.0, 0.0, high - low), uvs)


def _panel(corner: Triple, along: Triple, across: Triple, uvs: Quad, flip: bool = False) -> Mesh:
    """A rectangle in small cells, because light is computed at corners only.

    Args:
        corner: Where it starts, metres.
        along: One edge; u follows it.
        across: The other edge; v follows it.
        uvs: Texture coordinates (u, v) at the start, then at the opposite corner.
        flip: Face along `across x along` instead of `along x across`.
    """
    u, v = np.array(along), np.array(across)
    counts = [max(1, round(float(np.linalg.norm(edge)) / _CELL_M)) for edge in (u, v)]
    s, t = (
        grid.ravel()
        for grid in np.meshgrid(*(np.linspace(0, 1, n + 1) for n in counts), indexing="ij")
    )
    vertices = np.array(corner) + s[:, None] * u + t[:, None] * v
    start, end = np.array(uvs[:2]), np.array(uvs[2:])
    places = start + np.stack([s, t], axis=1) * (end - start)
    index = np.arange(len(vertices)).reshape(counts[0] + 1, counts[1] + 1)
    a, b, c, d = (part.ravel() for part in _corners(index))
    faces = np.concatenate([np.stack([a, b, c], axis=1), np.stack([a, c, d], axis=1)])
    normal = np.cross(u, v) / np.linalg.norm(np.cross(u, v))
    if flip:
        normal, faces = -normal, faces[:, ::-1]
    return Mesh(vertices, np.tile(normal, (len(vertices), 1)), places, faces)


def _corners(index: Ints) -> tuple[Ints, Ints, Ints, Ints]:
    """The four vertices of every cell, in turn."""
    return index[:-1, :-1], index[1:, :-1], index[1:, 1:], index[:-1, 1:]


def _skirting(size: Triple, middle: Pair) -> Iterator[Mesh]:
    (x, y), (length, depth, _) = middle, size
    thick, tall = _SKIRTING
    # It goes some way into the wall, which hides its rounded edge there.
    deep = thick + 0.01
    for s in (-1, 1):
        across = s * (depth / 2 - thick + deep / 2)
        along = s * (length / 2 - thick + deep / 2)
        yield box(length, deep, tall, 0.004).moved(x, y + across, tall / 2)
        yield box(deep, depth, tall, 0.004).moved(x + along, y, tall / 2)


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
    """A lit picture of trees and sky behind the window, drawn in at its sides to the opening.

    So it fills the window at every angle, even for somebody who looks out along the wall.
    """
    width, sill, head = _OPENING
    off, wider, taller = _OUTLOOK_M
    near, far, half = x_max + _WALL_M, x_max + off, width / 2
    side = math.hypot(far - near, wider)
    left = side / (2 * side + width + 2 * wider)
    # Seen from inside, left to right: x, y, how far beyond sill and head, and u.
    columns = (
        (near, half, 0.0, 0.0),
        (far, half + wider, taller, left),
        (far, -half - wider, taller, 1.0 - left),
        (near, -half, 0.0, 1.0),
    )
    low = [(x, window_y + y, sill - beyond) for x, y, beyond, _ in columns]
    high = [(x, window_y + y, head + beyond) for x, y, beyond, _ in columns]
    # The ground and the top of the sky have the colours of the picture's edges.
    vertices = np.array([*low, *high, *low, *high])
    uvs = np.array([(u, v) for v in (0.0, 1.0, 0.01, 0.99) for *_, u in columns])
    sides = [face for i in range(3) for face in ((i, i + 1, i + 5), (i, i + 5, i + 4))]
    caps = [(8, 11, 10), (8, 10, 9), (12, 13, 14), (12, 14, 15)]
    normals = np.tile([-1.0, 0.0, 0.0], (len(vertices), 1))
    mesh = Mesh(vertices, normals, uvs, np.array([*sides, *caps]))
    view = paint.sky(360, 1024, 3)
    # It shines by itself; the lights of the room hardly change it.
    return mesh.part(Material("outside", (0.12, 0.12, 0.12, 1.0), view, emission=8.6, specular=0.0))


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
