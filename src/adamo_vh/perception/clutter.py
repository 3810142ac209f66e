"""What a tag would hide: a coarse integral image over the objects' visible pixels."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from adamo_vh.perception.visibility import VisibleObject

_ROWS = 270
"""The picture is sampled to so many rows at most; finer buys nothing that a tag could use."""
_BOX_SHARE = 0.35
"""Weight of an object's box beside its pixels: keeps tags out of other objects' boxes, where they
read as those objects' names, and protects objects thinner than a cell."""


@dataclass(frozen=True, slots=True, eq=False)
class Clutter:
    """Answers how much of the visible objects any rectangle would hide."""

    cell_px: int
    """Pixels along the side of a cell."""
    integral: NDArray[np.float64]
    """(rows + 1, columns + 1) sums over all cells above and left."""

    @classmethod
    def of(
        cls, id_layers: Sequence[NDArray[np.int16]], visible: Sequence[VisibleObject]
    ) -> Clutter:
        """Weigh each visible object as one, spread over its pixels, so small ones count as much.

        Args:
            id_layers: Each (H, W) ids, front first.
            visible: The objects that count; others weigh nothing.
        """
        cell = _cell_px(id_layers[0].shape[0])
        # Ids index a table whose last entry answers NOTHING (-1).
        sampled = [np.ascontiguousarray(layer[::cell, ::cell]) for layer in id_layers]
        highest = max(*(item.id for item in visible), *(int(layer.max()) for layer in sampled), 0)
        weight = np.zeros(highest + 2)
        for item in visible:
            weight[item.id] = min(1.0, cell * cell / item.pixels)
        front = sampled[0]
        density = weight[front]
        for behind in sampled[1:]:
            density += np.where(behind != front, weight[behind], 0.0)
        for item in visible:
            left, top, right, bottom = item.box_px
            area = density[top // cell : -(-bottom // cell), left // cell : -(-right // cell)]
            area += _BOX_SHARE / area.size
        integral = np.zeros((density.shape[0] + 1, density.shape[1] + 1))
        integral[1:, 1:] = density.cumsum(axis=0).cumsum(axis=1)
        return cls(cell, integral)

    def hidden(self, rects: NDArray[np.int64]) -> NDArray[np.float64]:
        """How much each rectangle would hide.

        Args:
            rects: (N, 4) left, top, right, bottom pixels inside the picture.

        Returns:
            (N,) about the number of objects hidden; a half-hidden one counts half.
        """
        left, top = rects[:, 0] // self.cell_px, rects[:, 1] // self.cell_px
        right, bottom = -(-rects[:, 2] // self.cell_px), -(-rects[:, 3] // self.cell_px)
        sums = self.integral
        return np.asarray(
            sums[bottom, right] - sums[top, right] - sums[bottom, left] + sums[top, left]
        )


def _cell_px(height_px: int) -> int:
    return -(-height_px // _ROWS)
