"""What happens without the body: things are moved, taken and brought back, lights change."""

from __future__ import annotations

import base64
import json
import zlib

import pytest

from adamo_vh.action import Code, Outcome, Pick
from adamo_vh.action_server import LocalActionServer
from adamo_vh.action_server.soundness import state_faults
from adamo_vh.engine import (
    FLOOR,
    LightChanged,
    ObjectAdded,
    ObjectMoved,
    ObjectTaken,
    WorldEvent,
)
from adamo_vh.errors import EngineError
from adamo_vh.geometry import Vec3
from adamo_vh.runtime.builtin import BuiltinEngine
from adamo_vh.runtime.inspection.soundness import Soundness

PLATE, CUP, KEY = 57, 45, 34
ASIDE = Vec3(-1.5, -2.5, 0.0)
SMALL = (640, 360)


def assert_sound(engine: BuiltinEngine) -> None:
    state = engine.state()
    assert [*state_faults(state), *Soundness(engine.world).faults(state)] == []


def test_a_moved_thing_lies_where_it_was_put_and_all_else_stays(engine: BuiltinEngine) -> None:
    before = engine.state()
    engine.apply(ObjectMoved(PLATE, ASIDE))
    after = engine.state()
    assert after.object(PLATE).support == FLOOR
    assert after.object(PLATE).box.center.horizontal_distance(ASIDE) < 0.03
    assert [a for a in before.objects if a != after.object(a.id)] == [before.object(PLATE)]
    assert after.body == before.body
    assert_sound(engine)


def test_a_moved_thing_is_never_put_into_the_body(engine: BuiltinEngine) -> None:
    here = engine.body.state().position
    engine.apply(ObjectMoved(PLATE, here))
    distance = engine.state().object(PLATE).box.center.horizontal_distance(here)
    assert distance > engine.body.info.radius_m + 0.125
    assert engine.body.walk(Vec3(-2.0, -3.0, 0.0)).outcome is Outcome.DONE
    assert_sound(engine)


def test_a_taken_thing_is_gone_for_all_senses(engine: BuiltinEngine) -> None:
    server = LocalActionServer(engine, resolution=SMALL)
    assert any(item.tag == "Plate_57" for item in server.observe().observation.objects)
    engine.apply(ObjectTaken(PLATE))
    assert PLATE not in {item.id for item in engine.state().objects}
    assert PLATE not in engine.capture(*SMALL).objects
    assert PLATE in engine.object_names
    refused = server.execute(Pick("Plate_57"))
    assert refused.feedback.code == Code.GONE
    assert refused.feedback.text == "Refused: it is not in the room any more."
    assert_sound(engine)


def test_what_lay_on_a_taken_thing_falls(engine: BuiltinEngine) -> None:
    plate = engine.state().object(PLATE).box
    item = engine.world.objects[KEY]
    engine.data.qpos[item.qpos : item.qpos + 3] = (plate.center + Vec3(0, 0, 0.03)).array()
    engine.apply(ObjectMoved(CUP, ASIDE))
    assert engine.state().object(KEY).support == "object 57"
    engine.apply(ObjectTaken(PLATE))
    assert engine.state().object(KEY).support == "table"
    assert_sound(engine)


def test_a_taken_thing_can_be_brought_back_and_picked(engine: BuiltinEngine) -> None:
    engine.apply(ObjectTaken(PLATE))
    engine.body.pick(CUP)
    engine.body.drop(ASIDE)
    engine.apply(ObjectAdded(PLATE, Vec3(1.5, 1.0, 0.0)))
    assert engine.state().object(PLATE).support == FLOOR
    assert engine.body.pick(PLATE).outcome is Outcome.DONE
    assert_sound(engine)


def test_a_light_changes_the_picture_and_nothing_else(engine: BuiltinEngine) -> None:
    bright, state = engine.capture(*SMALL), engine.state()
    engine.apply(LightChanged(0, 0.0))
    dark = engine.capture(*SMALL)
    assert dark.rgb.mean() < bright.rgb.mean() - 3
    assert engine.state() == state
    engine.reset(0)
    assert (engine.capture(*SMALL).rgb == bright.rgb).all()


IMPOSSIBLE: list[WorldEvent] = [
    ObjectMoved(99, ASIDE),
    ObjectMoved(KEY, ASIDE),
    ObjectMoved(PLATE, Vec3(0.0, 0.0, 2.9)),
    ObjectTaken(99),
    ObjectTaken(KEY),
    ObjectAdded(PLATE, ASIDE),
    ObjectAdded(99, ASIDE),
    LightChanged(9, 0.5),
    LightChanged(-1, 0.5),
    LightChanged(0, 1.5),
    LightChanged(0, float("nan")),
]


@pytest.mark.parametrize("event", IMPOSSIBLE, ids=repr)
def test_what_cannot_be_done_changes_nothing(engine: BuiltinEngine, event: WorldEvent) -> None:
    engine.body.pick(KEY)
    before = engine.snapshot()
    with pytest.raises(EngineError):
        engine.apply(event)
    assert engine.snapshot() == before


def test_a_snapshot_keeps_what_happened(engine: BuiltinEngine) -> None:
    start, picture = engine.snapshot(), engine.capture(*SMALL).rgb
    engine.apply(ObjectTaken(PLATE))
    engine.apply(ObjectMoved(CUP, ASIDE))
    engine.apply(LightChanged(0, 0.1))
    kept, state, dark = engine.snapshot(), engine.state(), engine.capture(*SMALL).rgb
    engine.restore(start)
    assert len(engine.state().objects) == 19
    assert (engine.capture(*SMALL).rgb == picture).all()
    engine.restore(kept)
    assert engine.state() == state
    assert (engine.capture(*SMALL).rgb == dark).all()
    engine.apply(ObjectAdded(PLATE, Vec3(1.5, 1.0, 0.0)))
    there = engine.state().hash()
    engine.restore(kept)
    engine.apply(ObjectAdded(PLATE, Vec3(1.5, 1.0, 0.0)))
    assert engine.state().hash() == there


def test_a_snapshot_of_an_older_version_is_read(engine: BuiltinEngine) -> None:
    """It knew of no events: nothing is absent, and the lights are the scene's."""
    engine.body.pick(PLATE)
    state = engine.state()
    old = json.loads(zlib.decompress(engine.snapshot()))
    del old["absent"], old["lights"]
    engine.apply(ObjectTaken(CUP))
    engine.restore(zlib.compress(json.dumps(old).encode()))
    assert engine.state() == state


@pytest.mark.parametrize(
    "edit",
    [
        {"absent": [99]},
        {"absent": [PLATE], "body": {"held": PLATE}},
        {"body": {"held": 99}},
        {"body": {"held": "plate"}},
        {"body": {"heading_rad": float("nan")}},
        {"body": {"position": {"x": float("inf"), "y": 0, "z": 0}}},
        {"lights": []},
        {"lights": [None]},
        {"qpos": []},
        {"qpos": [float("nan")] * 400},
        {"scene": "s9"},
        {"said": 3},
    ],
    ids=repr,
)
def test_an_edited_snapshot_is_an_engine_error(engine: BuiltinEngine, edit: dict) -> None:
    before = engine.state().hash()
    told = json.loads(zlib.decompress(engine.snapshot()))
    told["qpos"] = edit.get("qpos", told["qpos"])[: len(told["qpos"])]
    told |= {k: v for k, v in edit.items() if k not in ("body", "qpos")}
    told["body"] |= edit.get("body", {})
    with pytest.raises(EngineError):
        engine.restore(zlib.compress(json.dumps(told).encode()))
    assert engine.state().hash() == before


def test_a_saved_state_that_was_edited_is_an_engine_error(engine: BuiltinEngine) -> None:
    server = LocalActionServer(engine, resolution=SMALL)
    saved = json.loads(server.save())
    for edit in (
        {"seen": [99]},
        {"seen": "all"},
        {"engine": "!"},
        {"engine": base64.b64encode(b"x").decode()},
    ):
        with pytest.raises(EngineError):
            server.load(json.dumps(saved | edit))
