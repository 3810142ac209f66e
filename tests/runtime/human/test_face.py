"""The face moves as its shapes say, and at rest nobody sees that it can."""

from __future__ import annotations

import numpy as np
import pytest

from adamo_vh.runtime.human.face import SHAPES, Face, moving_face
from adamo_vh.runtime.human.looks import VARIANTS, Garment, load_figure

MOUTH_Z = 1.5295


@pytest.fixture(scope="module", params=VARIANTS)
def face(request: pytest.FixtureRequest) -> Face:
    return moving_face(load_figure(request.param))


def area(garment: Garment) -> float:
    a, b, c = (garment.vertices[garment.faces[:, k]].astype(float) for k in range(3))
    return float(np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2)


def rims(face: Face) -> tuple[np.ndarray, np.ndarray]:
    """Numbers of the points of the upper and the lower lip that were one before the cut."""
    old = len(load_figure(face.figure.variant)["head"].vertices)
    points = face.figure["head"].vertices
    made = np.arange(old, len(points))
    jaw = face.shapes["head"]["jawOpen"]
    pairs: dict[tuple[float, ...], list[int]] = {}
    for number in made.tolist():
        pairs.setdefault(tuple(np.round(points[number], 6)), []).append(number)
    both = [sorted(found, key=lambda i: jaw[i, 2]) for found in pairs.values() if len(found) == 2]
    assert len(both) >= 10 and len(made) == 2 * len(both)
    return np.array([found[1] for found in both]), np.array([found[0] for found in both])


def test_every_shape_is_there_and_moves_something(face: Face) -> None:
    named = {name for moves in face.shapes.values() for name in moves}
    assert named == set(SHAPES)
    for garment, moves in face.shapes.items():
        for name, move in moves.items():
            assert move.shape == face.figure[garment].vertices.shape
            assert 0.0005 < np.linalg.norm(move, axis=1).max() < 0.04, (garment, name)


def test_a_cut_changes_nothing_at_rest(face: Face) -> None:
    before, after = load_figure(face.figure.variant)["head"], face.figure["head"]
    assert area(after) == pytest.approx(area(before), rel=1e-5)
    np.testing.assert_array_equal(after.vertices[: len(before.vertices)], before.vertices)
    np.testing.assert_allclose(after.weights.sum(axis=1), 1.0, atol=1e-5)
    np.testing.assert_allclose(np.linalg.norm(after.normals, axis=1), 1.0, atol=1e-5)


def test_mouth_and_teeth_are_hidden_at_rest(face: Face) -> None:
    skin = face.figure["head"].vertices
    for name in ("mouth", "teeth"):
        for x, y, z in face.figure[name].vertices:
            beside = np.hypot(skin[:, 1] - y, skin[:, 2] - z) < 0.008
            assert skin[beside, 0].max() > x + 0.001, (name, x, y, z)


def test_the_jaw_opens_the_mouth_and_leaves_the_rest(face: Face) -> None:
    points, jaw = face.figure["head"].vertices, face.shapes["head"]["jawOpen"]
    upper, lower = rims(face)
    middle = np.abs(points[upper, 1]) < 0.004
    gap = jaw[upper, 2] - jaw[lower, 2]
    assert gap[middle].min() > 0.015
    across = np.abs(points[upper, 1])
    assert gap[across == across.max()].max() < 0.001
    chin = (points[:, 2] < 1.505) & (points[:, 2] > 1.495) & (points[:, 0] > 0.07)
    assert jaw[chin, 2].max() < -0.012
    still = (points[:, 2] > 1.560) | (points[:, 2] < 1.455) | (points[:, 0] < 0.0)
    assert np.abs(jaw[still]).max() < 0.001
    assert "jawOpen" not in face.shapes["teeth"]


def test_lips_that_stay_closed_stay_closed(face: Face) -> None:
    upper, lower = rims(face)
    for name in ("mouthSmileLeft", "mouthFrownRight", "mouthPucker"):
        move = face.shapes["head"][name]
        assert np.linalg.norm(move[upper] - move[lower], axis=1).max() < 0.0005, name


def test_a_smile_raises_its_own_corner(face: Face) -> None:
    points = face.figure["head"].vertices
    for side, y in (("Left", 0.0262), ("Right", -0.0262)):
        corner = np.linalg.norm(points - [0.082, y, 1.5347], axis=1).argmin()
        other = np.linalg.norm(points - [0.082, -y, 1.5347], axis=1).argmin()
        smile = face.shapes["head"][f"mouthSmile{side}"]
        assert smile[corner, 2] > 0.004 and abs(smile[other]).max() < 1e-6
        assert face.shapes["head"][f"mouthFrown{side}"][corner, 2] < -0.003


def test_a_blink_closes_one_eye(face: Face) -> None:
    lids = face.figure["lids"].vertices
    for side, y in (("Left", 1.0), ("Right", -1.0)):
        move = face.shapes["lids"][f"eyeBlink{side}"]
        own = lids[:, 1] * y > 0
        assert np.abs(move[~own]).max() < 1e-6
        shut = (lids + move)[own]
        # The eye is open from 8 mm above its middle to 5.4 mm below.
        assert shut[:, 2].min() < 1.605 - 0.0054
        brow = face.shapes["brows"]
        assert brow["browInnerUp"][:, 2].max() > 0.003 > -brow[f"browDown{side}"][:, 2].max()


def test_each_eye_turns_alone_and_keeps_its_shape(face: Face) -> None:
    eyes, looks = face.figure["eyes"].vertices.astype(float), face.shapes["eyes"]
    ways = {"Up": (0.0, 1.0), "Down": (0.0, -1.0), "Out": (1.0, 0.0), "In": (-1.0, 0.0)}
    for side, y in (("Left", 1.0), ("Right", -1.0)):
        own = eyes[:, 1] * y > 0
        middle = np.array([0.065, 0.0335 * y, 1.605])
        pupil = own & (eyes[:, 0] == eyes[own, 0].max())
        for way, (out, up) in ways.items():
            move = looks[f"eyeLook{way}{side}"]
            assert not move[~own].any()
            away = np.linalg.norm(eyes[own] + move[own] - middle, axis=1)
            np.testing.assert_allclose(away, 0.0182, atol=1e-4)
            _, outward, upward = (move[pupil].mean(axis=0) * [1.0, y, 1.0]).tolist()
            assert outward == pytest.approx(0.0077 * out, abs=2e-4)
            assert upward == pytest.approx(0.0077 * up, abs=2e-4)
