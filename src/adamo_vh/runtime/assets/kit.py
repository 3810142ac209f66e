"""Shapes of the modelling kit: most household things are lathes, sweeps, lofts and rounded boxes.

Metres, Z up. Solids are centred at the origin unless they say otherwise, closed, and have their
faces counter-clockwise from outside. Curves in the plane are (N, 2) arrays. See `mesh` for what can
be done with a shape afterwards.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

from adamo_vh.runtime.assets.curves import arc, circle, fillet, rectangle, spline
from adamo_vh.runtime.assets.mesh import (
    DEFAULT_CREASE_DEG,
    Floats,
    Ints,
    Mesh,
    difference,
    fit,
    intersection,
    merge,
    shade,
    union,
)

__all__ = [
    "Mesh",
    "arc",
    "box",
    "circle",
    "cylinder",
    "difference",
    "ellipsoid",
    "extrude",
    "fillet",
    "fit",
    "intersection",
    "loft",
    "merge",
    "rectangle",
    "revolve",
    "rounded_box",
    "shade",
    "sphere",
    "spline",
    "sweep",
    "union",
]


def revolve(
    profile: ArrayLike,
    segments: int = 32,
    *,
    closed: bool = False,
    crease_deg: float = DEFAULT_CREASE_DEG,
) -> Mesh:
    """Turn a profile about the Z axis.

    The texture's u runs around counter-clockwise from above, so that a label reads from outside:
    u = 0.5 faces -y, the seam is at +y. Its v runs along the profile by length.

    Args:
        profile: (N, 2) of (radius, z), running upwards on the outside. Start and end on the axis
            for a solid; otherwise the surface is open there.
        segments: Facets around.
        closed: Join the last point to the first (a ring).
        crease_deg: See `mesh.shade`.
    """
    line = np.asarray(profile, dtype=np.float64)
    if closed:
        line = np.vstack((line, line[:1]))
    angle = np.linspace(0.5 * np.pi, 2.5 * np.pi, segments + 1)
    around = np.column_stack((np.cos(angle), np.sin(angle), np.ones_like(angle)))
    # The seam must close exactly, else booleans see a slit.
    around[-1] = around[0]
    points = around[None] * line[:, (0, 0, 1)][:, None]
    steps = np.linalg.norm(np.diff(line, axis=0), axis=1)
    along = np.concatenate(((0.0,), np.cumsum(steps))) / max(float(steps.sum()), 1e-12)
    uvs = np.stack(np.meshgrid(np.linspace(0.0, 1.0, segments + 1), along), axis=-1)
    faces = _grid_faces(len(line), segments + 1)
    return shade(points.reshape(-1, 3), faces, uvs.reshape(-1, 2), crease_deg)


def cylinder(
    radius: float,
    height: float,
    *,
    bevel: float = 0.0,
    top_radius: float | None = None,
    segments: int = 32,
    round_bevel: int = 1,
) -> Mesh:
    """Upright cylinder or cone frustum about the origin.

    Args:
        radius: Of the bottom, metres.
        height: Metres.
        bevel: Size of the bevel at both rims.
        top_radius: Of the top, if different.
        segments: Facets around.
        round_bevel: 1 is a flat bevel, more pieces make it round.
    """
    top = radius if top_radius is None else top_radius
    half = height / 2
    profile = np.array(((0.0, -half), (radius, -half), (top, half), (0.0, half)))
    if bevel > 0:
        profile = fillet(profile, bevel, round_bevel)
    return revolve(profile, segments)


def sphere(radius: float, segments: int = 24, rings: int = 12) -> Mesh:
    """Sphere about the origin."""
    return ellipsoid(radius, radius, radius, segments, rings)


def ellipsoid(
    radius_x: float, radius_y: float, radius_z: float, segments: int = 24, rings: int = 12
) -> Mesh:
    """Ellipsoid about the origin, half axes in metres."""
    profile = arc((0.0, 0.0), 1.0, -90.0, 90.0, rings + 1)
    profile[(0, -1), 0] = 0.0
    return revolve(profile, segments, crease_deg=80.0).scaled(radius_x, radius_y, radius_z)


def box(size_x: float, size_y: float, size_z: float, bevel: float = 0.0) -> Mesh:
    """Box about the origin with flat-bevelled edges."""
    return rounded_box(size_x, size_y, size_z, bevel, segments=1)


def rounded_box(
    size_x: float, size_y: float, size_z: float, radius: float, segments: int = 3
) -> Mesh:
    """Box about the origin, all edges and corners rounded by `radius`."""
    if radius <= 0:
        outline = rectangle(size_x, size_y)
        return loft([_at_height(outline, -size_z / 2), _at_height(outline, size_z / 2)])
    rise = np.linspace(0.0, 0.5 * np.pi, segments + 1)
    around = np.concatenate([rise + k * 0.5 * np.pi for k in range(4)])
    corner = np.repeat(np.array(((1, 1), (-1, 1), (-1, -1), (1, -1))), segments + 1, axis=0)
    inner = np.array((size_x, size_y)) / 2 - radius
    ball = np.column_stack((np.cos(around), np.sin(around))) * radius
    lift = size_z / 2 - radius
    heights = [(a, -lift) for a in (rise - 0.5 * np.pi)] + [(a, lift) for a in rise]
    rings = [
        _at_height(corner * inner + ball * np.cos(a), middle + radius * np.sin(a))
        for a, middle in heights
    ]
    return loft(rings)


def extrude(
    outline: ArrayLike,
    depth: float,
    *,
    holes: Sequence[ArrayLike] = (),
    bevel: float = 0.0,
    crease_deg: float = DEFAULT_CREASE_DEG,
) -> Mesh:
    """Plate of a given outline, centred in height (z from -depth / 2 to depth / 2).

    Args:
        outline: (N, 2) closed polygon, either direction.
        depth: Metres.
        holes: Polygons to leave out; they may not touch.
        bevel: Flat bevel of the rims; keep it below the smallest detail.
        crease_deg: See `mesh.shade`.
    """
    import manifold3d

    loops = [_directed(outline, 1.0), *(_directed(hole, -1.0) for hole in holes)]
    insets = [_inset(loop, bevel) for loop in loops]
    lid = np.asarray(manifold3d.triangulate(insets), dtype=np.int64)
    half = depth / 2
    points: list[Floats] = []
    faces: list[Ints] = []
    for loop, inset in zip(loops, insets, strict=True):
        layers = [(inset, -half), (loop, bevel - half), (loop, half - bevel), (inset, half)]
        if bevel <= 0:
            layers = layers[::3]
        rings = np.stack([_at_height(_ring_closed(o), z) for o, z in layers])
        faces.append(_grid_faces(len(layers), len(loop) + 1) + sum(map(len, points)))
        points.append(rings.reshape(-1, 3))
    flat = np.concatenate(insets)
    for height, triangles in ((-half, lid[:, ::-1]), (half, lid)):
        faces.append(triangles + sum(map(len, points)))
        points.append(_at_height(flat, height))
    vertices = np.concatenate(points)
    lower, span = vertices[:, :2].min(axis=0), np.ptp(vertices[:, :2], axis=0)
    uvs = (vertices[:, :2] - lower) / span
    return shade(vertices, np.concatenate(faces), uvs, crease_deg)


def loft(
    rings: Sequence[ArrayLike] | Floats,
    *,
    caps: bool = True,
    closed: bool = False,
    crease_deg: float = DEFAULT_CREASE_DEG,
) -> Mesh:
    """Skin over rings of equally many points.

    The texture's u runs along each ring, v from the first to the last.

    Args:
        rings: Each (K, 3), closed, counter-clockwise seen from the side of the last ring.
        caps: Close both ends by fans about the middle of the ring (right for convex ones).
        closed: Join the last ring to the first instead of capping.
        crease_deg: See `mesh.shade`.
    """
    stack = np.asarray(rings, dtype=np.float64)
    if closed:
        stack = np.concatenate((stack, stack[:1]))
    count, size = stack.shape[:2]
    stack = np.concatenate((stack, stack[:, :1]), axis=1)
    uvs = np.stack(
        np.meshgrid(np.linspace(0.0, 1.0, size + 1), np.linspace(0.0, 1.0, count)), axis=-1
    ).reshape(-1, 2)
    points, faces = stack.reshape(-1, 3), _grid_faces(count, size + 1)
    if caps and not closed:
        middle = stack[(0, -1), :-1].mean(axis=1)
        fan = np.arange(size)
        last = (count - 1) * (size + 1)
        bottom = np.column_stack((fan + 1, fan, np.full(size, len(points))))
        top = np.column_stack((fan, fan + 1, np.full(size, len(points) + 1 - last))) + last
        points = np.concatenate((points, middle))
        uvs = np.concatenate((uvs, ((0.5, 0.0), (0.5, 1.0))))
        faces = np.concatenate((faces, bottom, top))
    return shade(points, faces, uvs, crease_deg)


def sweep(
    section: ArrayLike,
    path: ArrayLike,
    *,
    closed: bool = False,
    caps: bool = True,
    scale: ArrayLike = 1.0,
    up: tuple[float, float, float] = (0.0, 0.0, 1.0),
    crease_deg: float = DEFAULT_CREASE_DEG,
) -> Mesh:
    """Drag a section along a path in space without twisting it: handles, shackles, stems.

    Args:
        section: (K, 2) closed counter-clockwise polygon (see `circle`); its second axis points
            to `up` where the path starts.
        path: (N, 3) points.
        closed: Whether the path is a loop.
        caps: Close the ends.
        scale: Size of the section, one number or one for every point of the path.
        up: Direction that is not along the start of the path.
        crease_deg: See `mesh.shade`.
    """
    line = np.asarray(path, dtype=np.float64)
    outline = _directed(section, 1.0)
    sizes = np.broadcast_to(np.asarray(scale, dtype=np.float64), len(line))
    padded = (
        np.vstack((line[-1:], line, line[:1]))
        if closed
        else np.vstack((2 * line[0] - line[1], line, 2 * line[-1] - line[-2]))
    )
    steps = np.diff(padded, axis=0)
    steps /= np.linalg.norm(steps, axis=1, keepdims=True)
    tangents = steps[:-1] + steps[1:]
    tangents /= np.linalg.norm(tangents, axis=1, keepdims=True)
    vertical = np.asarray(up, dtype=np.float64)
    if abs(vertical @ tangents[0]) > 0.99:
        vertical = np.roll(vertical, 1)
    rings = []
    for point, tangent, size in zip(line, tangents, sizes, strict=True):
        vertical = vertical - tangent * (vertical @ tangent)
        vertical = vertical / np.linalg.norm(vertical)
        side = np.cross(vertical, tangent)
        rings.append(point + size * (outline[:, :1] * side + outline[:, 1:] * vertical))
    return loft(rings, caps=caps, closed=closed, crease_deg=crease_deg)


def _grid_faces(rows: int, columns: int) -> Ints:
    """Triangles of a grid of points: columns run right and rows up, seen from outside."""
    corner = np.arange(rows * columns).reshape(rows, columns)
    a, b = corner[:-1, :-1].ravel(), corner[:-1, 1:].ravel()
    c, d = corner[1:, 1:].ravel(), corner[1:, :-1].ravel()
    return np.concatenate((np.column_stack((a, b, c)), np.column_stack((a, c, d))))


def _at_height(outline: Floats, height: float) -> Floats:
    return np.column_stack((outline, np.full(len(outline), height)))


def _ring_closed(outline: Floats) -> Floats:
    return np.concatenate((outline, outline[:1]))


def _directed(outline: ArrayLike, sign: float) -> Floats:
    """The polygon running counter-clockwise (sign 1) or clockwise (-1)."""
    loop = np.asarray(outline, dtype=np.float64)
    x, y = loop.T
    area = float(x @ np.roll(y, -1) - y @ np.roll(x, -1))
    return loop if area * sign > 0 else loop[::-1]


def _inset(loop: Floats, distance: float) -> Floats:
    """Move every side of a polygon to its left, keeping the number of points."""
    if distance <= 0:
        return loop
    ahead = np.roll(loop, -1, axis=0) - loop
    ahead /= np.linalg.norm(ahead, axis=1, keepdims=True)
    left = np.column_stack((-ahead[:, 1], ahead[:, 0]))
    both = left + np.roll(left, 1, axis=0)
    # Mitre: the sharper the corner, the farther it moves; limited so that spikes stay short.
    mitre = 2 * both / np.maximum((both**2).sum(axis=1, keepdims=True), 0.5)
    return np.asarray(loop + distance * mitre)
