"""In films eyes turn to what is looked at, and an own figure blinks by the shape of its face."""

from __future__ import annotations

import math

import mujoco
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from tests.runtime.human.own.rigs import Rig, rig

from adamo_vh.geometry import Vec3
from adamo_vh.runtime.embodiment import Stance
from adamo_vh.runtime.human.anatomy import lids, turned
from adamo_vh.runtime.human.face import MOST_LOOK_RAD, look_shares
from adamo_vh.runtime.human.face_mujoco import FaceParts
from adamo_vh.runtime.human.looks import LIDS_CLOSED_RAD, VARIANTS, load_figure
from adamo_vh.runtime.human.motion import idle
from adamo_vh.runtime.human.own.reading import own_figure_of
from adamo_vh.runtime.human.skeleton import INDEX, Pose
from adamo_vh.runtime.human.skin_mujoco import add_human

_AHEAD = (0.0, 0.0)


def posed(figure, closed_rad, look_rad=_AHEAD):
    """How far each vertex of the model has moved."""
    spec = mujoco.MjSpec()
    add_human(spec, figure)
    model = spec.compile()
    before = model.skin_vert.copy()
    parts = FaceParts.of(model, figure)
    parts.follow(turned(Pose(), lids(closed_rad)), (0.3, -0.3))
    parts.follow(turned(Pose(), lids(closed_rad)), look_rad)
    return model.skin_vert - before


def rows(figure, name):
    """The vertices of a garment."""
    number = next(i for i, g in enumerate(figure.garments) if g.name.endswith(name))
    start = sum(len(g.vertices) for g in figure.garments[:number])
    return slice(start, start + len(figure.garments[number].vertices))


@pytest.mark.parametrize("share", [0.0, 0.5, 1.0, 2.0])
def test_lids_close_as_far_as_the_pose_says(share):
    told = Rig("unity", garments=("lids", "shoes"), without=("eyelids",))
    figure = own_figure_of(rig(told), "x.glb").figure
    moved = posed(figure, share * LIDS_CLOSED_RAD)
    (shapes,) = (figure.shapes or {}).values()
    whole = shapes["eyeBlinkLeft"] + shapes["eyeBlinkRight"]
    np.testing.assert_allclose(moved[rows(figure, "lids")], min(share, 1.0) * whole, atol=1e-6)
    assert np.count_nonzero(moved) <= np.count_nonzero(whole)


def test_what_a_joint_closes_is_not_closed_twice():
    told = Rig("unity", garments=("lids", "shoes"))
    assert not posed(own_figure_of(rig(told), "x.glb").figure, LIDS_CLOSED_RAD).any()
    assert not posed(load_figure("mara"), LIDS_CLOSED_RAD).any()


@pytest.mark.parametrize("variant", VARIANTS)
@pytest.mark.parametrize(
    ("look_rad", "axis", "sign"),
    [((0.3, 0), 1, 1), ((-0.3, 0), 1, -1), ((0, 0.3), 2, -1), ((0, -0.3), 2, 1)],
    ids=["left", "right", "down", "up"],
)
def test_pupils_go_where_she_looks_and_nothing_else_moves(variant, look_rad, axis, sign):
    figure = load_figure(variant)
    moved = posed(figure, 0.0, look_rad)
    eyes = rows(figure, "eyes")
    ahead_m = figure["eyes"].vertices[:, 0]
    front = ahead_m > ahead_m.max() - 0.002
    assert (sign * moved[eyes][front, axis] > 0.002).all()
    moved[eyes] = 0.0
    assert not moved.any()


@given(st.floats(-2, 2), st.floats(-2, 2))
def test_no_shape_is_overdone_or_fights_another(left, down):
    shares = look_shares(left, down)
    assert all(0.0 <= share <= 1.0 for share in shares.values())
    for side in ("Left", "Right"):
        assert not shares[f"eyeLookUp{side}"] * shares[f"eyeLookDown{side}"]
        assert not shares[f"eyeLookIn{side}"] * shares[f"eyeLookOut{side}"]
    assert shares["eyeLookOutLeft"] == shares["eyeLookInRight"]


@given(st.floats(-math.pi, math.pi), st.floats(-1.2, 1.2), st.floats(0.5, 4.0))
def test_head_and_eyes_together_look_at_the_gaze(yaw, pitch, far):
    stance = Stance(Vec3(0, 0, 0), 0.0, Vec3(1, 0, 1.6), None)
    line = Vec3(math.cos(pitch) * math.cos(yaw), math.cos(pitch) * math.sin(yaw), math.sin(pitch))
    stance = Stance(stance.position, 0.0, stance.eyes + line * far, None)
    moment = idle(stance, 0.0)
    left, down = moment.look_rad
    assert max(abs(left), abs(down)) <= MOST_LOOK_RAD
    if abs(yaw) < math.radians(60) and abs(pitch) < math.radians(30):
        _, rotations = moment.joints()
        eye = [math.cos(down) * math.cos(left), math.cos(down) * math.sin(left), -math.sin(down)]
        seen = rotations[INDEX["head"]] @ eye
        wish = (stance.gaze - moment.eyes).array()
        off = math.acos(np.clip(seen @ wish / np.linalg.norm(wish), -1, 1))
        assert math.degrees(off) < 3.0
