"""The kit that people are modelled with: distances, blends, shade, and the binding to joints."""

from __future__ import annotations

import numpy as np
import pytest
from tools.figures import clothes, face, hair
from tools.figures.binding import bind
from tools.figures.hands import hand
from tools.figures.meshing import Mesh, daylight, largest, merged, smoothed, tube
from tools.figures.shapes import (
    both,
    common,
    ellipsoid,
    grown,
    half_space,
    loft,
    minus,
    mirrored,
    round_cone,
    union,
)
from tools.figures.variant import PEOPLE

from adamo_vh.geometry import Array
from adamo_vh.runtime.human.skeleton import EYES, INDEX, REST

BALL = ellipsoid((0.0, 0.0, 0.0), (0.1, 0.1, 0.1))


def at(*points: tuple[float, float, float]) -> Array:
    return np.array(points, float)


def names(points: Array) -> list[int]:
    ids, weights = bind(points)
    return [int(i[w.argmax()]) for i, w in zip(ids, weights, strict=True)]


def test_a_ball_is_an_exact_distance():
    points = np.random.default_rng(0).uniform(-0.3, 0.3, (200, 3))
    np.testing.assert_allclose(BALL(points), np.linalg.norm(points, axis=1) - 0.1, atol=1e-9)


def test_a_round_cone_ends_in_its_two_radii():
    cone = round_cone((0, 0, 0), (0, 0, 1), 0.2, 0.1)
    np.testing.assert_allclose(cone(at((0, 0, -0.2), (0, 0, 1.1), (0.15, 0, 0.5))), 0.0, atol=1e-12)


def test_a_loft_passes_through_its_rows():
    shape = loft([(0.0, 0.0, 0.1, 0.2), (0.5, 0.02, 0.15, 0.1), (1.0, 0.0, 0.1, 0.1)])
    np.testing.assert_allclose(shape(at((0.17, 0, 0.5), (0.02, 0.1, 0.5))), 0.0, atol=1e-9)
    assert shape(at((0, 0, 1.2)))[0] > 0.1


def test_a_smooth_union_only_adds():
    other = ellipsoid((0.12, 0.0, 0.0), (0.1, 0.1, 0.1))
    points = np.random.default_rng(1).uniform(-0.3, 0.3, (500, 3))
    sharp = np.minimum(BALL(points), other(points))
    soft = union(0.05, BALL, other)(points)
    assert (soft <= sharp + 1e-12).all()
    assert (sharp - soft).max() <= 0.05 / 4 + 1e-12


def test_cuts_and_overlaps_take_away():
    half = half_space((0, 0, 0), (0, 0, 1))
    left, right = at((0, 0, 0.05)), at((0, 0, -0.05))
    assert common(0.0, BALL, half)(right)[0] < 0 < common(0.0, BALL, half)(left)[0]
    assert minus(0.0, BALL, half)(left)[0] < 0 < minus(0.0, BALL, half)(right)[0]
    assert grown(BALL, 0.02)(left)[0] == pytest.approx(BALL(left)[0] - 0.02)


def test_a_mirrored_shape_is_the_same_on_both_sides():
    side = ellipsoid((0.0, 0.2, 0.0), (0.1, 0.05, 0.1))
    points = np.random.default_rng(2).uniform(-0.3, 0.3, (100, 3))
    for shape in (mirrored(side), both(0.02, side)):
        np.testing.assert_allclose(shape(points), shape(points * [1, -1, 1]))


def test_smoothing_keeps_the_size():
    path = np.column_stack([np.zeros(40), np.zeros(40), np.linspace(0, 1, 40)])
    mesh = tube(path, np.full(40, 0.1), sides=24)
    before = np.linalg.norm(mesh.vertices[480, :2])
    after = np.linalg.norm(smoothed(mesh, 10).vertices[480, :2])
    assert after == pytest.approx(before, rel=0.05)


def test_only_the_largest_piece_stays():
    big = Mesh(np.eye(4)[:, :3], np.array([[0, 1, 2], [0, 2, 3], [0, 3, 1]]))
    crumb = Mesh(np.eye(3) + 5, np.array([[0, 1, 2]]))
    kept = largest(merged(crumb, big))
    assert len(kept.faces) == 3 and kept.vertices.max() < 2


def test_creases_are_darker_than_open_places():
    pair = union(0.0, BALL, ellipsoid((0.21, 0.0, 0.0), (0.1, 0.1, 0.1)))
    places = at((0.1, 0, 0), (-0.1, 0, 0))
    crease, open_place = daylight(places, np.sign(places), pair)
    assert crease < 0.5
    assert open_place > 0.95


@pytest.mark.parametrize("person", PEOPLE.values(), ids=PEOPLE)
def test_the_body_lies_around_the_skeleton(person):
    joints = {name: at(tuple(REST[j])) for name, j in INDEX.items()}
    assert face.head(person)(joints["head"])[0] < -0.03
    assert clothes.top(person)(joints["chest"])[0] < -0.05
    assert clothes.trousers(person)(joints["shin_l"])[0] < -0.03
    assert clothes.top(person)(joints["forearm_r"])[0] < -0.02
    for finger in ("index_1_l", "middle_2_l", "ring_3_l", "little_2_l", "thumb_2_l"):
        assert hand(person)(joints[finger])[0] < -0.004
    # Between the eyes is the bridge of the nose.
    assert abs(face.head(person)(EYES[None])[0]) < 0.015
    # Hair stays out of the eyes and off the mouth.
    assert hair.hair(person)(EYES[None] + [0.0, 0.033, 0.0])[0] > 0.01


def test_places_follow_the_joint_they_lie_on():
    middle = {
        "upper_arm_l": ("upper_arm_l", "forearm_l"),
        "forearm_r": ("forearm_r", "hand_r"),
        "thigh_l": ("thigh_l", "shin_l"),
        "shin_r": ("shin_r", "foot_r"),
    }
    for name, (a, b) in middle.items():
        place = (REST[INDEX[a]] + REST[INDEX[b]]) / 2
        assert names(place[None]) == [INDEX[name]]
    assert names(at((0.09, 0.0, 1.56), (0.08, 0.0, 1.49))) == [INDEX["head"]] * 2


def test_weights_change_gradually_across_a_joint():
    elbow, wrist = REST[INDEX["forearm_l"]], REST[INDEX["hand_l"]]
    steps = np.linspace(-0.4, 0.4, 81)[:, None] * (wrist - elbow) + elbow
    ids, weights = bind(steps)
    share = np.where(ids == INDEX["forearm_l"], weights, 0).sum(axis=1)
    assert share[0] < 0.02 and share[-1] > 0.98
    assert np.abs(np.diff(share)).max() < 0.15


def test_a_limb_does_not_move_the_other_side():
    ids, weights = bind(at((0.0, 0.06, 0.7), (0.0, -0.06, 0.7)))
    left, right = INDEX["thigh_l"], INDEX["thigh_r"]
    assert np.where(ids[0] == right, weights[0], 0).sum() < 0.05
    assert np.where(ids[1] == left, weights[1], 0).sum() < 0.05
