"""Checkers: each condition's true and false side, the two scores, and the geometry below them."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from scipy.optimize import linprog
from tests.tabletop import CORNERS, OBJECTS, TABLE, changed, held, resting, tabletop

from adamo_vh.benchmark.checkers import OVERLAP_M, score
from adamo_vh.benchmark.conditions import NEAR_M, Holds, InArea, Near, OnFloor
from adamo_vh.benchmark.overlap import footprint_overlaps, penetration_m
from adamo_vh.benchmark.tasks import TASKS, Task, task
from adamo_vh.engine import Area, WorldState, object_support
from adamo_vh.geometry import Array, Box, Quaternion, Vec3

coordinates = st.floats(-0.5, 0.5)
lengths = st.floats(0.02, 0.6)
parts = st.floats(-1.0, 1.0)


@st.composite
def boxes(draw: st.DrawFn) -> Box:
    turn = np.array([draw(parts) for _ in range(4)])
    assume(np.linalg.norm(turn) > 0.1)
    w, x, y, z = (turn / np.linalg.norm(turn)).tolist()
    center = Vec3(draw(coordinates), draw(coordinates), draw(coordinates))
    return Box(center, Vec3(draw(lengths), draw(lengths), draw(lengths)), Quaternion(w, x, y, z))


@st.composite
def outcomes(draw: st.DrawFn) -> WorldState:
    """The tabletop after somebody moved a few things anywhere, and perhaps holds one."""
    state = tabletop()
    for object_id in draw(st.lists(st.sampled_from(sorted(OBJECTS)), max_size=6)):
        x, y = draw(st.floats(-2.8, 2.8)), draw(st.floats(-4.8, 2.8))
        state = resting(state, object_id, x, y, draw(st.sampled_from(["floor", TABLE])))
    if draw(st.booleans()):
        state = held(state, draw(st.sampled_from(sorted(OBJECTS))))
    return state


def half_spaces(box: Box) -> tuple[Array, Array]:
    """The box as normals (6, 3) and offsets (6,): normals @ p <= offsets."""
    axes, half = box.orientation.matrix().T, box.size.array() / 2
    middle = axes @ box.center.array()
    return np.concatenate([axes, -axes]), np.concatenate([middle + half, half - middle])


def meet(constraints: list[tuple[Array, Array]]) -> bool:
    """Whether convex sets share a point, by linear programming."""
    normals = np.concatenate([a for a, _ in constraints])
    offsets = np.concatenate([b for _, b in constraints])
    zero = np.zeros(normals.shape[1])
    return bool(linprog(zero, A_ub=normals, b_ub=offsets, bounds=(None, None)).success)


# --- conditions -------------------------------------------------------------------------------


def test_holds_is_true_of_the_object_in_the_hand_alone() -> None:
    state = held(tabletop(), 34)
    assert Holds(34).satisfied(state)
    assert not Holds(57).satisfied(state)
    assert not Holds(34).satisfied(tabletop())


def test_holds_ends_with_the_release() -> None:
    assert not Holds(34).satisfied(resting(held(tabletop(), 34), 34, -1.0, -1.0))


def test_on_floor_needs_rest_on_the_floor() -> None:
    assert OnFloor(57).satisfied(resting(tabletop(), 57, -1.5, 0.0))
    assert not OnFloor(57).satisfied(tabletop())


def test_on_floor_needs_release() -> None:
    state = resting(tabletop(), 57, -1.5, 0.0)
    in_hand = replace(state.object(57), held=True)
    assert not OnFloor(57).satisfied(changed(state, in_hand))
    assert not OnFloor(57).satisfied(held(tabletop(), 57))


@pytest.mark.parametrize(("distance_m", "near"), [(0.2, True), (0.299, True), (0.301, False)])
def test_near_ends_at_its_limit(distance_m: float, near: bool) -> None:
    plate = tabletop().object(57).box.center
    state = resting(tabletop(), 37, plate.x - distance_m, plate.y, TABLE)
    assert Near(37, 57).satisfied(state) is near


def test_near_measures_in_plan() -> None:
    """A tall thing beside a flat one is not further away for being tall."""
    state = tabletop()
    item, plate = state.object(50), state.object(57).box.center
    box = replace(item.box, center=Vec3(plate.x, plate.y + NEAR_M - 0.001, plate.z + 5.0))
    assert Near(50, 57).satisfied(changed(state, replace(item, box=box)))


@pytest.mark.parametrize("support", ["floor", "shelf/top", None])
def test_near_needs_the_same_surface(support: str | None) -> None:
    state = resting(tabletop(), 37, 0.1, -0.603, TABLE)
    assert Near(37, 57).satisfied(state)
    assert not Near(37, 57).satisfied(changed(state, replace(state.object(37), support=support)))


def test_near_does_not_join_what_lies_on_another_object() -> None:
    state = resting(tabletop(), 37, 0.1, -0.603, TABLE)
    for object_id in (37, 57):
        on_plant = replace(state.object(object_id), support=object_support(50))
        state = changed(state, on_plant)
    assert not Near(37, 57).satisfied(state)


def test_near_does_not_join_two_things_in_the_air() -> None:
    state = resting(tabletop(), 37, 0.1, -0.603, TABLE)
    for object_id in (37, 57):
        state = changed(state, replace(state.object(object_id), support=None))
    assert not Near(37, 57).satisfied(state)


@pytest.mark.parametrize("object_id", [37, 57])
def test_near_needs_both_released(object_id: int) -> None:
    state = resting(tabletop(), 37, 0.1, -0.603, TABLE)
    assert not Near(37, 57).satisfied(held(state, object_id))


@given(st.floats(-0.4, 0.4), st.floats(-0.4, 0.4), st.sampled_from([TABLE, "floor"]))
def test_near_is_symmetric_and_never_across_surfaces(dx: float, dy: float, support: str) -> None:
    plate = tabletop().object(57).box.center
    state = resting(tabletop(), 37, plate.x + dx, plate.y + dy, support)
    near = Near(37, 57).satisfied(state)
    assert near == Near(57, 37).satisfied(state)
    assert near == (support == TABLE and math.hypot(dx, dy) <= NEAR_M) or math.isclose(
        math.hypot(dx, dy), NEAR_M
    )


@pytest.mark.parametrize("area", CORNERS, ids=lambda area: area.name)
def test_every_corner_counts(area: Area) -> None:
    x, y = (area.x_min + area.x_max) / 2, (area.y_min + area.y_max) / 2
    assert InArea(2).satisfied(resting(tabletop(), 2, x, y))


def test_in_area_needs_the_floor_and_release() -> None:
    state = resting(tabletop(), 2, 2.5, 2.5)
    item = state.object(2)
    assert not InArea(2).satisfied(changed(state, replace(item, support="shelf/top")))
    assert not InArea(2).satisfied(changed(state, replace(item, held=True)))


@pytest.mark.parametrize(("x", "inside"), [(1.0, False), (1.905, False), (1.915, True)])
def test_in_area_asks_for_any_overlap_of_the_footprint(x: float, inside: bool) -> None:
    """The flashlight is 0.18 m long and the area begins at x = 2."""
    assert InArea(2).satisfied(resting(tabletop(), 2, x, 2.5)) is inside


def test_in_area_follows_the_turn_of_the_object() -> None:
    assert InArea(2).satisfied(resting(tabletop(), 2, 1.95, 2.5))
    assert not InArea(2).satisfied(resting(tabletop(), 2, 1.95, 2.5, yaw_rad=math.pi / 2))


def test_in_area_tells_kinds_apart() -> None:
    assert not InArea(2, kind="rug").satisfied(resting(tabletop(), 2, 2.5, 2.5))


# --- scores -----------------------------------------------------------------------------------


def test_completion_counts_conditions() -> None:
    state = tabletop()
    fractions = []
    for n, object_id in enumerate((57, 19, 20, 23, 36)):
        state = resting(state, object_id, -1.5, n * 0.4 - 1.0)
        result = score(tabletop(), state, task("T14"))
        fractions.append(result.completion)
        assert sum(c.satisfied for c in result.conditions) == n + 1
    assert fractions == [0.2, 0.4, 0.6, 0.8, 1.0]
    assert result.strict == 1.0


def test_conditions_are_reported_in_the_order_of_the_task() -> None:
    result = score(tabletop(), resting(tabletop(), 57, -1.5, 0.0), task("T8"))
    assert [(c.text, c.satisfied) for c in result.conditions] == [
        ("37 on floor", False),
        ("57 on floor", True),
    ]


@settings(max_examples=60)
@given(outcomes(), st.sampled_from(TASKS))
def test_scores_keep_their_range_and_their_order(final: WorldState, item: Task) -> None:
    result = score(tabletop(), final, item)
    assert 0.0 <= result.completion <= 1.0
    assert result.strict in (0.0, 1.0)
    assert result.strict <= result.completion
    if result.strict:
        assert result.completion == 1.0
        assert result.violations == ()


@settings(max_examples=20)
@given(outcomes(), st.sampled_from(TASKS))
def test_scoring_again_gives_the_same(final: WorldState, item: Task) -> None:
    assert score(tabletop(), final, item) == score(tabletop(), final, item)


def test_an_object_that_the_world_does_not_have_is_an_error() -> None:
    few = replace(tabletop(), objects=tabletop().objects[:3])
    with pytest.raises(KeyError):
        score(few, few, task("T2"))


# --- violations -------------------------------------------------------------------------------


def violations_of(final: WorldState, initial: WorldState | None = None) -> tuple[str, ...]:
    """Violations of T4, its condition being satisfied."""
    done = resting(final, 57, -1.5, 0.0)
    result = score(initial or tabletop(), done, task("T4"))
    assert result.completion == 1.0
    assert result.strict == float(not result.violations)
    return result.violations


def test_a_clean_success_is_strict() -> None:
    assert violations_of(tabletop()) == ()


def test_another_thing_on_another_support_is_a_violation() -> None:
    assert violations_of(resting(tabletop(), 37, -1.5, 1.0)) == (
        "Glass_37 was moved from table to floor",
    )


def test_another_thing_elsewhere_on_its_support_is_a_violation() -> None:
    assert violations_of(resting(tabletop(), 34, -0.174, -1.503, TABLE)) == (
        "Key_34 was moved by 0.10 m",
    )


def test_settling_is_no_move() -> None:
    assert violations_of(resting(tabletop(), 34, -0.174, -1.590, TABLE)) == ()


def test_another_thing_in_the_hand_is_a_violation() -> None:
    assert violations_of(held(tabletop(), 34)) == ("Key_34 was left in the hand",)


def test_moving_the_anchor_instead_of_the_target_is_not_strict() -> None:
    tape = tabletop().object(4).box.center
    result = score(tabletop(), resting(tabletop(), 50, tape.x, tape.y + 0.24, TABLE), task("T5"))
    assert (result.completion, result.strict) == (1.0, 0.0)
    assert "IndoorPlant_50 was moved" in result.violations[0]


def test_an_overlap_is_a_violation() -> None:
    plate = tabletop().object(57).box.center
    final = resting(tabletop(), 37, plate.x - 0.165, plate.y, TABLE)
    result = score(tabletop(), final, task("T9"))
    assert result.conditions[0].satisfied
    assert result.violations == ("Glass_37 and Plate_57 overlap by 10 mm",)


@pytest.mark.parametrize(("gap_m", "clean"), [(0.001, True), (-0.004, True), (-0.006, False)])
def test_contact_is_no_overlap(gap_m: float, clean: bool) -> None:
    plate = tabletop().object(57).box.center
    final = resting(tabletop(), 37, plate.x - 0.175 - gap_m, plate.y, TABLE)
    assert (score(tabletop(), final, task("T9")).violations == ()) is clean


def test_an_overlap_of_the_scene_itself_is_nobodys_fault() -> None:
    initial = resting(tabletop(), 34, -0.174, -1.353, TABLE)
    initial = changed(initial, replace(initial.object(34), box=initial.object(18).box))
    assert violations_of(initial, initial) == ()


def test_a_nudge_into_a_neighbour_is_an_overlap() -> None:
    """Too short to count as a move, but the two were apart before."""
    lock = tabletop().object(18).box.center
    apart = resting(tabletop(), 27, lock.x, lock.y + 0.029, TABLE)
    nudged = resting(tabletop(), 27, lock.x, lock.y + 0.010, TABLE)
    assert violations_of(apart, apart) == ()
    assert violations_of(nudged, apart) == ("Lock_18 and Lighter_27 overlap by 14 mm",)


def test_a_held_thing_overlaps_nothing() -> None:
    state = held(tabletop(), 57)
    inside = replace(state.object(57), box=state.object(37).box)
    assert score(tabletop(), changed(state, inside), task("T2")).strict == 1.0


def test_a_floating_thing_is_a_violation() -> None:
    item = replace(tabletop().object(34), support=None)
    assert violations_of(changed(tabletop(), item)) == (
        "Key_34 was moved from table to None",
        "Key_34 floats",
    )


def test_a_floating_target_is_a_violation() -> None:
    state = resting(tabletop(), 37, -1.5, 0.0)
    floating = changed(state, replace(state.object(57), support=None))
    result = score(tabletop(), floating, task("T8"))
    assert result.violations == ("Plate_57 floats",)


# --- geometry ---------------------------------------------------------------------------------


def test_penetration_of_aligned_boxes_is_the_shallowest_way_out() -> None:
    cube = Box(Vec3(0, 0, 0), Vec3(1, 1, 1))
    other = Box(Vec3(0.9, 0.2, 0.0), Vec3(1, 1, 1))
    assert penetration_m(cube, other) == pytest.approx(0.1)
    assert penetration_m(cube, Box(Vec3(1.5, 0, 0), Vec3(1, 1, 1))) == pytest.approx(-0.5)


def test_crossed_edges_are_told_apart() -> None:
    """Two bars, edge above edge: only the cross product of their edges separates them."""
    size = Vec3(1.0, 0.1, 0.1)
    tilt = Quaternion(math.cos(math.pi / 8), math.sin(math.pi / 8), 0.0, 0.0)
    turn = Quaternion(math.cos(math.pi / 4), 0.0, 0.0, math.sin(math.pi / 4))
    both = Quaternion(turn.w * tilt.w, turn.w * tilt.x, turn.z * tilt.x, turn.z * tilt.w)
    height = 0.1 * math.sqrt(2)
    low = Box(Vec3(0, 0, 0), size, tilt)
    assert penetration_m(low, Box(Vec3(0, 0, height + 0.002), size, both)) < 0
    assert penetration_m(low, Box(Vec3(0, 0, height - 0.002), size, both)) > 0


@settings(max_examples=150)
@given(boxes(), boxes())
def test_penetration_agrees_with_linear_programming(a: Box, b: Box) -> None:
    depth = penetration_m(a, b)
    assume(abs(depth) > 1e-6)
    assert (depth > 0) == meet([half_spaces(a), half_spaces(b)])


@settings(max_examples=60)
@given(boxes(), boxes())
def test_a_shared_point_means_penetration(a: Box, b: Box) -> None:
    steps = np.linspace(-0.5, 0.5, 9)
    local = np.stack(np.meshgrid(steps, steps, steps), axis=-1).reshape(-1, 3) * a.size.array()
    points = local @ a.orientation.matrix().T + a.center.array()
    normals, offsets = half_spaces(b)
    if (points @ normals.T < offsets).all(axis=1).any():
        assert penetration_m(a, b) > 0


@given(boxes(), boxes())
def test_penetration_is_symmetric(a: Box, b: Box) -> None:
    assert penetration_m(a, b) == pytest.approx(penetration_m(b, a), abs=1e-9)


@given(boxes())
def test_a_box_is_in_itself_by_its_shortest_edge(a: Box) -> None:
    shortest = min(a.size.x, a.size.y, a.size.z)
    assert penetration_m(a, a) == pytest.approx(shortest)
    assert shortest > OVERLAP_M


@settings(max_examples=150)
@given(boxes(), coordinates, coordinates, lengths, lengths)
def test_footprint_agrees_with_linear_programming(
    box: Box, x: float, y: float, width: float, depth: float
) -> None:
    """The box and the upright prism over the area meet exactly if footprint and area do."""
    inside = Area("area", "corner", x, y, x + width, y + depth)
    shrunk, grown = (_prism(inside, margin) for margin in (-1e-6, 1e-6))
    overlaps = footprint_overlaps(box, inside)
    assume(meet([half_spaces(box), shrunk]) == meet([half_spaces(box), grown]))
    assert overlaps == meet([half_spaces(box), grown])


def _prism(area: Area, margin: float) -> tuple[Array, Array]:
    normals = np.array([[1.0, 0, 0], [-1.0, 0, 0], [0, 1.0, 0], [0, -1.0, 0]])
    offsets = np.array([area.x_max, -area.x_min, area.y_max, -area.y_min])
    return normals, offsets + margin


@pytest.mark.parametrize("gone", [37, 57])
def test_a_condition_on_what_was_taken_out_of_the_room_is_not_met(gone: int) -> None:
    start = tabletop()
    done = resting(start, 37, 0.326, -0.9, support="table")
    asked = replace(task("T2"), conditions=(Near(37, 57), OnFloor(4)))
    taken = replace(done, objects=tuple(o for o in done.objects if o.id != gone))
    assert score(start, done, asked).completion == 0.5
    assert score(start, taken, asked).completion == 0.0
