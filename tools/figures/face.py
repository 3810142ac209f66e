"""The head: skull, face, ears and neck as one shape; eyes, lids, lashes and brows beside it."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from tools.figures.clothes import mix
from tools.figures.meshing import Mesh, merged, tube
from tools.figures.shapes import (
    Shape,
    chain,
    common,
    ellipsoid,
    half_space,
    minus,
    mirrored,
    round_cone,
    turned,
    union,
)
from tools.figures.variant import Variant

from adamo_vh.geometry import Array
from adamo_vh.runtime.human.skeleton import INDEX, REST

EYE_RADIUS = 0.0182
PUPIL_DISTANCE_HALF = 0.0335
EYE = np.array([REST[INDEX["eyelids"]][0], PUPIL_DISTANCE_HALF, REST[INDEX["eyelids"]][2]])
"""Centre of the left eyeball: on the axis of the eyelids."""
MOUTH_Z = 1.5295


def opening(v: Variant) -> tuple[float, float, float]:
    """Half width of the eye's opening, its height above and below the corners, metres."""
    return mix(v, 0.0158, 0.0166), mix(v, 0.0064, 0.0080), mix(v, 0.0050, 0.0054)


def skull(v: Variant) -> Shape:
    """The head without face and neck, what the hair lies on."""
    return ellipsoid((-0.010, 0.0, 1.622), (0.096, mix(v, 0.0775, 0.0755), 0.088))


def head(v: Variant) -> Shape:
    """The head and the neck with eye sockets."""
    f = v.feminine
    face = ellipsoid((0.026, 0.0, 1.568), (0.060, mix(v, 0.0615, 0.0590), 0.086))
    jaw = mirrored(
        chain(
            (
                (0.000, mix(v, 0.048, 0.046), 1.556),
                (0.022, mix(v, 0.0425, 0.0375), 1.521),
                (0.066, 0.012, 1.492),
            ),
            (0.020, mix(v, 0.0150, 0.0135), mix(v, 0.0165, 0.014)),
            0.015,
        )
    )
    chin = ellipsoid((0.073, 0.0, mix(v, 1.492, 1.494)), (0.019, mix(v, 0.021, 0.016), 0.018))
    cheeks = mirrored(ellipsoid((0.052, 0.036, 1.565), (0.029, 0.025, 0.024)))
    forehead = ellipsoid((0.030, 0.0, 1.640), (0.056, 0.060, 0.052))
    brow = mirrored(
        chain(
            ((0.080, 0.008, 1.624), (0.076, 0.030, 1.629), (0.058, 0.052, 1.622)),
            (mix(v, 0.011, 0.0085), mix(v, 0.0105, 0.0085), 0.010),
            0.01,
        )
    )
    muzzle = ellipsoid((0.070, 0.0, 1.531), (0.024, 0.030, 0.026))
    whole = union(0.030, skull(v), face, forehead)
    whole = union(0.024, whole, jaw, cheeks)
    whole = union(0.020, whole, chin, muzzle, brow)
    socket = mirrored(ellipsoid((0.096, 0.034, 1.604), (0.020, 0.021, 0.0135)))
    whole = minus(0.016, whole, socket)
    whole = union(0.010, whole, nose(v))
    whole = union(0.004, whole, mouth(v))
    whole = union(0.004, whole, mirrored(_ear()))
    whole = _with_eyes(v, whole)
    nape = round_cone((-0.026, 0.0, 1.40), (-0.030, 0.0, 1.53), 0.032, 0.036)
    throat = round_cone(
        (-0.010, 0.0, 1.36), (0.000, 0.0, 1.53), mix(v, 0.054, 0.045), mix(v, 0.050, 0.042)
    )
    apple = ellipsoid((0.040, 0.0, 1.462), (0.012, 0.010, 0.014))
    neck = union(0.03, throat, nape)
    if f < 0.5:
        neck = union(0.02, neck, apple)
    shoulders = ellipsoid((-0.014, 0.0, 1.372), (0.056, 0.095, 0.036))
    return union(0.022, whole, union(0.035, neck, shoulders))


def nose(v: Variant) -> Shape:
    """Bridge, tip and wings."""
    n = mix(v, 1.0, 0.80)
    bridge = chain(
        ((0.082, 0.0, 1.616), (0.0875, 0.0, 1.600), (0.098, 0.0, 1.572)),
        (0.0085 * n, 0.0075 * n, 0.0085 * n),
        0.01,
    )
    tip = ellipsoid(
        (0.1020 + 0.002 * (1 - v.feminine), 0.0, 1.5635), (0.0112 * n, 0.0105 * n, 0.0095 * n)
    )
    wings = mirrored(ellipsoid((0.0925, 0.0112 * n, 1.5600), (0.0095, 0.0066 * n, 0.0066)))
    holes = mirrored(ellipsoid((0.0985, 0.0062 * n, 1.5535), (0.0050, 0.0032, 0.0035)))
    return minus(0.003, union(0.008, bridge, tip, wings), holes)


def mouth(v: Variant) -> Shape:
    """Closed lips with the corners a little up."""
    full = mix(v, 0.85, 1.08)
    z = MOUTH_Z
    upper = mirrored(
        chain(
            (
                (0.0935, 0.000, z + 0.0040),
                (0.0930, 0.007, z + 0.0044),
                (0.0800, 0.0240, z + 0.0045),
            ),
            (0.0046 * full, 0.0048 * full, 0.0022),
            0.004,
        )
    )
    lower = mirrored(
        chain(
            (
                (0.0925, 0.000, z - 0.0052),
                (0.0905, 0.009, z - 0.0046),
                (0.0805, 0.0230, z + 0.0030),
            ),
            (0.0058 * full, 0.0054 * full, 0.0022),
            0.004,
        )
    )
    line = mirrored(
        chain(
            (
                (0.1010, 0.000, z - 0.0002),
                (0.0985, 0.009, z - 0.0002),
                (0.0920, 0.018, z + 0.0014),
                (0.0840, 0.0262, z + 0.0052),
            ),
            (0.0016, 0.0016, 0.0014, 0.0012),
        )
    )
    return minus(0.003, union(0.004, upper, lower), line)


def _ear() -> Shape:
    turn = turned(roll=8.0, pitch=-14.0, yaw=-22.0)
    outer = ellipsoid((-0.010, 0.0815, 1.595), (0.018, 0.0075, 0.030), turn)
    hollow = ellipsoid((-0.006, 0.0885, 1.599), (0.0105, 0.0060, 0.0205), turn)
    lobe = ellipsoid((-0.004, 0.0780, 1.570), (0.0095, 0.006, 0.0105))
    inner = ellipsoid((0.002, 0.080, 1.593), (0.006, 0.005, 0.0075))
    return union(0.004, minus(0.005, union(0.008, outer, lobe), hollow), inner)


def _with_eyes(v: Variant, whole: Shape) -> Shape:
    """Lids around the eyeballs, cut open like an almond."""
    x, y, z = (float(c) for c in EYE)
    lids = mirrored(ellipsoid((x, y, z), (EYE_RADIUS + 0.0034,) * 3))
    cavity = mirrored(ellipsoid((x, y, z), (EYE_RADIUS + 0.0004,) * 3))
    cut = mirrored(common(0.0, _almond(v), half_space((x - 0.002, 0, 0), (-1.0, 0.0, 0.0))))
    return minus(0.0012, union(0.009, whole, lids), cavity, cut)


def _corner_frame(v: Variant, p: Array) -> tuple[Array, Array]:
    """Coordinates along the line between the corners of the left eye and above it."""
    tilt = np.radians(mix(v, 2.0, 5.0))
    y, z = p[:, 1] - EYE[1], p[:, 2] - (EYE[2] - 0.0015)
    return y * np.cos(tilt) + z * np.sin(tilt), z * np.cos(tilt) - y * np.sin(tilt)


def _almond(v: Variant) -> Shape:
    half, above, below = opening(v)
    upper, lower = ((half**2 + h**2) / (2 * h) for h in (above, below))

    def distance(p: Array) -> Array:
        s, t = _corner_frame(v, p)
        return np.maximum(
            np.hypot(s, t - (above - upper)) - upper, np.hypot(s, t + (below - lower)) - lower
        )

    return distance


def lid_edge(v: Variant, count: int, height: float, out: float, reach: float = 1.0) -> Array:
    """(count, 3) points on the left eye's upper edge (height 1) or lower edge (height -1)."""
    half, above, below = opening(v)
    h = above if height > 0 else below
    radius = (half**2 + h**2) / (2 * h)
    s = np.linspace(-half, half * reach, count)
    t = np.sqrt(np.maximum(radius**2 - s**2, 0.0)) - radius + h
    t = t * np.sign(height)
    tilt = np.radians(mix(v, 2.0, 5.0))
    y = s * np.cos(tilt) - t * np.sin(tilt)
    z = s * np.sin(tilt) + t * np.cos(tilt) - 0.0015
    x = np.sqrt(np.maximum((EYE_RADIUS + out) ** 2 - y**2 - z**2, 1e-6))
    return np.asarray(EYE + np.stack([x, y, z], axis=1))


def _both_sides(left: Mesh) -> Mesh:
    return merged(left, Mesh(left.vertices * [1, -1, 1], left.faces[:, ::-1]))


def lashes(v: Variant) -> Mesh:
    """A dark line on the edge of the upper lids, thicker towards the outer corner."""
    path = lid_edge(v, 12, 1.0, 0.0030, reach=1.12)
    t = np.linspace(0.0, 1.0, len(path))
    radii = mix(v, 0.0007, 0.00125) * (0.55 + 0.65 * t) * np.clip(np.minimum(t, 1 - t) * 9, 0.05, 1)
    return _both_sides(tube(path, radii, sides=4))


def lids(rows: int = 6, columns: int = 11) -> Mesh:
    """The movable upper lids, tucked away when open; they turn about the joint `eyelids`."""
    elevation = np.radians(np.linspace(19.0, 100.0, rows))
    side = np.radians(np.linspace(-82.0, 82.0, columns))
    e, s = np.meshgrid(elevation, side, indexing="ij")
    radius = EYE_RADIUS + 0.0011
    points = EYE + radius * np.stack(
        [np.cos(e) * np.cos(s), np.sin(s), np.sin(e) * np.cos(s)], axis=-1
    ).reshape(-1, 3)
    return _both_sides(Mesh(points, _grid(rows, columns)))


def eyeballs(rings: int = 8, columns: int = 16) -> tuple[Mesh, Array]:
    """The front of both eyeballs and their (N, 2) texture coordinates."""
    angle = np.radians(np.linspace(1.0, 88.0, rings))
    around = np.linspace(0.0, 2 * np.pi, columns, endpoint=False)
    a, r = np.meshgrid(angle, around, indexing="ij")
    disc = np.stack([np.sin(a) * np.cos(r), np.sin(a) * np.sin(r)], axis=-1).reshape(-1, 2)
    points = EYE + EYE_RADIUS * np.column_stack([np.cos(a).ravel(), disc])
    ring = np.arange(columns)
    faces = []
    for i in range(rings - 1):
        p, q = i * columns + ring, i * columns + np.roll(ring, -1)
        faces += [np.stack([p, p + columns, q + columns], 1), np.stack([p, q + columns, q], 1)]
    faces.append(np.stack([np.zeros(columns - 2, int), ring[1:-1], ring[2:]], 1))
    mesh = _both_sides(Mesh(points, np.concatenate(faces)))
    # A slight turn inwards, so that both look at the same place.
    shift = np.array([-0.022, 0.0])
    return mesh, np.concatenate([0.5 + disc / 2 - shift, 0.5 + disc / 2 * [-1, 1] + shift])


def _grid(rows: int, columns: int) -> NDArray[np.int64]:
    """(M, 3) triangles of a grid of points."""
    i = np.arange(rows * columns).reshape(rows, columns)
    a, b, c, d = i[:-1, :-1], i[:-1, 1:], i[1:, 1:], i[1:, :-1]
    return np.concatenate([np.stack([a, b, c], -1), np.stack([a, c, d], -1)]).reshape(-1, 3)


def brows(v: Variant) -> Shape:
    """The left brow, to be laid on the face."""
    r = mix(v, 0.0036, 0.0029)
    high = mix(v, 0.0, 0.0025)
    t = np.linspace(0.0, 1.0, 9)
    y = 0.0130 + 0.0405 * t
    z = 1.6290 + (0.0052 + high) * np.sin(np.pi * np.clip(t * 0.82, 0, 1)) ** 0.9 - 0.0040 * t**2.5
    thickness = r * (0.85 + 0.35 * t - 1.0 * t**2.2)
    points = [(float(a), float(b), float(c)) for a, b, c in zip(brow_depth(y), y, z, strict=True)]
    return chain(points, [float(a) for a in thickness], 0.001)


def brow_depth(y: Array) -> Array:
    """(N,) how far in front a brow lies, from how far to the side."""
    return np.interp(y, [0.0125, 0.025, 0.040, 0.052], [0.0880, 0.0860, 0.0790, 0.0660])
