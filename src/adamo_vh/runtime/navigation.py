"""Where the body can stand, and the shortest way there.

A 5 cm grid of clearances from the furniture, Dijkstra over it, and string pulling, so that paths
hug corners instead of following the grid. Clearances are exact distances to the solids, not grid
approximations.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from adamo_vh.engine import SceneInfo
from adamo_vh.geometry import Array, Solid, Vec3
from adamo_vh.runtime.solids import Solids

if TYPE_CHECKING:
    from scipy.sparse import csr_array

CELL_M = 0.05
BODY_RADIUS_M = 0.25
BODY_HEIGHT_M = 1.75
_STEPS = ((0, 1), (1, 0), (1, 1), (1, -1))


@dataclass(frozen=True, slots=True)
class Path:
    """A way on the floor."""

    points: tuple[Vec3, ...]
    """From the start to the end, corners only; one point if nothing is to be walked."""

    @property
    def end(self) -> Vec3:
        """Where it ends."""
        return self.points[-1]

    @property
    def length_m(self) -> float:
        """Metres walked."""
        return sum(a.distance(b) for a, b in pairwise(self.points))

    def walked_to(self, place: Vec3) -> float:
        """Metres walked on arrival at the point of it that is nearest to a place."""
        nearest_m, walked_m, so_far_m = math.inf, 0.0, 0.0
        for a, b in pairwise(self.points):
            along, off, whole_m = b - a, place - a, a.distance(b)
            part = (along.x * off.x + along.y * off.y) / whole_m**2 if whole_m else 0.0
            part = min(max(part, 0.0), 1.0)
            if (off_m := place.horizontal_distance(a + along * part)) < nearest_m:
                nearest_m, walked_m = off_m, so_far_m + whole_m * part
            so_far_m += whole_m
        return walked_m


class FloorMap:
    """The walkable floor at one moment."""

    def __init__(self, room: SceneInfo, solids: Sequence[Solid]) -> None:
        """Map the room.

        Args:
            room: Its extent.
            solids: Everything that the body must not touch.
        """
        self._room = room
        in_the_way = [s for s in solids if s.overlaps_height(0.0, BODY_HEIGHT_M)]
        self._solids = Solids.of(in_the_way)
        xs = np.arange(room.x_min + CELL_M / 2, room.x_max, CELL_M)
        ys = np.arange(room.y_min + CELL_M / 2, room.y_max, CELL_M)
        self._shape = (len(xs), len(ys))
        grid = np.stack(np.meshgrid(xs, ys, indexing="ij"), axis=-1)
        self._centres = grid.reshape(-1, 2)
        free = (self._wall_clearance(self._centres) >= BODY_RADIUS_M).reshape(self._shape)
        for solid in in_the_way:
            # Only cells around it can be too close, and there are many solids.
            far = solid.radius_m + BODY_RADIUS_M
            near = (
                slice(*np.searchsorted(xs, [solid.x - far, solid.x + far])),
                slice(*np.searchsorted(ys, [solid.y - far, solid.y + far])),
            )
            cells = grid[near]
            distance = solid.distance(cells.reshape(-1, 2)).reshape(cells.shape[:2])
            free[near] &= distance >= BODY_RADIUS_M
        self._free = free.ravel()

    def clearance(self, points: Array) -> Array:
        """Distance of floor points from the nearest wall or solid, in metres.

        Args:
            points: (N, 2).

        Returns:
            (N,); negative outside the room.
        """
        return np.asarray(np.minimum(self._wall_clearance(points), self._solids.distance(points)))

    def _wall_clearance(self, points: Array) -> Array:
        room = self._room
        x, y = points[:, 0], points[:, 1]
        sides = [x - room.x_min, room.x_max - x, y - room.y_min, room.y_max - y]
        return np.asarray(np.minimum.reduce(sides))

    @cached_property
    def _graph(self) -> csr_array:
        from scipy.sparse import csr_array

        free = self._free.reshape(self._shape)
        index = np.arange(free.size).reshape(self._shape)
        rows, cols, costs = [], [], []
        for dx, dy in _STEPS:
            a, b = _shifted(index, dx, dy)
            both = free.ravel()[a] & free.ravel()[b]
            rows.append(a[both])
            cols.append(b[both])
            costs.append(np.full(int(both.sum()), CELL_M * float(np.hypot(dx, dy))))
        return csr_array(
            (np.concatenate(costs), (np.concatenate(rows), np.concatenate(cols))),
            shape=(free.size, free.size),
        )

    def _cell(self, point: Vec3) -> int:
        """Index of the walkable cell nearest to a point."""
        distance = np.hypot(*(self._centres - [point.x, point.y]).T)
        return int(np.argmin(np.where(self._free, distance, np.inf)))

    def can_stand(self, point: Vec3) -> bool:
        """Whether the body fits at a point."""
        at = np.array([[point.x, point.y]])
        return bool(self.clearance(at)[0] >= BODY_RADIUS_M - 1e-6)

    def ways_from(self, start: Vec3) -> Ways:
        """All shortest ways from a place."""
        from scipy.sparse.csgraph import dijkstra

        cell = self._cell(start)
        lengths, before = dijkstra(
            self._graph, directed=False, indices=cell, return_predecessors=True
        )
        return Ways(self, start, cell, np.asarray(lengths), np.asarray(before))

    def line_is_free(self, a: Array, b: Array) -> bool:
        """Whether the body can walk straight between two floor points, each (2,)."""
        count = max(2, int(np.hypot(*(b - a)) / (CELL_M / 2)) + 1)
        line = a + (b - a) * np.linspace(0, 1, count)[:, None]
        return bool((self.clearance(line) >= BODY_RADIUS_M - 1e-6).all())


@dataclass(frozen=True, slots=True)
class Ways:
    """Shortest ways from one start to every place that can be reached."""

    floor: FloorMap
    start: Vec3
    cell: int
    lengths_m: NDArray[np.float64]
    """(cells,) walked metres; infinity where no way leads."""
    before: NDArray[np.int32]
    """(cells,) predecessor of each cell on its shortest way."""

    def places(self) -> Array:
        """(N, 2) all places that can be reached, on the grid, metres."""
        return np.asarray(self.floor._centres[np.isfinite(self.lengths_m)])

    def to_nearest(self, target: Vec3) -> Path:
        """The way to the reachable place nearest to a target: the very point if one can stand."""
        centres = self.floor._centres
        distance = np.hypot(*(centres - [target.x, target.y]).T)
        distance = np.where(np.isfinite(self.lengths_m), distance, np.inf)
        # Of places that are about as near (both sides of a table) the shortest way decides.
        about = distance <= distance.min() + CELL_M
        cell = int(np.argmin(np.where(about, self.lengths_m + distance, np.inf)))
        if self.floor.can_stand(target):
            cell = int(np.argmin(distance))
        exact = distance[cell] < CELL_M and self.floor.can_stand(target)
        return self._way(cell, np.array([target.x, target.y]) if exact else centres[cell])

    def to_standing_place(
        self, target: Vec3, reach_m: float, keep_off_m: float, accept: Callable[[Vec3], bool]
    ) -> Path | None:
        """The shortest way to a place from which a target can be handled.

        Args:
            target: What is to be reached.
            reach_m: Largest horizontal distance from the body's axis.
            keep_off_m: Smallest horizontal distance, so that the body does not stand on it.
            accept: Final say on a place, e.g. a line of sight.

        Returns:
            The way, or None if there is no such place.
        """
        centres = self.floor._centres
        distance = np.hypot(*(centres - [target.x, target.y]).T)
        fits = np.isfinite(self.lengths_m) & (distance <= reach_m) & (distance >= keep_off_m)
        # Among equally short ways the closer place is the more comfortable one.
        cost = np.where(fits, self.lengths_m + 0.01 * distance, np.inf)
        for cell in np.argsort(cost, kind="stable")[: int(fits.sum())]:
            place = Vec3(float(centres[cell, 0]), float(centres[cell, 1]), 0.0)
            if accept(place):
                return self._way(int(cell), centres[cell])
        return None

    def _way(self, cell: int, end: Array) -> Path:
        cells = [cell]
        while cells[-1] != self.cell:
            cells.append(int(self.before[cells[-1]]))
        corners = [self.floor._centres[c] for c in reversed(cells)]
        points = [np.array([self.start.x, self.start.y]), *corners[1:-1], end]
        return Path(tuple(Vec3(float(x), float(y), 0.0) for x, y in self._pulled(points)))

    def _pulled(self, points: list[Array]) -> list[Array]:
        """String pulling: leave out every corner that can be cut."""
        kept = [points[0]]
        i = 0
        while i < len(points) - 1:
            ahead = len(points) - 1
            while ahead > i + 1 and not self.floor.line_is_free(points[i], points[ahead]):
                ahead = max(i + 1, ahead - max(1, (ahead - i) // 8))
            if float(np.hypot(*(points[ahead] - kept[-1]))) > 1e-9:
                kept.append(points[ahead])
            i = ahead
        return kept


def _shifted(index: NDArray[np.int64], dx: int, dy: int) -> tuple[NDArray[np.int64], ...]:
    """Pairs of neighbouring cells in one direction."""
    nx, ny = index.shape
    if dy >= 0:
        return index[: nx - dx, : ny - dy].ravel(), index[dx:, dy:].ravel()
    return index[: nx - dx, -dy:].ravel(), index[dx:, : ny + dy].ravel()
