"""What printed labels promise: legible from any side, never glaring, the same on every machine."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
from numpy.typing import NDArray

from adamo_vh.runtime.assets import catalog, labels
from adamo_vh.runtime.assets.asset import Asset, Part
from adamo_vh.runtime.assets.labels import Band, Label, Line, Motif

LABELLED = ("peanut_butter", "tomato_soup", "pills", "painkiller", "wine_bottle")
BLACK, WHITE = (0, 0, 0), (255, 255, 255)
GIRTH_M, HEIGHT_M = 0.2, 0.05
PLAIN = Label(ground=WHITE, lines=(Line("WORD", (0.4, 0.8), BLACK),))


built = cache(catalog.build)


def printed(asset: Asset) -> Part:
    """The part that carries the print."""
    (part,) = (part for part in asset.parts if part.material.name == "label")
    return part


def texels(asset: Asset) -> NDArray[np.float64]:
    """(N, 3) sRGB of all that is painted on an asset, in [0, 1]."""
    pictures = []
    for part in asset.parts:
        tint = np.array(part.material.rgba[:3])
        picture = part.material.texture
        pictures.append(tint[None] if picture is None else picture.reshape(-1, 3) / 255 * tint)
    return np.concatenate(pictures)


def inked_arcs_deg(picture: NDArray[np.uint8]) -> list[float]:
    """Arc of every run of columns with dark print, narrow gaps between letters closed."""
    inked = (picture.max(axis=2) < 128).any(axis=0)
    columns = np.flatnonzero(inked)
    words = np.split(columns, np.flatnonzero(np.diff(columns) > len(inked) / 45) + 1)
    return [360.0 * (word[-1] - word[0] + 1) / len(inked) for word in words]


# --- legibility -----------------------------------------------------------------------------


def test_words_stay_within_the_quarter_that_faces_a_person() -> None:
    _, *arcs, _ = inked_arcs_deg(labels.wrap(PLAIN, GIRTH_M, HEIGHT_M))
    assert len(arcs) == PLAIN.panels - 1, "the seam at the back cuts one in two"
    assert max(arcs) <= 90.0
    assert min(arcs) == pytest.approx(labels.WORDS_ARC_DEG, abs=3.0)


@pytest.mark.parametrize("panels", [3, 4])
def test_one_print_faces_the_front(panels: int) -> None:
    """The seam is at the back; u = 0.5 is the front."""
    label = Label(WHITE, PLAIN.lines, panels=panels)
    dark = 255.0 - labels.wrap(label, GIRTH_M, HEIGHT_M).mean(axis=(0, 2))
    middle, quarter = len(dark) / 2, len(dark) // 8
    columns = np.arange(len(dark))
    front = np.abs(columns + 0.5 - middle) < quarter
    assert np.average(columns[front] + 0.5, weights=dark[front]) == pytest.approx(middle, rel=0.03)


def test_a_line_fills_the_height_it_was_given() -> None:
    picture = labels.wrap(PLAIN, GIRTH_M, HEIGHT_M)
    rows = np.flatnonzero((picture.max(axis=2) < 128).any(axis=1))
    low, high = 1.0 - (rows[-1] + 1) / len(picture), 1.0 - rows[0] / len(picture)
    assert (low, high) == pytest.approx((0.4, 0.8), abs=0.01)


def test_bands_run_all_around_in_their_place() -> None:
    label = Label(WHITE, (), bands=(Band((0.0, 0.25), (200, 0, 0)),))
    picture = labels.wrap(label, GIRTH_M, HEIGHT_M)
    edge = round(0.75 * len(picture))
    assert (picture[edge + 1 :] == (200, 0, 0)).all()
    assert (picture[: edge - 1] == WHITE).all()


@pytest.mark.parametrize("name", ["tomato", "peanut", "grapes", "cross", "capsule"])
def test_motifs_stay_in_their_place(name: str) -> None:
    label = Label(WHITE, (), motifs=(Motif(getattr(labels, name), (0.2, 0.5)),))
    picture = labels.wrap(label, GIRTH_M, HEIGHT_M)
    marked = (picture != WHITE).any(axis=2)
    assert marked[round(0.52 * len(picture)) : round(0.78 * len(picture))].any()
    assert not marked[: round(0.49 * len(picture))].any()
    assert not marked[round(0.81 * len(picture)) :].any()
    assert marked.any(axis=0).mean() < 0.75


@pytest.mark.parametrize("name", LABELLED)
def test_print_reads_from_outside_and_upright(name: str) -> None:
    """Texture u grows to the right of a person in front (+x at -y), v grows upwards."""
    wall = printed(built(name))
    front = wall.vertices[:, 1] < -0.9 * wall.vertices[:, 1].max()
    assert wall.uvs[front, 0].mean() == pytest.approx(0.5, abs=0.01)
    assert np.corrcoef(wall.vertices[front, 0], wall.uvs[front, 0])[0, 1] > 0.9
    assert np.corrcoef(wall.vertices[:, 2], wall.uvs[:, 1])[0, 1] > 0.99


@pytest.mark.parametrize("name", LABELLED)
def test_print_has_contrast(name: str) -> None:
    picture = printed(built(name)).material.texture
    assert picture is not None
    grey = picture @ np.array((0.299, 0.587, 0.114))
    assert np.percentile(grey, 95) - np.percentile(grey, 5) > 80


# --- colours --------------------------------------------------------------------------------


@pytest.mark.parametrize("name", LABELLED)
def test_whites_do_not_glare(name: str) -> None:
    colours = texels(built(name))
    whites = colours[colours.min(axis=1) > 0.7]
    assert whites.max(initial=0.0) <= 0.85


@pytest.mark.parametrize("name", LABELLED)
def test_nothing_is_blue(name: str) -> None:
    red, green, blue = texels(built(name)).T
    assert not ((blue > 1.15 * np.maximum(red, green)) & (blue > 0.15)).any()


@pytest.mark.parametrize("name", LABELLED)
def test_surfaces_are_too_dull_for_white_highlights(name: str) -> None:
    assert max(part.material.specular for part in built(name).parts) <= 0.25


def test_peanut_butter_has_neither_white_nor_cream() -> None:
    assert texels(built("peanut_butter")).min(axis=1).max() < 0.35


def test_metal_of_the_can_is_not_white() -> None:
    for part in built("tomato_soup").parts:
        if part.material.name != "label":
            assert max(part.material.rgba[:3]) <= 0.6


# --- determinism ----------------------------------------------------------------------------


@pytest.mark.parametrize("name", LABELLED)
def test_prints_are_the_same_every_time(name: str) -> None:
    first, second = printed(built(name)), printed(catalog.build(name))
    assert first.material.texture is not None and second.material.texture is not None
    assert first.material.texture.tobytes() == second.material.texture.tobytes()
