"""How high things are: twice from their centre down to the surface that they rest on.

The text tells centres of things and points on surfaces, so that no pixel is needed.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence

from adamo_vh.geometry import Vec3
from adamo_vh.inference.baseline.prompt.reading import Listed, Room

_AROUND_M = 1.2
"""Points further away are on another surface."""
_WALL_M = 0.03
"""What lies so near to the edge of the room is on its wall."""
_OFF_M = 0.006
"""Places are told to a centimetre."""
_FLAT_M = 0.004
_SLIMMEST = 4.0
"""Greatest height over the side of a cube of the same volume."""


def heights(things: Sequence[Listed], points: Iterable[Vec3], room: Room) -> Mapping[str, float]:
    """The height of each thing whose surface has a reference point, metres, to about a centimetre.

    Args:
        things: With their centres and volumes.
        points: On whatever is in view, things and walls included.
        room: Its walls.

    Returns:
        By tag; things on surfaces without a point are left out.
    """
    surfaces = [p for p in points if not _on_wall(p, room) and not _on_thing(p, things)]
    found = {}
    for thing in things:
        at = thing.position
        below = [
            at.z - p.z
            for p in surfaces
            if at.z - p.z >= -_OFF_M and at.horizontal_distance(p) <= _AROUND_M
        ]
        height = max(2 * min(below, default=math.inf), _FLAT_M)
        if height <= _SLIMMEST * _side_m(thing):
            found[thing.tag] = height
    return found


def _on_wall(point: Vec3, room: Room) -> bool:
    inside = min(
        point.x - room.x_min, room.x_max - point.x, point.y - room.y_min, room.y_max - point.y
    )
    return inside < _WALL_M


def _on_thing(point: Vec3, things: Sequence[Listed]) -> bool:
    return any(
        thing.position.horizontal_distance(point) < _side_m(thing)
        and abs(point.z - thing.position.z) < 1.5 * _side_m(thing)
        for thing in things
    )


def _side_m(thing: Listed) -> float:
    """Side of a cube of the same volume."""
    return float((max(thing.volume_cm3, 0.1) * 1e-6) ** (1 / 3))
