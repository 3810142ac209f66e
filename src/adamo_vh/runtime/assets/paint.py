"""Textures of natural and built materials, drawn by code and seeded.

Every picture is (H, W, 3) uint8 sRGB with row 0 at the top, and all but the leaf and the sky are
seamless: noise is made in the frequency domain, so it repeats without a visible edge.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Picture = NDArray[np.uint8]
Field = NDArray[np.float64]
Colour = tuple[int, int, int]
"""8 bit sRGB."""


def noise(height: int, width: int, grain_px: tuple[float, float], seed: int) -> Field:
    """Smooth random field that repeats at its edges.

    Args:
        height: Rows.
        width: Columns.
        grain_px: Size of a feature down the rows and along the columns, pixels.
        seed: Of the generator.

    Returns:
        (height, width) with mean 0 and standard deviation 1.
    """
    spectrum = np.fft.rfft2(np.random.default_rng(seed).standard_normal((height, width)))
    down = np.fft.fftfreq(height)[:, None] * grain_px[0]
    along = np.fft.rfftfreq(width)[None, :] * grain_px[1]
    spectrum *= np.exp(-2.0 * (down**2 + along**2))
    spectrum[0, 0] = 0.0
    field = np.fft.irfft2(spectrum, s=(height, width))
    return np.asarray(field / field.std())


def shade(colour: Colour, field: Field, strength: float) -> Picture:
    """Paint one colour, lighter and darker with a field.

    Args:
        colour: Mean colour.
        field: (H, W) deviations of about unit size.
        strength: Relative change of brightness for one unit of the field.

    Returns:
        The picture.
    """
    pixels = np.array(colour) * (1.0 + strength * field)[..., None]
    return np.clip(np.rint(pixels), 0, 255).astype(np.uint8)


def flat(colour: Colour, size: int = 8) -> Picture:
    """A small square of one colour."""
    return np.full((size, size, 3), colour, dtype=np.uint8)


def ramp(stops: tuple[tuple[float, Colour], ...], height: int = 256) -> Picture:
    """Colours along v, for the profile of a turned body.

    Args:
        stops: Pairs of v in [0, 1], rising, and the colour there; two stops at one place make an
            edge.
        height: Rows.

    Returns:
        (height, 8, 3) picture; v = 0 is the bottom row.
    """
    places = np.array([place for place, _ in stops])
    colours = np.array([colour for _, colour in stops], dtype=np.float64)
    v = 1.0 - (np.arange(height) + 0.5) / height
    column = np.stack([np.interp(v, places, colours[:, i]) for i in range(3)], axis=1)
    return np.repeat(np.rint(column).astype(np.uint8)[:, None], 8, axis=1)


def wood(height: int, width: int, colour: Colour, seed: int) -> Picture:
    """Wood with the grain along the columns' direction (u)."""
    return shade(colour, _grain(height, width, seed), 0.075)


def planks(size_px: tuple[int, int], boards: int, cuts: int, colour: Colour, seed: int) -> Picture:
    """Boards side by side, each of its own tone, with thin dark joints.

    Args:
        size_px: Height and width of the picture.
        boards: Rows of boards.
        cuts: Pieces in each row, staggered from row to row; 1 has no cross joint.
        colour: Mean colour.
        seed: Of the generator.

    Returns:
        The picture; the grain runs along u.
    """
    height, width = size_px
    rng = np.random.default_rng(seed)
    rows, columns = np.mgrid[0:height, 0:width]
    row = rows * boards // height
    stagger = (np.arange(boards) * 0.382 % 1.0)[row]
    along = (columns / width * cuts + stagger) % cuts
    tone = rng.uniform(-1.0, 1.0, (boards, cuts))[row, along.astype(int) % cuts]
    shift = rng.integers(0, width, boards)[row]
    grain = _grain(height, width, seed)
    grain = grain[rows, (columns + shift) % width]
    across_px = np.minimum(rows % (height / boards), -rows % (height / boards))
    joint = across_px < 1.0
    if cuts > 1:
        along_px = np.minimum(along % 1.0, -along % 1.0) * width / cuts
        joint |= along_px < 1.0
    return shade(colour, grain + 0.8 * tone - 4.0 * joint, 0.075)


def plaster(size_px: tuple[int, int], colour: Colour, seed: int) -> Picture:
    """A painted wall: almost even."""
    field = noise(*size_px, (2, 2), seed) + noise(*size_px, (24, 24), seed + 1)
    return shade(colour, field, 0.007)


def soil(size_px: int, seed: int) -> Picture:
    """Dark potting soil in crumbs."""
    crumbs = noise(size_px, size_px, (5, 5), seed)
    crumbs = crumbs + 0.6 * noise(size_px, size_px, (14, 14), seed + 1)
    return shade((62, 44, 32), crumbs, 0.22)


def leaf(colour: Colour, vein: Colour, seed: int, size_px: int = 256) -> Picture:
    """One leaf from its foot (u = 0) to its tip (u = 1), the mid rib at v = 0.5.

    Args:
        colour: Of the blade.
        vein: Of the ribs.
        seed: Of the generator.
        size_px: Edge length of the picture.

    Returns:
        The picture, without an outline: the mesh has the leaf's shape.
    """
    v, u = (np.mgrid[0:size_px, 0:size_px] + 0.5) / size_px
    side = np.abs(v - 0.5) * 2.0
    pixels = shade(colour, noise(size_px, size_px, (10, 10), seed) - 2.0 * side, 0.06)
    rib = np.exp(-((side / 0.05) ** 2))
    branch = ((u - 0.35 * side) * 9.0) % 1.0
    twig = np.exp(-(((branch - 0.5) / 0.09) ** 2)) * np.clip(1.1 - side, 0.0, 1.0) * 0.45
    weight = np.maximum(rib, twig)[..., None]
    blend = pixels * (1 - weight) + np.array(vein) * weight
    return np.asarray(np.rint(blend), dtype=np.uint8)


def fabric(size_px: int, colour: Colour, seed: int, thread_px: int = 8) -> Picture:
    """Plain weave: threads over and under."""
    rows, columns = np.mgrid[0:size_px, 0:size_px] * (np.pi / thread_px)
    weave = np.sin(rows) * np.sin(columns) + 0.6 * noise(size_px, size_px, (2, 12), seed)
    return shade(colour, weave, 0.05)


def carpet(size_px: int, colour: Colour, seed: int) -> Picture:
    """Short dense pile."""
    pile = noise(size_px, size_px, (2, 2), seed) + 0.5 * noise(size_px, size_px, (40, 40), seed + 1)
    return shade(colour, pile, 0.06)


def terracotta(size_px: int, seed: int) -> Picture:
    """Fired clay with faint turning marks along u."""
    marks = noise(size_px, size_px, (4, 300), seed)
    marks = marks + 0.7 * noise(size_px, size_px, (6, 6), seed + 1)
    return shade((178, 92, 58), marks, 0.035)


def sky(height: int, width: int, seed: int) -> Picture:
    """What stands outside a window: a pale hazy sky above a soft line of trees.

    The sky is kept nearly grey so that nothing in the room but the blue object is blue.
    """
    v = (np.arange(height) + 0.5)[:, None] / height
    haze = np.array([196.0, 203.0, 206.0]) + v[..., None] * np.array([20.0, 10.0, -4.0])
    cloud = np.clip(noise(height, width, (width / 10, width / 4), seed), -1.5, 1.5)
    picture = haze + 4.0 * cloud[..., None]
    ridge = 0.70 + 0.035 * noise(1, width, (1, width / 12), seed + 1)
    ridge = ridge + 0.010 * noise(1, width, (1, width / 90), seed + 2)
    trees = np.clip((v - ridge) * height / 6.0, 0.0, 1.0)[..., None]
    green = shade((134, 148, 112), noise(height, width, (9, 9), seed + 3), 0.05)
    blend = picture * (1 - trees) + green * trees
    return np.asarray(np.clip(np.rint(blend), 0, 255), dtype=np.uint8)


def _grain(height: int, width: int, seed: int) -> Field:
    """Long fibres and slow bands along the columns."""
    fibre = noise(height, width, (1.6, width / 5), seed)
    pore = np.minimum(noise(height, width, (1.0, width / 30), seed + 1), 0.0)
    band = noise(height, width, (height / 14, width / 1.5), seed + 2)
    return np.asarray(0.55 * fibre + 0.5 * pore + 0.7 * band)
