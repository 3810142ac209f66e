"""Reference points: a grid of rays through the picture that anchors places in the room."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from adamo_vh.geometry import Array, Camera, Vec3
from adamo_vh.observation import ReferencePoint

Raycast = Callable[[Vec3, Array], Sequence[Vec3 | None]]
"""Like `adamo_vh.engine.Engine.raycast`: origin and (N, 3) unit directions to first hits."""


def only(keep: Callable[[Vec3], bool], raycast: Raycast) -> Raycast:
    """A raycast whose hits count only where they may be anchors."""

    def cast(origin: Vec3, directions: Array) -> Sequence[Vec3 | None]:
        hits = raycast(origin, directions)
        return [hit if hit is not None and keep(hit) else None for hit in hits]

    return cast


def grid_pixels(width_px: int, height_px: int, n: int) -> Array:
    """Centres of the n x n cells of a picture.

    Returns:
        (n * n, 2) u and v: columns from left to right, each from bottom to top.
    """
    centers = (np.arange(n) + 0.5) / n
    u = np.repeat(centers * width_px, n)
    v = np.tile((1.0 - centers) * height_px, n)
    return np.stack([u, v], axis=1)


def reference_points(camera: Camera, raycast: Raycast, n: int) -> tuple[ReferencePoint, ...]:
    """Cast a ray through each cell of an n x n grid and number the hits.

    Args:
        camera: Where the picture was taken from.
        raycast: First hits in the world.
        n: Cells along each side of the picture.

    Returns:
        P0, P1, ... without gaps; a ray that hits nothing gets no number.
    """
    pixels = grid_pixels(camera.width_px, camera.height_px, n)
    hits = raycast(camera.position, camera.rays(pixels))
    anchored = [(hit, uv) for hit, uv in zip(hits, pixels, strict=True) if hit is not None]
    return tuple(
        ReferencePoint(f"P{number}", hit, (float(uv[0]), float(uv[1])))
        for number, (hit, uv) in enumerate(anchored)
    )
