"""The one frame: cameras, boxes and angles mean what the conventions say."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from adamo_vh.geometry import Box, Camera, Quaternion, Vec3, hull, wrap_angle

angles = st.floats(-math.pi, math.pi)
coordinates = st.floats(-5, 5)
points = st.builds(Vec3, coordinates, coordinates, coordinates)


def camera(yaw: float = 0.0, pitch: float = 0.0) -> Camera:
    return Camera(Vec3(0, 0, 1.6), yaw, pitch, math.radians(65), 1920, 1080)


def test_yaw_zero_looks_along_x_with_y_to_the_left_and_z_up() -> None:
    u, v, depth = camera().project(np.array([[2.0, 0.5, 1.9]]))[0]
    assert depth == pytest.approx(2.0)
    assert u < 960
    assert v < 540


def test_yaw_ninety_degrees_looks_along_y() -> None:
    u, v, depth = camera(math.pi / 2).project(np.array([[0.0, 3.0, 1.6]]))[0]
    assert (u, v, depth) == pytest.approx((960, 540, 3.0))


@given(angles, st.floats(-1.4, 1.4), st.floats(0, 1920), st.floats(0, 1080), st.floats(0.1, 20))
def test_projection_undoes_rays(yaw: float, pitch: float, u: float, v: float, far: float) -> None:
    view = camera(yaw, pitch)
    ray = view.rays(np.array([[u, v]]))
    assert np.linalg.norm(ray) == pytest.approx(1)
    back = view.project(view.position.array() + far * ray)[0]
    assert back[:2] == pytest.approx([u, v], abs=1e-6)
    assert back[2] > 0


@given(points, points)
def test_a_camera_has_what_it_is_aimed_at_in_the_middle(eyes: Vec3, point: Vec3) -> None:
    if eyes.horizontal_distance(point) > 0.01:
        view = Camera.towards(eyes, point, math.radians(65), (1920, 1080))
        assert view.project(point.array()[None])[0, :2] == pytest.approx([960, 540], abs=1e-3)


@given(angles)
def test_the_volume_and_size_of_a_box_do_not_change_when_it_turns(yaw: float) -> None:
    box = Box(Vec3(1, 2, 3), Vec3(0.2, 0.1, 0.05), Quaternion.from_yaw(yaw))
    assert box.volume_m3 == pytest.approx(0.001)
    assert box.radius_m == pytest.approx(math.hypot(0.1, 0.05))
    assert (box.bottom_z, box.top_z) == pytest.approx((2.975, 3.025))
    assert box.orientation.yaw_rad == pytest.approx(yaw, abs=1e-9) or abs(yaw) == math.pi


@given(st.floats(-100, 100))
def test_wrapped_angles_are_the_same_direction(angle: float) -> None:
    wrapped = wrap_angle(angle)
    assert -math.pi < wrapped <= math.pi
    assert math.cos(wrapped) == pytest.approx(math.cos(angle), abs=1e-9)
    assert math.sin(wrapped) == pytest.approx(math.sin(angle), abs=1e-9)


def test_rounded_points_have_no_negative_zero() -> None:
    assert str(Vec3(-0.0004, 0, 0).rounded(2).x) == "0.0"


@given(st.lists(st.tuples(st.integers(-5, 5), st.integers(-5, 5)), min_size=3, max_size=30))
def test_a_hull_holds_all_points_and_turns_left_at_every_corner(
    points: list[tuple[float, float]],
) -> None:
    corners = hull(points)
    assert set(corners) <= set(points)
    if len(corners) < 3:
        return
    for a, b in zip(corners, [*corners[1:], corners[0]], strict=True):
        for x, y in points:
            assert (b[0] - a[0]) * (y - a[1]) - (b[1] - a[1]) * (x - a[0]) >= 0


@given(points, st.integers(0, 4))
def test_a_point_is_told_in_one_way_and_never_as_minus_zero(point: Vec3, digits: int) -> None:
    parts = point.text(digits).strip("()").split(", ")
    numbers = [float(part) for part in parts]
    assert numbers == pytest.approx([point.x, point.y, point.z], abs=0.51 * 10**-digits)
    assert not any(
        number == 0 and part.startswith("-") for number, part in zip(numbers, parts, strict=False)
    )
    assert str(Vec3(-0.001, -0.0, -0.004)) == "(0.00, 0.00, 0.00)"
