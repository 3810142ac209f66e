"""Hands close around what they hold, by its size, and are never flat when they are empty."""

from __future__ import annotations

import numpy as np
import pytest
from tests.runtime.human.body_limits import limit_excess

from adamo_vh.runtime.human.anatomy import FINGER_AXIS, grip
from adamo_vh.runtime.human.closing import FINGER_JOINTS
from adamo_vh.runtime.human.grasp import Grip, Thing, Way, way_of
from adamo_vh.runtime.human.hand import AXES, FINGERS, finger_points
from adamo_vh.runtime.human.postures import CARRY, carrying, standing
from adamo_vh.runtime.human.rotations import rotation_vectors
from adamo_vh.runtime.human.skeleton import INDEX, joint_frames

_SKIN_M = 0.013
"""From the bones of a hand to its skin, and a little more."""


def cylinder(radius: float, height: float) -> Thing:
    turn, z = np.meshgrid(np.linspace(0, 2 * np.pi, 60), np.linspace(-0.5, 0.5, 40) * height)
    return Thing.around(
        np.stack([radius * np.cos(turn), radius * np.sin(turn), z], -1).reshape(-1, 3)
    )


THINGS = {
    "bottle": (cylinder(0.032, 0.24), Way.ROUND),
    "can": (cylinder(0.035, 0.105), Way.ROUND),
    "jar": (cylinder(0.054, 0.15), Way.ROUND),
    "cup": (Thing.box(0.149, 0.105, 0.131), Way.ROUND),
    "key": (Thing.box(0.055, 0.024, 0.002), Way.TIPS),
    "lock": (Thing.box(0.045, 0.02, 0.077), Way.TIPS),
    "torch": (Thing.box(0.18, 0.045, 0.045), Way.TIPS),
    "roll": (cylinder(0.068, 0.043), Way.RIM),
    "plate": (cylinder(0.125, 0.03), Way.RIM),
    "plant": (cylinder(0.125, 0.34), Way.BOTH),
    "binoculars": (Thing.box(0.192, 0.173, 0.069), Way.BOTH),
    "laptop": (Thing.box(0.34, 0.30, 0.03), Way.TRAY),
}


def bones(pose, side):
    """(15, 2, 3) both ends of every bone of a hand's fingers, in the body frame."""
    places, rotations = joint_frames(pose)
    found = []
    for finger in FINGERS:
        points = finger_points(finger)
        for k in (1, 2, 3):
            j = INDEX[f"{finger}_{k}_{side}"]
            bone = (points[k] - points[k - 1]) @ AXES[side]
            found.append((places[j], places[j] + rotations[j] @ bone))
    return np.array(found)


@pytest.mark.parametrize(("thing", "way"), THINGS.values(), ids=THINGS)
def test_things_are_held_by_their_size(thing, way):
    assert way_of(thing) is way


@pytest.mark.parametrize("heading", [0.0, 0.8, 2.5])
@pytest.mark.parametrize("name", THINGS)
def test_a_thing_is_where_it_is_carried_and_no_joint_is_overbent(name, heading):
    hold = Grip.of(THINGS[name][0], heading)
    pose = carrying(standing(), hold)
    assert np.linalg.norm(grip(pose, "r", hold.offset) - CARRY) < 0.03
    assert limit_excess(pose).max() == 0.0


@pytest.mark.parametrize("radius", [0.022, 0.032, 0.045, 0.054])
def test_fingers_and_thumb_lie_on_something_round_and_not_in_it(radius):
    pose = carrying(standing(), Grip.of(cylinder(radius, 0.2), 0.0))
    ends = bones(pose, "r")
    along = np.linspace(0, 1, 9)[:, None]
    points = np.stack([a + along * (b - a) for a, b in ends])[..., :2]
    away = np.linalg.norm(points - CARRY[:2], axis=-1) - radius
    assert away.min() > 0.004  # flesh gives way a little
    touching = (away.min(axis=1) < _SKIN_M).reshape(5, 3)
    assert touching.any(axis=1).all(), dict(zip(FINGERS, away.min(axis=1), strict=False))
    # Around it: from the thumb to the tips they go more than half round.
    angles = np.sort(np.arctan2(*(points - CARRY[:2]).reshape(-1, 2).T))
    gap = np.diff(angles, append=angles[0] + 2 * np.pi).max()
    assert gap < np.radians(200.0)


def test_a_key_is_between_the_tips_of_thumb_and_fingers():
    hold = Grip.of(THINGS["key"][0], 0.0)
    pose = carrying(standing(), hold)
    tips = bones(pose, "r")[:, 1].reshape(5, 3, 3)[:, 2]
    middle = grip(pose, "r", hold.offset)
    thumb, index = tips[0], tips[1]
    assert np.linalg.norm((thumb + index) / 2 - middle) < 0.012
    assert np.linalg.norm(thumb - index) < 0.06


@pytest.mark.parametrize("name", ["plant", "binoculars", "laptop"])
def test_both_hands_have_what_is_large(name):
    thing = THINGS[name][0]
    pose = carrying(standing(), Grip.of(thing, 0.4))
    seen = thing.seen_from(0.4)
    for side in "lr":
        palm = joint_frames(pose)[0][INDEX[f"middle_1_{side}"]] - CARRY
        far = np.hypot(palm[0], palm[1]) - seen.side(palm, 0.0, 1.0)
        assert -0.13 < far < 0.05
    left, right = (joint_frames(pose)[0][INDEX[f"hand_{s}"]] for s in "lr")
    assert left[1] - right[1] > 0.16
    with_one = carrying(standing(), Grip.of(THINGS["jar"][0], 0.4))
    hanging = joint_frames(with_one)[0][INDEX["hand_l"]]
    assert np.allclose(hanging, joint_frames(standing())[0][INDEX["hand_l"]])


def test_an_empty_hand_is_curled_and_not_flat():
    pose = standing()
    for side in "lr":
        bends = rotation_vectors(pose.rotations[FINGER_JOINTS[side]]) @ FINGER_AXIS[side]
        fingers = bends.reshape(5, 3)[1:]
        assert (fingers.sum(axis=1) > np.radians(12.0)).all()
        assert fingers[-1].sum() > fingers[0].sum()


def test_an_outline_turns_with_the_body_that_sees_it():
    thing = Thing.box(0.3, 0.1, 0.1)
    ahead = np.array([1.0, 0.0, 0.0])
    assert thing.side(ahead, 0.0) == pytest.approx(0.15, abs=0.005)
    assert thing.seen_from(np.pi / 2).side(ahead, 0.0) == pytest.approx(0.05, abs=0.005)
    assert thing.widths()[0] == pytest.approx(0.1, abs=0.01)
    lopsided = Thing.around(np.array([[0.0, 0.2, 0.0], [0.0, -0.1, 0.0], [0.1, 0.0, 0.01]]))
    assert lopsided.mirrored().side(np.array([0.0, -1.0]), 0.0) == pytest.approx(0.2, abs=0.01)
