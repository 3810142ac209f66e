"""What things are taken for: the kinds that are meant, the others that homes have, and neither."""

from __future__ import annotations

import math

import cv2
import numpy as np
import pytest

from adamo_vh.geometry import Camera, Vec3
from adamo_vh.inference.baseline.language.requests import understand
from adamo_vh.inference.baseline.mind.beliefs import look
from adamo_vh.inference.baseline.mind.choosing import thing_of
from adamo_vh.inference.baseline.mind.memory import Memory
from adamo_vh.inference.baseline.prompt.reading import Body, Listed, Prompt, Room
from adamo_vh.inference.baseline.sight.kinds import class_of, classify, likeliest
from adamo_vh.inference.baseline.sight.measures import Sight
from adamo_vh.inference.baseline.sight.outlines import misfits
from adamo_vh.inference.baseline.sight.prototypes import prototypes
from adamo_vh.inference.baseline.sight.standing import heights
from adamo_vh.inference.messages import ImagePart

ROOM = Room()
CAMERA = Camera(Vec3(-1.92, -1.0, 1.6), 0.0, math.atan2(-0.8, 1.92), math.radians(74), 1280, 720)


def _on_table(name: str, x: float) -> Listed:
    prototype = prototypes()[name]
    return Listed(name, Vec3(x, 0.0, 0.78 + prototype.size_m[2] / 2), prototype.volume_cm3)


@pytest.mark.parametrize("name", ["Plate", "Lock", "Screwdriver", "Pills", "WineBottle", "Key"])
def test_how_high_a_thing_is_follows_from_its_centre_and_the_surface(name):
    points = [Vec3(0.4, 0.1, 0.78), Vec3(0.2, 0.0, 0.0), Vec3(1.2, 1.0, 0.0)]
    found = heights([_on_table(name, 0.0)], points, ROOM)
    assert found[name] == pytest.approx(prototypes()[name].size_m[2], abs=0.012)


def test_a_point_on_another_thing_or_on_the_wall_is_no_surface():
    plant, lock = _on_table("IndoorPlant", 0.0), _on_table("Lock", 0.3)
    on_plant, on_wall = Vec3(0.05, 0.0, 0.9), Vec3(3.0, 0.2, 0.79)
    beside = Listed("Glass", Vec3(2.6, 0.2, 0.85), 1400.0)
    assert heights([plant, lock, beside], [on_plant, on_wall], ROOM) == {}


def test_a_surface_without_a_point_tells_no_height():
    assert heights([_on_table("Cup", 0.0)], [Vec3(0.0, 0.0, 0.0)], ROOM) == {}
    assert heights([_on_table("Cup", 0.0)], [Vec3(2.0, 0.0, 0.78)], ROOM) == {}


@pytest.mark.parametrize(("name", "lying"), [("Lock", 0.025), ("Painkiller", 0.045)])
def test_a_height_tells_what_stands_from_what_lies(name, lying):
    prototype = prototypes()[name]
    stands = classify("7", prototype.volume_cm3, Sight(0, height_m=prototype.size_m[2]))
    lies = classify("7", prototype.volume_cm3, Sight(0, height_m=lying))
    assert stands[name] > 2 * lies[name]


@pytest.mark.parametrize(
    ("other", "meant", "colours"),
    [
        ("Spoon", "Flashlight", {"brown": 0.6, "orange": 0.3, "yellow": 0.1}),
        ("RemoteControl", "Screwdriver", {"black": 0.8, "grey": 0.2}),
        ("Teapot", "Binoculars", {"green": 0.8, "black": 0.2}),
        ("Apple", "TomatoSoup", {"red": 0.9, "green": 0.1}),
        ("Banana", "Flashlight", {"yellow": 0.9, "brown": 0.1}),
    ],
)
def test_what_no_instruction_names_is_not_taken_for_the_most_similar_that_one_names(
    other, meant, colours
):
    prototype = prototypes()[other]
    fits = {name: 0.3 if name in (other, meant) else 3.0 for name in prototypes()}
    sight = Sight(900, colours, misfits=fits, height_m=prototype.size_m[2])
    beliefs = classify("7", prototype.volume_cm3, sight)
    assert beliefs[meant] < 0.5


def test_what_fits_no_known_kind_is_none_of_them():
    odd = Sight(900, {"purple": 1.0}, misfits=dict.fromkeys(prototypes(), 9.0))
    assert sum(classify("7", 900.0, odd).values()) < 0.1


def test_what_is_meant_is_likelier_there_than_another_thing_of_the_same_looks():
    volume = prototypes()["Lock"].volume_cm3
    assert prototypes()[likeliest(classify("7", volume, None))].weight == 1.0


def test_a_thing_half_hidden_is_as_large_as_its_centre_tells():
    plate = prototypes()["Plate"]
    at = Vec3(0.0, -0.8, 0.8)
    u, v, _ = (float(value) for value in CAMERA.project(at.array()[None])[0])
    whole = Listed(
        "1", at, plate.volume_cm3, (round(u - 39), round(v - 19), round(u + 39), round(v + 19))
    )
    hidden = Listed(
        "2", at, plate.volume_cm3, (round(u - 39), round(v - 19), round(u + 5), round(v + 19))
    )
    found = misfits([whole, hidden], CAMERA)
    assert found["2"]["Plate"] == pytest.approx(found["1"]["Plate"], abs=0.1)


@pytest.mark.parametrize(
    ("tag", "kind"),
    [("WoodenSpoon_68", "Spoon"), ("RubberDuck_62", "Duck"), ("Wine_Bottle_36", "WineBottle"),
     ("indoorplant_50", "IndoorPlant"), ("RemoteControl_67", "RemoteControl"), ("67", None),
     ("Keyboard_3", None), ("Lamp_4", None)],
)  # fmt: skip
def test_the_last_word_of_a_tag_names_its_kind(tag, kind):
    assert class_of(tag) == kind


def test_what_is_of_a_vivid_colour_all_over_is_no_glass():
    fits = {name: 0.1 if name in ("Glass", "PeanutButter", "Cup") else 3.0 for name in prototypes()}
    lid = Sight(4200, {"red": 0.85, "brown": 0.15}, clear=0.33, misfits=fits)
    pale = Sight(4200, {"grey": 0.4, "white": 0.4, "orange": 0.2}, clear=0.15, misfits=fits)
    assert classify("7", 1600.0, lid)["Glass"] < 0.3
    assert classify("7", 1400.0, pale)["Glass"] > 0.5


@pytest.mark.parametrize(("away_m", "is_kept"), [(0.4, True), (1.2, False)])
def test_a_nearer_view_counts_more_unless_it_shows_the_lid_alone(away_m, is_kept):
    at, eyes_m = Vec3(0.0, 0.0, 0.5), 1.6
    body = Body(Vec3(-away_m, 0.0, 0.0), 0.0, at, "empty")
    camera = Camera(
        Vec3(0.08 - away_m, 0.0, eyes_m), 0.0, math.atan2(at.z - eyes_m, away_m - 0.08),
        math.radians(74), 1280, 720,
    )  # fmt: skip
    u, v, _ = (round(float(value)) for value in camera.project(at.array()[None])[0])
    thing = Listed("8", at, 1782.0, (u - 30, v - 30, u + 30, v + 30))
    frame = np.full((720, 1280, 3), (70, 105, 140), np.uint8)
    cv2.circle(frame, (u, v), 29, (30, 30, 200), -1)
    data = cv2.imencode(".png", frame)[1].tobytes()
    prompt = Prompt("", ROOM, (thing,), (), body, ImagePart(data, "image/png", 1280, 720))
    plan = understand("Pick all objects that have a printed product label")
    memory = Memory(things={"8": thing_of("8", at, 1782.0)}, fits={("goal", 0): {"8": 0.9}})
    memory.seen_m["8"] = 2.4
    look(prompt, plan, memory, None)
    assert (memory.fits["goal", 0]["8"] == 0.9) is is_kept
