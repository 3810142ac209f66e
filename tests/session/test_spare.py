"""An engine serves the next episode only if that one goes as in an engine made for it."""

from __future__ import annotations

import os
from pathlib import Path

import pytest
from tests.records import assert_the_same_record

from adamo_vh.action import Look, Pick, Walk
from adamo_vh.action_server import PAPER_TOOLS, Tool
from adamo_vh.engine import LightChanged, ObjectTaken
from adamo_vh.episode.result import EpisodeResult
from adamo_vh.geometry import Vec3
from adamo_vh.record.termination import TerminationReason
from adamo_vh.session.runs import run_episode
from adamo_vh.session.session import Session
from adamo_vh.session.spare import close_spares, engine_for

SMALL = (64, 36)


@pytest.fixture(autouse=True)
def none_at_hand():
    close_spares()
    yield
    close_spares()


def played(out: Path | None = None) -> EpisodeResult:
    return run_episode(task="T2", model="baseline", resolution=(160, 90), out=out)


def used(scene: str = "s1", figure: str = "mara"):
    with engine_for(scene, figure) as engine:
        return engine


def test_the_next_episode_in_the_same_place_gets_the_same_engine(bare_scene):
    first = used(bare_scene)
    assert used(bare_scene) is first
    assert used(bare_scene, "ken") is not first
    assert used(bare_scene) is first


def test_whatever_was_done_in_it_it_is_as_new():
    with engine_for("s1", "mara") as engine:
        start, picture = engine.state().hash(), engine.capture(*SMALL).rgb.tobytes()
        engine.apply(ObjectTaken(57))
        engine.apply(LightChanged(0, 0.1))
        engine.body.walk(Vec3(-1.0, 0.5, 0.0))
        engine.stage.watcher = lambda seconds: True
    with engine_for("s1", "mara") as again:
        assert again is engine
        assert again.state().hash() == start
        assert again.capture(*SMALL).rgb.tobytes() == picture
        assert again.stage.watcher is None


def test_two_at_once_have_one_each(bare_scene):
    with engine_for(bare_scene, "mara") as one, engine_for(bare_scene, "mara") as other:
        assert one is not other


def test_one_that_does_not_come_back_to_its_start_is_replaced(bare_scene):
    with engine_for(bare_scene, "mara") as engine:
        engine._settled[:] += 0.01
    assert used(bare_scene) is not engine


def test_a_changed_scene_file_is_another_place(tmp_path: Path):
    from adamo_vh.runtime.scenes.scene import load_scene
    from adamo_vh.runtime.scenes.writing import scene_toml

    file = tmp_path / "mine.toml"
    file.write_text(scene_toml(load_scene("s1")))
    first = used(str(file))
    assert used(str(file)) is first
    file.write_text(file.read_text().replace("ambient = 0.", "ambient = 0.1", 1))
    assert used(str(file)) is not first


def test_no_more_than_two_stay(bare_scene):
    engines = [used(bare_scene, figure) for figure in ("mara", "ken", "jonas")]
    assert used(bare_scene, "mara") is not engines[0]
    assert used(bare_scene, "jonas") is engines[2]


def test_a_child_process_makes_its_own(bare_scene):
    engine = used(bare_scene)
    read, write = os.pipe()
    child = os.fork()
    if child == 0:
        from adamo_vh.session import spare

        os.write(write, b"1" if spare._taken(spare._spares[0].place) is None else b"0")
        os._exit(0)
    os.waitpid(child, 0)
    assert os.read(read, 1) == b"1"
    assert used(bare_scene) is engine


def test_an_episode_is_recorded_as_in_an_engine_made_for_it(tmp_path: Path):
    played(tmp_path / "alone")
    run_episode(task="T9", model="random", resolution=(64, 64), out=tmp_path / "between")
    played(tmp_path / "later")
    assert_the_same_record(tmp_path / "alone", tmp_path / "later")


def test_an_engine_that_an_episode_broke_serves_no_other():
    broken = []

    def break_it(context, action):
        # What a fault in the graphics driver leaves behind: a world that is not what it was.
        broken.append(context.body)
        context.body._world.data.qpos[:] += 0.3
        raise RuntimeError("lost")

    tools = [Tool(Look, break_it), *PAPER_TOOLS[1:]]
    result = run_episode("Look at the plate", model="baseline", tools=tools, resolution=(64, 64))
    if broken:
        assert result.termination is TerminationReason.BROKEN
    assert played().completion == 1.0


def test_a_session_gives_its_engine_back_when_it_is_closed(bare_scene):
    from adamo_vh.episode.config import EpisodeConfig

    config = EpisodeConfig.of("Stand still", model="random", resolution=(64, 64), scene=bare_scene)
    with Session.begin(config) as session:
        engine = session.engine
        assert used(bare_scene) is not engine
    with engine_for(bare_scene, "mara") as one, engine_for(bare_scene, "mara") as other:
        assert engine in (one, other)


def test_a_variation_is_a_place_of_its_own():
    with engine_for("s1", "mara", 1) as varied:
        assert varied.scene.variation == 1
    assert used() is not varied
    with engine_for("s1", "mara", 1) as again:
        assert again is varied


@pytest.mark.parametrize("action", [Walk(0.5, 0.5, 0.0), Look(1.0, 0.0, 1.0), Pick("57")])
def test_what_the_last_body_did_is_not_seen(action):
    from adamo_vh.action_server import LocalActionServer

    with engine_for("s1", "mara") as engine:
        server = LocalActionServer(engine, resolution=SMALL)
        first = server.observe()
        server.execute(action)
    with engine_for("s1", "mara") as engine:
        again = LocalActionServer(engine, resolution=SMALL).observe()
    assert again.state_hash == first.state_hash
    assert again.observation.frame == first.observation.frame
    assert again.observation.objects == first.observation.objects
