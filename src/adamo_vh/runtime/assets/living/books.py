"""Closed books without any print: in rows and in stacks."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache

import numpy as np

from adamo_vh.runtime.assets.asset import Collider, Material, Part
from adamo_vh.runtime.assets.kit import Mesh, box, merge
from adamo_vh.runtime.assets.living.joinery import upright_box

_COVERS = (
    (128, 48, 36),
    (176, 122, 52),
    (84, 92, 62),
    (104, 70, 50),
    (62, 52, 46),
    (158, 92, 62),
    (140, 116, 78),
    (88, 44, 40),
)
"""8 bit sRGB: muted, none of them blue or near white."""
_PAPER = (176, 158, 122)
_CELLS = len(_COVERS) + 1


@dataclass(frozen=True, slots=True, eq=False)
class Books:
    """Books in a piece of furniture: what is seen (see `bound`) and what collides."""

    mesh: Mesh
    colliders: tuple[Collider, ...]


def book_row(
    start: tuple[float, float, float], length: float, depth: float, tallest: float, seed: int
) -> Books:
    """Books standing side by side, their backs at -y.

    Args:
        start: Left front corner of the row on the board, metres.
        length: Of the row along x.
        depth: Of the deepest book.
        tallest: Height of the tallest book.
        seed: Of the variation.
    """
    rng = np.random.default_rng(seed)
    covers = np.concatenate([rng.permutation(len(_COVERS)) for _ in range(6)])
    meshes: list[Mesh] = []
    x = 0.0
    while x < length - 0.015:
        thick = min(float(rng.uniform(0.018, 0.042)), length - x)
        high = tallest * float(rng.uniform(0.78, 1.0))
        deep = depth * float(rng.uniform(0.86, 1.0))
        book = _book((deep, high, thick), int(covers[len(meshes)]))
        # Lying with its back to -x: stand it up and turn the back to the front.
        standing = book.turned("x", 90).turned("z", 90)
        low = standing.lower
        meshes.append(standing.moved(start[0] + x - low[0], start[1] - low[1], start[2] - low[2]))
        x += thick + 0.001
    row = merge(meshes)
    return Books(row, (upright_box(row),))


def book_stack(
    sizes: Sequence[tuple[float, float, float]], start: tuple[float, float, float], seed: int
) -> Books:
    """Books lying on each other, the largest first.

    Args:
        sizes: Width, depth and thickness of each, from below.
        start: Middle of the stack on what carries it, metres.
        seed: Of the variation.
    """
    rng = np.random.default_rng(seed)
    covers = rng.permutation(len(_COVERS))
    meshes, colliders, z = [], [], start[2]
    for size, cover in zip(sizes, covers, strict=False):
        turn = float(rng.uniform(-14, 14))
        book = _book(size, int(cover)).turned("z", turn).moved(start[0], start[1], z + size[2] / 2)
        half = np.deg2rad(turn) / 2
        meshes.append(book)
        colliders.append(
            Collider(
                "box",
                (size[0] / 2, size[1] / 2, size[2] / 2),
                (start[0], start[1], z + size[2] / 2),
                (float(np.cos(half)), 0.0, 0.0, float(np.sin(half))),
            )
        )
        z += size[2]
    return Books(merge(meshes), tuple(colliders))


def bound(rows: Sequence[Books]) -> Part:
    """All books of a piece of furniture as one part."""
    return merge(row.mesh for row in rows).part(_material())


def _book(size: tuple[float, float, float], cover: int) -> Mesh:
    """A book lying about the origin, its back at -x."""
    width, depth, thick = size
    board = 0.003
    lids = [box(width, depth, board).moved(z=s * (thick - board) / 2) for s in (-1, 1)]
    back = box(board, depth, thick).moved(x=-(width - board) / 2)
    pages = box(width - 0.009, depth - 0.010, thick - 2 * board).moved(x=-0.001)
    return merge([*(_tinted(m, cover) for m in (*lids, back)), _tinted(pages, len(_COVERS))])


def _tinted(mesh: Mesh, cell: int) -> Mesh:
    return mesh.textured(np.tile(((cell + 0.5) / _CELLS, 0.5), (len(mesh.vertices), 1)))


@cache
def _material() -> Material:
    """All covers and the paper side by side in one picture."""
    strip = np.repeat(np.array((*_COVERS, _PAPER), dtype=np.uint8), 8, axis=0)
    texture = np.repeat(strip[None], 8, axis=0)
    return Material("books", texture=texture, rgba=(1.0, 1.0, 1.0, 1.0), specular=0.08)
