"""Poses of the built-in engine: all that moves is told, once, and nothing else changes."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
import pytest

from adamo_vh.engine import LightChanged, ObjectMoved, ObjectTaken
from adamo_vh.errors import ConfigError
from adamo_vh.geometry import Vec3
from adamo_vh.runtime.builtin import BuiltinEngine
from adamo_vh.runtime.human.skeleton import JOINTS, Pose, joint_frames
from adamo_vh.session.posing import RATE_HZ, Posing, joint_names


@pytest.fixture
def posing(engine: BuiltinEngine) -> Iterator[Posing]:
    made = Posing(engine)
    yield made
    made.close()


def told_by(engine: BuiltinEngine, act: Callable[[], Any], what: Callable[[Posing], Any]) -> list:
    """What is told at every moment of an action."""
    told: list[Any] = []

    def moment() -> bool:
        told.append(what(watch))
        return True

    watch = Posing(engine, moment)
    try:
        act()
    finally:
        watch.close()
    return told


def whole(pose):
    """The joints' places that a page makes of a pose, in the world."""
    x, y, heading = pose.body
    turns = np.array(pose.joints).reshape(-1, 4)
    qx, qy, qz, qw = turns.T
    rows = [
        [1 - 2 * (qy * qy + qz * qz), 2 * (qx * qy - qz * qw), 2 * (qx * qz + qy * qw)],
        [2 * (qx * qy + qz * qw), 1 - 2 * (qx * qx + qz * qz), 2 * (qy * qz - qx * qw)],
        [2 * (qx * qz - qy * qw), 2 * (qy * qz + qx * qw), 1 - 2 * (qx * qx + qy * qy)],
    ]
    rotations = np.moveaxis(np.array(rows), -1, 0)
    bent = Pose(rotations, np.array(pose.pelvis) - [0, 0, 0.93])
    places, _ = joint_frames(bent)
    cos, sin = np.cos(heading), np.sin(heading)
    return places @ np.array([[cos, -sin, 0], [sin, cos, 0], [0, 0, 1]]).T + [x, y, 0]


def test_the_first_pose_has_everything_and_the_next_nothing(engine, posing):
    first = posing.pose()
    assert first is not None
    assert len(first.joints) == 4 * len(JOINTS) == 4 * len(joint_names())
    assert set(first.things) == {str(item.id) for item in engine.state().objects}
    assert first.gone == () and first.held is None and first.lights
    assert posing.pose() is None


def test_a_thing_stands_where_the_state_has_it(engine, posing):
    told = posing.pose().things
    for item in engine.state().objects:
        box, (*place, x, y, z, w) = item.box, told[str(item.id)]
        assert place == pytest.approx([box.center.x, box.center.y, box.center.z], abs=1e-4)
        turn = box.orientation
        assert (x, y, z, w) == pytest.approx((turn.x, turn.y, turn.z, turn.w), abs=1e-4)


def test_what_the_page_draws_is_what_the_engine_shows(engine):
    poses: list[Any] = []

    def act():
        engine.body.look(Vec3(0.3, 0.2, 0.8))
        engine.body.walk(Vec3(-1.0, -1.0, 0.0))

    def what(watch):
        poses.append(watch.pose() or poses[-1])
        shown = engine.stage.shown(engine.body.stance)
        return np.abs(whole(poses[-1]) - shown.joints()[0]).max()

    apart = told_by(engine, act, what)
    assert len(apart) > RATE_HZ
    assert max(apart) < 0.002


def test_a_thing_that_is_taken_moves_with_the_hand(engine):
    item = engine.state().objects[0]
    told = told_by(engine, lambda: engine.body.pick(item.id), lambda watch: watch.pose())
    poses = [pose for pose in told[1:] if pose is not None]
    assert sum(str(item.id) in pose.things for pose in poses) > 3
    assert poses[-1].held == item.id
    assert all(set(pose.things) <= {str(item.id)} for pose in poses)


def test_simulated_time_grows_from_motion_to_motion(engine):
    def act():
        engine.body.pick(engine.state().objects[0].id)  # It walks, turns and takes.
        engine.body.look(Vec3(0.0, 0.0, 1.0))

    seconds = told_by(engine, act, lambda watch: watch.seconds)
    assert seconds == sorted(seconds) and seconds[0] == 0.0
    steps = np.diff(seconds)
    assert steps.max() == pytest.approx(1 / RATE_HZ, abs=1e-6)


def test_what_others_do_is_told(engine, posing):
    posing.pose()
    state = engine.state()
    engine.apply(ObjectTaken(state.objects[0].id))
    taken = posing.pose()
    assert taken.gone == (state.objects[0].id,) and str(state.objects[0].id) not in taken.things
    engine.apply(ObjectMoved(state.objects[1].id, Vec3(0.0, 0.0, 0.8)))
    assert str(state.objects[1].id) in posing.pose().things
    engine.apply(LightChanged(0, 0.2))
    told = posing.pose()
    assert told.lights[0] == pytest.approx(0.2) and told.things == {} and told.gone is None


def test_a_pose_that_is_left_out_hands_its_changes_on(engine, posing):
    first = posing.pose()
    engine.apply(ObjectMoved(engine.state().objects[1].id, Vec3(0.0, 0.0, 0.8)))
    both = posing.pose().after(first)
    assert set(both.things) == set(first.things) and both.lights == first.lights
    assert both.things != first.things


def test_looking_on_changes_nothing(engine):
    def played():
        engine.reset(0)
        engine.body.pick(engine.state().objects[0].id)
        return engine.state().hash()

    alone = played()
    posing = Posing(engine)
    try:
        assert played() == alone
    finally:
        posing.close()
    assert engine.stage.watcher is None and engine.stage.moments_per_s == 15


def test_another_engine_is_refused(lent):
    with pytest.raises(ConfigError, match="built-in engine"):
        Posing(lent)
