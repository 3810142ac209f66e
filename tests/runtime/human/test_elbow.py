"""The elbow keeps the arm out of furniture, and hand and shoulder stay where they are."""

from __future__ import annotations

import numpy as np
import pytest
from tests.runtime.human.body_limits import limit_excess

from adamo_vh.geometry import Solid
from adamo_vh.runtime.human.elbow import swung
from adamo_vh.runtime.human.handling import Handling
from adamo_vh.runtime.human.reach import reaching
from adamo_vh.runtime.human.skeleton import INDEX, Pose, joint_frames
from adamo_vh.runtime.solids import Solids

AHEAD = np.array([1.0, 0.0, -0.2])
BOARD = Solids.of([Solid(0.85, 0.0, 0.6, 0.8, 0.0, 1.22, 1.25)])
"""Of a shelf, 1.25 m high and 0.25 m ahead."""
ARM = [INDEX[name] for name in ("upper_arm_r", "forearm_r", "hand_r")]


def deep(hand: Handling) -> float:
    """How deep the arm is in the board, summed over a reach."""
    total = 0.0
    for time_s in np.linspace(0.0, hand.duration_s, 30):
        places, _ = joint_frames(hand.pose(time_s))
        shoulder, elbow, wrist = places[ARM]
        along = np.linspace(0.2, 0.9, 6)[:, None]
        points = [shoulder + along * (elbow - shoulder), elbow + along * (wrist - elbow)]
        total += float(BOARD.depth(np.concatenate(points), 0.04).sum())
    return total


@pytest.mark.parametrize("angle", [-0.8, 0.5])
@pytest.mark.parametrize("target", [(0.6, -0.1, 1.0), (0.5, 0.1, 1.5), (0.4, -0.2, 0.2)])
def test_only_the_elbow_moves(angle: float, target: tuple[float, float, float]) -> None:
    pose = reaching(Pose(), np.array(target))
    (places, turns), (after, turned) = joint_frames(pose), joint_frames(swung(pose, angle))
    assert np.linalg.norm(after[ARM[1]] - places[ARM[1]]) > 0.01
    others = [j for j in range(len(places)) if j != ARM[1]]
    np.testing.assert_allclose(after[others], places[others], atol=1e-9)
    kept = [j for j in range(len(places)) if j not in ARM[:2]]
    np.testing.assert_allclose(turned[kept], turns[kept], atol=1e-9)


@pytest.mark.parametrize("takes", [True, False])
@pytest.mark.parametrize("target", [(0.65, -0.2, 1.28), (0.65, 0.2, 1.28), (0.85, 0.2, 1.28)])
def test_the_arm_goes_over_a_board(target: tuple[float, float, float], takes: bool) -> None:
    plain = Handling(np.array(target), AHEAD, takes)
    clear = plain.clear(BOARD.depth)
    assert abs(clear.swing_rad) > 0.1
    assert deep(clear) < 0.7 * deep(plain)
    poses = [clear.pose(time_s) for time_s in np.linspace(0.0, clear.duration_s, 40)]
    assert max(limit_excess(pose).max() for pose in poses) == 0.0
    ends = clear.pose(0.0), clear.pose(clear.duration_s)
    for end, before in zip(ends, (plain.pose(0.0), plain.pose(plain.duration_s)), strict=True):
        np.testing.assert_allclose(end.rotations, before.rotations, atol=1e-9)


def test_where_nothing_is_in_the_way_nothing_changes() -> None:
    reach = Handling(np.array([0.65, 0.2, 1.28]), AHEAD, takes=True)
    assert reach.clear(Solids.of([]).depth).swing_rad == 0.0


def test_depth_is_how_far_a_ball_must_move_to_be_outside() -> None:
    points = np.array([[0.8, 0.0, 1.24], [0.8, 0.0, 1.27], [0.8, 0.0, 1.3], [0.22, 0.0, 1.235]])
    np.testing.assert_allclose(BOARD.depth(points, 0.04), [0.05, 0.02, 0.0, 0.01], atol=1e-9)
    assert Solids.of([]).depth(points, 0.04).tolist() == [0.0] * 4
