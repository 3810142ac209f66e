"""The baseline's eyes: colours, white parts, print, shape and size, out of pixels alone."""

from __future__ import annotations

import math
from dataclasses import replace

import cv2
import numpy as np
import pytest

from adamo_vh.geometry import Camera, Vec3
from adamo_vh.inference.baseline.language.requests import understand
from adamo_vh.inference.baseline.mind.choosing import degree, thing_of
from adamo_vh.inference.baseline.prompt.reading import Body, Listed, Prompt, Room
from adamo_vh.inference.baseline.sight.kinds import classify
from adamo_vh.inference.baseline.sight.looking import boxed, sights
from adamo_vh.inference.baseline.sight.marks import brightest, drawn_over, print_share
from adamo_vh.inference.baseline.sight.measures import Sight, shares
from adamo_vh.inference.baseline.sight.outlines import camera_of, misfits
from adamo_vh.inference.baseline.sight.prototypes import prototypes
from adamo_vh.inference.messages import ImagePart

WOOD = (70, 105, 140)
BODY = Body(Vec3(-2.0, -1.0, 0.0), 0.0, Vec3(0.0, -1.0, 0.8), "empty")
CAMERA = Camera(Vec3(-1.92, -1.0, 1.6), 0.0, math.atan2(-0.8, 1.92), math.radians(74), 1280, 720)
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
    return Prompt("", Room(), tuple(things), (), BODY, image)


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
    drawn = drawn_over(frame, brightest(frame), [box], [], None)
    assert drawn[280, 405]
    assert drawn[297, 440]
    assert not drawn[340, 440]


def test_the_camera_follows_from_the_text():
    places = [Vec3(x, y, 0.8) for x in (-0.4, 0.0, 0.4) for y in (-1.7, -1.0, -0.3)]
    things = [listed(str(n), place, 10) for n, place in enumerate(places)]
    camera = camera_of(prompt(picture(), things))
    assert camera is not None
    assert math.degrees(camera.fov_y_rad) == pytest.approx(74, abs=1.5)


@pytest.mark.parametrize("name", ["Plate", "PeanutButter", "WineBottle", "Screwdriver"])
def test_a_silhouette_fits_its_own_kind(name):
    prototype, at = prototypes()[name], Vec3(0.0, -0.8, 0.85)
    length, width, height = prototype.size_m
    sides = np.array([(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]) / 2
    if length == width:
        turns = np.arange(0, 2 * math.pi, 0.1)
        rim = np.stack([np.cos(turns), np.sin(turns), np.ones(len(turns))], axis=1) / 2
        sides = np.concatenate([rim, rim * (1, 1, -1)])
    pixels = CAMERA.project(at.array() + sides * (length, width, height))[:, :2]
    left, top = (int(v) for v in pixels.min(axis=0))
    right, bottom = (int(v) for v in pixels.max(axis=0))
    thing = Listed("7", at, prototype.volume_cm3, (left, top, right, bottom))
    found = misfits([thing], CAMERA)["7"]
    assert found[name] < 0.2
    assert found[name] <= min(found.values()) + 0.2


def test_things_before_the_very_eyes_are_not_judged_by_their_size():
    far, near = listed("1", Vec3(0.0, -0.8, 0.8), 40), CAMERA.position + Vec3(0.1, 0.0, 0.0)
    found = misfits([far, Listed("2", near, 800.0, (0, 0, 700, 700))], CAMERA)
    assert set(found) == {"1"}
    assert set(found["1"]) == set(prototypes())


def test_what_surrounds_a_thing_does_not_change_how_large_its_kinds_would_look():
    one, other = listed("1", Vec3(0.0, -0.8, 0.8), 40), listed("2", Vec3(0.2, -1.3, 0.1), 25)
    assert misfits([one, other], CAMERA)["1"] == misfits([one], CAMERA)["1"]


def test_outlines_are_measured_only_when_asked_for():
    frame, thing = picture(), listed("1", Vec3(0.0, -0.8, 0.8), 40)
    disc(frame, thing, "red")
    full = sights(prompt(frame, [thing]))["1"]
    without = sights(prompt(frame, [thing]), outlines=False)["1"]
    assert without == replace(full, roundness=0.0)


def _framed(frame: np.ndarray, thing: Listed, colour: tuple[int, int, int]) -> None:
    """The box that is drawn around a thing: a bright line with a dark rim on both sides."""
    assert thing.box_px
    left, top, right, bottom = thing.box_px
    for out, ink in ((3, (22, 18, 16)), (2, colour), (1, (22, 18, 16))):
        cv2.rectangle(frame, (left - out, top - out), (right + out - 1, bottom + out - 1), ink, 1)


def test_boxes_that_the_text_leaves_out_are_found_in_the_frame():
    frame = picture()
    places = [Vec3(x, y, 0.8) for x in (-0.4, 0.4) for y in (-1.5, -1.1, -0.6)]
    things = [listed(str(n), place, 18 + 3 * n) for n, place in enumerate(places)]
    for n, thing in enumerate(things):
        disc(frame, thing, ("red", "white", "blue")[n % 3])
        _framed(frame, thing, ((60, 240, 30), (64, 160, 255), (208, 92, 255))[n % 3])
    bare = [Listed(t.tag, t.position, t.volume_cm3) for t in things]
    found = {thing.tag: thing.box_px for thing in boxed(prompt(frame, bare))}
    for thing in things:
        box = found[thing.tag]
        assert box is not None
        assert thing.box_px is not None
        assert max(abs(a - b) for a, b in zip(box, thing.box_px, strict=True)) <= 3
    sight = sights(prompt(frame, bare))["0"]
    assert sight.share("red") > 0.9


def test_where_no_box_is_drawn_none_is_found():
    bare = [Listed("1", Vec3(0.0, -0.8, 0.8), 800.0)]
    assert boxed(prompt(picture(), bare))[0].box_px is None
    assert sights(prompt(picture(), bare)) == {}


def test_a_broken_picture_shows_nothing():
    thing = listed("1", Vec3(0.0, -0.8, 0.8), 40)
    told = prompt(picture(), [thing])
    broken = Prompt("", Room(), told.things, (), BODY, ImagePart(b"no picture", "image/jpeg", 8, 8))
    assert sights(broken) == {}


@pytest.mark.parametrize("name", sorted(prototypes()))
def test_a_tag_with_a_class_is_believed(name):
    assert classify(f"{name}_7", 1.0, None) == {name: 1.0}


@pytest.mark.parametrize("name", ["Key", "IndoorPlant"])
def test_volume_alone_tells_extremes(name):
    beliefs = classify("7", prototypes()[name].volume_cm3, None)
    assert max(beliefs, key=lambda known: beliefs[known]) == name


def test_size_and_colour_tell_a_plate_from_binoculars():
    others = dict.fromkeys(prototypes(), 4.0)
    plate = Sight(3000, {"red": 0.6, "white": 0.4}, misfits=others | {"Plate": 0.3})
    black = Sight(3000, {"black": 0.9, "grey": 0.1}, misfits=others | {"Binoculars": 0.3})
    assert classify("7", 1875, plate)["Plate"] > 0.6
    assert classify("7", 2292, black)["Binoculars"] > 0.6


def test_descriptions_are_weighed_against_pixels():
    blue = Sight(pixels=900, colours={"blue": 0.9, "grey": 0.1}, roundness=0.95)
    red = Sight(pixels=900, colours={"red": 0.9, "grey": 0.1}, roundness=0.95)
    wish = understand("Pick the blue circular object").goals[0].target
    thing = thing_of("7", Vec3(0, 0, 0.8), 800.0)
    assert degree(wish, thing, blue, [thing]) > 0.5
    assert degree(wish, thing, red, [thing]) < 0.3
