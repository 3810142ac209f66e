"""Outlines are smoothed by what they cover; everything else keeps its colour."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from adamo_vh.runtime.smoothing import smooth

Picture = NDArray[np.uint8]


def two_surfaces(boundary: NDArray[np.floating], height: int = 90) -> tuple[Picture, Picture]:
    """A white surface above a line, a black one below it, drawn without smoothing."""
    rows = np.arange(height)[:, np.newaxis] + 0.5
    above = rows < boundary
    labels = np.zeros((height, len(boundary), 4), np.uint8)
    labels[above, 0] = 1
    picture = np.repeat(np.where(above, 255, 0).astype(np.uint8)[:, :, np.newaxis], 4, axis=2)
    return picture, labels


@pytest.mark.parametrize("slope", [0.03, 0.1, -0.2, 0.45, 0.7])
@pytest.mark.parametrize("steep", [False, True])
def test_a_straight_outline_covers_what_the_line_covers(slope: float, steep: bool) -> None:
    columns = np.arange(80)
    line = (70.2 if slope < 0 else 2.3) + slope * (columns + 0.5)
    picture, labels = two_surfaces(line)
    rough = picture[:, :, 0].sum(axis=0) / 255.0
    if steep:
        turned, kept = picture.transpose(1, 0, 2).copy(), labels.transpose(1, 0, 2).copy()
        smooth(turned, kept)
        picture = turned.transpose(1, 0, 2)
    else:
        smooth(picture, labels)
    # At the ends of the picture the outline's last step has no end to measure.
    inner = slice(30, 50)
    covered = picture[:, inner, 0].sum(axis=0) / 255.0
    error = np.abs(covered - line[inner])
    before = np.abs(rough[inner] - line[inner])
    assert error.max() < 0.3
    assert error.mean() < 0.5 * before.mean()
    assert ((picture[:, inner] > 0) & (picture[:, inner] < 255)).any()


def test_what_is_printed_on_a_surface_stays() -> None:
    picture = np.random.default_rng(1).integers(0, 256, (20, 30, 4), np.uint8)
    labels = np.full((20, 30, 4), 7, np.uint8)
    labels[:, :, 2] = np.arange(30) * 8
    """A curved surface: it turns a little from pixel to pixel."""
    before = picture.copy()
    smooth(picture, labels)
    assert (picture == before).all()


def test_level_outlines_are_sharp() -> None:
    picture, labels = two_surfaces(np.full(30, 12.0))
    before = picture.copy()
    smooth(picture, labels)
    assert (picture == before).all()


@pytest.mark.parametrize("byte", [0, 1])
def test_either_byte_of_a_number_tells_surfaces_apart(byte: int) -> None:
    picture, labels = two_surfaces(10 + 0.1 * np.arange(60))
    labels[:, :, [0, byte]] = labels[:, :, [byte, 0]]
    before = picture.copy()
    smooth(picture, labels)
    assert (picture != before).any()


@pytest.mark.parametrize("shape", [(1, 1), (1, 9), (9, 1), (2, 2)])
def test_the_smallest_pictures_are_fine(shape: tuple[int, int]) -> None:
    picture = np.zeros((*shape, 4), np.uint8)
    labels = np.random.default_rng(2).integers(0, 3, (*shape, 4), np.uint8)
    smooth(picture, labels)
    assert (picture == 0).all()
