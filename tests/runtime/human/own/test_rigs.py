"""Rigged humanoids of any names, poses, axes and sizes become the same figure."""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np
import pytest
from scipy.spatial import cKDTree
from tests.runtime.human.own.rigs import (
    FINGERS,
    Y_UP,
    Y_UP_BACKWARDS,
    Z_UP,
    Z_UP_BACK,
    Rig,
    palms_forward,
    rig,
    t_pose,
)

from adamo_vh.errors import FileError
from adamo_vh.runtime.human.face import moving_face
from adamo_vh.runtime.human.glb import figure_glb
from adamo_vh.runtime.human.looks import load_figure
from adamo_vh.runtime.human.own.names import meaning
from adamo_vh.runtime.human.own.reading import own_figure_of
from adamo_vh.runtime.human.skeleton import INDEX

GARMENTS = ("hands", "shoes", "lids")
SMALL: dict[str, Any] = {"garments": GARMENTS}
ALL = (*FINGERS, "toes_l", "toes_r", "clavicle_l", "clavicle_r", "neck", "eyelids")


@cache
def mara():
    garments = {g.name: g for g in moving_face(load_figure("mara")).figure.garments}
    return {name: garments[name] for name in GARMENTS}


def face(figure):
    """The shapes of a figure's garments."""
    assert figure.shapes is not None
    return figure.shapes


def distance_m(figure):
    """How far the figure's surface is from where Mara's is, at most."""
    ours = np.concatenate([garment.vertices for garment in mara().values()])
    theirs = np.concatenate([garment.vertices for garment in figure.garments])
    return max(cKDTree(a).query(b)[0].max() for a, b in ((ours, theirs), (theirs, ours)))


RIGS = {
    "Mixamo in centimetres": Rig("mixamo", t_pose(), Y_UP, 100.0, turned=True, **SMALL),
    "Unity, small and facing -Z": Rig("unity", t_pose(), Y_UP_BACKWARDS, size=0.6, **SMALL),
    "VRM 0.x": Rig("nothing", t_pose(), Y_UP_BACKWARDS, vrm="0", **SMALL),
    "VRM 1.0, tall": Rig("nothing", t_pose(), Y_UP, size=1.3, vrm="1", **SMALL),
    "Unreal, A pose, Z up": Rig("unreal", axes=Z_UP_BACK, turned=True, **SMALL),
    "Rigify, eight influences": Rig("rigify", t_pose(), Z_UP, turned=True, split=2, **SMALL),
    "VRoid without the optional": Rig("vroid", t_pose(), without=ALL, turned=True, **SMALL),
    "left and right exchanged": Rig("unity", t_pose(), swap=True, turned=True, **SMALL),
    "our names within": Rig("adamo", axes=Z_UP, **SMALL),
    "named as VRM 1.0, without its map": Rig("vrm", t_pose(), Y_UP, turned=True, **SMALL),
}


@pytest.mark.parametrize("name", RIGS)
def test_whatever_the_rig_the_figure_is_the_same(name):
    made = own_figure_of(rig(RIGS[name]), "x.glb")
    assert distance_m(made.figure) < 0.0005
    assert abs(made.report.drawn_m - max(g.vertices[:, 2].max() for g in mara().values())) < 0.001


def test_what_is_found_is_reported():
    made = own_figure_of(
        rig(Rig("mixamo", t_pose(), Y_UP, 100.0, extra=True, without=FINGERS, **SMALL)), "Me.glb"
    ).report
    assert made.source == "names of bones (Mixamo)"
    assert made.bones["leftUpperArm"] == "mixamorig:LeftArm"
    assert (made.up, made.facing, made.rest_pose, made.unit) == ("+Y", "+Z", "T", "centimetres")
    assert made.skinned == 3
    assert made.attached == 1
    assert any("stage hangs on no bone of the body" in note for note in made.notes)
    assert "the hand does not close" in "\n".join(made.lines())
    assert len(made.sha256) == 64


@pytest.mark.parametrize(("vrm", "author"), [("0", "author"), ("1", "authors")])
def test_the_licence_of_a_vrm_is_shown(vrm, author):
    report = own_figure_of(rig(Rig("nothing", vrm=vrm, **SMALL)), "x.vrm").report
    assert report.source == {"0": "VRM 0.x", "1": "VRM 1.0"}[vrm]
    assert report.licence[author] == "A. Tester"
    assert "A. Tester" in "\n".join(report.lines())


def test_weights_are_on_our_joints():
    made = own_figure_of(rig(Rig("unity", t_pose(), turned=True, **SMALL)), "x.glb")
    hands = next(g for g in made.figure.garments if g.name.endswith("hands"))
    used = {int(j) for j in np.unique(hands.bone_ids[hands.weights > 0])}
    fingers = {INDEX[name] for name in FINGERS}
    assert used <= {INDEX[f"{part}_{s}"] for part in ("forearm", "hand") for s in "lr"} | fingers
    assert used >= fingers
    np.testing.assert_allclose(hands.weights.sum(axis=1), 1.0, atol=1e-5)


def test_what_hangs_on_the_head_is_out_of_the_eyes_way():
    made = own_figure_of(rig(Rig("unity", extra=True, **SMALL)), "x.glb")
    roles = {garment.name.split("/")[1]: garment.material.name for garment in made.figure.garments}
    assert roles["lids"] == "lids"
    assert roles["shoes"] == "body/shoes"
    hat = made.figure.garments[-1]
    assert hat.material.name == "head"
    np.testing.assert_array_equal(np.unique(hat.bone_ids[hat.weights > 0]), [INDEX["head"]])


def test_palms_that_face_forward_are_turned_inwards():
    rigged = Rig("unity", palms_forward(), turned=True, **SMALL)
    told = own_figure_of(rig(rigged), "x.glb")
    assert distance_m(told.figure) < 0.06


def test_left_and_right_exchanged_is_told():
    report = own_figure_of(rig(RIGS["left and right exchanged"]), "x.glb").report
    assert any("exchanged" in note for note in report.notes)


def test_our_own_export_comes_back_as_it_was():
    ours = moving_face(load_figure("ken"))
    made = own_figure_of(figure_glb(load_figure("ken")), "ken.glb")
    assert made.report.source == "names of bones (VRM)"
    assert made.report.missing == {}
    assert len(made.report.bones) == 52
    assert len(made.figure.garments) == len(ours.figure.garments)
    for one, other in zip(ours.figure.garments, made.figure.garments, strict=True):
        used = np.unique(one.faces)
        np.testing.assert_allclose(other.vertices, one.vertices[used], atol=2e-4)
        np.testing.assert_allclose(other.uvs, one.uvs[used], atol=1e-5)
        np.testing.assert_allclose(other.normals, one.normals[used], atol=1e-3)
        if one.material.texture is not None:
            np.testing.assert_array_equal(other.material.texture, one.material.texture)
    assert {s for m in face(made.figure).values() for s in m} == {
        s for m in ours.shapes.values() for s in m
    }


def test_shapes_move_as_in_the_file():
    made = own_figure_of(rig(Rig("unity", t_pose(), Y_UP, 100.0, turned=True, **SMALL)), "x.glb")
    ours = moving_face(load_figure("mara")).shapes["lids"]["eyeBlinkLeft"]
    theirs = next(m for name, m in face(made.figure).items() if name.endswith("lids"))
    size = np.linalg.norm(theirs["eyeBlinkLeft"], axis=1)
    np.testing.assert_allclose(
        np.sort(size[size > 1e-6]),
        np.sort(np.linalg.norm(ours, axis=1)[np.linalg.norm(ours, axis=1) > 1e-6]),
        atol=1e-4,
    )


def test_missing_bones_are_named_with_what_helps():
    with pytest.raises(FileError, match=r"^x.glb: bones are missing: hips.*export it as VRM"):
        own_figure_of(rig(Rig("nothing", **SMALL)), "x.glb")


@pytest.mark.parametrize(
    ("name", "bone"),
    [
        ("mixamorig:LeftForeArm", "leftLowerArm"),
        ("mixamorig1:RightUpLeg", "rightUpperLeg"),
        ("Left Upper Arm", "leftUpperArm"),
        ("J_Bip_R_LowerLeg", "rightLowerLeg"),
        ("upperarm_r", "rightUpperArm"),
        ("DEF-thigh.L", "leftUpperLeg"),
        ("Bip01 L Forearm", "leftLowerArm"),
        ("CC_Base_R_Hand", "rightHand"),
        ("Bip01 L Finger0", "leftThumb1"),
        ("Bip01 R Finger12", "rightIndex3"),
        ("left_elbow", "leftLowerArm"),
        ("rForeArm", "rightLowerArm"),
        ("lHand", "leftHand"),
        ("LeftHandIndex2", "leftIndex2"),
        ("Right Middle Proximal", "rightMiddle1"),
        ("DEF-f_ring.01.R", "rightRing1"),
        ("J_Bip_L_Little3", "leftLittle3"),
        ("thumb_02_l", "leftThumb2"),
        ("Hips", "hips"),
        ("upper_arm_l", "leftUpperArm"),
        ("rightIndexIntermediate", "rightIndex2"),
    ],
)
def test_names_of_bones_are_understood(name, bone):
    told = meaning(name)
    assert told is not None
    assert told.bone == bone


@pytest.mark.parametrize(
    "name", ["Camera", "LeftToe_End", "hair_01", "", "Skirt.L.002", "頭", "LeftIndex99"]
)
def test_other_names_mean_nothing(name):
    assert meaning(name) is None
