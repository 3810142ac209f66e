"""An engine behind the wire is the same engine: same states, same pictures, same episodes."""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from tests.dialled import dialled
from tools.wire import FOLDER, texts

import adamo_vh
from adamo_vh.abilities import Abilities
from adamo_vh.action import Code, Outcome
from adamo_vh.engine import LightChanged, ObjectTaken, acting_body
from adamo_vh.episode.result import read_manifest
from adamo_vh.errors import ConfigError, EngineError
from adamo_vh.geometry import Vec3
from adamo_vh.perception.visibility import visible_objects
from adamo_vh.record.trajectory import read_trajectory
from adamo_vh.runtime.builtin import BuiltinEngine
from adamo_vh.service.engines.remote import RemoteWorld
from adamo_vh.session.lending import Lender

TINY = (320, 180)
PLATE = 57


@pytest.fixture
def remote(engine: BuiltinEngine) -> Iterator[RemoteWorld]:
    with dialled(engine) as world:
        yield world


def test_the_published_schema_is_that_of_the_messages() -> None:
    told = texts()["engine.json"]
    assert (FOLDER / "engine.json").read_text(encoding="utf-8") == told, "run: python tools/wire.py"
    assert set(json.loads(told)["methods"]) >= {"scene", "capture", "rays", "walk", "restore"}


def test_what_is_seen_and_known_is_the_same(engine: BuiltinEngine, remote: RemoteWorld) -> None:
    assert remote.state().hash() == engine.state().hash()
    assert remote.object_names == engine.object_names
    assert remote.state().furniture == engine.state().furniture
    assert remote.scene.source == "dialled in: Built-in 1"
    body, near = acting_body(remote), engine.body
    assert (body.info, body.state()) == (near.info, near.state())
    views = (
        (body.see(*TINY), near.see(*TINY)),
        (body.closeup(Vec3(0, 1, 1), 0.3, 64, 48), near.closeup(Vec3(0, 1, 1), 0.3, 64, 48)),
    )
    for far, own in views:
        assert np.array_equal(far.rgb, own.rgb)
        assert all(map(np.array_equal, far.id_layers, own.id_layers))
        assert (dict(far.objects), far.camera, far.body) == (
            dict(own.objects),
            own.camera,
            own.body,
        )
    ways = np.array([[0.0, 0.0, -1.0], [0.0, 0.0, 1.0]])
    assert [*body.rays(Vec3(0, 0, 1), ways)] == [*near.rays(Vec3(0, 0, 1), ways)]


def test_actions_snapshots_and_events_pass_through(remote: RemoteWorld) -> None:
    body, kept, start = acting_body(remote), remote.snapshot(), remote.state().hash()
    assert body.look(Vec3(1, 1, 1)).outcome is Outcome.DONE
    assert body.pick(PLATE).code in (Code.OK, Code.REPOSITIONED)
    assert body.pick(PLATE).code == Code.HAND_FULL
    held = body.state()
    assert held.held == PLATE and held.held_box is not None
    report = body.drop(Vec3(0.0, 0.0, 0.0))
    assert report.support == "floor" and report.point is not None
    body.say("done")
    remote.restore(kept)
    assert remote.state().hash() == start
    with pytest.raises(EngineError, match="refused restore: The snapshot is damaged"):
        remote.restore(b"bm90aGluZw==")
    with pytest.raises(EngineError, match="refused apply"):
        remote.apply(ObjectTaken(9999))
    remote.apply(LightChanged(0, 0.1))
    remote.apply(ObjectTaken(PLATE))
    assert body.pick(PLATE).code == Code.GONE
    remote.reset(0)
    assert remote.state().hash() == start


def test_an_episode_is_the_same_through_the_wire(
    engine: BuiltinEngine, remote: RemoteWorld, tmp_path: Path
) -> None:
    settings: Any = {"task": "T2", "resolution": TINY, "model": "baseline"}
    near = adamo_vh.run_episode(engine=engine, out=tmp_path / "near", **settings)
    far = adamo_vh.run_episode(engine=remote, out=tmp_path / "far", **settings)
    assert far.score == near.score and far.score is not None
    one, two = (read_trajectory(tmp_path / name) for name in ("near", "far"))
    assert [act.state_hash for act in one.acts] == [act.state_hash for act in two.acts]
    manifest = read_manifest(tmp_path / "far")
    assert (manifest.engine, manifest.engine_lacks) == ("RemoteWorld", ())
    assert not adamo_vh.replay_episode(tmp_path / "far", engine=remote).mismatches


def test_an_engine_that_knows_no_pixels_is_seen_in_boxes(engine: BuiltinEngine) -> None:
    with dialled(engine, Abilities(ids=False)) as world:
        percept, own = acting_body(world).see(640, 360), engine.body.see(640, 360)
        assert percept.from_boxes
        assert visible_objects(percept, 20) == visible_objects(own, 20)
        result = adamo_vh.run_episode(task="T2", engine=world, resolution=(640, 360))
    near = adamo_vh.run_episode(task="T2", engine=engine, resolution=(640, 360))
    assert result.score == near.score


def test_an_engine_that_keeps_no_states_carries_one_episode_at_a_time(
    engine: BuiltinEngine, tmp_path: Path
) -> None:
    able = Abilities(snapshot=False, closeup=False)
    with dialled(engine, able) as world:
        short: Any = {"resolution": TINY, "limits": adamo_vh.Limits(max_steps=4)}
        adamo_vh.run_episode(task="T2", engine=world, out=tmp_path / "run", **short)
        told = read_manifest(tmp_path / "run").engine_lacks
        assert told == able.lacking() and len(told) == 2
        replayed = adamo_vh.replay_episode(tmp_path / "run", engine=world)
        assert not replayed.mismatches and replayed.steps > 0
        with pytest.raises(EngineError, match="keeps no states"):
            adamo_vh.replay_episode(tmp_path / "run", 1, engine=world)
        with pytest.raises(ConfigError, match="no close-ups, which profile 'lean'"):
            adamo_vh.run_episode(task="T2", engine=world, profile="lean", **short)
        lender = Lender(world)
        one, two = lender.lend(), lender.lend()
        one.reset(0)
        assert one.abilities == able
        with pytest.raises(EngineError, match="one episode at a time"):
            two.reset(0)
        one.close()
        two.reset(0)


def test_an_engine_may_not_have_a_scene(engine: BuiltinEngine) -> None:
    with dialled(engine) as world, pytest.raises(EngineError, match="loaded scene 's1', and 's7'"):
        RemoteWorld(world.line, "s7")
