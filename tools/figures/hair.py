"""Hair: a cap over the skull with a hairline, locks and strands."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from tools.figures.face import skull
from tools.figures.shapes import (
    Shape,
    both,
    chain,
    common,
    displaced,
    ellipsoid,
    grown,
    half_space,
    mirrored,
    union,
)
from tools.figures.variant import Variant

from adamo_vh.geometry import Array

_SHORT = ((0, 1.668), (25, 1.667), (42, 1.655), (54, 1.628), (64, 1.600), (72, 1.583), (84, 1.583),
          (92, 1.618), (112, 1.612), (124, 1.560), (145, 1.520), (180, 1.512))  # fmt: skip
_LONG = ((0, 1.684), (25, 1.676), (42, 1.655), (56, 1.615), (66, 1.57), (78, 1.540), (180, 1.50))


def _above(line: Sequence[tuple[float, float]]) -> Shape:
    """Everything above a hairline given as (degrees from the front, height) pairs."""
    from scipy.interpolate import PchipInterpolator

    curve = PchipInterpolator([a for a, _ in line], [z for _, z in line])

    def distance(p: Array) -> Array:
        angle = np.degrees(np.arctan2(np.abs(p[:, 1]), p[:, 0]))
        return np.asarray((curve(angle) - p[:, 2]) * 0.6)

    return distance


def hairline(v: Variant) -> Shape:
    """Where hair grows; also used to paint the scalp."""
    return _above(_SHORT if v.hair_style in ("short", "curls") else _LONG)


def strand(v: Variant, p: Array) -> Array:
    """(N,) coordinate across the strands, in strands."""
    x, y, z = np.moveaxis(p, 1, 0)
    if v.hair_style == "short":
        return np.asarray((y + 0.35 * x + 0.25 * z) / 0.011)
    if v.hair_style == "curls":
        return np.asarray((x + y + z) / 0.012)
    return np.asarray(np.arctan2(y, x + 0.012) / np.radians(5.0))


def _strands(v: Variant, depth_m: float) -> Shape:
    edge = hairline(v)

    def field(p: Array) -> Array:
        s = strand(v, p)
        wave = np.sin(2 * np.pi * s) + 0.6 * np.sin(2 * np.pi * s * 0.43 + 30 * p[:, 2] + 1.0)
        # The edge stays a clean line.
        return depth_m * wave * np.clip(-edge(p) / 0.018, 0.35, 1.0)

    return field


def hair(v: Variant) -> Shape:
    """The whole hair."""
    return {"short": _short, "bob": _bob, "curls": _curls}[v.hair_style](v)


def _short(v: Variant) -> Shape:
    cap = common(0.008, grown(skull(v), 0.009), _above(_SHORT))
    crown = common(
        0.012,
        ellipsoid((0.000, 0.0, 1.648), (0.094, 0.079, 0.078)),
        _above(((0, 1.674), (35, 1.668), (55, 1.645), (90, 1.640), (180, 1.60))),
    )
    tuft = union(
        0.016,
        chain(
            ((0.058, -0.040, 1.680), (0.070, 0.000, 1.691), (0.054, 0.038, 1.692)),
            (0.016, 0.021, 0.018),
            0.01,
        ),
        chain(
            ((0.030, -0.045, 1.692), (0.042, 0.000, 1.706), (0.024, 0.040, 1.700)),
            (0.016, 0.017, 0.015),
            0.01,
        ),
        chain(
            ((-0.01, -0.045, 1.694), (0.000, 0.000, 1.707), (-0.01, 0.040, 1.700)),
            (0.014, 0.014, 0.014),
            0.01,
        ),
    )
    return displaced(union(0.014, cap, crown, tuft), _strands(v, 0.0011))


def _bob(v: Variant) -> Shape:
    cap = common(0.01, grown(skull(v), 0.013), _above(_LONG))
    # Parted on the right: one sweep over the forehead to the left, a short one to the right.
    left = chain(
        ((0.042, -0.030, 1.703), (0.068, 0.000, 1.692), (0.069, 0.036, 1.668),
         (0.051, 0.063, 1.632), (0.035, 0.076, 1.590), (0.030, 0.077, 1.550),
         (0.034, 0.066, 1.480)),
        (0.010, 0.014, 0.016, 0.016, 0.017, 0.018, 0.014), 0.02,
    )  # fmt: skip
    right = chain(
        ((0.042, -0.032, 1.703), (0.060, -0.050, 1.680), (0.048, -0.068, 1.640),
         (0.034, -0.078, 1.594), (0.030, -0.077, 1.550), (0.034, -0.066, 1.480)),
        (0.010, 0.013, 0.015, 0.017, 0.018, 0.014), 0.02,
    )  # fmt: skip
    sides = mirrored(
        chain(
            ((0.008, 0.080, 1.62), (0.008, 0.080, 1.55), (0.010, 0.068, 1.48)),
            (0.016, 0.022, 0.018),
            0.02,
        )
    )
    behind = both(0.03, chain(
        ((-0.010, 0.080, 1.620), (-0.020, 0.080, 1.560), (-0.014, 0.068, 1.480)),
        (0.018, 0.024, 0.016), 0.02,
    ))  # fmt: skip
    back = chain(
        ((-0.060, 0.0, 1.640), (-0.066, 0.0, 1.560), (-0.056, 0.0, 1.475)),
        (0.055, 0.052, 0.036),
        0.03,
    )
    back_sides = mirrored(
        chain(
            ((-0.05, 0.045, 1.62), (-0.052, 0.050, 1.555), (-0.044, 0.045, 1.475)),
            (0.045, 0.040, 0.028),
            0.03,
        )
    )
    whole = union(0.022, cap, left, right, sides, behind, back, back_sides)
    straight_cut = half_space((0.0, 0.0, 1.502), (-0.12, 0.0, -1.0))
    return common(0.008, displaced(whole, _strands(v, 0.0011)), straight_cut)


def _curls(v: Variant) -> Shape:
    line = (
        (0, 1.668),
        (30, 1.664),
        (50, 1.640),
        (64, 1.604),
        (80, 1.590),
        (100, 1.585),
        (125, 1.550),
        (180, 1.515),
    )
    cap = common(
        0.02,
        union(0.02, grown(skull(v), 0.012), ellipsoid((-0.024, 0.0, 1.650), (0.118, 0.112, 0.098))),
        _above(line),
    )

    edge = _above(line)

    def curls(p: Array) -> Array:
        q = p * (2 * np.pi / 0.034)
        bumps = np.sin(q[:, 0] + 1.3 * np.sin(q[:, 1] * 0.6)) * np.sin(
            q[:, 1] + 1.1 * np.sin(q[:, 2] * 0.7)
        ) + np.sin(q[:, 2] + 1.2 * np.sin(q[:, 0] * 0.5)) * np.sin(q[:, 1] * 0.9 + 0.5)
        return np.asarray(0.0042 * bumps * np.clip(-edge(p) / 0.02, 0.25, 1.0))

    return displaced(cap, curls)
