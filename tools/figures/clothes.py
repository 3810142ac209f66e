"""The clothes: a top with sleeves and a neckline, trousers, shoes. Shapes only."""

from __future__ import annotations

import numpy as np
from tools.figures.shapes import (
    Point,
    Shape,
    both,
    chain,
    common,
    displaced,
    ellipsoid,
    grown,
    half_space,
    loft,
    minus,
    round_cone,
    slab,
    union,
)
from tools.figures.variant import Variant

from adamo_vh.geometry import Array
from adamo_vh.runtime.human.skeleton import INDEX, REST

SHOULDER, ELBOW, WRIST = (
    tuple(REST[INDEX[f"{name}_l"]].tolist()) for name in ("upper_arm", "forearm", "hand")
)


def _between(a: Point, b: Point, t: float) -> Point:
    x, y, z = (p + t * (q - p) for p, q in zip(a, b, strict=True))
    return (x, y, z)


def mix(variant: Variant, masculine: float, feminine: float) -> float:
    """A measure between those of two builds."""
    return masculine + variant.feminine * (feminine - masculine)


def torso(v: Variant) -> Shape:
    """The top without its sleeves, hem at 0.90 m."""
    g = v.girth
    man = [
        (0.80, -0.004, 0.104, 0.140),
        (0.885, -0.002, 0.124, 0.180), (0.93, -0.003, 0.121, 0.173), (1.00, 0.000, 0.112, 0.158),
        (1.08, 0.002, 0.108, 0.152), (1.16, 0.002, 0.112, 0.156), (1.24, 0.000, 0.119, 0.166),
        (1.31, -0.004, 0.118, 0.170), (1.37, -0.012, 0.096, 0.148), (1.42, -0.018, 0.072, 0.085),
        (1.46, -0.012, 0.055, 0.060),
    ]  # fmt: skip
    woman = [
        (0.80, -0.006, 0.104, 0.148),
        (0.885, -0.004, 0.124, 0.186), (0.93, -0.005, 0.119, 0.176), (1.00, -0.002, 0.104, 0.150),
        (1.08, 0.002, 0.094, 0.130), (1.16, 0.003, 0.096, 0.131), (1.24, 0.000, 0.102, 0.143),
        (1.31, -0.006, 0.098, 0.146), (1.37, -0.012, 0.086, 0.128), (1.42, -0.018, 0.066, 0.076),
        (1.46, -0.012, 0.048, 0.052),
    ]  # fmt: skip
    rows = []
    for (z, *a), (_, *b) in zip(man, woman, strict=True):
        x, depth, width = (mix(v, p, q) for p, q in zip(a, b, strict=True))
        rows.append((z, x, depth * g, width * g))
    body = loft(rows, rounding=0.012)
    bust = ellipsoid((0.069, 0.064, 1.264), (0.042, 0.055, 0.054))
    chest = ellipsoid((0.066, 0.062, 1.295), (0.040, 0.080, 0.060))
    front = union(0.05, body, both(0.045, bust) if v.feminine > 0.5 else both(0.06, chest))
    return union(0.04, front, grown(_seat(), 0.006))


def _seat() -> Shape:
    return both(0.03, ellipsoid((-0.056, 0.070, 0.900), (0.072, 0.078, 0.088)))


def sleeve(v: Variant) -> Shape:
    """The left sleeve, open at the wrist."""
    r = mix(v, 1.0, 0.87) * v.girth
    inward = mix(v, 0.014, 0.026)
    high = (SHOULDER[0], SHOULDER[1] - inward, SHOULDER[2] - 0.016)
    upper = _between(SHOULDER, ELBOW, 0.45)
    lower = _between(ELBOW, WRIST, 0.35)
    arm = chain(
        (high, upper, ELBOW, lower, WRIST),
        (0.055 * r, 0.051 * r, 0.045 * r, 0.044 * r, 0.038 * r),
        0.02,
    )
    collar = chain(
        ((-0.014, 0.03, 1.412), (-0.012, 0.10, 1.394), high),
        (0.044 * r, 0.043 * r, 0.053 * r),
        0.03,
    )
    start, end = _between(ELBOW, WRIST, 0.84), _between(ELBOW, WRIST, 0.97)
    cuff = round_cone(start, end, 0.0445 * r, 0.0415 * r)
    axis = np.subtract(WRIST, ELBOW)
    outward = (float(axis[0]), float(axis[1]), float(axis[2]))
    hollow = round_cone(_between(ELBOW, WRIST, 0.92), WRIST, 0.031 * r, 0.032 * r)
    cut = half_space(_between(ELBOW, WRIST, 0.965), outward)
    whole = union(0.006, union(0.03, arm, collar), cuff)
    return minus(0.003, common(0.004, displaced(whole, _arm_folds), cut), hollow)


def _arm_folds(p: Array) -> Array:
    """Folds across the sleeve: deeper at the elbow and above the cuff."""
    axis = np.subtract(WRIST, SHOULDER) / np.linalg.norm(np.subtract(WRIST, SHOULDER))
    along = (p - SHOULDER) @ axis
    phase = 2 * np.pi * along / 0.036 + 2.6 * np.sin(40 * p[:, 0] + 9 * along)
    where = np.exp(-(((along - 0.285) / 0.06) ** 2)) + 0.8 * np.exp(-(((along - 0.45) / 0.05) ** 2))
    where *= along < 0.49
    high = np.exp(-(((along - 0.07) / 0.05) ** 2))
    slow = np.sin(2 * np.pi * along / 0.045 + 30 * p[:, 0])
    return np.asarray(0.0019 * where * np.sin(phase) + 0.0011 * high * slow)


def _torso_folds(p: Array) -> Array:
    """Folds of the top: across above the hem, slanted below the arms."""
    x, y, z = np.moveaxis(p, 1, 0)
    side = np.abs(y)
    low = np.exp(-(((z - 0.985) / 0.045) ** 2))
    across = np.sin(2 * np.pi * (z + 0.25 * side) / 0.042 + 1.6 * np.sin(17 * y + 11 * x))
    arm = np.exp(-(((z - 1.24) / 0.06) ** 2)) * np.clip((side - 0.06) / 0.06, 0.0, 1.0)
    slanted = np.sin(2 * np.pi * (z - 0.9 * side) / 0.05 + 9 * x)
    low = low * np.clip(side / 0.05 + 0.35, 0, 1)
    return np.asarray(0.0026 * low * across + 0.0024 * arm * slanted)


def top(v: Variant) -> Shape:
    """The whole top, open at the neck and the wrists."""
    hem = common(0.006, grown(torso(v), 0.0035), slab(0.890, 0.938))
    body = common(0.005, displaced(torso(v), _torso_folds), slab(0.890, 2.0))
    body = union(0.006, body, hem)
    whole = union(0.035, body, both(0.0, sleeve(v)))
    return minus(0.004, whole, neck_hole(v), _hem_hole(v))


def _hem_hole(v: Variant) -> Shape:
    return common(0.004, grown(torso(v), -0.005), slab(0.80, 0.902))


def neck_hole(v: Variant) -> Shape:
    """Where the neck comes out: tilted, lower in front."""
    size = {"crew": 0.061, "roll": 0.058, "shirt": 0.060}[v.neckline] * mix(v, 1.04, 0.96)
    tube = round_cone((0.0, 0.0, 1.42), (0.012, 0.0, 1.56), size, size)
    return common(0.004, tube, half_space((-0.008, 0.0, 1.422), (-0.42, 0.0, -1.0)))


def collar(v: Variant) -> Shape:
    """What closes the neckline: a ribbed ring, a roll or a turned-down collar."""
    r = mix(v, 1.04, 0.96)
    if v.neckline == "roll":
        inner = chain(((-0.014, 0, 1.40), (-0.003, 0, 1.52)), (0.052 * r, 0.050 * r))
        outer = chain(
            ((-0.015, 0, 1.405), (-0.010, 0, 1.445), (-0.004, 0, 1.485)),
            (0.066 * r, 0.066 * r, 0.061 * r), 0.02,
        )  # fmt: skip
        roll = common(0.01, outer, half_space((0.0, 0, 1.487), (-0.22, 0, 1.0)))
        return minus(0.008, common(0.004, roll, half_space((0, 0, 1.405), (-0.42, 0, -1.0))), inner)
    if v.neckline == "shirt":
        return _shirt_collar(r)
    ring = _ring((-0.006, 0.0, 1.427), 0.064 * r, 0.060 * r, 0.0078, 0.40)
    return union(0.0, ring)


def _ring(center: Point, depth: float, width: float, thick: float, tilt: float) -> Shape:
    """An elliptic ring around the neck, lower in front by `tilt` metres a metre."""

    def distance(p: Array) -> Array:
        x, y, z = np.moveaxis(p - np.array(center), 1, 0)
        k = np.hypot(x / depth, y / width)
        radial = (k - 1.0) * (depth + width) / 2
        return np.asarray(np.hypot(radial, (z + tilt * x - 0.15 * np.abs(y)) * 0.85) - thick)

    return distance


def _shirt_collar(r: float) -> Shape:
    """A standing band with a turned-down leaf, parted in front."""

    def distance(p: Array) -> Array:
        x, y, z = np.moveaxis(p - np.array([-0.006, 0.0, 1.45]), 1, 0)
        height = z + 0.36 * x
        flare = np.clip(-height, 0, 0.05) * 0.62
        k = np.hypot(x / (0.066 * r), y / (0.063 * r))
        radial = (k - 1.0) * 0.064 * r - flare
        parted = 0.010 - np.abs(y) + np.clip(0.018 - height, 0, 0.1) * -0.42
        leaf = np.maximum(np.abs(radial) - 0.0042, np.maximum(height - 0.022, -0.026 - height))
        return np.asarray(np.maximum(leaf, np.where(x > 0, parted, -1.0)))

    return distance


def trousers(v: Variant) -> Shape:
    """Both legs, open at the ankles; the waist ends under the top."""
    r = mix(v, 1.0, 0.97) * v.girth
    hips = common(0.05, grown(torso(v), -0.009), slab(0.80, 0.965))
    leg = chain(
        (
            (0.000, 0.086, 0.89), (0.012, 0.092, 0.72), (0.014, 0.096, 0.50),
            (-0.006, 0.099, 0.36), (-0.019, 0.102, 0.05),
        ),
        (0.090 * r, 0.082 * r, 0.064 * r, 0.062 * r, 0.059 * r),
        0.02,
    )  # fmt: skip
    hollow = round_cone((-0.018, 0.102, 0.10), (-0.019, 0.102, 0.03), 0.047 * r, 0.052 * r)
    cut = slab(0.062, 2.0)
    left = minus(0.003, common(0.004, displaced(leg, _leg_folds), cut), hollow)
    crotch = ellipsoid((-0.006, 0.0, 0.845), (0.075, 0.035, 0.050))
    whole = union(0.05, hips, crotch, both(0.02, left))
    # Above the hem the trousers stay below the top.
    under = union(0.02, slab(-1.0, 0.872), grown(torso(v), -0.007))
    return common(0.008, whole, under)


def _leg_folds(p: Array) -> Array:
    """Folds across the leg: at the knee, the groin and above the shoe; a crease along the front."""
    x, y, z = np.moveaxis(p, 1, 0)
    around = np.arctan2(y - 0.097, x)
    phase = 2 * np.pi * z / 0.05 + 1.7 * np.sin(2 * around + 20 * z)
    where = 0.9 * np.exp(-(((z - 0.47) / 0.06) ** 2)) + np.exp(-(((z - 0.10) / 0.055) ** 2))
    where += 0.7 * np.exp(-(((z - 0.80) / 0.05) ** 2))
    return np.asarray(0.0026 * where * np.sin(phase))


def shoe_upper() -> Shape:
    """The left shoe above its sole."""
    front = ellipsoid((0.098, 0.107, 0.028), (0.094, 0.047, 0.043))
    heel = ellipsoid((-0.032, 0.099, 0.040), (0.045, 0.035, 0.048))
    instep = round_cone((-0.012, 0.100, 0.074), (0.085, 0.105, 0.038), 0.037, 0.030)
    ankle = round_cone((-0.022, 0.100, 0.06), (-0.020, 0.101, 0.096), 0.037, 0.035)
    whole = union(0.035, front, heel, instep, ankle)
    return common(0.004, whole, slab(0.012, 0.115))


def shoe_sole() -> Shape:
    """The left sole."""
    front = ellipsoid((0.098, 0.107, 0.012), (0.102, 0.053, 0.30))
    heel = ellipsoid((-0.030, 0.099, 0.012), (0.060, 0.042, 0.30))
    middle = ellipsoid((0.03, 0.102, 0.012), (0.09, 0.039, 0.30))

    def lifted(p: Array) -> Array:
        return np.asarray(p[:, 2] - 0.023 - 0.2 * np.clip(p[:, 0] - 0.14, 0, 1))

    return common(0.008, union(0.03, front, heel, middle), slab(0.0, 0.2), lifted)


def laces() -> Shape:
    """Four bars across the left instep."""
    upper = shoe_upper()
    heights = np.linspace(0.03, 0.13, 201)

    def on_shoe(x: float, y: float) -> Point:
        column = np.column_stack([np.full(201, x), np.full(201, y), heights])
        return x, y, float(heights[upper(column) < 0].max()) + 0.0012

    bars = []
    for x in (0.034, 0.050, 0.066, 0.082):
        points = [on_shoe(x + 0.001 * k, 0.104 + 0.006 * k) for k in (-3, -2, -1, 0, 1, 2, 3)]
        bars.append(chain(points, [0.0022, *[0.0030] * 5, 0.0022]))
    return union(0.0, *bars)
