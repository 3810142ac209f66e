"""Reference points lie on the rays of a regular grid, and are numbered without gaps."""

from __future__ import annotations

import numpy as np
import pytest
from tests.percepts import camera, floor_hits, sphere_hits

from adamo_vh.perception.reference_points import grid_pixels, reference_points


def test_columns_go_left_to_right_each_from_bottom_to_top():
    expected = [(25, 75), (25, 25), (75, 75), (75, 25)]
    assert grid_pixels(100, 100, 2).tolist() == [list(map(float, uv)) for uv in expected]


@pytest.mark.parametrize("n", [3, 4, 5, 6, 7])
def test_every_cell_has_its_point(n):
    points = reference_points(camera(1280, 720), sphere_hits, n)
    assert [point.tag for point in points] == [f"P{i}" for i in range(n * n)]
    cells = {(int(u * n / 1280), int(v * n / 720)) for u, v in (p.pixel for p in points)}
    assert len(cells) == n * n


@pytest.mark.parametrize(("width_px", "height_px"), [(640, 360), (1280, 720), (1920, 1080)])
def test_points_project_back_to_their_pixels(width_px, height_px):
    view = camera(width_px, height_px)
    points = reference_points(view, floor_hits, 6)
    uv = view.project(np.array([point.position.array() for point in points]))
    assert np.allclose(uv[:, :2], [point.pixel for point in points], atol=1e-6)
    assert (uv[:, 2] > 0).all()


def test_resolution_does_not_move_points():
    small = reference_points(camera(640, 360), floor_hits, 6)
    large = reference_points(camera(1920, 1080), floor_hits, 6)
    assert [p.position.rounded() for p in small] == [p.position.rounded() for p in large]


def test_a_ray_that_hits_nothing_gets_no_number():
    view = camera(1280, 720)
    points = reference_points(view, floor_hits, 6)
    assert 0 < len(points) < 36
    assert [point.tag for point in points] == [f"P{i}" for i in range(len(points))]
    below_horizon = [
        tuple(uv) for uv in grid_pixels(1280, 720, 6) if view.rays(np.array([uv]))[0, 2] < 0
    ]
    assert [point.pixel for point in points] == below_horizon


def test_no_grid_gives_no_points():
    assert reference_points(camera(640, 360), floor_hits, 0) == ()
