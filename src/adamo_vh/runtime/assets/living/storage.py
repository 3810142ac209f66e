"""The tall shelf and the sideboard."""

from __future__ import annotations

from adamo_vh.runtime.assets.asset import Asset, Looks, Surface
from adamo_vh.runtime.assets.kit import Mesh, cylinder, merge
from adamo_vh.runtime.assets.living.books import Books, book_row, book_stack, bound
from adamo_vh.runtime.assets.living.joinery import (
    BLACK_METAL,
    BRASS_METAL,
    Board,
    furniture,
    oak,
    solids,
    timber,
    walnut,
)

SHELF_LEVELS = {"lower": 0.97, "middle": 1.35, "top": 1.95}
"""Heights in metres of what the tall shelf carries."""
_THIN = 0.018


def tall_shelf() -> Asset:
    """Oak shelf, 1.20 x 0.40 m, three open levels above a cabinet; open at -y."""
    wide, deep, top = 1.20, 0.40, SHELF_LEVELS["top"]
    side = [
        Board((0.020, deep, top - _THIN), (s * (wide / 2 - 0.010), 0.0, (top - _THIN) / 2), "z")
        for s in (-1, 1)
    ]
    lower, middle = (
        Board((wide - 0.040, deep - 0.012, _THIN), (0.0, -0.006, SHELF_LEVELS[name] - _THIN / 2))
        for name in ("lower", "middle")
    )
    lid = Board((wide, deep, _THIN), (0.0, 0.0, top - _THIN / 2))
    back = Board((wide - 0.040, 0.012, top - _THIN), (0.0, deep / 2 - 0.006, (top - _THIN) / 2))
    case = Board((wide - 0.040, deep - 0.050, 0.882), (0.0, 0.013, 0.511))
    plinth = Board((wide - 0.040, 0.018, 0.070), (0.0, -deep / 2 + 0.045, 0.035))
    doors = [
        Board((0.572, 0.018, 0.872), (s * 0.2895, -deep / 2 + 0.019, 0.511), "z", collides=False)
        for s in (-1, 1)
    ]
    handles = merge(_bar(s * 0.045, -deep / 2 + 0.006, 0.70) for s in (-1, 1))
    books = _shelf_books()
    return furniture(
        "TallShelf",
        (1.20, 0.40, 2.008),
        [
            timber((*side, lower, middle, lid, *doors), oak()),
            timber((back, case, plinth), walnut()),
            handles.part(BLACK_METAL),
            bound(books),
        ],
        (
            *solids((*side, lower, middle, lid, back, case, plinth)),
            *(collider for row in books for collider in row.colliders),
        ),
        tuple(
            Surface(name, (0.0, -0.006, z), (wide / 2 - 0.020, deep / 2 - 0.012))
            for name, z in SHELF_LEVELS.items()
        ),
        looks=Looks("tall oak shelf with books", ("brown",), "shelf"),
    )


def _shelf_books() -> list[Books]:
    """Books at the ends and far back, so that the front stays free for other things."""
    return [
        book_row((-0.575, 0.020, 0.97), 0.36, 0.16, 0.25, seed=1),
        book_row((0.300, 0.020, 0.97), 0.27, 0.16, 0.27, seed=4),
        book_row((0.385, 0.000, 1.35), 0.19, 0.17, 0.29, seed=7),
        book_stack(((0.25, 0.17, 0.032), (0.22, 0.16, 0.026)), (-0.40, 0.09, 1.95), seed=2),
    ]


def sideboard() -> Asset:
    """Walnut sideboard with oak fronts, 1.90 x 0.50 m, its top at 0.58 m; front at -y."""
    top = Board((1.90, 0.50, 0.026), (0.0, 0.0, 0.567), "x", 0.004)
    case = Board((1.86, 0.450, 0.414), (0.0, 0.015, 0.347))
    legs = [
        Board((0.040, 0.040, 0.140), (sx * 0.86, sy * 0.18, 0.070), "z")
        for sx in (-1, 1)
        for sy in (-1, 1)
    ]
    doors = [
        Board((0.600, 0.018, 0.392), (s * 0.618, -0.219, 0.347), "x", collides=False)
        for s in (-1, 1)
    ]
    drawers = [
        Board((0.624, 0.018, 0.127), (0.0, -0.219, z), "x", collides=False)
        for z in (0.2145, 0.347, 0.4795)
    ]
    knobs = [_knob(s * 0.350, -0.236, 0.36) for s in (-1, 1)]
    knobs += [_knob(0.0, -0.236, z) for z in (0.2145, 0.347, 0.4795)]
    stack = book_stack(
        ((0.24, 0.17, 0.030), (0.21, 0.15, 0.022), (0.18, 0.13, 0.020)), (-0.76, 0.08, 0.58), seed=5
    )
    return furniture(
        "Sideboard",
        (1.90, 0.50, 0.652),
        [
            timber((top, case, *legs), walnut()),
            timber((*doors, *drawers), oak()),
            merge(knobs).part(BRASS_METAL),
            bound([stack]),
        ],
        (*solids((top, case, *legs)), *stack.colliders),
        (Surface("", (0.0, 0.0, 0.58), (0.95, 0.25)),),
        looks=Looks("walnut sideboard", ("brown",), "sideboard"),
    )


def _bar(x: float, y: float, z: float) -> Mesh:
    """Handle of a door."""
    return cylinder(0.006, 0.16, segments=12).moved(x, y, z)


def _knob(x: float, y: float, z: float) -> Mesh:
    return cylinder(0.014, 0.022, bevel=0.004, segments=16).turned("x", 90).moved(x, y, z)
