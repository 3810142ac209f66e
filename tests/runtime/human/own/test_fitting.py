"""Figures of other proportions stand on our joints: soles on the floor, hands where ours are."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
from tests.runtime.human.own.rigs import (
    FINGERS,
    Y_UP,
    Y_UP_BACKWARDS,
    Z_UP,
    Rig,
    palms_forward,
    rig,
    t_pose,
)

from adamo_vh.errors import FileError
from adamo_vh.runtime.human.own.bones import Bones, bones_of
from adamo_vh.runtime.human.own.container import opened
from adamo_vh.runtime.human.own.fitting import fit_of
from adamo_vh.runtime.human.own.reading import own_figure_of
from adamo_vh.runtime.human.own.stature import stature_of
from adamo_vh.runtime.human.own.tree import tree_of
from adamo_vh.runtime.human.skeleton import INDEX, REST

SHORT = {"shin": 0.6, "foot": 0.6, "forearm": 0.8, "hand": 0.8, "chest": 0.8, "spine": 0.8}
TALL = {"shin": 1.3, "foot": 1.3, "forearm": 1.2, "upper_arm": 0.8, "neck": 0.9}
PARTS = ("hands", "shoes", "trousers")
RIGS = {
    "like ours": Rig("unity", t_pose(), garments=PARTS),
    "short": Rig("unity", t_pose(), Y_UP, 50.0, 0.6, True, offsets=SHORT, garments=PARTS),
    "tall": Rig("mixamo", t_pose(), Z_UP, offsets=TALL, garments=PARTS, turned=True),
    "backwards": Rig("unity", axes=Y_UP_BACKWARDS, offsets=TALL, garments=PARTS),
    "palms to the front": Rig("unity", palms_forward(), garments=PARTS, turned=True),
}
LANDS = {
    "leftUpperArm": "upper_arm_l",
    "rightLowerArm": "forearm_r",
    "leftHand": "hand_l",
    "rightUpperLeg": "thigh_r",
    "leftLowerLeg": "shin_l",
    "head": "head",
}


@cache
def fitted(name):
    content = rig(RIGS[name])
    tree = tree_of(opened(content).document)
    bones = bones_of(opened(content).document, tree)
    points = np.array([tree.place(n) for n in bones.nodes.values()])
    soles = np.array([tree.place(bones.nodes[f"{s}Toes"]) for s in ("left", "right")])
    stature, _ = stature_of(bones, tree, points, soles)
    return stature, fit_of(stature, 0.2 / stature.scale, bones.spine)


@cache
def figure(name):
    return own_figure_of(rig(RIGS[name]), f"{name}.glb").figure


def garment(made, name):
    return next(g for g in made.garments if g.name.endswith(name))


def put(fit, bone, place):
    return (fit.maps[bone] @ [*place, 1.0])[:3]


@pytest.mark.parametrize("name", RIGS)
@pytest.mark.parametrize("bone", LANDS)
def test_bones_land_on_our_joints(name, bone):
    stature, fit = fitted(name)
    place = put(fit, bone, stature.places[bone])
    np.testing.assert_allclose(place, REST[INDEX[LANDS[bone]]], atol=1e-6)


@pytest.mark.parametrize("name", RIGS)
def test_limbs_end_where_the_next_begins(name):
    stature, fit = fitted(name)
    for side in ("left", "right"):
        for bone, after in (
            ("UpperArm", "LowerArm"),
            ("LowerArm", "Hand"),
            ("UpperLeg", "LowerLeg"),
            ("LowerLeg", "Foot"),
        ):
            end = put(fit, side + bone, stature.places[side + after])
            begin = put(fit, side + after, stature.places[side + after])
            assert np.linalg.norm(end - begin) < (0.03 if after == "Foot" else 1e-6)


@pytest.mark.parametrize("name", RIGS)
def test_the_trunk_meets_shoulders_and_hips(name):
    stature, fit = fitted(name)
    for side, letter in (("left", "l"), ("right", "r")):
        hip = put(fit, "hips", stature.places[f"{side}UpperLeg"])
        shoulder = put(fit, f"{side}Shoulder", stature.places[f"{side}UpperArm"])
        np.testing.assert_allclose(hip, REST[INDEX[f"thigh_{letter}"]], atol=0.03)
        np.testing.assert_allclose(shoulder, REST[INDEX[f"upper_arm_{letter}"]], atol=0.05)


@pytest.mark.parametrize("name", RIGS)
def test_below_the_hips_nothing_jumps(name):
    _, fit = fitted(name)
    for x, y in ((0.1, 0.2), (-0.1, 0.0)):
        place = [x, y, fit.hips_z, 1.0]
        np.testing.assert_allclose(fit.hem @ place, fit.maps["hips"] @ place, atol=1e-9)


@pytest.mark.parametrize("name", RIGS)
def test_soles_are_on_the_floor(name):
    shoes = garment(figure(name), "shoes").vertices
    assert abs(shoes[:, 2].min()) < 0.002
    assert -0.15 < shoes[:, 0].min() < -0.04
    assert 0.15 < shoes[:, 0].max() < 0.3


@pytest.mark.parametrize("name", RIGS)
def test_thumbs_are_in_front_and_palms_inside(name):
    ours = garment(figure("like ours"), "hands").vertices
    hands = garment(figure(name), "hands").vertices
    for side in (1.0, -1.0):
        mine, theirs = (h[np.sign(h[:, 1]) == side] for h in (ours, hands))
        np.testing.assert_allclose(theirs.mean(axis=0), mine.mean(axis=0), atol=0.04)
        assert abs(theirs[:, 0].max() - mine[:, 0].max()) < 0.04


def test_a_large_head_stays_large_and_a_huge_one_does_not():
    tops = []
    for size in (1.0, 1.5, 4.0):
        told = Rig("unity", t_pose(), head=size, garments=("hair", "shoes"))
        tops.append(
            float(garment(own_figure_of(rig(told), "x").figure, "hair").vertices[:, 2].max())
        )
    assert tops[0] + 0.05 < tops[1] < tops[2] < REST[INDEX["head"], 2] + 0.45


def test_the_pose_of_the_file_is_told():
    told = {name: fitted(name)[0].rest_pose for name in ("like ours", "backwards")}
    assert told == {"like ours": "T", "backwards": "A"}
    assert fitted("backwards")[0].facing == "-Z"
    assert fitted("tall")[0].up == "+Z"


def lying():
    """A figure whose arms are as low as its hips."""
    pose = t_pose()
    return Rig("unity", pose, garments=("shoes",), offsets={"upper_arm": 1e-6, "clavicle": -3.0})


@pytest.mark.parametrize(
    ("told", "says"),
    [
        (Rig("unity", garments=("shoes",), offsets={"forearm": 0.0}), "left arm"),
        (Rig("unity", garments=("shoes",), offsets={"shin": 0.0}), "left leg"),
        (lying(), "upright|one place"),
    ],
)
def test_bones_in_one_place_are_refused(told, says):
    with pytest.raises(FileError) as caught:
        own_figure_of(rig(told), "x.glb")
    assert any(word in str(caught.value) for word in says.split("|"))


def test_the_trunk_is_numbered_from_below():
    bones = Bones({"hips": 0, "spine2": 3, "spine0": 1, "spine1": 2, "spine": 1, "head": 4}, "test")
    assert bones.spine == ("spine0", "spine1", "spine2")
    assert "spine" not in bones.lacking()
    assert "neck" in bones.lacking()


HALF = {f"{finger}_{k}": 1.3 for finger in ("index", "middle", "ring", "little") for k in (2, 3)}
HANDS = {
    "like ours": RIGS["like ours"],
    "long fingers": Rig("vroid", t_pose(), Y_UP, offsets=HALF, garments=PARTS, turned=True),
    "without fingers": Rig("unity", t_pose(), without=FINGERS, garments=PARTS),
}


@pytest.mark.parametrize("name", ["like ours", "long fingers"])
@pytest.mark.parametrize("finger", ["index", "little", "thumb"])
def test_fingers_bend_where_ours_do(name, finger):
    made = own_figure_of(rig(HANDS[name]), "x.glb").figure
    hands = garment(made, "hands")
    # What a joint moves lies beyond it along the finger, and near it.
    for k in (1, 2, 3):
        j = INDEX[f"{finger}_{k}_l"]
        mine = hands.vertices[(hands.weights * (hands.bone_ids == j)).max(axis=1) > 0.6]
        assert len(mine) > 5
        assert np.linalg.norm(mine - REST[j], axis=1).max() < 0.065
        assert np.linalg.norm(mine - REST[j], axis=1).min() < 0.02


def test_a_hand_without_finger_bones_stays_as_it_is():
    told = own_figure_of(rig(HANDS["without fingers"]), "x.glb")
    hands = garment(told.figure, "hands")
    used = {int(j) for j in np.unique(hands.bone_ids[hands.weights > 0])}
    assert not used & {INDEX[name] for name in FINGERS}
    assert "the hand does not close" in "\n".join(told.report.lines())
