"""The modelling kit makes closed, outward-facing solids of the right size, shaded as they look."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from adamo_vh.runtime.assets import kit
from adamo_vh.runtime.assets.asset import Material
from adamo_vh.runtime.assets.kit import Mesh

ARCH = kit.fillet([(0, 0, 0), (0, 0, 2), (2, 0, 2), (2, 0, 0)], 0.9, 8)
L_SHAPE = [(0, 0), (2, 0), (2, 1), (1, 1), (1, 2), (0, 2)]

SOLIDS: dict[str, tuple[Callable[[], Mesh], float]] = {
    "box": (lambda: kit.box(1, 2, 3), 6.0),
    "bevelled box": (lambda: kit.box(1, 2, 3, bevel=0.01), 6.0),
    "rounded box": (lambda: kit.rounded_box(1, 2, 3, 0.01), 6.0),
    "cylinder": (lambda: kit.cylinder(1, 2, segments=96), 2 * math.pi),
    "cone": (lambda: kit.cylinder(1, 3, top_radius=0, segments=96), math.pi),
    "sphere": (lambda: kit.sphere(1, 96, 48), 4 / 3 * math.pi),
    "ellipsoid": (lambda: kit.ellipsoid(1, 2, 3, 96, 48), 8 * math.pi),
    "ring": (
        lambda: kit.revolve(kit.rectangle(0.2, 0.3) + np.array((1, 0)), 96, closed=True),
        2 * math.pi * 0.06,
    ),
    "plate": (lambda: kit.extrude(L_SHAPE, 0.5), 1.5),
    "clockwise plate": (lambda: kit.extrude(L_SHAPE[::-1], 0.5, bevel=0.001), 1.5),
    "plate with a hole": (
        lambda: kit.extrude(kit.rectangle(2, 2), 0.5, holes=[kit.rectangle(1, 1)]),
        1.5,
    ),
    "rod": (lambda: kit.sweep(kit.rectangle(0.2, 0.1), [(0, 0, 0), (3, 0, 4)]), 0.1),
    "arch": (lambda: kit.sweep(kit.circle(0.1, count=48), ARCH), 0.1606),
    "loop": (
        lambda: kit.sweep(
            kit.circle(0.1, count=48),
            np.column_stack((kit.circle(1, count=96), np.zeros(96))),
            closed=True,
        ),
        2 * math.pi**2 * 0.01,
    ),
    "bored box": (lambda: kit.difference(kit.box(2, 2, 2), kit.box(1, 1, 3)), 6.0),
    "crossed boxes": (lambda: kit.union(kit.box(3, 1, 1), kit.box(1, 3, 1)), 5.0),
    "overlap": (lambda: kit.intersection(kit.box(3, 1, 1), kit.box(1, 3, 1)), 1.0),
    "mirrored": (lambda: kit.extrude(L_SHAPE, 0.5).scaled(x=-1), 1.5),
}


@pytest.mark.parametrize("name", SOLIDS)
def test_solids_are_closed_and_of_the_right_volume(name: str) -> None:
    build, volume = SOLIDS[name]
    mesh = build()
    assert open_edges(mesh) == 0
    assert volume_of(mesh) == pytest.approx(volume, rel=0.02)


@pytest.mark.parametrize("name", SOLIDS)
def test_normals_are_unit_and_point_out(name: str) -> None:
    mesh = SOLIDS[name][0]()
    a, b, c = np.moveaxis(mesh.vertices[mesh.faces], 1, 0)
    facing = np.cross(b - a, c - a)
    np.testing.assert_allclose(np.linalg.norm(mesh.normals, axis=1), 1.0, atol=1e-9)
    assert (np.einsum("ij,ij->i", facing, mesh.normals[mesh.faces].mean(axis=1)) > 0).all()


def test_sharp_edges_stay_hard_and_round_ones_are_smooth() -> None:
    cube = kit.box(2, 2, 2)
    assert np.allclose(np.abs(cube.normals).max(axis=1), 1.0)
    ball = kit.sphere(1, 48, 24)
    np.testing.assert_allclose(ball.normals, ball.vertices, atol=0.02)


def test_a_lathe_reads_from_outside_with_its_seam_at_the_back() -> None:
    side = kit.revolve([(1, 0), (1, 2)], 64)
    front = side.vertices[np.isclose(side.uvs[:, 0], 0.5)]
    right = side.vertices[np.isclose(side.uvs[:, 0], 0.75)]
    np.testing.assert_allclose(front[:, :2], [[0, -1]] * len(front), atol=1e-9)
    np.testing.assert_allclose(right[:, :2], [[1, 0]] * len(right), atol=1e-9)
    np.testing.assert_allclose(side.uvs[:, 1], side.vertices[:, 2] / 2, atol=1e-9)


def test_projection_reads_upright_from_where_it_is_seen() -> None:
    front = kit.box(2, 1, 4).projected("-y")
    np.testing.assert_allclose(front.uvs[:, 0], (front.vertices[:, 0] + 1) / 2)
    np.testing.assert_allclose(front.uvs[:, 1], (front.vertices[:, 2] + 2) / 4)
    back = kit.box(2, 1, 4).projected("y")
    np.testing.assert_allclose(back.uvs[:, 0], (1 - back.vertices[:, 0]) / 2)


def test_fillet_keeps_the_ends_and_rounds_the_corner() -> None:
    line = kit.fillet([(0, 0), (1, 0), (1, 1)], 0.2, 8)
    np.testing.assert_allclose(line[[0, -1]], [(0, 0), (1, 1)])
    middle = np.array((0.8, 0.2))
    np.testing.assert_allclose(np.linalg.norm(line[1:-1] - middle, axis=1), 0.2)


def test_turning_and_moving_keep_the_shape() -> None:
    mesh = kit.extrude(L_SHAPE, 0.5).turned("z", 90).turned("x", 30).moved(1, 2, 3)
    assert volume_of(mesh) == pytest.approx(1.5)
    up = kit.cylinder(0.1, 2).moved(z=1).turned("x", 90)
    np.testing.assert_allclose(up.lower[1], -2, atol=1e-9)


def test_open_meshes_are_no_solids() -> None:
    with pytest.raises(ValueError, match="closed solids"):
        kit.difference(kit.revolve([(1, 0), (1, 2)]), kit.box(1, 1, 1))


def test_merging_keeps_every_triangle() -> None:
    pieces = [kit.box(1, 1, 1).moved(x=3.0 * i) for i in range(4)]
    merged = kit.merge(pieces)
    assert len(merged.faces) == sum(len(piece.faces) for piece in pieces)
    assert volume_of(merged) == pytest.approx(4.0)


sizes = st.tuples(*[st.floats(0.002, 1.0)] * 3)


@settings(max_examples=30, deadline=None)
@given(size=sizes)
def test_fit_spans_exactly_the_size_about_the_origin(size: tuple[float, float, float]) -> None:
    material = Material("any")
    parts = (kit.sphere(0.3).moved(z=1).part(material), kit.box(1, 2, 3).part(material))
    points = np.concatenate([part.vertices for part in kit.fit(parts, size)])
    np.testing.assert_allclose(points.max(axis=0), np.array(size) / 2, rtol=1e-5)
    np.testing.assert_allclose(points.min(axis=0), -np.array(size) / 2, rtol=1e-5)


@settings(max_examples=30, deadline=None)
@given(size=sizes, share=st.floats(0.01, 0.49), segments=st.integers(1, 6))
def test_rounded_boxes_are_closed_and_of_their_size(
    size: tuple[float, float, float], share: float, segments: int
) -> None:
    mesh = kit.rounded_box(*size, radius=share * min(size), segments=segments)
    np.testing.assert_allclose(mesh.upper - mesh.lower, size, rtol=1e-9)
    assert open_edges(mesh) == 0
    # An octahedron, a sixth of its box, is what the largest radius in one flat cut would leave.
    assert math.prod(size) / 6 < volume_of(mesh) <= math.prod(size)


def volume_of(mesh: Mesh) -> float:
    """Signed volume: positive when the faces look outwards."""
    a, b, c = np.moveaxis(mesh.vertices[mesh.faces], 1, 0)
    return float(np.einsum("ij,ij->i", a, np.cross(b, c)).sum() / 6)


def open_edges(mesh: Mesh) -> int:
    """Number of directed edges without a partner running the other way."""
    _, place = np.unique(np.rint(mesh.vertices / 1e-6).astype(int), axis=0, return_inverse=True)
    faces = place.ravel()[mesh.faces]
    edges = np.concatenate((faces[:, :2], faces[:, 1:], faces[:, (2, 0)]))
    forward = {tuple(edge) for edge in edges.tolist()}
    return sum((b, a) not in forward for a, b in forward)
