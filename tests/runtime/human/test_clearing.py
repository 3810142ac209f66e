"""Arms keep out of furniture: elbow, way of the hand and left arm; where the reach ends stays."""

from __future__ import annotations

import numpy as np
import pytest
from tests.runtime.human.body_limits import limit_excess

from adamo_vh.geometry import Solid
from adamo_vh.runtime.human.anatomy import grip
from adamo_vh.runtime.human.clearing import swung
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
    same_reach(plain, clear)


LAMP = Solids.of([Solid(0.42, -0.16, 0.08, 0.08, 0.0, 0.8, 1.2)])
"""On a table, between her and what she takes."""
SIDE = Solids.of([Solid(0.35, 0.3, 0.25, 0.04, 0.0, 0.0, 2.0)])
"""Of a bookcase, on her left."""


def hand_in(hand: Handling, solids: Solids) -> float:
    """How deep the hand is in something, summed over a reach."""
    times = np.linspace(0.0, hand.duration_s, 40)
    places = np.array([grip(hand.pose(time_s), "r") for time_s in times])
    return float(solids.depth(places, 0.05).sum())


def left_in(hand: Handling, solids: Solids) -> float:
    """How deep the left forearm is in something, summed over a reach."""
    total = 0.0
    for time_s in np.linspace(0.0, hand.duration_s, 30):
        places, _ = joint_frames(hand.pose(time_s))
        elbow, wrist = places[INDEX["forearm_l"]], places[INDEX["hand_l"]]
        points = elbow + np.linspace(0.2, 1.2, 8)[:, None] * (wrist - elbow)
        total += float(solids.depth(points, 0.04).sum())
    return total


@pytest.mark.parametrize("takes", [True, False])
def test_the_hand_goes_around_a_lamp(takes: bool) -> None:
    plain = Handling(np.array([0.62, -0.16, 0.85]), AHEAD, takes)
    clear = plain.clear(LAMP.depth)
    assert hand_in(plain, LAMP) > 0.1
    assert hand_in(clear, LAMP) < 0.3 * hand_in(plain, LAMP)
    same_reach(plain, clear)


def test_the_left_arm_keeps_out_of_a_bookcase() -> None:
    plain = Handling(np.array([0.6, 0.0, 1.75]), AHEAD, takes=True)
    clear = plain.clear(SIDE.depth)
    assert left_in(plain, SIDE) > 0.1
    assert left_in(clear, SIDE) < 0.5 * left_in(plain, SIDE)
    same_reach(plain, clear)


def same_reach(plain: Handling, clear: Handling) -> None:
    """No joint is overbent, and the reach begins, takes and ends where it did."""
    times = np.linspace(0.0, clear.duration_s, 40)
    assert max(limit_excess(clear.pose(time_s)).max() for time_s in times) == 0.0
    for time_s in (0.0, clear.duration_s):
        before, after = plain.pose(time_s), clear.pose(time_s)
        np.testing.assert_allclose(after.rotations, before.rotations, atol=1e-9)
    taken = grip(plain.pose(plain.event_s), "r")
    np.testing.assert_allclose(grip(clear.pose(clear.event_s), "r"), taken, atol=0.01)


def test_where_nothing_is_in_the_way_nothing_changes() -> None:
    reach = Handling(np.array([0.65, 0.2, 1.28]), AHEAD, takes=True)
    clear = reach.clear(Solids.of([]).depth)
    assert (clear.swing_rad, clear.left_rad) == (0.0, (0.0, 0.0)) and not clear.detour.any()


def test_depth_is_how_far_a_ball_must_move_to_be_outside() -> None:
    points = np.array([[0.8, 0.0, 1.24], [0.8, 0.0, 1.27], [0.8, 0.0, 1.3], [0.22, 0.0, 1.235]])
    np.testing.assert_allclose(BOARD.depth(points, 0.04), [0.05, 0.02, 0.0, 0.01], atol=1e-9)
    assert Solids.of([]).depth(points, 0.04).tolist() == [0.0] * 4
