"""An engine serves the next episode only if that one goes as in an engine made for it."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from adamo_vh.engine import LightChanged, ObjectTaken
from adamo_vh.geometry import Vec3
from adamo_vh.session.spare import close_spares, engine_for

SMALL = (64, 36)


@pytest.fixture(autouse=True)
def none_at_hand():
    close_spares()
    yield
    close_spares()


def used(scene: str = "s1", figure: str = "mara"):
    with engine_for(scene, figure) as engine:
        return engine


def test_the_next_episode_in_the_same_place_gets_the_same_engine():
    first = used()
    assert used() is first
    assert used(figure="ken") is not first
    assert used() is first


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


def test_two_at_once_have_one_each():
    with engine_for("s1", "mara") as one, engine_for("s1", "mara") as other:
        assert one is not other


def test_one_that_does_not_come_back_to_its_start_is_replaced():
    with engine_for("s1", "mara") as engine:
        engine._settled[:] += 0.01
    assert used() is not engine


def test_a_changed_scene_file_is_another_place(tmp_path: Path):
    from adamo_vh.runtime.scenes.scene import load_scene
    from adamo_vh.runtime.scenes.writing import scene_toml

    file = tmp_path / "mine.toml"
    file.write_text(scene_toml(load_scene("s1")))
    first = used(str(file))
    assert used(str(file)) is first
    file.write_text(file.read_text().replace("ambient = 0.", "ambient = 0.1", 1))
    assert used(str(file)) is not first


def test_no_more_than_two_stay():
    engines = [used(figure=figure) for figure in ("mara", "ken", "jonas")]
    assert used(figure="mara") is not engines[0]
    assert used(figure="jonas") is engines[2]


def test_a_child_process_makes_its_own():
    engine = used()
    read, write = os.pipe()
    child = os.fork()
    if child == 0:
        from adamo_vh.session import spare

        os.write(write, b"1" if spare._taken(spare._spares[0].place) is None else b"0")
        os._exit(0)
    os.waitpid(child, 0)
    assert os.read(read, 1) == b"1"
    assert used() is engine
