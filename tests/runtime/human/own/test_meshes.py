"""Meshes as files have them: shared arrays, sparse ones, loose bones, several skins."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from tests.runtime.human.own.rigs import Rig, rig, t_pose, written

from adamo_vh.runtime.assets.glb_writing import FLOAT, INDICES, INT, SHORT, VERTICES, GlbWriter
from adamo_vh.runtime.human.looks import load_figure
from adamo_vh.runtime.human.own.container import opened
from adamo_vh.runtime.human.own.faults import Broken
from adamo_vh.runtime.human.own.numbers import Numbers
from adamo_vh.runtime.human.own.reading import own_figure_of
from adamo_vh.runtime.human.own.tree import tree_of
from adamo_vh.runtime.human.skeleton import INDEX

SHOES = Rig("unity", t_pose(), garments=("shoes",), plain=True)


def shoes(told=SHOES):
    return written(told, load_figure("mara"))


def arrays(writer):
    """The arrays of what a writer has, and how many it has."""
    writer.json["asset"] = {"version": "2.0"}
    return Numbers(opened(writer.file()))


def test_parts_that_share_their_vertices_are_each_what_they_show():
    writer = shoes()
    (primitive,) = writer.json["meshes"][0]["primitives"]
    indices = np.arange(0, 600)
    halves = []
    for number, corners in enumerate((indices[:300], indices[300:])):
        material = writer.add("materials", {"name": f"half {number}"})
        part = writer.accessor(corners, "SCALAR", INT, INDICES)
        halves.append({**primitive, "indices": part, "material": material})
    writer.json["meshes"][0]["primitives"] = halves * 20
    made = own_figure_of(writer.file(), "x.glb")
    assert made.report.triangles == 4000
    assert made.report.parts == 2
    assert sum(len(garment.vertices) for garment in made.figure.garments) == 20 * 600


def test_two_skins_are_one_figure():
    writer = shoes(Rig("unity", t_pose(), garments=("shoes", "hands"), plain=True))
    skin = dict(writer.json["skins"][0])
    second = writer.add("skins", skin)
    skinned = [node for node in writer.json["nodes"] if "skin" in node]
    skinned[1]["skin"] = second
    made = own_figure_of(writer.file(), "x.glb")
    assert made.report.skinned == 2


def test_a_bone_that_lies_loose_goes_with_the_nearest():
    """As where only deforming bones were exported, without those that hold them together."""
    writer = shoes()
    names = [node["name"] for node in writer.json["nodes"]]
    parent = names.index("LeftLowerLeg")
    leaf = next(c for c in writer.json["nodes"][parent]["children"] if names[c] == "LeftFoot")
    before = own_figure_of(writer.file(), "x.glb")
    tree = tree_of(opened(writer.file()).document)
    middle = (tree.place(leaf) + tree.place(parent)) / 2
    loose = writer.add("nodes", {"name": "DEF-twist", "translation": middle.tolist()})
    skin = writer.json["skins"][0]
    place = skin["joints"].index(leaf)
    matrices = Numbers(opened(writer.file())).floats(skin["inverseBindMatrices"], 16).copy()
    # What hung on the foot hangs on the loose bone now, where it was.
    matrices[place] = (
        (np.linalg.inv(translation(middle)) @ tree.matrices[leaf] @ matrices[place].reshape(4, 4).T)
        .T.ravel()
    )  # fmt: skip
    skin["joints"][place] = loose
    skin["inverseBindMatrices"] = writer.accessor(matrices, "MAT4", FLOAT)
    made = own_figure_of(writer.file(), "x.glb")
    weights = joint_weights(made.figure.garments[0])
    assert (
        weights[INDEX["shin_l"]] > 0.3 * joint_weights(before.figure.garments[0])[INDEX["foot_l"]]
    )
    assert weights[INDEX["pelvis"]] == 0


def translation(place):
    found = np.eye(4)
    found[:3, 3] = place
    return found


def joint_weights(garment):
    return np.bincount(
        garment.bone_ids.ravel().astype(int), garment.weights.ravel(), minlength=len(INDEX)
    )


def test_somebody_else_in_the_file_is_left_out():
    writer = shoes()
    other = writer.add("nodes", {"name": "prop bone", "translation": [9.0, 0.0, 0.0]})
    bones = len(writer.json["skins"][0]["joints"])
    skin = writer.add("skins", {"joints": [other] * bones})
    writer.add("nodes", {"name": "prop", "mesh": 0, "skin": skin})
    made = own_figure_of(writer.file(), "x.glb")
    assert made.report.skinned == 1
    assert any("hangs on no bone of the body" in note for note in made.report.notes)


def test_sparse_arrays_are_read():
    writer = GlbWriter()
    at = writer.view(np.array([1, 3], "<u2").tobytes())
    new = writer.view(np.array([[1, 2, 3], [4, 5, 6]], "<f4").tobytes())
    sparse: dict[str, Any] = {
        "count": 2,
        "indices": {"bufferView": at, "componentType": SHORT},
        "values": {"bufferView": new},
    }
    told: dict[str, Any] = {"componentType": FLOAT, "count": 5, "type": "VEC3", "sparse": sparse}
    number = writer.add("accessors", told)
    expected = np.zeros((5, 3))
    expected[1], expected[3] = (1, 2, 3), (4, 5, 6)
    np.testing.assert_array_equal(arrays(writer).floats(number, 3), expected)
    sparse["indices"]["componentType"] = FLOAT
    with pytest.raises(Broken, match=r"sparse|beyond"):
        arrays(writer).floats(number, 3)
    sparse["indices"]["componentType"] = SHORT
    told["count"] = 3
    with pytest.raises(Broken, match="sparse"):
        arrays(writer).floats(number, 3)


def test_whole_numbers_that_stand_for_shares_are_read():
    writer = GlbWriter()
    number = writer.shares(np.array([[0.0, 0.5, 1.0], [1.0, -1.0, 0.0]]), "VEC3", 5120)
    found = arrays(writer).floats(number, 3)
    np.testing.assert_allclose(found, [[0.0, 0.5, 1.0], [1.0, -1.0, 0.0]], atol=0.01)


def test_fractions_are_no_indices():
    writer = GlbWriter()
    number = writer.accessor(np.array([[0.5], [1.5]]), "SCALAR", FLOAT)
    with pytest.raises(Broken, match="fractions"):
        arrays(writer).wholes(number, 1)


def test_an_array_without_bytes_is_nothing():
    writer = GlbWriter()
    writer.view(bytes(4))
    number = writer.add("accessors", {"componentType": FLOAT, "count": 3, "type": "VEC3"})
    np.testing.assert_array_equal(arrays(writer).floats(number, 3), np.zeros((3, 3)))


def test_weights_that_sum_to_nothing_hang_on_the_first_bone():
    writer = shoes()
    attributes = writer.json["meshes"][0]["primitives"][0]["attributes"]
    count = writer.json["accessors"][attributes["POSITION"]]["count"]
    attributes["WEIGHTS_0"] = writer.accessor(np.zeros((count, 4)), "VEC4", FLOAT, VERTICES)
    made = own_figure_of(writer.file(), "x.glb").figure.garments[0]
    assert joint_weights(made)[INDEX["pelvis"]] == pytest.approx(len(made.vertices))


def test_what_a_tail_is_made_of_follows_the_hips():
    """Bones that are none of ours go with the one above them."""
    writer = shoes()
    names = [node["name"] for node in writer.json["nodes"]]
    foot, hips = names.index("LeftFoot"), names.index("Hips")
    tail = writer.add("nodes", {"name": "tail", "translation": [0.0, -0.1, -0.1]})
    writer.json["nodes"][hips]["children"].append(tail)
    skin = writer.json["skins"][0]
    skin["joints"][skin["joints"].index(foot)] = tail
    weights = joint_weights(own_figure_of(writer.file(), "x.glb").figure.garments[0])
    assert weights[INDEX["foot_l"]] == 0
    assert weights[INDEX["pelvis"]] > 100


def test_normals_are_made_where_there_are_none():
    writer = shoes()
    del writer.json["meshes"][0]["primitives"][0]["attributes"]["NORMAL"]
    made = own_figure_of(writer.file(), "x.glb").figure.garments[0]
    told = own_figure_of(rig(SHOES), "x.glb").figure.garments[0]
    np.testing.assert_allclose(np.linalg.norm(made.normals, axis=1), 1.0, atol=1e-4)
    assert (made.normals * told.normals).sum(axis=1).mean() > 0.9


def test_a_mirrored_mesh_is_not_inside_out():
    writer = shoes(Rig("unity", t_pose(), garments=("shoes",), plain=True, extra=True))
    hat = next(node for node in writer.json["nodes"] if node["name"] == "hat")
    hat["scale"] = [-1.0, 1.0, 1.0]
    made = own_figure_of(writer.file(), "x.glb").figure.garments
    (cube,) = (garment for garment in made if garment.material.name == "head")
    corners = cube.vertices[cube.faces]
    outward = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    middle = cube.vertices.mean(axis=0)
    assert ((corners.mean(axis=1) - middle) * outward).sum(axis=1).min() > 0
