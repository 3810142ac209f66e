"""The test of every frame: a picture of the world passes, whatever hides what in it."""

from __future__ import annotations

import math

import pytest

from adamo_vh.action import Drop, Pick
from adamo_vh.action_server import LocalActionServer, frame_check
from adamo_vh.action_server.frame_check import frame_fault
from adamo_vh.engine import ObjectMoved, acting_body
from adamo_vh.geometry import Vec3
from adamo_vh.observation import NOTHING
from adamo_vh.runtime.builtin import BuiltinEngine
from adamo_vh.session.bodies import create_engine

SMALL = (640, 360)


def ahead(engine: BuiltinEngine, forward_m: float, left_m: float = 0.0) -> Vec3:
    """A place on the floor as the body sees it."""
    stance = engine.body.stance
    cos, sin = math.cos(stance.heading_rad), math.sin(stance.heading_rad)
    here = stance.position
    return Vec3(
        here.x + forward_m * cos - left_m * sin, here.y + forward_m * sin + left_m * cos, 0.0
    )


def test_what_the_own_trunk_hides_is_no_fault() -> None:
    engine = BuiltinEngine("s1")
    for number, forward_m, left_m in ((20, 0.19, 0.34), (23, 0.15, 0.44), (8, 0.39, 0.0)):
        engine.apply(ObjectMoved(number, ahead(engine, forward_m, left_m)))
    engine.body.look(ahead(engine, 0.39))
    view = engine.capture(*SMALL)
    assert set(view.objects) == {8}, "the trunk is meant to hide two of the three"
    assert frame_fault(view, engine.state(), engine.body) == ""


def test_what_a_large_thing_in_the_hand_hides_is_no_fault() -> None:
    engine = BuiltinEngine("s1")
    server = LocalActionServer(engine, resolution=SMALL)
    seen = server.observe()
    plant = next(item.tag for item in seen.observation.objects if item.tag == "IndoorPlant_50")
    server.execute(Pick(plant))
    for item in engine.state().objects:
        engine.body.look(item.box.center)
        view = engine.capture(*SMALL)
        assert frame_fault(view, engine.state(), engine.body) == "", item.class_name
    server.execute(Drop(plant, 1.5, 0.5, 0.0))


def test_few_things_that_lack_their_pixels_are_enough() -> None:
    engine = BuiltinEngine("s1")
    view = engine.capture(*SMALL)
    for layer in view.id_layers:
        layer[:] = NOTHING
    fault = frame_fault(view, engine.state(), engine.body)
    assert "lack an object that is there" in fault


def test_thin_things_far_away_and_leaves_are_no_fault(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(frame_check, "_MISSES", 0.0)
    engine = create_engine("s2", variation=1)
    body = acting_body(engine)
    for x, y in ((1.48, 0.24), (-0.5, 0.9), (2.0, 2.5), (-1.5, -1.0)):
        body.walk(Vec3(0.775, -0.275, 0.0))
        body.look(Vec3(x, y, 1.13))
        view = body.see(*SMALL)
        assert frame_fault(view, engine.state(), body) == "", (x, y)
