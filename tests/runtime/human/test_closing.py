"""The shapes of a hand: joints bend as fingers do, and touch what they should."""

from __future__ import annotations

import numpy as np
import pytest

from adamo_vh.runtime.human.anatomy import FINGER_AXIS, mirrored
from adamo_vh.runtime.human.closing import (
    FINGER_JOINTS,
    MOST_GAP_M,
    PALM_M,
    around,
    at_ease,
    flat,
    mirrored_shape,
    opened,
    pinch_middle,
    pinching,
    round_middle,
    under,
)
from adamo_vh.runtime.human.grasp import Grip, Thing
from adamo_vh.runtime.human.hand import AXES, FINGERS, KNUCKLES, WRIST, axes, finger_points
from adamo_vh.runtime.human.ik import hand_to
from adamo_vh.runtime.human.postures import fingered, standing
from adamo_vh.runtime.human.rotations import about_z, angles, rotation_vectors
from adamo_vh.runtime.human.skeleton import INDEX, JOINTS, PARENTS, REST, Pose, joint_frames

SHAPES = {
    "at ease": at_ease(),
    "flat": flat(),
    **{f"around {r} mm": around(r) for r in range(8, 59, 10)},
    **{f"a gap of {g} mm": pinching(g) for g in (3, 15, 30, 45)},
    **{f"under {h} mm": under(h) for h in (5, 30, 60)},
    "about to close": opened(around(30)),
}


def tips(shape):
    """(5, 4, 3) joints and tips of the left fingers, in the frame of the hand."""
    places, rotations = joint_frames(fingered(Pose(), shape, "l"))
    found = []
    for finger in FINGERS:
        joints = [INDEX[f"{finger}_{k}_l"] for k in (1, 2, 3)]
        points = finger_points(finger)
        last = places[joints[2]] + rotations[joints[2]] @ ((points[3] - points[2]) @ AXES["l"])
        found.append(np.stack([*places[joints], last]))
    return (np.array(found) - np.array(WRIST)) @ AXES["l"].T


def test_the_axes_of_a_hand_are_at_right_angles_and_mirrored():
    for side in "lr":
        np.testing.assert_allclose(axes(side) @ axes(side).T, np.eye(3), atol=1e-12)
    np.testing.assert_allclose(axes("r"), axes("l") * [1.0, -1.0, 1.0])
    along = np.subtract(KNUCKLES, WRIST)
    assert along @ axes("l")[0] == pytest.approx(np.linalg.norm(along))
    assert axes("l")[2][1] < 0 < axes("r")[2][1]  # palms face the body


def test_every_finger_has_three_joints_in_a_row_on_both_sides():
    for side in "lr":
        for finger in FINGERS:
            chain = [INDEX[f"{finger}_{k}_{side}"] for k in (1, 2, 3)]
            assert [PARENTS[j] for j in chain] == [INDEX[f"hand_{side}"], *chain[:2]]
    np.testing.assert_allclose(
        REST[FINGER_JOINTS["r"]], REST[FINGER_JOINTS["l"]] * [1.0, -1.0, 1.0]
    )
    assert len(JOINTS) == 52


def test_in_the_rest_pose_fingers_are_where_the_table_says():
    still = np.tile(np.eye(3), (15, 1, 1))
    for number, finger in enumerate(FINGERS):
        np.testing.assert_allclose(tips(still)[number], finger_points(finger), atol=1e-9)


@pytest.mark.parametrize("shape", SHAPES.values(), ids=SHAPES)
def test_fingers_bend_about_one_axis_and_never_backwards(shape):
    turns = rotation_vectors(shape).reshape(5, 3, 3)[1:]
    bends = turns @ FINGER_AXIS["l"]
    np.testing.assert_allclose(np.linalg.norm(turns, axis=2), np.abs(bends), atol=0.02)
    rest = np.radians([10.0, 20.0, 14.0])
    whole = np.degrees(bends + rest)
    assert whole.min() > -10.0
    assert (whole.max(axis=0) < [92.0, 110.0, 75.0]).all()


@pytest.mark.parametrize("radius_mm", range(10, 56, 9))
def test_a_larger_thing_opens_the_hand_further(radius_mm):
    def reach(shape):
        return np.linalg.norm(tips(shape)[1:, 3] - tips(shape)[0, 3], axis=1).mean()

    if radius_mm > 14:
        assert reach(around(radius_mm)) > reach(around(radius_mm - 9)) - 0.004
    middle = round_middle(radius_mm / 1000)
    assert middle[2] == pytest.approx(PALM_M + radius_mm / 1000)
    # The tip of the middle finger is on the far side, the thumb's on the near one.
    points = tips(around(radius_mm))
    assert points[2, 3, 2] > middle[2] - (0.0 if radius_mm < 50 else 0.02)
    assert points[0, 3, 0] < points[2, 1:, 0].max()


@pytest.mark.parametrize("gap_mm", [3, 15, 30, 45])
def test_tips_are_a_gap_apart_around_its_middle(gap_mm):
    points = tips(pinching(gap_mm))
    thumb, index = points[0, 3], points[1, 3]
    gap = np.linalg.norm((index - thumb)[[0, 2]])
    assert gap == pytest.approx(gap_mm / 1000 + 0.0124, abs=0.008)
    middle = (thumb + index) / 2
    assert np.linalg.norm((middle - pinch_middle(gap_mm / 1000))[[0, 2]]) < 0.006
    assert gap_mm <= MOST_GAP_M * 1000


def test_under_something_flat_only_the_thumb_is_above():
    points = tips(under(20))
    assert points[1:, 1:, 2].max() < PALM_M + 0.002
    assert points[0, 3, 2] > PALM_M + 0.02


def test_an_opened_hand_is_between_flat_and_closed():
    far = angles(flat(), around(20)).max()
    assert angles(opened(around(20)), around(20)).max() < far
    assert angles(opened(around(20)), flat()).max() < far


def test_the_other_hand_is_the_mirror_image():
    both = fingered(fingered(Pose(), around(30), "l"), mirrored_shape(around(30)), "r")
    np.testing.assert_allclose(mirrored(both).rotations, both.rotations, atol=1e-12)


@pytest.mark.parametrize("yaw", [-0.5, 0.0, 0.6])
@pytest.mark.parametrize("place", [(0.35, -0.2, 1.05), (0.3, -0.15, 1.0), (0.3, -0.3, 1.2)])
def test_a_hand_is_turned_as_wished_where_the_arm_reaches(yaw, place):
    upright = Grip.of(Thing.box(0.06, 0.06, 0.2), 0.0).home()
    assert upright is not None
    wish = about_z(yaw) @ upright
    offset = np.array([0.01, 0.02, -0.09])
    pose, gap = hand_to(standing(), np.array(place), wish, offset)
    places, rotations = joint_frames(pose)
    j = INDEX["hand_r"]
    reached = places[j] + rotations[j] @ offset
    assert np.linalg.norm(reached - place) == pytest.approx(gap, abs=1e-9)
    assert gap < 0.02
    assert angles(rotations[j], wish) < np.radians(6.0)
    wrist = float(np.linalg.norm(rotation_vectors(pose.rotations[j])))
    assert wrist < np.radians(93.0)


def test_what_is_too_far_leaves_the_hand_stretched_towards_it():
    target = np.array([1.4, -0.2, 1.2])
    pose, gap = hand_to(standing(), target, np.eye(3), np.array([0.0, 0.0, -0.08]))
    assert gap > 0.5
    shoulder = joint_frames(pose)[0][INDEX["upper_arm_r"]]
    wrist = joint_frames(pose)[0][INDEX["hand_r"]] - shoulder
    assert wrist @ (target - shoulder) > 0.97 * np.linalg.norm(wrist) * np.linalg.norm(
        target - shoulder
    )
