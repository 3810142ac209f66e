"""A point a little outside the room means the nearest one inside; far outside it is refused."""

from __future__ import annotations

import math

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from adamo_vh.action import Code, Drop, Look, Outcome, Pick, Walk
from adamo_vh.action_server import LocalActionServer
from adamo_vh.action_server.tools import OUTSIDE_M
from adamo_vh.geometry import Vec3
from adamo_vh.runtime.builtin import BuiltinEngine

NEXT_TO = (-1.0, 0.0, 1.0)
inside = st.tuples(st.floats(-2.9, 2.9), st.floats(-4.9, 2.9), st.floats(0.05, 3.1))
off = st.tuples(*[st.sampled_from(NEXT_TO)] * 3).filter(any)
quick = settings(
    max_examples=15,
    suppress_health_check=[HealthCheck.function_scoped_fixture, HealthCheck.too_slow],
)


def pushed_out(
    engine: BuiltinEngine,
    at: tuple[float, float, float],
    side: tuple[float, float, float],
    by_m: float,
) -> tuple[Vec3, Vec3]:
    """A point outside the room by a distance, and the nearest one inside."""
    room = engine.scene
    low, high = (room.x_min, room.y_min, 0.0), (room.x_max, room.y_max, room.height_m)
    near = [
        v if s == 0 else (lo if s < 0 else hi)
        for v, s, lo, hi in zip(at, side, low, high, strict=True)
    ]
    length = math.hypot(*side)
    away = [v + s / length * by_m for v, s in zip(near, side, strict=True)]
    return Vec3.of(away), Vec3.of(near)


@quick
@given(at=inside, side=off, by_m=st.floats(0.02, OUTSIDE_M - 0.001))
def test_a_little_outside_is_corrected_and_said(
    engine: BuiltinEngine,
    at: tuple[float, float, float],
    side: tuple[float, float, float],
    by_m: float,
) -> None:
    asked, near = pushed_out(engine, at, side, by_m)
    for action in (Look(asked.x, asked.y, asked.z), Walk(asked.x, asked.y, asked.z)):
        engine.reset(0)
        result = LocalActionServer(engine, resolution=(64, 36)).execute(action)
        assert result.feedback.outcome is Outcome.CORRECTED
        assert result.feedback.text.startswith(
            f"Corrected: {asked} is outside the room, so {near} was taken; "
        )
        told = result.state_hash
        engine.reset(0)
        LocalActionServer(engine, resolution=(64, 36)).execute(type(action)(near.x, near.y, near.z))
        assert engine.state().hash() == told


@quick
@given(at=inside, side=off, by_m=st.floats(OUTSIDE_M + 0.001, 50.0))
def test_far_outside_is_refused_with_the_extent(
    engine: BuiltinEngine,
    at: tuple[float, float, float],
    side: tuple[float, float, float],
    by_m: float,
) -> None:
    asked, _ = pushed_out(engine, at, side, by_m)
    before = engine.state().hash()
    server = LocalActionServer(engine, resolution=(64, 36))
    for action in (Look(asked.x, asked.y, asked.z), Walk(asked.x, asked.y, asked.z)):
        result = server.execute(action)
        assert result.feedback.code == Code.OUTSIDE_ROOM
        assert "x from -3 to 3, y from -5 to 3, z from 0 to 3.2" in result.feedback.text
        assert result.state_hash == before


@pytest.mark.parametrize("z", [-0.05, -0.3, -0.5])
def test_a_drop_below_the_floor_lands_on_it(engine: BuiltinEngine, z: float) -> None:
    server = LocalActionServer(engine, resolution=(320, 180))
    server.observe()
    server.execute(Pick("Plate_57"))
    feedback = server.execute(Drop("Plate_57", -1.5, -2.5, z)).feedback
    assert feedback.outcome is Outcome.CORRECTED
    assert feedback.code == Code.MOVED_INSIDE
    assert f"(-1.50, -2.50, {z:.2f}) is outside the room, so (-1.50, -2.50, 0.00)" in feedback.text
    assert feedback.text.endswith("on the floor.")
    assert engine.state().object(57).support == "floor"


def test_a_wall_that_was_told_with_two_digits_is_no_correction(engine: BuiltinEngine) -> None:
    server = LocalActionServer(engine, resolution=(320, 180))
    assert server.execute(Look(3.004, -1.0, 1.0)).feedback.outcome is Outcome.DONE
