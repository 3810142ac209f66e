"""A cheap test of every frame: what cannot be a picture of the world must not be scored.

Rays know nothing of the drawing, so they tell whether the id image fits the world: pixels that show
an object must hit it, and objects that a ray hits must have their pixels.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from adamo_vh.engine import Body, WorldState
from adamo_vh.geometry import Array
from adamo_vh.observation import NOTHING, Percept

_STEP = 120
"""Rows and columns that are looked at, about: finer finds no further fault."""
_SKIN_M = 0.02
"""How far from its box a hit still counts as one of the object."""
_FEWEST = 3
"""So many rays tell something."""
_MISSES = 0.5
"""Share of rays that may miss: thin things, edges, what the body's own arms hide."""
_STEEPEST = -math.sin(math.radians(35.0))
"""Upward part of a ray's direction below which the body's own trunk may hide what it hits."""
_THICK_PX = 4.0
"""What shows fewer pixels across may have none."""


def frame_fault(percept: Percept, state: WorldState, body: Body) -> str:
    """Why a percept cannot be a picture of the world; empty if it can.

    Args:
        percept: What the body saw.
        state: The world then.
        body: Casts the rays.
    """
    camera = percept.camera
    size = (camera.height_px, camera.width_px)
    if percept.rgb.shape != (*size, 3) or percept.rgb.dtype != np.uint8:
        return f"the picture is {percept.rgb.shape} {percept.rgb.dtype}, not {(*size, 3)} uint8"
    if not percept.id_layers or any(layer.shape != size for layer in percept.id_layers):
        return f"an id layer is not {size}"
    step = max(1, min(size) // _STEP)
    rgb = percept.rgb[::step, ::step]
    ids = percept.id_layers[0][::step, ::step]
    if not rgb.any():
        return "the picture is black"
    if (rgb == rgb[0, 0]).all() and (ids != NOTHING).any():
        return "the picture is blank, where objects are in view"
    room = _Room.of(state)
    if strange := sorted(set(percept.objects) - set(room.ids.tolist())):
        return f"it shows object {strange[0]}, which is not in the room"
    # Where pixels were painted from boxes, one of them may show what stands before the object.
    wrong = "" if percept.from_boxes else _drawn_wrongly(percept, room, body, step)
    return wrong or _left_out(percept, room, body)


@dataclass(frozen=True, slots=True, eq=False)
class _Room:
    """The objects that lie in the room, as arrays; what is in the hand is passed by rays."""

    ids: NDArray[np.int64]
    """(N,) all ids, ascending."""
    held: int | None
    centres: Array
    """(N, 3) of the boxes, metres."""
    halves: Array
    """(N, 3) half edges."""
    turns: Array
    """(N, 3, 3) world_from_local."""

    @classmethod
    def of(cls, state: WorldState) -> _Room:
        boxes = [item.box for item in state.objects]
        return cls(
            np.array([item.id for item in state.objects], np.int64),
            state.body.held,
            np.array([box.center.array() for box in boxes]).reshape(-1, 3),
            np.array([box.size.array() for box in boxes]).reshape(-1, 3) / 2,
            np.array([box.orientation.matrix() for box in boxes]).reshape(-1, 3, 3),
        )

    def hit(self, points: Array) -> NDArray[np.bool_]:
        """(M, N) whether a point (M, 3) is on the thing in a box."""
        offset = points[:, None, :] - self.centres
        local = np.einsum("mni,nij->mnj", offset, self.turns)
        return np.asarray((np.abs(local) <= self.halves + _SKIN_M).all(axis=2))


def _drawn_wrongly(percept: Percept, room: _Room, body: Body, step: int) -> str:
    """Whether pixels show objects that are not there."""
    ids = percept.id_layers[0][::step, ::step]
    rows, columns = np.nonzero(ids != NOTHING)
    order = np.argsort(ids[rows, columns], kind="stable")
    rows, columns = rows[order], columns[order]
    shown, first, count = np.unique(ids[rows, columns], return_index=True, return_counts=True)
    if strange := sorted(set(shown.tolist()) - set(room.ids.tolist())):
        return f"it shows object {strange[0]}, which is not in the room"
    # Two pixels of each object, from its middle.
    lying = shown != (NOTHING if room.held is None else room.held)
    chosen = np.concatenate([first + count // 2, first + count // 3])[np.tile(lying, 2)]
    pixels = np.stack([columns[chosen], rows[chosen]], axis=1) * step + 0.5
    index = np.searchsorted(room.ids, np.tile(shown, 2)[np.tile(lying, 2)])
    hit = room.hit(_cast(percept, pixels, body))
    missed = int((~hit[np.arange(len(index)), index]).sum())
    return _verdict(missed, len(index), "show an object where there is none")


def _left_out(percept: Percept, room: _Room, body: Body) -> str:
    """Whether objects that a ray to their middle hits have no pixel around it."""
    camera = percept.camera
    seen = camera.project(room.centres)
    size = np.array([camera.width_px, camera.height_px])
    inside = (seen[:, 2] > 0) & (seen[:, :2] >= 0).all(axis=1) & (seen[:, :2] < size).all(axis=1)
    there = np.flatnonzero(inside & (room.ids != (NOTHING if room.held is None else room.held)))
    # Rays pass the body and what it holds, which hide things all the same.
    there = there[camera.rays(seen[there, :2])[:, 2] > _STEEPEST]
    columns, rows = seen[there, :2].astype(np.intp).T
    if room.held is not None:
        there = there[percept.id_layers[0][rows, columns] != room.held]
    # What is thinner than a few pixels may fall between them.
    per_m = camera.focal_px / seen[there, 2]
    there = there[np.sort(room.halves[there], axis=1)[:, 1] * 2 * per_m >= _THICK_PX]
    hit = room.hit(_cast(percept, seen[there, :2], body))
    # Where boxes are in each other, the hit may be on the other thing.
    clear = there[hit[np.arange(len(there)), there] & (hit.sum(axis=1) == 1)]
    around = np.linalg.norm(room.halves[clear], axis=1) * camera.focal_px / seen[clear, 2]
    missed = 0
    for number, (column, row, _), reach in zip(room.ids[clear], seen[clear], around, strict=True):
        # Between its leaves one sees past a plant: anywhere around its middle will do.
        tall = slice(max(int(row - reach), 0), int(row + reach) + 1)
        wide = slice(max(int(column - reach), 0), int(column + reach) + 1)
        missed += not any((layer[tall, wide] == number).any() for layer in percept.id_layers)
    return _verdict(missed, len(clear), "lack an object that is there")


def _verdict(missed: int, looked: int, what: str) -> str:
    if looked < _FEWEST or missed <= _MISSES * looked:
        return ""
    return f"{missed} of {looked} pixels {what}"


def _cast(percept: Percept, pixels: Array, body: Body) -> Array:
    """(N, 3) first hits through pixels (N, 2); not a number where nothing was hit."""
    nothing = np.full(3, np.nan)
    if not len(pixels):
        return nothing[None][:0]
    hits = body.rays(percept.camera.position, percept.camera.rays(pixels))
    return np.array([nothing if hit is None else hit.array() for hit in hits])
