"""Pictures for the figure: the painted head, the eye, palettes whose rows are light and shade."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from tools.figures.clothes import mix
from tools.figures.face import MOUTH_Z
from tools.figures.hair import hairline
from tools.figures.meshing import daylight
from tools.figures.shapes import Shape
from tools.figures.variant import Colour, Variant

from adamo_vh.geometry import Array

Picture = NDArray[np.uint8]

HEAD_PX = 640
HEAD_LOW_M, HEAD_HIGH_M = 1.34, 1.735
_FRONT = 1.6
"""How much more of the picture the face gets than the back of the head."""
_PROBES = 128
"""Texels at whose places the surface and its shade are looked up, each way."""
EYE_PX = 128


def head_uv(points: Array) -> Array:
    """(N, 2) place on the head's picture: unrolled around the vertical, wider in front."""
    angle = np.arctan2(points[:, 1], points[:, 0]) / np.pi
    u = 0.5 + 0.5 * np.tanh(_FRONT * angle) / np.tanh(_FRONT)
    return np.column_stack([u, (points[:, 2] - HEAD_LOW_M) / (HEAD_HIGH_M - HEAD_LOW_M)])


def _head_places(surface: Shape, around: Shape) -> tuple[Array, Array]:
    """For each texel the (H, W, 3) place on the surface and how open it is (H, W)."""
    from scipy.ndimage import gaussian_filter, zoom

    u = (np.arange(_PROBES) + 0.5) / _PROBES
    angle = np.pi * np.arctanh((2 * u - 1) * np.tanh(_FRONT)) / _FRONT
    z = HEAD_HIGH_M - (HEAD_HIGH_M - HEAD_LOW_M) * u
    a, height = np.meshgrid(angle, z, indexing="xy")
    outward = np.stack([np.cos(a), np.sin(a), np.zeros_like(a)], -1).reshape(-1, 3)
    foot = np.column_stack([np.zeros(_PROBES**2), np.zeros(_PROBES**2), height.ravel()])
    radius = np.full(len(foot), 0.14)
    for _ in range(48):
        radius -= 0.8 * surface(foot + radius[:, None] * outward)
        radius = np.clip(radius, 0.0, 0.16)
    points = foot + radius[:, None] * outward
    step = 1e-3
    slope = np.stack(
        [surface(points + step * e) - surface(points - step * e) for e in np.eye(3)], axis=1
    )
    normals = slope / np.maximum(np.linalg.norm(slope, axis=1, keepdims=True), 1e-9)
    light = daylight(points + 0.001 * normals, normals, around)
    scale = HEAD_PX / _PROBES
    shape = (_PROBES, _PROBES)
    fine = [
        zoom(points[:, i].reshape(shape), scale, order=1, mode="nearest", grid_mode=True)
        for i in range(3)
    ]
    light = zoom(
        gaussian_filter(light.reshape(shape), 0.7), scale, order=1, mode="nearest", grid_mode=True
    )
    return np.stack(fine, axis=-1), light


def _spot(p: Array, center: tuple[float, float, float], radius: float) -> Array:
    """(H, W) soft spot on both sides of the face."""
    q = np.stack([p[..., 0], np.abs(p[..., 1]), p[..., 2]], axis=-1) - np.array(center)
    return np.asarray(np.exp(-np.einsum("...i,...i->...", q, q) / radius**2))


def _soft(distance: Array, width: float) -> Array:
    """1 inside, 0 outside, soft over a width in metres."""
    return np.clip(0.5 - distance / width, 0.0, 1.0)


def lips_mask(v: Variant, p: Array) -> Array:
    """(H, W) how much of each texel is lip."""
    y, z = np.abs(p[..., 1]), p[..., 2] - MOUTH_Z
    full = mix(v, 0.85, 1.08)
    t = np.clip(y / 0.0258, 0.0, 1.0)
    bow = 0.0016 * np.exp(-((y / 0.0035) ** 2))
    top = (0.0080 * full) * (1 - t**2.0) + 0.0055 * t**1.5 - bow
    bottom = -(0.0100 * full) * (1 - t**2.2) + 0.0046 * t**1.5
    inside = np.maximum(np.maximum(z - top, bottom - z), y - 0.0258)
    return _soft(inside, 0.0016) * (p[..., 0] > 0.05)


def head_picture(v: Variant, surface: Shape, around: Shape) -> Picture:
    """Paint skin, blush, lips, lids, stubble and scalp on the unrolled head."""
    p, light = _head_places(surface, around)
    colour = np.broadcast_to(np.array(v.skin) / 255.0, (*light.shape, 3)).copy()

    def tint(target: Array, amount: Array) -> None:
        colour[:] += (target - colour) * np.clip(amount, 0, 1)[..., None]

    skin, lips, hair = (np.array(c) / 255.0 for c in (v.skin, v.lips, v.hair))
    rosy = skin * 0.55 + lips * 0.45
    tint(rosy, v.blush * 0.9 * _spot(p, (0.072, 0.042, 1.562), 0.021))
    tint(rosy, v.blush * 0.7 * _spot(p, (0.104, 0.0, 1.563), 0.012))
    tint(rosy, v.blush * 0.8 * _spot(p, (-0.010, 0.086, 1.594), 0.030))
    tint(
        skin * 0.72,
        0.42 * _spot(p, (0.080, 0.034, 1.6165), 0.0125)
        + 0.25 * _spot(p, (0.083, 0.034, 1.590), 0.012),
    )
    if v.feminine > 0.5:
        tint(lips * 0.75, 0.35 * _spot(p, (0.080, 0.036, 1.616), 0.010))
    if v.stubble:
        tint(skin * 0.45 + hair * 0.55, v.stubble * _beard(p))
    scalp = _soft(hairline(v)(p.reshape(-1, 3)).reshape(light.shape) - 0.001, 0.010)
    tint(hair, scalp)
    tint(lips, 0.8 * lips_mask(v, p))
    y, z = np.abs(p[..., 1]), p[..., 2] - MOUTH_Z
    line = np.abs(z - 0.0052 * np.clip(y / 0.0262, 0, 1) ** 2) - 0.0004
    tint(lips * 0.42, 0.85 * _soft(np.maximum(line, y - 0.0258), 0.0012) * (p[..., 0] > 0.05))
    nostril = _spot(p, (0.0985, 0.0062 * mix(v, 1, 0.80), 1.5535), 0.0042)
    tint(skin * 0.35, 0.8 * nostril * (p[..., 2] < 1.5570))
    shade = 0.60 + 0.40 * light
    colour *= shade[..., None] ** np.array([0.75, 1.0, 1.1])
    return _bytes(colour)


def _beard(p: Array) -> Array:
    """(H, W) where a short beard grows."""
    x, y, z = p[..., 0], np.abs(p[..., 1]), p[..., 2]
    edge = 1.530 + 0.055 * np.clip((y - 0.028) / 0.045, 0, 1) ** 1.3
    cheek = np.clip((edge - z) / 0.010, 0, 1) * (x > -0.004)
    moustache = (
        np.exp(-(((z - 1.5445) / 0.0055) ** 2)) * np.clip((0.034 - y) / 0.008, 0, 1) * (x > 0.05)
    )
    throat = np.clip((z - 1.470) / 0.018, 0, 1)
    front = np.clip((x + 0.002) / 0.012, 0, 1)
    return np.maximum(cheek * throat * front, 0.9 * moustache)


def eye_picture(v: Variant) -> Picture:
    """A front view of the eyeball: white, iris, pupil, and a glint."""
    n = EYE_PX
    u = (np.arange(n) + 0.5) / n * 2 - 1
    x, y = np.meshgrid(u, -u)
    r = np.hypot(x, y)
    angle = np.arctan2(y, x)
    colour = np.empty((n, n, 3))
    colour[:] = np.array([0.90, 0.88, 0.85])
    colour *= (1 - 0.30 * np.clip(r - 0.3, 0, 1) - 0.32 * np.clip((y - 0.12) / 0.5, 0, 1))[
        ..., None
    ]
    iris = np.array(v.iris) / 255.0
    rays = 1 + 0.16 * np.sin(angle * 23) * np.sin(angle * 7 + 1) + 0.55 * np.clip(-y, 0, 1)
    size = 0.415
    disc = np.clip((size - r) / 0.03, 0, 1)
    inner = iris * (0.75 + 0.6 * np.clip(1 - r / size, 0, 1))[..., None] * rays[..., None]
    inner *= (
        1 - 0.55 * np.clip((r - 0.32) / 0.09, 0, 1) - 0.25 * np.clip((y + 0.05) / 0.35, 0, 1)
    )[..., None]
    colour += (inner - colour) * disc[..., None]
    colour *= (1 - 0.95 * np.clip((0.18 - r) / 0.03, 0, 1))[..., None]
    glint = np.clip((0.075 - np.hypot(x - 0.13, y - 0.15)) / 0.03, 0, 1)
    colour += (0.97 - colour) * glint[..., None]
    return _bytes(colour)


def palette(colours: list[Colour], warmth: float = 0.9, darkest: float = 0.55) -> Picture:
    """One column of 16 texels for each colour, lighter upward: v is how open the place is."""
    light = np.linspace(1.0, 0.0, 64)[:, None, None]
    shade = darkest + (1 - darkest) * light
    columns = np.repeat(np.array(colours, float) / 255.0, 16, axis=0)[None]
    return _bytes(columns * shade ** np.array([warmth, 1.0, 1.05]))


def column_u(index: int, count: int) -> float:
    """Texture coordinate of a palette's column."""
    return (index + 0.5) / count


def strands_picture(v: Variant, seed: int = 3) -> Picture:
    """Streaks of hair from side to side, lighter upward."""
    rng = np.random.default_rng(seed)
    tone = rng.normal(0.0, 1.0, 256)
    tone = np.convolve(np.tile(tone, 3), [0.25, 0.5, 0.25], "same")[256:512]
    light = np.linspace(1.0, 0.0, 64)[:, None, None]
    base = np.array(v.hair) / 255.0
    streaks = base * (1 + 0.17 * tone[None, :, None]) * (0.42 + 0.72 * light)
    return _bytes(streaks + 0.03 * light * tone[None, :, None] * base)


def _bytes(colour: Array) -> Picture:
    return np.asarray(np.clip(colour * 255 + 0.5, 0, 255), np.uint8)
