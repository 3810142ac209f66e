"""Faces of several makers move by ARKit's names."""

from __future__ import annotations

import pytest
from tests.runtime.human.own.rigs import Rig, rig, t_pose

from adamo_vh.runtime.human.face import SHAPES
from adamo_vh.runtime.human.own.expressions import (
    BOTH,
    LEFT,
    RIGHT,
    Share,
    meaning_of_missing,
    shapes_of,
)
from adamo_vh.runtime.human.own.fields import Document
from adamo_vh.runtime.human.own.licence import licence_of
from adamo_vh.runtime.human.own.reading import own_figure_of


def document(names=(), **extensions):
    told = {
        "nodes": [{"mesh": 0}],
        "meshes": [
            {
                "primitives": [{"attributes": {"POSITION": 0}}],
                "extras": {"targetNames": list(names)},
            }
        ],
        "extensions": extensions,
    }
    return Document.model_validate(told)


def test_arkits_own_names_are_taken_first():
    found = shapes_of(document((*SHAPES, "viseme_aa", "blink")))
    assert found == {name: (Share(0, i, 1.0),) for i, name in enumerate(SHAPES)}


@pytest.mark.parametrize(
    ("name", "shape", "half"),
    [
        ("eyeBlink_L", "eyeBlinkLeft", BOTH),
        ("viseme_aa", "jawOpen", BOTH),
        ("mouthOpen", "jawOpen", BOTH),
        ("vrc.v_ou", "mouthPucker", BOTH),
        ("Fcl_MTH_O", "mouthFunnel", BOTH),
        ("Fcl_EYE_Close", "eyeBlinkRight", RIGHT),
        ("eyesClosed", "eyeBlinkLeft", LEFT),
        ("mouthSmile", "mouthSmileLeft", LEFT),
        ("Face.M_F00_000_00_Fcl_EYE_Close_L", "eyeBlinkLeft", BOTH),
    ],
)
def test_other_names_mean_the_same(name, shape, half):
    wanted = name.rpartition("M_F00_000_00_")[2]
    assert shapes_of(document((wanted,)))[shape] == (Share(0, 0, 1.0, half),)


def test_expressions_of_vrm_1():
    preset = {
        "aa": {"morphTargetBinds": [{"node": 0, "index": 3, "weight": 0.8}]},
        "blink": {"morphTargetBinds": [{"node": 0, "index": 1, "weight": 1.0}]},
        "happy": {"morphTargetBinds": "nonsense"},
        "sad": None,
    }
    found = shapes_of(document(VRMC_vrm={"expressions": {"preset": preset}}))
    assert found["jawOpen"] == (Share(0, 3, 0.8),)
    assert found["eyeBlinkLeft"] == (Share(0, 1, 1.0, LEFT),)
    assert found["eyeBlinkRight"] == (Share(0, 1, 1.0, RIGHT),)


def test_presets_of_vrm_0():
    groups = [
        {"presetName": "A", "binds": [{"mesh": 0, "index": 2, "weight": 50}]},
        {"presetName": "blink_l", "binds": [{"mesh": 0, "index": 4, "weight": 100}]},
        {"presetName": "o", "binds": [{"mesh": 7, "index": 0, "weight": 100}]},
        "nonsense",
    ]
    found = shapes_of(document(VRM={"blendShapeMaster": {"blendShapeGroups": groups}}))
    assert found == {"jawOpen": (Share(0, 2, 0.5),), "eyeBlinkLeft": (Share(0, 4, 1.0),)}


@pytest.mark.parametrize(
    "told",
    [
        {"VRMC_vrm": 3},
        {"VRMC_vrm": {"expressions": []}},
        {"VRMC_vrm": {"expressions": {"preset": {"aa": {"morphTargetBinds": [1, None, {}]}}}}},
        {"VRM": {"blendShapeMaster": {"blendShapeGroups": {"x": 1}}}},
        {"VRM": {"blendShapeMaster": None}},
    ],
)
def test_nonsense_moves_nothing(told):
    assert shapes_of(document(**told)) == {}


def test_what_a_face_cannot_do_is_told():
    assert meaning_of_missing({}) == [
        "does not blink",
        "eyes stay straight ahead",
        "lips do not follow speech",
        "does not smile",
        "brows do not move",
    ]
    assert meaning_of_missing(dict.fromkeys(SHAPES)) == []


@pytest.mark.parametrize("vrm", ["0", "1"])
def test_a_vrm_blinks_on_the_side_it_says(vrm):
    content = rig(Rig("nothing", t_pose(), vrm=vrm, garments=("lids", "shoes")))
    moves = own_figure_of(content, "x.vrm").figure.shapes
    assert moves is not None
    (lids,) = (by for name, by in moves.items() if name.endswith("lids"))
    assert abs(lids["eyeBlinkLeft"]).max() > 0.005


def test_a_jaw_that_is_a_bone_opens_the_mouth():
    content = rig(Rig("unity", garments=("head",), without=("eyelids",), plain=True))
    told = own_figure_of(content.replace(b'"Eyelids"', b'"jaw"    '), "x.glb")
    assert "jawOpen" not in told.report.shapes
    jawed = Rig("unity", garments=("lids", "shoes"), plain=True)
    made = own_figure_of(rig(jawed).replace(b'"Eyelids"', b'"jaw"    '), "x.glb")
    assert made.report.shapes == ("jawOpen",)
    (lids,) = (by for by in (made.figure.shapes or {}).values())
    assert lids["jawOpen"][:, 2].min() < -0.003
    assert lids["jawOpen"][:, 2].max() < 0.0005


def test_an_eye_that_is_a_bone_turns():
    eyed = Rig("unity", garments=("lids", "shoes"), plain=True)
    made = own_figure_of(rig(eyed).replace(b'"Eyelids"', b'"LeftEye"'), "x.glb")
    assert set(made.report.shapes) == {f"eyeLook{way}Left" for way in ("Up", "Down", "In", "Out")}
    assert "eyes stay straight ahead" not in made.report.without
    (lids,) = (by for by in (made.figure.shapes or {}).values())
    assert lids["eyeLookUpLeft"][:, 2].max() > 0.003
    assert lids["eyeLookOutLeft"][:, 1].max() > 0.003
    assert abs(lids["eyeLookOutLeft"][:, 2]).max() < 1e-6


@pytest.mark.parametrize("vrm", ["0", "1"])
def test_a_vrm_looks_left_with_both_eyes(vrm):
    bind = {"node": 0, "index": 2, "weight": 1.0}
    presets = {"VRMC_vrm": {"expressions": {"preset": {"lookLeft": {"morphTargetBinds": [bind]}}}}}
    groups = [{"presetName": "lookleft", "binds": [{"mesh": 0, "index": 2, "weight": 100}]}]
    told = presets if vrm == "1" else {"VRM": {"blendShapeMaster": {"blendShapeGroups": groups}}}
    assert shapes_of(document(**told)) == {
        "eyeLookOutLeft": (Share(0, 2, 1.0, LEFT),),
        "eyeLookInRight": (Share(0, 2, 1.0, RIGHT),),
    }


def test_what_a_licence_says_is_read_as_plain_text():
    meta = {"name": "A\u001b[31m", "authors": ["B", "C"], "allowRedistribution": False, "x": 1}
    found = licence_of(document(VRMC_vrm={"meta": meta}, VRM={"meta": {"licenseName": "CC_BY"}}))
    assert found == {
        "name": "A[31m",
        "authors": "B, C",
        "allowRedistribution": "False",
        "licenseName": "CC_BY",
    }
    assert licence_of(document(VRMC_vrm={"meta": 3}, VRM=None)) == {}
