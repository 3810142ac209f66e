"""The baseline's eyes: colours, white parts, print, shape and size, out of pixels alone."""

from __future__ import annotations

import math

import cv2
import numpy as np
import pytest

from adamo.geometry import Camera, Vec3
from adamo.inference.baseline.colours import shares
from adamo.inference.baseline.drawn import drawn_over
from adamo.inference.baseline.grammar import understand
from adamo.inference.baseline.grounding import classify, degree, remembered
from adamo.inference.baseline.print_marks import print_share
from adamo.inference.baseline.prototypes import prototypes
from adamo.inference.baseline.reading import Body, Listed, Prompt, Room
from adamo.inference.baseline.sight import Sight
from adamo.inference.baseline.view import camera_of
from adamo.inference.baseline.vision import sights
from adamo.inference.messages import ImagePart

WOOD = (70, 105, 140)
BODY = Body(Vec3(-2.0, -1.0, 0.0), 0.0, Vec3(0.0, -1.0, 0.8), "empty")
CAMERA = Camera(Vec3(-1.92, -1.0, 1.6), 0.0, math.atan2(-0.8, 1.92), math.radians(65), 1280, 720)
BGR = {
    "red": (30, 30, 200),
    "orange": (20, 110, 230),
    "yellow": (40, 210, 230),
    "green": (50, 160, 40),
    "blue": (200, 90, 30),
    "white": (235, 238, 240),
    "grey": (120, 122, 124),
    "black": (22, 20, 20),
    "brown": (30, 60, 100),
}


def picture() -> np.ndarray:
    return np.full((720, 1280, 3), WOOD, np.uint8)


def prompt(frame: np.ndarray, things: list[Listed], quality: int = 90) -> Prompt:
    data = cv2.imencode(".jpg", frame, [cv2.IMWRITE_JPEG_QUALITY, quality])[1].tobytes()
    image = ImagePart(data, "image/jpeg", frame.shape[1], frame.shape[0])
    return Prompt("", Room(), tuple(things), (), BODY, image, "", None)


def listed(tag: str, at: Vec3, radius_px: int, volume_cm3: float = 800.0) -> Listed:
    u, v, _ = CAMERA.project(at.array()[None])[0]
    r = radius_px
    return Listed(tag, at, volume_cm3, (round(u) - r, round(v) - r, round(u) + r, round(v) + r))


def disc(frame: np.ndarray, thing: Listed, colour: str) -> None:
    assert thing.box_px
    left, top, right, bottom = thing.box_px
    middle, radius = ((left + right) // 2, (top + bottom) // 2), (right - left) // 2 - 1
    cv2.circle(frame, middle, radius, BGR[colour], -1)


@pytest.mark.parametrize("colour", sorted(BGR))
def test_colours_have_plain_names(colour):
    crop = np.full((20, 20, 3), BGR[colour], np.uint8)
    found = shares(crop, np.ones((20, 20), bool))
    assert found == {colour: 1.0}


@pytest.mark.parametrize("colour", ["red", "blue", "green", "white", "black"])
def test_a_thing_is_told_from_the_table_around_it(colour):
    frame = picture()
    thing = listed("1", Vec3(0.0, -0.8, 0.8), 40)
    disc(frame, thing, colour)
    sight = sights(prompt(frame, [thing]))["1"]
    assert sight.share(colour) > 0.9
    assert sight.roundness > 0.85
    assert sight.pixels == pytest.approx(math.pi * 39**2, rel=0.1)


def test_a_white_rim_is_a_share_of_the_thing():
    frame = picture()
    thing = listed("1", Vec3(0.0, -0.8, 0.8), 40)
    disc(frame, thing, "white")
    assert thing.box_px
    middle = ((thing.box_px[0] + thing.box_px[2]) // 2, (thing.box_px[1] + thing.box_px[3]) // 2)
    cv2.circle(frame, middle, 28, BGR["red"], -1)
    sight = sights(prompt(frame, [thing]))["1"]
    assert sight.share("white") == pytest.approx(0.5, abs=0.1)
    assert sight.share("red") == pytest.approx(0.5, abs=0.1)


def test_what_shows_the_table_is_clear():
    frame = picture()
    thing = listed("1", Vec3(0.0, -0.8, 0.8), 40)
    assert sights(prompt(frame, [thing]))["1"].clear > 0.9


def test_the_nearer_thing_does_not_colour_the_one_behind():
    frame = picture()
    behind, before = listed("1", Vec3(0.1, -0.8, 0.8), 40), listed("2", Vec3(0.0, -0.8, 0.76), 30)
    disc(frame, behind, "blue")
    disc(frame, before, "red")
    assert sights(prompt(frame, [behind, before]))["1"].share("red") < 0.05


def test_printed_words_are_seen():
    plain = np.full((120, 160, 3), BGR["orange"], np.uint8)
    printed = plain.copy()
    for row in (30, 60, 90):
        cv2.putText(printed, "TOMATO SOUP", (15, row), 0, 0.6, (250, 250, 250), 1, cv2.LINE_AA)
    mask = np.ones(plain.shape[:2], bool)
    assert print_share(plain, mask) == 0
    assert print_share(printed, mask) > 0.05


def test_lines_and_tags_are_left_out():
    frame = picture()
    box = (400, 300, 480, 380)
    cv2.rectangle(frame, (396, 296), (484, 384), (40, 240, 170), 2)
    cv2.rectangle(frame, (400, 270), (440, 288), (22, 18, 16), -1)
    cv2.putText(frame, "57", (408, 286), 0, 0.5, (250, 250, 250), 1, cv2.LINE_AA)
    drawn = drawn_over(frame, [box], [], None)
    assert drawn[280, 405]
    assert drawn[297, 440]
    assert not drawn[340, 440]


def test_the_camera_follows_from_the_text():
    places = [Vec3(x, y, 0.8) for x in (-0.4, 0.0, 0.4) for y in (-1.7, -1.0, -0.3)]
    things = [listed(str(n), place, 10) for n, place in enumerate(places)]
    camera = camera_of(prompt(picture(), things))
    assert camera is not None
    assert math.degrees(camera.fov_y_rad) == pytest.approx(65, abs=1.5)


def test_sizes_are_measured_in_metres():
    frame = picture()
    places = [Vec3(x, y, 0.8) for x in (-0.4, 0.4) for y in (-1.7, -1.3, -0.7, -0.3)]
    things = [listed(str(n), place, 12) for n, place in enumerate(places)]
    at = Vec3(0.0, -1.0, 0.8)
    radius_px = round(0.125 * CAMERA.focal_px / at.distance(CAMERA.position))
    sight = sights(prompt(frame, [*things, listed("9", at, radius_px)]))["9"]
    assert sight.width_m == pytest.approx(0.25, rel=0.08)


def test_a_broken_picture_shows_nothing():
    thing = listed("1", Vec3(0.0, -0.8, 0.8), 40)
    told = prompt(picture(), [thing])
    broken = Prompt(
        "", Room(), told.things, (), BODY, ImagePart(b"no picture", "image/jpeg", 8, 8), "", None
    )
    assert sights(broken) == {}


@pytest.mark.parametrize("name", sorted(prototypes()))
def test_a_tag_with_a_class_is_believed(name):
    assert classify(f"{name}_7", 1.0, None) == {name: 1.0}


@pytest.mark.parametrize("name", ["Key", "IndoorPlant"])
def test_volume_alone_tells_extremes(name):
    beliefs = classify("7", prototypes()[name].volume_cm3, None)
    assert max(beliefs, key=lambda known: beliefs[known]) == name


def test_size_and_colour_tell_a_plate_from_binoculars():
    plate = Sight(3000, {"red": 0.6, "white": 0.4}, width_m=0.25, extent_m=0.115, pitch_rad=0.35)
    black = Sight(3000, {"black": 0.9, "grey": 0.1}, width_m=0.19, extent_m=0.125, pitch_rad=0.35)
    assert classify("7", 1875, plate)["Plate"] > 0.6
    assert classify("7", 2292, black)["Binoculars"] > 0.6


def test_descriptions_are_weighed_against_pixels():
    blue = Sight(pixels=900, colours={"blue": 0.9, "grey": 0.1}, roundness=0.95)
    red = Sight(pixels=900, colours={"red": 0.9, "grey": 0.1}, roundness=0.95)
    wish = understand("Pick the blue circular object").goals[0].target
    thing = remembered(Listed("7", Vec3(0, 0, 0.8), 800.0), blue)
    assert degree(wish, thing, blue, [thing]) > 0.5
    assert degree(wish, thing, red, [thing]) < 0.3
