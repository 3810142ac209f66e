"""What was drawn before is not drawn again, and nothing comes out otherwise for it."""

from __future__ import annotations

from dataclasses import replace
from itertools import count
from pathlib import Path
from typing import Any

import pytest
from tests.records import assert_the_same_record

import adamo_vh
from adamo_vh.action import Look, Pick, Walk
from adamo_vh.action_server import LocalActionServer
from adamo_vh.action_server.frame_cache import FrameCache, view_key
from adamo_vh.engine import LightChanged, ObjectTaken
from adamo_vh.errors import ConfigError
from adamo_vh.geometry import Vec3
from adamo_vh.observation import Observation
from adamo_vh.perception import Labeling, PerceptionConfig
from adamo_vh.runtime.builtin import BuiltinEngine

SMALL = (640, 360)
TINY = (320, 180)
PLATE = 57


def server(engine: BuiltinEngine, frames: FrameCache, **perception: Any) -> LocalActionServer:
    config = PerceptionConfig(**perception)
    return LocalActionServer(engine, perception=config, resolution=TINY, frames=frames)


def test_the_first_view_of_a_repetition_is_not_drawn_again(engine: BuiltinEngine) -> None:
    frames = FrameCache()
    first = server(engine, frames).observe().observation
    engine.reset(1)
    second = server(engine, frames)
    assert second.observe().observation is first
    assert (frames.drawn, frames.found) == (1, 1)
    # What a kept view lists counts as seen.
    assert PLATE in second.seen
    assert second.execute(Pick("Plate_57")).feedback.code != "not_seen"


def test_what_the_state_hash_leaves_out_makes_another_view(engine: BuiltinEngine) -> None:
    frames = FrameCache()
    here = server(engine, frames)
    bright, before = here.observe(), engine.state().hash()
    engine.apply(LightChanged(0, 0.1))
    dark = here.observe()
    assert engine.state().hash() == before == dark.state_hash
    assert dark.observation.frame.data != bright.observation.frame.data
    engine.apply(ObjectTaken(PLATE))
    assert all(item.tag != "Plate_57" for item in here.observe().observation.objects)
    engine.reset(0)
    assert here.observe().observation is bright.observation


def test_figure_furniture_and_settings_make_another_view(engine: BuiltinEngine) -> None:
    class Other:
        scene = replace(engine.scene, digest="of another figure or other furniture")
        snapshot = engine.snapshot

    other: Any = Other()
    plain = PerceptionConfig()
    settings = [
        (engine, TINY, plain),
        (other, TINY, plain),
        (engine, SMALL, plain),
        (engine, TINY, replace(plain, labeling=Labeling.OPAQ)),
        (engine, TINY, replace(plain, grid=3)),
        (engine, TINY, replace(plain, jpeg_quality=50)),
        (engine, TINY, replace(plain, points_on_walls=False)),
    ]
    assert len({view_key(*setting) for setting in settings}) == len(settings)


def test_two_figures_and_two_scenes_have_digests_of_their_own() -> None:
    engines = [adamo_vh.create_engine(*made) for made in (("s1",), ("s1", "ken"), ("s2",))]
    keys = {view_key(engine, TINY, PerceptionConfig()) for engine in engines}
    for engine in engines:
        engine.close()
    assert len(keys) == 3


def test_what_cannot_be_told_apart_is_always_drawn(engine: BuiltinEngine) -> None:
    class Own:
        described = "own"
        tag = short = staticmethod(Labeling.SEM.tag)
        resolve = staticmethod(Labeling.SEM.resolve)

    class Silent:
        scene = replace(engine.scene, digest="")

        def __getattr__(self, name: str) -> Any:
            return getattr(engine, name)

    silent: Any = Silent()
    frames = FrameCache()
    for here in (server(engine, frames, labeling=Own()), server(silent, frames)):
        assert here.observe().observation is not here.observe().observation
    assert (frames.drawn, frames.found) == (4, 0)


def test_a_moment_of_an_action_is_never_kept(engine: BuiltinEngine) -> None:
    here = server(engine, FrameCache())
    first = here.observe().observation
    watched: list[Observation] = []
    moments = count()

    def watch(_: float) -> bool:
        if next(moments) % 8 == 0:
            watched.append(here.observe().observation)
        return True

    engine.stage.watcher = watch
    try:
        here.execute(Walk(-1.6, -2.0, 0.0))
    finally:
        engine.stage.watcher = None
    assert watched[0] is not first
    assert watched[-1].agent.position.horizontal_distance(first.agent.position) > 0.5
    engine.reset(0)
    assert here.observe().observation is first


def test_no_more_is_kept_than_was_allowed(engine: BuiltinEngine) -> None:
    frames = FrameCache(megabytes=0.15)
    here = server(engine, frames)
    for x in (0.0, 0.2, 0.4, 0.6):
        here.execute(Look(x, -1.0, 0.8))
    assert 0 < frames.kept < 4
    assert frames.size <= 0.15 * 2**20
    nothing = FrameCache(megabytes=0)
    here = server(engine, nothing)
    here.observe()
    here.observe()
    assert (nothing.drawn, nothing.kept, nothing.size) == (2, 0, 0)
    with pytest.raises(ConfigError, match="use a number from 0"):
        FrameCache(-1)


@pytest.mark.parametrize("task", ["T1", "T8"])
def test_an_episode_is_the_same_with_and_without(
    task: str, engine: BuiltinEngine, tmp_path: Path
) -> None:
    frames = FrameCache()
    settings: Any = {"task": task, "engine": engine, "resolution": SMALL}
    adamo_vh.run_episode(**settings, out=tmp_path / "without")
    for number in ("first", "second"):
        adamo_vh.run_episode(**settings, out=tmp_path / number, frame_cache=frames)
        assert_the_same_record(tmp_path / "without", tmp_path / number)
    assert frames.found >= frames.drawn > 0


def test_a_body_far_from_where_it_was_sees_something_else(engine: BuiltinEngine) -> None:
    frames = FrameCache()
    here = server(engine, frames)
    first = here.observe().observation
    engine.body.walk(Vec3(-1.0, -3.0, 0.0))
    assert here.observe().observation.camera != first.camera
    assert here.observe().observation.agent != first.agent
