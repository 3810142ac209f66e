"""What the motion of the virtual human promises."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from hypothesis import Phase, given, settings
from hypothesis import strategies as st
from tests.runtime.human.body_limits import centre_of_mass, limit_excess
from tests.spread import spread

from adamo_vh.geometry import Vec3, wrap_angle
from adamo_vh.runtime.embodiment import Stance
from adamo_vh.runtime.human.anatomy import grip, mirrored
from adamo_vh.runtime.human.clips import clips, walk_clip
from adamo_vh.runtime.human.closing import FINGER_JOINTS
from adamo_vh.runtime.human.gait import gait
from adamo_vh.runtime.human.grasp import Thing
from adamo_vh.runtime.human.ik import ANKLE_M, STANDING_FEET, plant_feet
from adamo_vh.runtime.human.motion import (
    BodyFrame,
    Motion,
    drop_motion,
    idle,
    look_motion,
    pick_motion,
    walk_motion,
)
from adamo_vh.runtime.human.postures import CARRY, at_rest, carrying, gazing, line_of_gaze, standing
from adamo_vh.runtime.human.reach import reaching
from adamo_vh.runtime.human.rotations import (
    about,
    angles,
    blended,
    looking,
)
from adamo_vh.runtime.human.route import route
from adamo_vh.runtime.human.skeleton import INDEX, JOINTS, joint_frames
from adamo_vh.runtime.human.stretch import stretch_to
from adamo_vh.runtime.navigation import Path

RATE_HZ = 60
MOST_TURN_DEG = 14.0
"""In one frame at 60 Hz: the lids of a blink are the fastest, then the swinging shins."""
LIMBS = [j for j in range(len(JOINTS)) if j not in {*FINGER_JOINTS["l"], *FINGER_JOINTS["r"]}]
"""All joints but those of the fingers."""
START = Stance(Vec3(0.4, -0.3, 0.0), 0.3, Vec3(1.6, 0.1, 1.4))
few = settings(max_examples=12, deadline=None, phases=[Phase.explicit, Phase.generate])
coordinates = st.floats(-2.5, 2.5, allow_nan=False)
bearings = st.floats(-math.pi, math.pi)
TARGETS = [
    np.array([r * math.cos(a), r * math.sin(a), z])
    for r in (0.25, 0.5, 0.7, 0.9)
    for z in (0.0, 0.3, 0.7, 0.9, 1.3, 1.7, 1.95, 2.07)
    for a in np.radians([-30.0, 0.0, 30.0])
]


def path_to(body: Stance, *corners: tuple[float, float]) -> Path:
    return Path((body.position, *(Vec3(x, y, 0.0) for x, y in corners)))


def walk(body: Stance, *corners: tuple[float, float]) -> Motion:
    path = path_to(body, *corners)
    a, b = path.points[-2:]
    return walk_motion(body, path, body.walked(b, math.atan2(b.y - a.y, b.x - a.x)))


def ahead(body: Stance, distance_m: float, height_m: float) -> Vec3:
    cos, sin = math.cos(body.heading_rad), math.sin(body.heading_rad)
    return body.position + Vec3(cos * distance_m, sin * distance_m, height_m)


def pick(body: Stance, target: Vec3, thing: Thing | None = None) -> Motion:
    return pick_motion(body, replace(body.facing(target)[0], held=7), target, thing)


def drop(body: Stance, target: Vec3, thing: Thing | None = None) -> Motion:
    return drop_motion(body, replace(body.facing(target)[0], held=None), target, thing)


THINGS = {
    "bottle": Thing.box(0.065, 0.065, 0.24),
    "jar": Thing.box(0.10, 0.10, 0.15),
    "key": Thing.box(0.055, 0.024, 0.002),
    "screwdriver": Thing.box(0.23, 0.022, 0.021),
    "plate": Thing.box(0.25, 0.25, 0.03),
    "plant": Thing.box(0.25, 0.25, 0.34),
    "tray": Thing.box(0.42, 0.30, 0.04),
}


def frames(motion: Motion, rate_hz: int = RATE_HZ) -> list[BodyFrame]:
    return [motion.at(i / rate_hz) for i in range(math.ceil(motion.duration_s * rate_hz) + 2)]


def same(a: BodyFrame, b: BodyFrame) -> bool:
    return (
        a.body == b.body
        and np.array_equal(a.pose.rotations, b.pose.rotations)
        and np.array_equal(a.pose.pelvis_shift, b.pose.pelvis_shift)
    )


FULL = replace(START, held=7)
MOTIONS: dict[str, Callable[[], Motion]] = {
    "straight": lambda: walk(START, (3.0, 0.4)),
    "corners": lambda: walk(START, (1.8, -0.3), (1.8, 1.5), (-0.5, 1.5)),
    "back": lambda: walk(START, (-2.0, -0.6)),
    "one small step": lambda: walk(START, (0.45, -0.3)),
    "carrying": lambda: walk(FULL, (2.0, 1.0)),
    "glance": lambda: look_motion(START, replace(START, gaze=Vec3(1.6, 0.1, 0.4))),
    "turn": lambda: look_motion(START, START.facing(Vec3(-1.5, -1.0, 0.5))[0]),
    "from the floor": lambda: pick(START, ahead(START, 0.45, 0.04)),
    "from a table": lambda: pick(START, ahead(START, 0.6, 0.85)),
    "far over a table": lambda: pick(START, ahead(START, 0.9, 0.85)),
    "from a shelf": lambda: pick(START, ahead(START, 0.85, 1.97)),
    "overhead": lambda: pick(START, ahead(START, 0.1, 2.0)),
    "to the floor": lambda: drop(FULL, ahead(FULL, 0.7, 0.1)),
    "to a table behind": lambda: drop(FULL, ahead(FULL, -0.6, 0.85)),
    "to a shelf": lambda: drop(FULL, ahead(FULL, 0.7, 1.4)),
    "a bottle from a table": lambda: pick(START, ahead(START, 0.6, 0.87), THINGS["bottle"]),
    "a key from the floor": lambda: pick(START, ahead(START, 0.5, 0.01), THINGS["key"]),
    "a plate to a shelf": lambda: drop(FULL, ahead(FULL, 0.7, 1.4), THINGS["plate"]),
    "a plant from a table": lambda: pick(START, ahead(START, 0.6, 0.95), THINGS["plant"]),
    "a tray to a low table": lambda: drop(FULL, ahead(FULL, 0.6, 0.45), THINGS["tray"]),
}


@cache
def made(name: str) -> Motion:
    return MOTIONS[name]()


@pytest.fixture(params=MOTIONS)
def motion(request: pytest.FixtureRequest) -> Motion:
    """Every motion in turn."""
    return made(request.param)


# --- rotations and limbs ------------------------------------------------------------------------


@given(st.tuples(*[st.floats(-3, 3)] * 3).filter(lambda v: np.linalg.norm(v) > 0.1))
def test_looking_turns_x_to_the_direction_without_roll(direction):
    line = np.array(direction)
    turn = looking(line)
    assert np.allclose(turn[:, 0], line / np.linalg.norm(line))
    assert abs(turn[2, 1]) < 1e-12


@given(st.floats(-3, 3), st.floats(0, 1))
def test_blending_goes_along_the_shortest_arc(angle, weight):
    axis = (0.6, 0.0, 0.8)
    middle = blended(np.eye(3), about(axis, angle), weight)
    assert np.allclose(middle, about(axis, angle * weight), atol=1e-9)


@given(st.floats(-0.08, 0.08), st.floats(-0.06, 0.06), st.floats(-0.22, -0.03))
def test_feet_stay_planted_when_the_pelvis_moves(x, y, z):
    pose = replace(standing(), pelvis_shift=np.array([x, y, z]))
    planted, gap = plant_feet(pose, STANDING_FEET)
    places, rotations = joint_frames(planted)
    assert gap < 1e-6
    for side, foot in zip("lr", STANDING_FEET, strict=True):
        j = INDEX[f"foot_{side}"]
        assert np.allclose(places[j], [foot.x, foot.y, ANKLE_M], atol=1e-6)
        assert np.allclose(rotations[j], np.eye(3), atol=1e-9)
    assert limit_excess(planted).max() == 0.0


# --- postures -----------------------------------------------------------------------------------


def test_standing_breathes_and_keeps_its_weight_over_the_feet():
    still, full = standing(0.0), standing(2.0)
    lifted = joint_frames(full)[0] - joint_frames(still)[0]
    assert 0.002 < np.linalg.norm(lifted[INDEX["upper_arm_r"]]) < 0.02
    mass = centre_of_mass(still)
    assert -0.07 < mass[0] < 0.15
    assert abs(mass[1]) < 0.01


@few
@given(st.floats(-1.4, 1.4), st.floats(-1.2, 1.2))
def test_the_face_turns_to_where_one_looks(yaw, pitch):
    line = np.array([np.cos(pitch) * np.cos(yaw), np.cos(pitch) * np.sin(yaw), np.sin(pitch)])
    pose = gazing(standing(), line)
    face = joint_frames(pose)[1][INDEX["head"]][:, 0]
    # The eyes, which have no joint, do the rest.
    assert math.acos(min(1.0, float(face @ line))) < math.radians(27.0)
    assert limit_excess(pose).max() == 0.0


@pytest.mark.parametrize(
    "target", spread(TARGETS, 5), ids=lambda t: "_".join(f"{v:.2f}" for v in t)
)
def test_the_hand_meets_every_target_within_reach(target):
    pose = reaching(standing(), target)
    assert np.linalg.norm(grip(pose) - target) < 0.02
    assert limit_excess(pose).max() == 0.0
    places, _ = joint_frames(pose)
    assert places[LIMBS, 2].min() > -0.005
    feet = stretch_to(*(float(v) for v in target)).feet()
    for side, foot in zip("lr", feet, strict=True):
        assert np.linalg.norm(places[INDEX[f"foot_{side}"]] - foot.ankle()[0]) < 0.005
    if target[2] < 1.8:  # the very top asks for a moment of falling forward
        mass = centre_of_mass(pose)
        assert min(f.x for f in feet) - 0.06 < mass[0] < max(f.x for f in feet) + 0.20
        assert abs(mass[1] - np.mean([f.y for f in feet])) < 0.13


def test_the_left_hand_reaches_as_the_right_one_does():
    target = np.array([0.6, 0.1, 0.4])
    left = reaching(standing(), target, "l")
    assert np.linalg.norm(grip(left, "l") - target) < 0.02
    right = reaching(standing(), target * [1, -1, 1])
    assert np.allclose(mirrored(left).rotations, right.rotations, atol=1e-9)


def test_what_is_carried_is_in_the_hand_and_out_of_the_view_ahead():
    pose = carrying(standing())
    assert np.allclose(grip(pose), CARRY, atol=1e-6)
    camera = replace(START, gaze=ahead(START, 2.0, 1.6), held=7)
    held = BodyFrame(camera, at_rest(camera)).hand.array()[None]
    assert camera.camera(1280, 720).project(held)[0, 1] > 720
    down = replace(camera, gaze=ahead(START, 0.6, 1.0))
    u, v, depth = down.camera(1280, 720).project(held)[0]
    assert 0 < u < 1280
    assert 0 < v < 720
    assert depth > 0


def test_waiting_changes_the_posture_but_not_the_state():
    a, b = idle(START, 0.0), idle(START, 2.0)
    assert a.body == b.body == START
    assert not np.array_equal(a.pose.rotations, b.pose.rotations)


# --- every motion -------------------------------------------------------------------------------


def test_a_motion_begins_and_ends_exactly_in_its_states(motion):
    assert motion.at(0.0).body == motion.start
    last = motion.at(motion.duration_s)
    assert last.body == motion.end
    assert np.array_equal(last.pose.rotations, at_rest(motion.end, motion.thing).rotations)
    assert motion.body_at(motion.duration_s + 1.0) == motion.end


def test_a_motion_never_jumps_and_keeps_the_limits(motion):
    film = frames(motion)
    local = np.array([f.pose.rotations for f in film])
    turns = np.degrees(angles(local[:-1], local[1:]))
    assert turns.max() < MOST_TURN_DEG, JOINTS[int(turns.max(axis=0).argmax())]
    places = np.array([f.joints()[0] for f in film])
    assert np.linalg.norm(np.diff(places, axis=0), axis=2).max() * RATE_HZ < 5.5
    assert max(float(limit_excess(f.pose).max()) for f in film) == 0.0
    assert places[:, LIMBS, 2].min() > -0.005


def test_frames_do_not_depend_on_which_others_were_asked_for(motion):
    some = [motion.at(motion.duration_s * k / 7) for k in range(8)]
    again = [motion.at(motion.duration_s * k / 7) for k in reversed(range(8))]
    assert all(same(a, b) for a, b in zip(some, reversed(again), strict=True))


def test_a_motion_can_be_cancelled_at_any_time(motion):
    for part in (0.0, 0.3, 0.55, 0.8, 1.0):
        time_s = part * motion.duration_s
        body = motion.body_at(time_s)
        grasped = any(e.kind == "grasp" and e.time_s <= time_s for e in motion.events)
        released = any(e.kind == "release" and e.time_s <= time_s for e in motion.events)
        held = (motion.start.held is not None and not released) or grasped
        assert (body.held is not None) == held
        assert -math.pi < body.heading_rad <= math.pi
        assert look_motion(body, body.facing(Vec3(0.0, 0.0, 1.0))[0]).start == body


# --- walking ------------------------------------------------------------------------------------


@few
@given(coordinates, coordinates, coordinates, coordinates, bearings)
def test_planted_feet_do_not_slide(x1, y1, x2, y2, heading):
    points = [Vec3(0.0, 0.0, 0.0), Vec3(x1, y1, 0.0), Vec3(x2, y2, 0.0)]
    steps = gait(route(heading, points, math.atan2(y2 - y1, x2 - x1)))
    times = np.arange(0.0, steps.duration_s + 0.1, 1 / RATE_HZ)
    soles = [steps.feet(float(t)) for t in times]
    gaps = [0.0]
    for side in range(2):
        track = [s[side] for s in soles]
        grounded = [f.lift_m == 0.0 for f in track]
        where = np.array([[f.x, f.y] for f in track])
        moved = np.linalg.norm(np.diff(where, axis=0), axis=1)
        both = np.array(grounded[1:]) & np.array(grounded[:-1])
        gaps.append(float(moved[both].max(initial=0.0)))
    assert max(gaps) < 1e-9  # the plan; below, what the legs make of it
    assert max(_leg_error(steps, float(t)) for t in times[::3]) < 0.01


def _leg_error(steps, time_s: float) -> float:
    here = steps.stand(time_s)
    places, _ = joint_frames(steps.pose(time_s))
    cos, sin = math.cos(here.heading_rad), math.sin(here.heading_rad)
    turn = np.array([[cos, -sin, 0.0], [sin, cos, 0.0], [0.0, 0.0, 1.0]])
    worst = 0.0
    for side, foot in zip("lr", steps.feet(time_s), strict=True):
        at = turn @ places[INDEX[f"foot_{side}"]] + [here.x, here.y, 0.0]
        worst = max(worst, float(np.linalg.norm(at - foot.ankle()[0])))
    return worst


def test_a_long_walk_has_walking_speed_and_full_steps():
    motion = walk(START, (8.0, -0.3))
    a, b = (motion.at(motion.duration_s / 2 + d).body.position for d in (-0.5, 0.5))
    assert 1.0 < a.distance(b) < 1.25


def test_the_body_stays_near_the_path_and_turns_smoothly():
    motion = made("corners")
    film = frames(motion)
    near = min(math.hypot(f.body.position.x - 1.8, f.body.position.y + 0.3) for f in film)
    assert near < 0.07
    headings = np.unwrap([f.body.heading_rad for f in film])
    assert np.abs(np.diff(headings)).max() * RATE_HZ < math.radians(240)


def test_the_gaze_leads_the_body_in_a_turn():
    motion = made("turn")
    middle = motion.at(0.6)
    turned = wrap_angle(middle.body.heading_rad - START.heading_rad)
    yaw = math.atan2(*line_of_gaze(middle.body)[1::-1])
    assert abs(yaw) > math.radians(20.0)
    assert turned * yaw > 0


def test_the_carrying_hand_stays_in_front_while_walking():
    for frame in frames(made("carrying"), 15):
        assert np.linalg.norm(grip(frame.pose) - CARRY) < 0.05
        assert frame.hand.distance(BodyFrame(frame.body, at_rest(frame.body)).hand) < 0.05


# --- taking and putting down --------------------------------------------------------------------


@few
@given(st.floats(0.25, 0.9), bearings, st.floats(0.0, 2.07))
def test_the_hand_is_at_the_thing_when_it_grasps(distance, bearing, height):
    target = START.position + Vec3(
        distance * math.cos(bearing), distance * math.sin(bearing), height
    )
    motion = pick(START, target)
    (event,) = motion.events
    assert event.kind == "grasp"
    assert motion.at(event.time_s).hand.distance(target) < 0.02
    assert motion.body_at(event.time_s - 0.01).held is None
    assert motion.body_at(event.time_s).held == 7
    at_end = idle(motion.end, 0.0, motion.thing).hand
    assert motion.at(motion.duration_s).hand.distance(at_end) < 1e-6


def test_actions_follow_each_other():
    target = ahead(START, 0.6, 0.85)
    taken = pick(START, target)
    way = walk(taken.end, (2.0, 1.0))
    put = drop(way.end, ahead(way.end, 0.6, 0.5))
    whole = taken.then(way).then(put)
    assert whole.duration_s == pytest.approx(taken.duration_s + way.duration_s + put.duration_s)
    assert [e.kind for e in whole.events] == ["grasp", "release"]
    assert whole.body_at(taken.duration_s + 1.0).held == 7
    assert same(whole.at(whole.duration_s), put.at(put.duration_s))
    film = np.array([f.joints()[0] for f in frames(whole, 30)])
    assert np.linalg.norm(np.diff(film, axis=0), axis=2).max() * 30 < 5.5
    with pytest.raises(ValueError, match="must start in the state"):
        way.then(taken)


# --- clips --------------------------------------------------------------------------------------


@pytest.mark.parametrize("clip", clips(20.0), ids=lambda c: c.name)
def test_clips_loop(clip):
    assert clip.rotations.shape == (len(clip.times_s), len(JOINTS), 3, 3)
    assert np.degrees(angles(clip.rotations[0], clip.rotations[-1])).max() < 1.0
    assert np.allclose(clip.pelvis[0], clip.pelvis[-1], atol=0.002)


def test_the_walk_clip_has_two_equal_steps():
    clip = walk_clip(20.0)
    half = len(clip.times_s) // 2
    left, right = (clip.rotations[:half, INDEX[f"shin_{s}"]] for s in "lr")
    assert angles(left, np.eye(3)).max() == pytest.approx(angles(right, np.eye(3)).max(), abs=1.2)
    assert angles(left, np.eye(3)).max() > math.radians(35)
