"""Colours of drawn crops by name, in any light, and what is said of them."""

from __future__ import annotations

import colorsys

import cv2
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from adamo_vh.inference.baseline.sight.marks import brightest, clipped
from adamo_vh.inference.baseline.sight.measures import (
    COLOURS,
    Sight,
    colour_words,
    shares,
    white_level,
)

Picture = NDArray[np.uint8]
HUES = {"red": 0, "orange": 28, "yellow": 52, "green": 120, "blue": 215, "purple": 280, "pink": 325}
"""Of plain colours, degrees."""


def plain(hue_deg: float, saturation: float, value: float, size: int = 16) -> Picture:
    """A picture of one colour, BGR."""
    rgb = colorsys.hsv_to_rgb(hue_deg / 360, saturation, value)
    return np.full((size, size, 3), [round(255 * part) for part in rgb[::-1]], np.uint8)


def named(picture: Picture, white_from: float = 165) -> dict[str, float]:
    return dict(shares(picture, np.ones(picture.shape[:2], bool), white_from))


@pytest.mark.parametrize("name", HUES)
@pytest.mark.parametrize("saturation", [0.55, 0.8, 1.0])
@pytest.mark.parametrize("value", [0.65, 0.8, 1.0])
def test_a_hue_keeps_its_name_pale_or_deep(name: str, saturation: float, value: float) -> None:
    assert named(plain(HUES[name], saturation, value)) == {name: 1.0}


@pytest.mark.parametrize("name", ["red", "green", "blue"])
def test_a_colour_in_the_shade_is_still_that_colour(name: str) -> None:
    assert named(plain(HUES[name], 0.8, 0.35)) == {name: 1.0}


@pytest.mark.parametrize("hue_deg", [25, 40])
def test_dark_orange_is_brown(hue_deg: float) -> None:
    assert named(plain(hue_deg, 0.7, 0.4)) == {"brown": 1.0}


@pytest.mark.parametrize(
    ("value", "name"), [(0.05, "black"), (0.2, "black"), (0.45, "grey"), (0.9, "white")]
)
def test_without_a_hue_the_brightness_names_it(value: float, name: str) -> None:
    assert named(plain(0, 0.0, value)) == {name: 1.0}


def test_cream_is_white_and_butter_is_yellow() -> None:
    assert named(plain(42, 0.2, 0.95)) == {"white": 1.0}
    assert named(plain(52, 0.6, 0.95)) == {"yellow": 1.0}


@given(st.integers(0, 2**32 - 1))
@settings(max_examples=30, deadline=None)
def test_shares_are_of_the_masked_pixels_and_sum_to_one(seed: int) -> None:
    random = np.random.default_rng(seed)
    picture = random.integers(0, 256, (12, 12, 3), np.uint8)
    mask = random.random((12, 12)) < 0.5
    found = shares(picture, mask)
    assert set(found) <= set(COLOURS)
    assert sum(found.values()) == pytest.approx(1.0 if mask.any() else 0.0)
    hidden = picture.copy()
    hidden[~mask] = 0
    assert shares(hidden, mask) == found


def test_nothing_has_no_colour() -> None:
    assert shares(plain(0, 1, 1), np.zeros((16, 16), bool)) == {}


def test_halves_are_halves() -> None:
    picture = np.hstack([plain(HUES["red"], 0.9, 0.8), plain(HUES["blue"], 0.9, 0.8)])
    assert named(picture) == {"red": 0.5, "blue": 0.5}


# --- the light ------------------------------------------------------------------------------


@pytest.mark.parametrize(("brightest_of_all", "name"), [(250, "grey"), (225, "white")])
def test_whether_a_pale_grey_is_white_is_decided_by_the_light(
    brightest_of_all: int, name: str
) -> None:
    pale = np.full((40, 40, 3), 158, np.uint8)
    bright = np.full((40, 40, 3), brightest_of_all, np.uint8)
    picture = np.hstack([pale, bright])
    level = white_level(picture, np.ones(picture.shape[:2], bool))
    assert named(pale, level) == {name: 1.0}


@given(st.integers(0, 255))
@settings(max_examples=30, deadline=None)
def test_the_level_of_white_stays_within_reason(value: int) -> None:
    picture = np.full((30, 30, 3), value, np.uint8)
    assert 145 <= white_level(picture, np.ones((30, 30), bool)) <= 165


def test_without_things_the_level_is_that_of_good_light() -> None:
    assert white_level(plain(0, 0, 1), np.zeros((16, 16), bool)) == 165


# --- words ----------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("colours", "word"),
    [
        ({"red": 0.9, "grey": 0.1}, "red"),
        ({"red": 0.6, "white": 0.25, "grey": 0.15}, "red"),
        ({"red": 0.5, "white": 0.5}, ""),
        ({"black": 0.8, "grey": 0.2}, "black"),
        ({"orange": 0.44, "grey": 0.3, "black": 0.26}, ""),
        ({"red": 0.4, "blue": 0.4, "grey": 0.2}, ""),
        ({"grey": 0.5, "black": 0.5}, ""),
        ({}, ""),
    ],
)
def test_a_main_colour_is_said_only_if_there_is_one(colours: dict[str, float], word: str) -> None:
    assert colour_words(Sight(1000, colours)) == word


def test_of_too_few_pixels_or_of_glass_no_colour_is_said() -> None:
    assert colour_words(Sight(149, {"red": 1.0})) == ""
    assert colour_words(Sight(150, {"red": 1.0})) == "red"
    assert colour_words(Sight(1000, {"brown": 1.0}, clear=0.9)) == ""


# --- cutting --------------------------------------------------------------------------------


@given(*[st.integers(-40, 40)] * 4)
def test_a_box_is_cut_at_the_edges(left: int, top: int, right: int, bottom: int) -> None:
    picture = np.zeros((20, 30), np.uint8)
    rows, columns = clipped((left, top, right, bottom), picture)
    assert 0 <= rows.start <= 20 and 0 <= rows.stop <= 20
    assert 0 <= columns.start <= 30 and 0 <= columns.stop <= 30
    whole = {(x, y) for x in range(30) for y in range(20)
             if left <= x < right and top <= y < bottom}  # fmt: skip
    assert picture[rows, columns].size == len(whole)


def test_the_brightest_channel_decides() -> None:
    picture = cv2.merge([np.full((4, 4), value, np.uint8) for value in (10, 200, 90)])
    assert (brightest(np.asarray(picture, np.uint8)) == 200).all()
