"""Rotations of joints: as exact as SciPy's, which they do without."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from adamo_vh.geometry import Array
from adamo_vh.runtime.human.rotations import (
    angles,
    blended,
    from_rotation_vectors,
    quaternions,
    rotation_vectors,
)

EXACT = 2e-15
HALF_TURNS = [np.diag([1.0, -1.0, -1.0]), np.diag([-1.0, 1.0, -1.0]), np.diag([-1.0, -1.0, 1.0])]


def vectors() -> Array:
    """Axis times angle: all sizes up to half a turn, very small ones and none."""
    random = np.random.default_rng(5)
    axes = random.normal(size=(3000, 3))
    axes /= np.linalg.norm(axes, axis=1)[:, None]
    sizes = random.uniform(0.0, np.pi, 3000)
    sizes[:300] *= 10.0 ** -random.uniform(1, 14, 300)
    sizes[0] = 0.0
    return np.asarray(axes * sizes[:, None])


def test_they_agree_with_scipy() -> None:
    turns = vectors()
    theirs = Rotation.from_rotvec(turns)
    matrices = theirs.as_matrix()
    values = theirs.as_quat(canonical=True, scalar_first=True)
    assert from_rotation_vectors(turns) == pytest.approx(matrices, abs=EXACT)
    assert rotation_vectors(matrices) == pytest.approx(
        Rotation.from_matrix(matrices).as_rotvec(), abs=EXACT
    )
    assert quaternions(matrices) == pytest.approx(values, abs=EXACT)


def test_they_invert_each_other() -> None:
    turns = vectors()
    assert rotation_vectors(from_rotation_vectors(turns)) == pytest.approx(turns, abs=1e-7)


@pytest.mark.parametrize("turn", HALF_TURNS)
def test_half_turns_have_an_axis(turn: Array) -> None:
    assert np.linalg.norm(rotation_vectors(turn)) == pytest.approx(np.pi)
    assert from_rotation_vectors(rotation_vectors(turn)) == pytest.approx(turn, abs=EXACT)
    first = quaternions(turn)
    assert first[0] == 0.0
    assert first[np.flatnonzero(first)[0]] == 1.0


@pytest.mark.parametrize("shape", [(), (1,), (4,), (2, 3)])
def test_any_leading_axes(shape: tuple[int, ...]) -> None:
    turns = np.broadcast_to([0.3, -0.2, 0.9], (*shape, 3))
    matrices = from_rotation_vectors(turns)
    assert matrices.shape == (*shape, 3, 3)
    assert rotation_vectors(matrices) == pytest.approx(turns, abs=EXACT)
    assert quaternions(matrices).shape == (*shape, 4)
    half = blended(np.broadcast_to(np.eye(3), matrices.shape), matrices, 0.5)
    assert angles(half, matrices) == pytest.approx(np.linalg.norm(turns, axis=-1) / 2, abs=1e-12)
